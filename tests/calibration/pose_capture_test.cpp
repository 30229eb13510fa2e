#include "calibration/capture/pose_capture.h"

#include <deque>
#include <fstream>
#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <opencv2/imgproc.hpp>

#include "calibration/capture/camera_controls.h"
#include "calibration/decode/capture_folder.h"
#include "calibration/lab/board_lab.h"
#include "core/base/error.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/long_tests.h"

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr glm::ivec2 kCameraSize{360, 288};

CalibratedCamera smallCamera() {
    return withSize(defaultLabCamera(defaultInstallation().projectors.front().camera), kCameraSize);
}

/// A lab with a small camera and projector.
Installation smallRoom() {
    Installation room = defaultInstallation();
    InstalledProjector& projector = room.projectors.front();
    projector.camera = withSize(projector.camera, {320, 200});
    InstalledCamera camera;
    camera.camera = withSize(defaultLabCamera(defaultInstallation().projectors.front().camera), kCameraSize);
    room.cameras = {camera};
    return room;
}

/// The lab's light as a real camera sees it: by a clock, after a delay, in frames that are exposed for a while.
struct SlowLab {
    BoardLab lab;
    ManualClock clock;
    Microseconds delay{70'000}; ///< from what is sent to its light
    Microseconds frame{33'000}; ///< from one frame to the next, exposed all the time
    double drift = 0.0;         ///< of the exposure, a frame
    int frames = 0;
    std::function<void(int frame)> before; ///< each frame
    std::function<cv::Mat(int frame, const cv::Mat&)> change;
    std::function<void(const cv::Mat& picture, cv::Mat& sent)> correct; ///< what the projector makes of its picture
    bool isShown = false;

    explicit SlowLab(const BoardLabOptions& options = {})
        : lab(smallRoom(), parseCalibrationBoard("chess:6x5:48"), options) {
        lab.lay(lab.proposePoses(2)[1]);
        queue.push_back({Microseconds(-10'000'000), cv::Mat::zeros(200, 320, CV_8U)});
    }

    struct Sent {
        Microseconds at;
        cv::Mat picture;
    };
    std::deque<Sent> queue;

    /// What the projector's light is at a moment.
    [[nodiscard]] const cv::Mat& lightAt(Microseconds when) const {
        const cv::Mat* light = &queue.front().picture;
        for (const Sent& sent : queue)
            if (sent.at + delay <= when) light = &sent.picture;
        return *light;
    }
    cv::Mat photograph(const cv::Mat& light) {
        lab.show(light);
        return lab.photograph();
    }
};

class SlowDisplay final : public PatternDisplay {
public:
    explicit SlowDisplay(SlowLab& lab) : lab_(lab) {}
    [[nodiscard]] cv::Size size() const override { return {320, 200}; }
    void show(const cv::Mat& picture, const Progress& progress) override {
        progress.throwIfCancelled();
        checkPicture(picture, size());
        cv::Mat sent = picture.clone();
        if (lab_.correct) lab_.correct(picture, sent);
        lab_.queue.push_back({lab_.clock.now(), sent});
        lab_.isShown = true;
    }
    void clear() override {
        lab_.queue.push_back({lab_.clock.now(), cv::Mat::zeros(size(), CV_8U)});
        lab_.isShown = false;
    }

private:
    SlowLab& lab_;
};

class SlowCamera final : public CaptureCamera {
public:
    explicit SlowCamera(SlowLab& lab) : lab_(lab) {}
    [[nodiscard]] cv::Mat grab(const Progress& progress) override {
        progress.throwIfCancelled();
        if (lab_.before) lab_.before(lab_.frames);
        // Frames begin at fixed times; the next after the call is exposed until the one after begins.
        const Microseconds begin = (lab_.clock.now() / lab_.frame + 1) * lab_.frame;
        const cv::Mat& first = lab_.lightAt(begin);
        const cv::Mat& last = lab_.lightAt(begin + lab_.frame);
        cv::Mat seen = lab_.photograph(last);
        if (&first != &last) { // the change falls into the exposure
            cv::Mat both;
            cv::addWeighted(lab_.photograph(first), 0.6, seen, 0.4, 0.0, both);
            seen = both;
        }
        seen.convertTo(seen, CV_8U, 1.0 + lab_.drift * lab_.frames);
        if (lab_.change) seen = lab_.change(lab_.frames, seen);
        ++lab_.frames;
        lab_.clock.advance(begin + lab_.frame - lab_.clock.now());
        return seen;
    }
    [[nodiscard]] std::string name() const override { return "slow"; }
    [[nodiscard]] cv::Size size() const override { return {kCameraSize.x, kCameraSize.y}; }

private:
    SlowLab& lab_;
};

/// Pictures from files, in place of a camera.
class RecordedImages final : public CaptureCamera {
public:
    explicit RecordedImages(std::vector<fs::path> files) : files_(std::move(files)) {}
    [[nodiscard]] cv::Mat grab(const Progress&) override {
        if (next_ == files_.size()) throw DataError(name(), "holds no more images", "give one for each pattern");
        const fs::path& file = files_[next_++];
        return readGrey(file, file.parent_path().filename().string());
    }
    [[nodiscard]] std::string name() const override { return "images"; }
    [[nodiscard]] cv::Size size() const override { return {}; }
    [[nodiscard]] bool isLive() const override { return false; }

private:
    std::vector<fs::path> files_;
    std::size_t next_ = 0;
};

struct SlowCapture {
    SlowLab lab;
    SlowDisplay display{lab};
    SlowCamera camera{lab};
    PoseCaptureSettings settings;

    explicit SlowCapture(const BoardLabOptions& options = {}) : lab(options) {
        settings.order = parsePattern("graycode", {320, 200});
        settings.clock = std::shared_ptr<const Clock>(&lab.clock, [](const Clock*) {});
        settings.board = lab.lab.board();
    }
    [[nodiscard]] CapturedPose capture(const std::string& name = "pose_1") {
        return PoseCapture(camera, display, settings).capture(name);
    }
};

std::string refusalOf(const CapturedPose& pose) {
    return pose.findings.refusal ? std::string(keyOf(pose.findings.refusal->cause)) : "sound";
}

std::vector<std::string> warningsOf(const CapturedPose& pose) {
    std::vector<std::string> keys;
    for (const Finding& finding : pose.findings.warnings) keys.emplace_back(keyOf(finding.cause));
    return keys;
}

TEST(SettleTime, IsWhatProjectorAndCameraTakeTogether) {
    struct Case {
        int delay, frame; ///< milliseconds
    };
    for (const Case& one : {Case{0, 33}, Case{70, 33}, Case{180, 20}, Case{40, 200}}) {
        SlowCapture slow;
        slow.lab.delay = Microseconds(one.delay * 1000);
        slow.lab.frame = Microseconds(one.frame * 1000);
        PoseCapture capture(slow.camera, slow.display, slow.settings);
        const SettleTime& measured = capture.measureSettle();
        // A frame that begins later than the delay is complete; the earliest such call comes up to a frame later.
        EXPECT_GE(measured.delay, Microseconds(std::max(0, one.delay - one.frame) * 1000)) << one.delay;
        EXPECT_LE(measured.delay, Microseconds((one.delay + one.frame) * 1300)) << one.delay;
        EXPECT_EQ(measured.lateFrames > 0, one.delay > one.frame) << one.delay << ' ' << measured.lateFrames;
        EXPECT_GT(measured.contrast, 50.0);
        EXPECT_FALSE(slow.lab.isShown) << "the screen is given back";
    }
}

TEST(SettleTime, CameraThatSeesNothingOrNeverRestsIsRefused) {
    SlowCapture dark;
    dark.lab.change = [](int, const cv::Mat& seen) { return cv::Mat(seen.size(), CV_8U, cv::Scalar(60)); };
    PoseCapture blind(dark.camera, dark.display, dark.settings);
    try {
        (void)blind.measureSettle();
        ADD_FAILURE() << "it sees nothing";
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(refused.finding().cause, Cause::boardUnlit);
    }
    SlowCapture restless;
    restless.lab.change = [](int frame, const cv::Mat& seen) { return cv::Mat(seen * (frame % 2 == 0 ? 0.5 : 1.0)); };
    PoseCapture never(restless.camera, restless.display, restless.settings);
    try {
        (void)never.measureSettle();
        ADD_FAILURE() << "it flickers";
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(refused.finding().cause, Cause::lateFrame);
    }
    EXPECT_FALSE(restless.lab.isShown);
}

TEST(PoseCapture, SoundPoseIsWhatTheLabShowsUnderEachPattern) {
    for (const char* pattern : {"graycode", "phase:16x3+1x3"}) {
        BoardLabOptions quiet;
        quiet.noise = quiet.shotNoise = quiet.tremble = 0.0;
        SlowCapture slow(quiet);
        slow.settings.order = parsePattern(pattern, {320, 200});
        int told = 0;
        slow.settings.onShot = [&told](const Shot& shot) { EXPECT_EQ(shot.index, told++); };
        const CapturedPose pose = slow.capture();
        EXPECT_EQ(refusalOf(pose), "sound") << sentenceOf(*pose.findings.refusal);
        EXPECT_THAT(warningsOf(pose), IsEmpty()) << pattern;
        ASSERT_EQ(pose.images.size(), slow.settings.order.images.size());
        EXPECT_EQ(told, static_cast<int>(pose.images.size()));
        for (std::size_t i = 0; i < pose.images.size(); ++i) {
            const cv::Mat expected = slow.lab.photograph(drawPattern(slow.settings.order.images[i], {320, 200}));
            EXPECT_LE(cv::norm(pose.images[i], expected, cv::NORM_INF), 1.0) << pattern << ' ' << pose.files[i];
        }
        EXPECT_FALSE(slow.lab.isShown);
    }
}

/// What goes wrong at one frame or from it on, counted from the first shot of the pose.
struct CaptureFault {
    const char* what;
    std::function<void(SlowCapture&)> make;
    const char* refused; ///< key; "sound": told as a warning
    const char* warned = "";
};

/// From which frame on the patterns themselves are taken: counted in a capture without a fault.
int firstPatternFrame() {
    static const int kFirst = [] {
        SlowCapture slow;
        int first = 0;
        slow.settings.onShot = [&](const Shot& shot) {
            if (shot.index == 0) first = slow.lab.frames;
        };
        (void)slow.capture();
        return first;
    }();
    return kFirst;
}

TEST(PoseCapture, EachFaultIsToldByItsCauseAsItComes) {
    const int first = firstPatternFrame();
    ASSERT_GT(first, 10);
    const auto moved = [](const CalibratedCamera& camera, double millimetres) {
        CalibratedCamera other = camera;
        other.cameraFromWorld[3].x += 0.001 * millimetres;
        return other;
    };
    const std::vector<CaptureFault> faults = {
        {"camera moved",
         [&](SlowCapture& slow) {
             slow.lab.before = [&slow, &moved, first](int frame) {
                 if (frame == first + 30) slow.lab.lab.setCamera(moved(smallCamera(), 8.0));
             };
         },
         "rig_moved"},
        {"board moved",
         [&](SlowCapture& slow) {
             slow.lab.before = [&slow, first](int frame) {
                 glm::dmat4 pose = slow.lab.lab.proposePoses(2)[1];
                 pose[3].z += 0.008;
                 if (frame == first + 30) slow.lab.lab.lay(pose);
             };
         },
         "rig_moved"},
        {"projector slower than it was",
         [&](SlowCapture& slow) {
             slow.lab.before = [&slow, first](int frame) {
                 if (frame == first + 20) slow.lab.delay += Microseconds(200'000);
             };
         },
         "late_frame"},
        {"projector a little slower, change within an exposure",
         [&](SlowCapture& slow) {
             slow.lab.before = [&slow, first](int frame) {
                 if (frame == first + 20) slow.lab.delay += Microseconds(110'000);
             };
         },
         "late_frame"},
        {"camera stuck",
         [&](SlowCapture& slow) {
             auto last = std::make_shared<cv::Mat>();
             slow.lab.change = [last, first](int frame, const cv::Mat& seen) {
                 if (frame < first + 20) *last = seen.clone();
                 return last->clone();
             };
         },
         "doubled_image"},
        {"exposure drifts", [&](SlowCapture& slow) { slow.lab.drift = -0.0009; }, "sound", "exposure_drifts"},
        {"exposure drifts much",
         [&](SlowCapture& slow) {
             slow.lab.change = [first](int frame, const cv::Mat& seen) {
                 return cv::Mat(seen * (1.0 - 0.003 * std::max(0, frame - first)));
             };
         },
         "exposure_drifts"},
        {"light jumps",
         [&](SlowCapture& slow) {
             slow.lab.change = [first](int frame, const cv::Mat& seen) {
                 return cv::Mat(seen * (frame < first + 20 ? 1.0 : 0.72));
             };
         },
         "exposure_drifts"},
        {"light jumps a shot later",
         [&](SlowCapture& slow) {
             slow.lab.change = [first](int frame, const cv::Mat& seen) {
                 return cv::Mat(seen * (frame < first + 24 ? 1.0 : 0.8));
             };
         },
         "exposure_drifts"},
        {"exposure finds itself another value, step by step",
         [&](SlowCapture& slow) {
             slow.lab.change = [first](int frame, const cv::Mat& seen) {
                 return cv::Mat(seen * (0.6 + 0.4 * std::pow(0.7, std::max(0, frame - first - 20))));
             };
         },
         "exposure_drifts"},
        {"overexposed",
         [&](SlowCapture& slow) { slow.lab.change = [](int, const cv::Mat& seen) { return cv::Mat(seen * 3.0); }; },
         "clipped"},
        {"underexposed",
         [&](SlowCapture& slow) { slow.lab.change = [](int, const cv::Mat& seen) { return cv::Mat(seen * 0.15); }; },
         "sound", "underexposed"},
        {"camera mirrored",
         [&](SlowCapture& slow) {
             slow.lab.change = [](int, const cv::Mat& seen) {
                 cv::Mat mirror;
                 cv::flip(seen, mirror, 1);
                 return mirror;
             };
         },
         "mirrored"},
        {"size changes",
         [&](SlowCapture& slow) {
             slow.lab.change = [first](int frame, const cv::Mat& seen) {
                 return frame < first + 20 ? seen : cv::Mat(seen(cv::Rect(0, 0, 300, 200)));
             };
         },
         "image_size"},
        {"hand in the light",
         [&](SlowCapture& slow) {
             slow.lab.change = [first](int frame, const cv::Mat& seen) {
                 cv::Mat covered = seen.clone();
                 if (frame > first + 25) covered(cv::Rect(170, 45, 40, 110)) = cv::Scalar(30);
                 return covered;
             };
         },
         "wrong_order"},
        {"another board", [&](SlowCapture& slow) { slow.settings.board = parseCalibrationBoard("chess:7x6:48"); },
         "board_not_found"},
    };
    for (const CaptureFault& fault : faults) {
        SlowCapture slow;
        fault.make(slow);
        std::string refused;
        std::vector<std::string> warned;
        std::size_t taken = 0;
        std::string sentence;
        try {
            const CapturedPose pose = slow.capture();
            refused = refusalOf(pose);
            warned = warningsOf(pose);
            taken = pose.images.size();
            if (pose.findings.refusal) sentence = sentenceOf(*pose.findings.refusal);
            EXPECT_TRUE(pose.isSound() || taken < slow.settings.order.images.size()) << fault.what << ": ends at once";
        } catch (const CaptureRefused& why) { // while it measured how late light comes
            refused = keyOf(why.finding().cause);
        }
        EXPECT_EQ(refused, fault.refused) << fault.what << ": " << sentence;
        if (refused == "sound") {
            EXPECT_EQ(warned, std::vector<std::string>{fault.warned}) << fault.what;
        }
        EXPECT_FALSE(slow.lab.isShown) << fault.what;
        std::printf("%-55s %-16s %zu of %zu shots  %s\n", fault.what, refused.c_str(), taken,
                    slow.settings.order.images.size(), sentence.c_str());
    }
}

TEST(PoseCapture, BusierMachineIsWaitedForAndTheSamePoseTakenAgain) {
    const int first = firstPatternFrame();
    SlowCapture slow;
    slow.settings.triesWhenLate = 3;
    slow.lab.before = [&slow, first](int frame) {
        if (frame == first + 20) slow.lab.delay += Microseconds(200'000);
    };
    const CapturedPose pose = slow.capture();
    EXPECT_EQ(refusalOf(pose), "sound");
    ASSERT_EQ(pose.images.size(), slow.settings.order.images.size());
    for (std::size_t i = 0; i < pose.images.size(); i += 7) { // noise is some grey levels
        const cv::Mat expected = slow.lab.photograph(drawPattern(slow.settings.order.images[i], {320, 200}));
        EXPECT_LE(cv::norm(pose.images[i], expected, cv::NORM_L1) / static_cast<double>(expected.total()), 3.0)
            << pose.files[i];
    }
}

TEST(PoseCapture, KeystoneIsToldBeforeTheFirstPose) {
    // A projector mixes what it scales before it becomes light.
    const cv::Matx33d scaled(0.93, 0.0, 11.0, 0.0, 0.93, 7.0, 0.0, 0.0, 1.0);
    const cv::Matx33d slightlyScaled(0.99, 0.0, 1.3, 0.0, 0.99, 0.7, 0.0, 0.0, 1.0);
    const cv::Matx33d keystone(0.97, 0.03, 2.0, 0.0, 0.95, 3.0, 0.0, 0.0003, 1.0);
    struct Case {
        const char* what;
        std::optional<cv::Matx33d> warp;
        double cameraGamma;
    };
    for (const Case& one :
         {Case{"none", {}, 1.0}, Case{"none, camera with gamma", {}, 2.2}, Case{"scaled", scaled, 1.0},
          Case{"slightly scaled", slightlyScaled, 1.0}, Case{"keystone", keystone, 1.0}}) {
        SlowCapture slow;
        slow.settings.board.reset();
        slow.settings.order = parsePattern("phase:8x3+1x3", {320, 200});
        if (one.warp)
            slow.lab.correct = [&one](const cv::Mat& picture, cv::Mat& sent) {
                cv::warpPerspective(picture, sent, *one.warp, picture.size(), cv::INTER_LINEAR);
            };
        if (one.cameraGamma != 1.0)
            slow.lab.change = [&one](int, const cv::Mat& seen) {
                cv::Mat1f light;
                seen.convertTo(light, CV_32F, 1.0 / 255.0);
                cv::pow(light, 1.0 / one.cameraGamma, light);
                cv::Mat bent;
                light.convertTo(bent, CV_8U, 255.0);
                return bent;
            };
        const std::vector<std::string> warned = warningsOf(slow.capture());
        EXPECT_EQ(warned, one.warp ? std::vector<std::string>{"keystone"} : std::vector<std::string>{}) << one.what;
    }
}

TEST(PoseCapture, CancelledGivesTheScreenBack) {
    SlowCapture slow;
    std::stop_source stop;
    slow.settings.onShot = [&stop](const Shot& shot) {
        if (shot.index == 5) stop.request_stop();
    };
    PoseCapture capture(slow.camera, slow.display, slow.settings);
    EXPECT_THROW((void)capture.capture("pose_1", Progress({}, stop.get_token())), Cancelled);
    EXPECT_FALSE(slow.lab.isShown);
}

/// A capture on disk, as somebody else made it.
std::vector<fs::path> writePose(const fs::path& folder, SlowCapture& slow) {
    const CapturedPose pose = slow.capture("pose_1");
    savePose(folder, pose);
    return imagesIn(folder / "pose_1");
}

TEST(PoseCapture, ImagesOnDiskAreCheckedTheSameWay) {
    const TemporaryFolder folder;
    SlowCapture slow;
    const std::vector<fs::path> sound = writePose(folder.path(), slow);
    struct Case {
        const char* what;
        std::function<void(std::vector<fs::path>&)> change;
        const char* refused;
    };
    const std::vector<Case> cases = {
        {"as it was", [](auto&) {}, "sound"},
        {"one late",
         [](auto& files) {
             files.insert(files.begin() + 6, fs::path(files[5]));
             files.pop_back();
         },
         "doubled_image"},
        {"one missing", [](auto& files) { files.erase(files.begin() + 6); }, "wrong_order"},
        {"the last missing", [](auto& files) { files.pop_back(); }, "missing_image"},
        {"one twice", [](auto& files) { files.insert(files.begin() + 7, fs::path(files[6])); }, "doubled_image"},
        {"black and white swapped", [](auto& files) { std::swap(files.end()[-1], files.end()[-2]); },
         "black_white_swapped"},
        {"no picture",
         [&](auto& files) {
             std::ofstream(folder / "broken.png") << "nothing";
             files[4] = folder / "broken.png";
         },
         "unreadable_image"},
    };
    for (const Case& one : cases) {
        std::vector<fs::path> files = sound;
        one.change(files);
        RecordedImages camera(files);
        PoseCapture capture(camera, slow.display, slow.settings);
        const CapturedPose pose = capture.capture("pose_1");
        EXPECT_EQ(refusalOf(pose), one.refused)
            << one.what << ": " << (pose.findings.refusal ? sentenceOf(*pose.findings.refusal) : "");
    }
}

/// Other seeds, poses and amounts of noise, room light and trembling: none may be refused or doubted.
TEST(PoseCapture, SoundCapturesAreNeitherRefusedNorDoubted) {
    constexpr int kFirst = 1000; // the limits were chosen on those below
    const int count = longTests() ? 40 : 4;
    int refused = 0;
    int warned = 0;
    for (int seed = kFirst; seed < kFirst + count; ++seed) {
        std::mt19937 dice(static_cast<unsigned>(seed));
        std::uniform_real_distribution<double> share(0.0, 1.0);
        BoardLabOptions options;
        options.noise = 0.4 + 1.2 * share(dice);
        options.ambient = 0.1 * share(dice);
        options.tremble = 0.1 * share(dice);
        options.blur = 0.3 + 0.8 * share(dice);
        options.vignetting = 0.4 * share(dice);
        options.whiteLevel = 120.0 + 110.0 * share(dice);
        SlowCapture slow(options);
        slow.lab.lab.lay(slow.lab.lab.proposePoses(2)[static_cast<std::size_t>(seed / 2) % 2]);
        slow.lab.delay = Microseconds(static_cast<int>(120'000 * share(dice)));
        if (seed % 2 != 0) slow.settings.order = parsePattern("phase:16x3+1x3", {320, 200});
        const CapturedPose pose = slow.capture();
        refused += !pose.isSound();
        warned += !pose.findings.warnings.empty();
        if (!pose.isSound()) std::printf("%d: %s\n", seed, sentenceOf(*pose.findings.refusal).c_str());
        for (const Finding& warning : pose.findings.warnings)
            std::printf("%d: %s\n", seed, sentenceOf(warning).c_str());
    }
    std::printf("of %d sound captures %d refused, %d doubted\n", count, refused, warned);
    EXPECT_EQ(refused, 0);
    EXPECT_EQ(warned, 0);
}

/// A real projector and camera.
TEST(PoseCapture, RealCapturesAreNotRefused) {
    const fs::path data = fs::path(LUMORPH_SHARED_DIR) / "data/procam_chess";
    if (!fs::exists(data)) GTEST_SKIP() << "the shared data is not there";
    SlowCapture slow; // for its display, which a recording does not need
    for (const CapturedView& view : viewsIn(data)) {
        if (!longTests() && view.name != "capture_4") continue; // its board is near the picture's edge
        RecordedImages camera(view.files);
        PoseCaptureSettings settings;
        settings.order = parsePattern("graycode", {1024, 768});
        settings.board = parseCalibrationBoard("chess:9x7:75");
        PoseCapture capture(camera, slow.display, settings);
        const CapturedPose pose = capture.capture(view.name);
        EXPECT_EQ(refusalOf(pose), "sound")
            << view.name << ": " << (pose.findings.refusal ? sentenceOf(*pose.findings.refusal) : "");
        for (const Finding& warning : pose.findings.warnings) std::printf("%s\n", sentenceOf(warning).c_str());
    }
}

TEST(SavedPose, IsReadInTheOrderOfThePatternsAndReplacedAsAWhole) {
    const TemporaryFolder folder;
    CapturedPose pose;
    pose.name = "pose_1";
    for (int i = 0; i < 12; ++i) {
        pose.images.push_back(cv::Mat(40, 50, CV_8U, cv::Scalar(20 * i)));
        pose.files.push_back("shot_" + std::to_string(i) + ".png");
    }
    savePose(folder.path(), pose);
    fs::create_directories(folder / ".pose_2.partial");
    std::ofstream(folder / ".pose_2.partial/a.png") << "left behind by a power cut";
    ASSERT_THAT(viewsIn(folder.path()), SizeIs(1));
    const std::vector<cv::Mat> images = readImages(viewsIn(folder.path())[0]);
    ASSERT_EQ(images.size(), 12U);
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(cv::norm(images[i], pose.images[i], cv::NORM_INF), 0.0) << i;

    pose.images.resize(3);
    pose.files.resize(3);
    savePose(folder.path(), pose);
    EXPECT_THAT(imagesIn(folder / "pose_1"), SizeIs(3)) << "nothing of the first is left";

    std::stop_source stop;
    stop.request_stop();
    pose.images.resize(1);
    pose.files.resize(1);
    EXPECT_THROW(savePose(folder.path(), pose, Progress({}, stop.get_token())), Cancelled);
    EXPECT_THAT(imagesIn(folder / "pose_1"), SizeIs(3)) << "the one before stays";
    EXPECT_FALSE(fs::exists(folder / ".pose_1.partial"));
    for (const char* name : {"", "..", "a/b", "/tmp/x", ".hidden"}) {
        pose.name = name;
        EXPECT_THROW(savePose(folder.path(), pose), InvalidInput) << name;
    }
}

TEST(PatternDisplay, RefusesPicturesOfAnotherSizeOrKind) {
    EXPECT_NO_THROW(checkPicture(cv::Mat::zeros(48, 64, CV_8U), {64, 48}));
    EXPECT_THROW(checkPicture(cv::Mat::zeros(48, 60, CV_8U), {64, 48}), InvalidInput);
    EXPECT_THROW(checkPicture(cv::Mat::zeros(48, 64, CV_16U), {64, 48}), InvalidInput);
}

TEST(CameraAutomatics, AreSwitchedOffOrNamed) {
    std::map<unsigned, int> values = {{V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY},
                                      {V4L2_CID_AUTO_WHITE_BALANCE, 1},
                                      {V4L2_CID_FOCUS_AUTO, 1},
                                      {V4L2_CID_BRIGHTNESS, 128}};
    CameraControls driver;
    driver.get = [&](unsigned control) {
        return values.contains(control) ? std::optional(values.at(control)) : std::nullopt;
    };
    driver.set = [&](unsigned control, int value) {
        if (control == V4L2_CID_FOCUS_AUTO) return true; // takes it, and does not keep it
        values.at(control) = value;
        return true;
    };
    const auto before = values;
    EXPECT_THAT(switchAutomaticsOff(driver), ElementsAre(HasSubstr("focus")));
    EXPECT_EQ(values.at(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
    EXPECT_EQ(values.at(V4L2_CID_AUTO_WHITE_BALANCE), 0);
    EXPECT_EQ(values.at(V4L2_CID_BRIGHTNESS), before.at(V4L2_CID_BRIGHTNESS));
    EXPECT_THAT(switchAutomaticsOff(controlsOf("/dev/null")), IsEmpty()) << "no camera has none";
}

TEST(CaptureCamera, AbsentOneSaysWhatToDo) {
    try {
        (void)openCaptureCamera("/dev/video97");
        ADD_FAILURE() << "there is none";
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("There is no camera at /dev/video97"));
    }
}

} // namespace
} // namespace lumorph::test

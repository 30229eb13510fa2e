#include <algorithm>
#include <cstdio>
#include <mutex>

#include <glm/gtc/matrix_transform.hpp>
#include <opencv2/imgproc.hpp>

#include "app/studio/calibration/chain_live.h"
#include "app/studio/document/scene_edit.h"
#include "calibration/capture/capture_camera.h"
#include "calibration/lab/check_lab.h"
#include "calibration/lab/lab_capture.h"
#include "calibration/lab/true_room.h"
#include "calibration/light/light_lab.h"
#include "calibration/stages/lab_bench.h"
#include "tests/support/chain_judge.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/long_tests.h"
#include "tests/support/truth.h"
#include "tests/ui/chain_hand.h"
#include "tests/ui/devices_window.h"
#include "tests/ui/file_dialog.h"

// The whole chain in the window by the mouse, without the lab that lives in the studio: solved from recordings, and at
// a table whose camera sees what the projector's window shows, whose servos are a simulated board's, and whose tracker
// follows hands.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kBoard = "chess:9x7:25";
constexpr std::uint32_t kSeed = 31;

/// A room with one projector of few pixels, all of it assumed.
Installation assumedRoom() {
    Installation room = defaultInstallation();
    room.projectors.resize(1);
    InstalledProjector& projector = room.projectors.front();
    projector.camera = withSize(projector.camera, {960, 540});
    projector.lens = projector.pose = {Origin::Way::assumed, "of few pixels", ""}; // not entered by anybody
    return room;
}

/// What is calibrated with, as a new user has it.
struct NothingKept {
    explicit NothingKept(const std::filesystem::path& poses) {
        studio::Settings settings; // before the window reads them
        settings.remove("calibrate");
        std::filesystem::create_directories(poses);
        settings.setValue("calibrate/saved", QString::fromStdString(poses));
    }
};

/// Projector and camera have a sequence of their own.
struct ProjectorHand {
    StudioWindow& window;

    [[nodiscard]] bool offers(const QString& words) {
        return eventually(
            [&] {
                const auto* next = window.findNow<QAbstractButton>("calibrate.card.next");
                return next && next->text().startsWith(words);
            },
            240s);
    }
    void next() {
        pass(std::chrono::milliseconds(QApplication::doubleClickInterval() + 50));
        window.click("calibrate.card.next");
    }
    [[nodiscard]] std::string story() {
        return (window.text("calibrate.card.title") + ": " + window.text("calibrate.card.text")).toStdString();
    }
};

void print(const char* way, const ShownError& shown) {
    std::printf("%s | balls %zu of %zu: mean %.2f pixels | skin mean %.2f pixels, %.2f mm | eye %.1f mm | device %.2f "
                "mm\n",
                way, shown.balls.size(), shown.judgedBalls, meanOf(shown.balls), meanOf(shown.skinPixels),
                meanOf(shown.skinMillimetres), shown.eyeMillimetres, shown.deviceMillimetres);
}

class WholeChainOfRecordings : public ::testing::Test {
protected:
    TemporaryFolder folder;
    NothingKept nothing{folder / "poses"};
    StudioWindow window{folder / "session", "scene"};
};

TEST_F(WholeChainOfRecordings, IsSolvedByTheMouseAsItWasInTheLab) {
    if (!longTests()) GTEST_SKIP() << "minutes of photographs: LUMORPH_LONG_TESTS=1";
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    const std::shared_ptr<const Rig> rig = window.state().rig.rig;
    studio::editInstallation(window.studio().document, "Assumed", [](Installation& room) { room = assumedRoom(); });
    const Installation truth = trueRoom(labTruth(assumedRoom()), rig->actuators(), kSeed);
    LabCapture boards;
    boards.room = truth;
    boards.board = kBoard;
    boards.seed = kSeed;
    LabCapturer capturer(boards);
    writeLabCapture(capturer, folder / "boards");

    ChainHand chain(window);
    chain.open();
    window.click("chain.link.pointer");
    window.click("chain.way.files");
    window.click("chain.link.projector");
    ASSERT_TRUE(chain.offers("Open it")) << chain.story();
    chain.next();
    ProjectorHand projector{window};
    window.click("calibrate.way.folder");
    ASSERT_TRUE(projector.offers("Choose a folder"));
    projector.next();
    answerFileDialog(window, "calibrate.folder.file", folder / "boards", "Choose");
    window.enter("calibrate.projector.width", "960");
    window.enter("calibrate.projector.height", "540");
    ASSERT_TRUE(projector.offers("Read the images")) << projector.story();
    projector.next();
    ASSERT_TRUE(projector.offers("Use this calibration")) << projector.story();
    window.screenshot("whole-recordings-projector", 300ms);
    projector.next();
    ASSERT_TRUE(projector.offers("Go on with the chain")) << projector.story();
    projector.next();
    ASSERT_TRUE(eventually([&] { return chain.badge("projector") == "Simulated"; })) << chain.story();

    // Whoever measures on another machine sends folders.
    LabBenchOptions options;
    options.checkPattern = "phase:16x3+1x3";
    for (const studio::ChainLink& link : studio::chainLinks()) {
        if (link.stage->hasSequence() || link.stage->isWanted) continue;
        const std::filesystem::path kept = folder / "sent" / link.key;
        const StageSite site{rig, chain.room()};
        LabBench bench(*rig, truth, kSeed, options);
        writeStageRecording(measureStage(*link.stage, site, bench).recording, kept);
        window.click(QString("chain.link.") + link.key);
        window.click("chain.file.recording");
        answerFileDialog(window, "chain.recording.file", kept / "recording.json", "Open");
        ASSERT_TRUE(chain.offers("Solve the recording")) << chain.story();
        chain.next();
        const auto solved = [&] { return chain.button() == "Use it" || chain.button() == "Go on"; };
        ASSERT_TRUE(eventually([&] { return solved() || chain.badge(link.key) == "Simulated"; }, 120s))
            << chain.story();
        window.screenshot(QString("whole-recordings-") + link.key, 300ms);
        if (chain.button() == "Use it") chain.next();
        ASSERT_TRUE(eventually([&] { return chain.badge(link.key) == "Simulated"; })) << chain.story();
    }
    EXPECT_TRUE(realParts(chain.room()).empty()) << "what a lab recorded is nowhere measured";
    const ShownError shown = shownError(rig, chain.room(), truth);
    print("by recordings", shown);
    EXPECT_GE(shown.judgedBalls, 20U);
    EXPECT_LE(meanOf(shown.balls), 1.5);
    EXPECT_LE(meanOf(shown.skinPixels), 1.5);
}

/// A table that is not in the studio: it sees the projector's window, and a hand changes what lies there.
struct SeenTable {
    enum class Before { board, lightOf, device };

    Installation truth;
    std::shared_ptr<const Rig> rig;
    std::function<cv::Mat()> shown; ///< by the projector's window now, BGR; any thread

    std::mutex mutex; ///< of what follows
    Before before = Before::board;
    bool isCovered = false;
    std::vector<double> strokes; ///< where the servos' horns are
    double seconds = 1.0 / 60.0;
    std::unique_ptr<BoardLab> board;
    std::unique_ptr<LightLab> light;
    std::unique_ptr<CheckLab> device;
    std::vector<double> stood; ///< of `device`

    [[nodiscard]] cv::Mat photograph() {
        const cv::Mat picture = shown();
        cv::Mat grey, seen;
        cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
        const std::scoped_lock lock(mutex);
        if (before == Before::board) {
            board->show(grey);
            return board->photograph();
        }
        if (before == Before::lightOf) {
            const cv::Scalar mean = cv::mean(picture);
            const glm::ivec3 flat(std::lround(mean[2]), std::lround(mean[1]), std::lround(mean[0]));
            cv::cvtColor(light->photograph({isCovered ? std::nullopt : std::optional(flat)}, seconds), seen,
                         cv::COLOR_RGB2BGR);
            return seen;
        }
        const auto differs = [](double a, double b) { return std::abs(a - b) > 0.002; };
        if (!device || !std::ranges::equal(stood, strokes, std::not_fn(differs))) {
            stood = strokes;
            CheckLabOptions quick; // servos alone are looked at some two thousand times
            quick.pictures.samples = 1;
            device = std::make_unique<CheckLab>(truth, *rig, stood, quick, kSeed);
        }
        return device->photograph(0, grey);
    }
};

class SeeingCamera final : public CaptureCamera {
public:
    explicit SeeingCamera(std::shared_ptr<SeenTable> table) : table_(std::move(table)) {}
    [[nodiscard]] cv::Mat grab(const Progress& progress) override {
        progress.throwIfCancelled();
        return table_->photograph();
    }
    [[nodiscard]] std::string name() const override { return "/dev/video9"; }
    [[nodiscard]] cv::Size size() const override {
        const glm::ivec2 size = table_->truth.cameras.front().camera.size;
        return {size.x, size.y};
    }
    [[nodiscard]] std::optional<Exposures> exposures() const override { return Exposures{1.0 / 8000.0, 0.5}; }
    void setExposure(double seconds) override {
        const std::scoped_lock lock(table_->mutex);
        table_->seconds = seconds;
    }

private:
    std::shared_ptr<SeenTable> table_;
};

/// The board's horns stand where they are told; what stands on them bends by the true room's curves, without play.
class WholeChainAtTheTable : public DevicesWindow {
protected:
    WholeChainAtTheTable() {
        studio::editInstallation(window.studio().document, "Assumed", [](Installation& room) { room = assumedRoom(); });
        table->rig = window.state().rig.rig;
        table->truth = withLabCamera(trueRoom(labTruth(assumedRoom()), table->rig->actuators(), kSeed));
        CalibratedCamera& eyes = table->truth.cameras.front().camera;
        eyes = withSize(eyes, {640, 512}); // its pictures are worked out in a few hundredths of a second
        table->board =
            std::make_unique<BoardLab>(table->truth, parseCalibrationBoard(kBoard), BoardLabOptions{}, kSeed);
        LightLabOptions options;
        options.laysSheet = false;
        table->light = std::make_unique<LightLab>(table->truth, *table->rig, lightLabCamera(table->truth, options),
                                                  std::nullopt, options, kSeed);
        table->shown = [this] { return onScreen(); };
        window.studio().openCamera = [table = table](const std::string& address) {
            EXPECT_EQ(address, "/dev/video9");
            return std::make_unique<SeeingCamera>(table);
        };
    }

    /// What the projector's window shows, from whatever thread.
    [[nodiscard]] cv::Mat onScreen() {
        QImage picture;
        QMetaObject::invokeMethod(
            &window.studio().outputs,
            [&] {
                if (const studio::ProjectorWindow* open = window.studio().outputs.window(0)) picture = open->picture();
            },
            Qt::BlockingQueuedConnection);
        if (picture.isNull()) return cv::Mat::zeros(540, 960, CV_8UC3);
        const QImage bgr = picture.convertToFormat(QImage::Format_BGR888);
        return cv::Mat(bgr.height(), bgr.width(), CV_8UC3, const_cast<uchar*>(bgr.constBits()),
                       std::size_t(bgr.bytesPerLine()))
            .clone();
    }
    void place(SeenTable::Before before) {
        const std::scoped_lock lock(table->mutex);
        table->before = before;
    }
    void measureProjector();
    void measureLight();
    void touch(const char* link, std::vector<studio::LiveStep> steps);
    void measureMoving(const char* link);
    /// A body of a simulated tracker, of the room as it truly is.
    void hold(PoseRole role, const Pose& pose) {
        for (const studio::SeenBody& body : window.studio().trackers.bodies()) {
            if (body.role != role) continue;
            body.steering->setRoom(std::make_shared<const Installation>(table->truth));
            SimulatedOrders orders = body.steering->orders();
            orders.held = pose;
            body.steering->order(orders);
        }
    }
    void useAsMeasured(const char* link, const QString& badge) {
        ASSERT_TRUE(eventually([&] { return chain.button() == "Use it"; }, 240s)) << link << ": " << chain.story();
        std::printf("%s: %s\n", link, chain.story().c_str());
        window.screenshot(QString("whole-table-") + link, 300ms);
        chain.next();
        // What simulated devices say joins what the camera measured only when one says so.
        const auto ends = [&] {
            if (chain.button() == "Use it as simulated") chain.next();
            return chain.badge(link) == badge;
        };
        ASSERT_TRUE(eventually(ends, 10s)) << link << ": " << chain.story();
    }

    TemporaryFolder saved; ///< photographed ones
    std::shared_ptr<SeenTable> table = std::make_shared<SeenTable>();
    ChainHand chain{window};
};

void WholeChainAtTheTable::measureProjector() {
    window.click("chain.link.projector");
    ASSERT_TRUE(chain.offers("Open it")) << chain.story();
    chain.next();
    ProjectorHand hand{window};
    const std::vector<glm::dmat4> poses = table->board->proposePoses(9);
    std::size_t laid = 0;
    const auto lay = [&] {
        const std::scoped_lock lock(table->mutex);
        table->board->lay(poses.at(laid++));
    };
    lay();
    window.click("calibrate.way.camera");
    ASSERT_TRUE(hand.offers("Photograph pose 1")) << hand.story();
    window.screenshot("whole-table-board", 500ms);
    const auto button = [&] {
        const auto* next = window.findNow<QAbstractButton>("calibrate.card.next");
        return next ? next->text() : QString();
    };
    while (button() != "Use this calibration" && laid < poses.size()) {
        hand.next();
        const QString then = QString("Photograph pose %1").arg(laid + 1);
        const auto ends = [&] {
            if (button() == "Try again") hand.next(); // a busy machine shows and sees late
            return button().startsWith(then) || button() == "Use this calibration";
        };
        ASSERT_TRUE(eventually(ends, 240s)) << hand.story();
        lay();
        pass(500ms);
    }
    ASSERT_TRUE(hand.offers("Use this calibration")) << hand.story();
    window.screenshot("whole-table-projector", 300ms);
    hand.next();
    ASSERT_TRUE(hand.offers("Go on with the chain")) << hand.story();
    hand.next();
    ASSERT_TRUE(eventually([&] { return chain.badge("projector") == "Measured"; })) << chain.story();
}

void WholeChainAtTheTable::measureLight() {
    place(SeenTable::Before::lightOf);
    window.click("chain.link.light");
    ASSERT_TRUE(chain.offers("Begin, with the camera")) << chain.story();
    chain.next();
    ASSERT_TRUE(eventually(
        [&] {
            const QString words = window.text("chain.card.text");
            const std::scoped_lock lock(table->mutex);
            if (words.startsWith("Cover the lens")) table->isCovered = true;
            if (words.startsWith("Uncover the lens")) table->isCovered = false;
            return chain.button() == "Use it" || chain.button() == "Measure again";
        },
        300s))
        << chain.story();
    useAsMeasured("light", "Measured");
}

/// Where the projector truly throws a pixel on the table.
glm::dvec3 onTable(const Installation& truth, const glm::dvec2& pixel) {
    const CalibratedCamera& camera = truth.projectors.front().camera;
    const glm::dvec3 from = positionOf(camera), along = directionOf(camera, pixel);
    return from - from.y / along.y * along;
}

void WholeChainAtTheTable::touch(const char* link, std::vector<studio::LiveStep> steps) {
    window.click(QString("chain.link.") + link);
    ASSERT_TRUE(chain.offers("Begin, with the tracker")) << chain.story();
    chain.next();
    ASSERT_TRUE(chain.offers("Cancel")) << chain.story();
    const Installation& truth = table->truth;
    const Pose device{{0.02, 0.0, -0.03}, rotationOfTurn({0.0, 0.4, 0.0})};
    const auto title = [&] { return window.text("chain.card.title"); };
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const studio::LiveStep& step = steps[k];
        ASSERT_TRUE(eventually([&] { return title() == step.title; }, 10s))
            << "step " << k << ": " << chain.story() << ", not " << step.title.toStdString();
        if (k == steps.size() / 2) window.screenshot(QString("whole-table-touches-") + link);
        const double turn = double(k);
        const auto ends = [&] { return title() != step.title; };
        for (double t = 0.0; t < 40.0 && !ends(); t += 0.02) {
            const bool swings = step.ends == studio::LiveStep::Ends::swung;
            glm::dvec3 tip(0.06 * std::floor(0.5 * (turn + 1.0)), 0.0, 0.12), swing(0.5 * double(k % 2), 0.0, -0.4);
            if (swings) swing = {0.7 * std::sin(2.1 * t), 0.9 * std::sin(0.9 * t), 0.7 * std::cos(1.7 * t)};
            if (step.dot) tip = onTable(truth, step.dot->pixel);
            if (step.corner) tip = device.position + device.rotation * step.corner->onModel;
            hold(PoseRole::device, device);
            if (step.dot && std::string_view(link) == "eye") {
                const glm::dvec3 eye =
                    glm::dvec3(truth.eye) + 0.06 * glm::dvec3(int(k) % 3 - 1, int(k) % 2, (int(k) / 3) % 3 - 1);
                tip += 0.35 * (eye - tip);
                hold(PoseRole::head,
                     {eye, rotationOfTurn({0.2 * std::sin(turn), 0.3 * std::cos(2.0 * turn), 0.1 * turn})});
            }
            hold(PoseRole::pointer, {tip, rotationOfTurn(swing)});
            pass(20ms);
        }
        ASSERT_TRUE(ends()) << chain.story();
    }
    useAsMeasured(link, "Simulated"); // by no real tracker
}

void WholeChainAtTheTable::measureMoving(const char* link) {
    place(SeenTable::Before::device);
    window.click(QString("chain.link.") + link);
    ASSERT_TRUE(chain.offers("Begin, hands off")) << chain.story();
    chain.next();
    const DeviceProfile profile = window.studio().devices.profile();
    ASSERT_TRUE(eventually(
        [&] {
            std::vector<double> horns;
            for (std::size_t i = 0; i < profile.servos.size(); ++i) {
                const ServoSetup& servo = profile.servos[i];
                const double stroke =
                    (servoOf(i).position - servo.pulseMin - servo.trim) / (servo.pulseMax - servo.pulseMin);
                horns.push_back(std::clamp(servo.reversed ? 1.0 - stroke : stroke, 0.0, 1.0));
            }
            const std::scoped_lock lock(table->mutex);
            table->strokes = horns;
            return chain.button() != "Cancel";
        },
        1200s))
        << chain.story();
}

TEST_F(WholeChainAtTheTable, IsMeasuredByTheMouseAsFarAsDevicesAreSimulated) {
    if (!longTests()) GTEST_SKIP() << "minutes of hands and servos: LUMORPH_LONG_TESTS=1";
    studio::CalibrationSetup setup;
    setup.way = studio::CaptureWay::camera;
    setup.board = parseCalibrationBoard(kBoard);
    setup.camera = "/dev/video9";
    setup.saved = saved.path();
    studio::keepSetup(window.studio().settings, setup);
    ASSERT_NO_FATAL_FAILURE(goLive());
    chain.open();
    window.click("chain.link.pointer");
    window.click("chain.way.live");
    ASSERT_NO_FATAL_FAILURE(measureProjector());
    ASSERT_NO_FATAL_FAILURE(measureLight());
    for (const char* body : {"sim://pointer?rate=60", "sim://device?rate=60", "sim://head?rate=60"})
        window.studio().trackers.open(body);
    const Rig& rig = *table->rig;
    ASSERT_NO_FATAL_FAILURE(touch("pointer", studio::pointerSteps(rig, chain.room())));
    ASSERT_NO_FATAL_FAILURE(touch("tracker", studio::trackerSteps(rig, chain.room())));
    ASSERT_NO_FATAL_FAILURE(touch("device", studio::deviceSteps(rig, chain.room())));
    ASSERT_NO_FATAL_FAILURE(touch("eye", studio::eyeSteps(rig, chain.room())));
    ASSERT_NO_FATAL_FAILURE(measureMoving("servos"));
    useAsMeasured("servos", "Simulated");
    window.click("chain.link.delays");
    EXPECT_TRUE(window.text("chain.card.text").contains("cannot time a connected camera")) << chain.story();
    ASSERT_NO_FATAL_FAILURE(measureMoving("check"));
    window.screenshot("whole-table-check", 300ms);
    EXPECT_EQ(chain.badge("check"), "Simulated") << chain.story();
    const ShownError shown = shownError(table->rig, chain.room(), table->truth);
    print("at the table", shown);
    EXPECT_LE(meanOf(shown.balls), 1.5);
    EXPECT_LE(meanOf(shown.skinPixels), 1.5);
}

} // namespace
} // namespace lumorph::test

#include "calibration/tracking/camera_tracker.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "calibration/tracking/board_watch.h"
#include "calibration/tracking/camera_source.h"
#include "tests/calibration/photographer.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

using test::Photographer;
using ::testing::HasSubstr;

const glm::ivec2 kSize{640, 360};
constexpr double kFocal = 530.0;
constexpr double kRate = 30.0;
const CameraPlace kPlace{{0.10, 0.50, 0.35}, {0.0, 0.0, 0.0}};
constexpr auto kLens = "lens=530,530,319.5,179.5";

CalibratedCamera camera() { return cameraLookingAt(kPlace.from, kPlace.to, kSize, kFocal); }

/// A board's middle over the body's middle, its page up.
Pose bodyFromBoard(const MarkerBoard& board) {
    const glm::dvec2 size = sizeOf(board);
    return {{-0.5 * size.x, 0.0, 0.5 * size.y}, glm::angleAxis(glm::radians(-90.0), glm::dvec3(1.0, 0.0, 0.0))};
}

/// Slides 6 cm and turns 12 degrees in a second, and tilts a little.
Pose truthAt(double seconds) {
    return {{0.06 * seconds - 0.02, 0.01 * seconds, 0.015},
            glm::angleAxis(glm::radians(12.0 * seconds), glm::normalize(glm::dvec3(0.2, 1.0, 0.1)))};
}

cv::Mat pictureOf(const Photographer& photographer, const Pose& body, const MarkerBoard& board, double noise = 2.0) {
    std::vector<std::uint8_t> grey = photographer.picture(matrixOf(body) * matrixOf(bodyFromBoard(board)), noise);
    return cv::Mat(kSize.y, kSize.x, CV_8UC1, grey.data()).clone();
}

/// A video of the board on its way, made once.
class BoardVideo : public ::testing::Test {
protected:
    static constexpr int kPictures = 36;

    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        file_ = *folder_ / "board.avi";
        const MarkerBoard board;
        const Photographer photographer(board, camera());
        cv::VideoWriter video(file_.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kRate, {kSize.x, kSize.y});
        video.set(cv::VIDEOWRITER_PROP_QUALITY, 95);
        for (int i = 0; i < kPictures; ++i) {
            cv::Mat color;
            cv::cvtColor(pictureOf(photographer, truthAt(i / kRate), board), color, cv::COLOR_GRAY2BGR);
            video.write(color);
        }
    }
    static void TearDownTestSuite() { folder_.reset(); }

    /// Waits for what it tells.
    template <typename Condition> static bool comes(const CameraTracker& tracker, Condition condition) {
        for (int i = 0; i < 3000; ++i) {
            if (condition(tracker.status())) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }

    [[nodiscard]] CameraTrackerOptions options(const std::string& query) {
        CameraTrackerOptions made;
        made.address = parseBoardAddress("board://" + file_.string() + "?" + query);
        made.onPicture = [this](const BoardPicture& picture) {
            const std::scoped_lock lock(mutex_);
            pictures_.push_back(picture);
        };
        return made;
    }

    std::vector<BoardPicture> pictures() {
        const std::scoped_lock lock(mutex_);
        return pictures_;
    }

    inline static std::unique_ptr<TemporaryFolder> folder_;
    inline static std::filesystem::path file_;
    std::mutex mutex_;
    std::vector<BoardPicture> pictures_;
};

TEST_F(BoardVideo, GivesThePosesThatTheBoardTrulyHad) {
    const CameraTracker tracker(options(std::string(kLens) + "&from=0.1,0.5,0.35&to=0,0,0"));
    ASSERT_TRUE(comes(tracker, [](const CameraTrackerStatus& s) { return s.ended; }));
    const auto seen = pictures();
    ASSERT_EQ(seen.size(), static_cast<std::size_t>(kPictures));
    double worst = 0.0, worstTurn = 0.0;
    for (int i = 0; i < kPictures; ++i) {
        const BoardPicture& picture = seen[static_cast<std::size_t>(i)];
        EXPECT_EQ(picture.number, static_cast<std::uint64_t>(i + 1));
        ASSERT_TRUE(picture.pose) << i;
        const Pose truth = truthAt(i / kRate);
        worst = std::max(worst, glm::distance(picture.pose->position, truth.position));
        worstTurn = std::max(worstTurn, test::degreesBetween(picture.pose->rotation, truth.rotation));
    }
    std::printf("[ board    ] worst of %d pictures: %.2f mm, %.2f degrees\n", kPictures, 1e3 * worst, worstTurn);
    EXPECT_LT(worst, 2.0e-3);
    EXPECT_LT(worstTurn, 0.5);
    const CameraTrackerStatus status = tracker.status();
    EXPECT_EQ(status.size, kSize);
    EXPECT_EQ(status.foundShare, 1.0);
    EXPECT_EQ(status.assumptions, "") << "lens and place are known";
    EXPECT_THAT(status.advice, HasSubstr("come to its end"));
    EXPECT_FALSE(status.open);
    ASSERT_NE(status.preview, nullptr);
    EXPECT_EQ(status.preview->size(), glm::ivec2(320, 180));
    int orange = 0;
    for (const Image::Pixel& pixel : status.preview->pixels()) orange += pixel[0] > 200 && pixel[2] < 100 ? 1 : 0;
    EXPECT_GT(orange, 200) << "the board's outline is drawn in";
}

TEST_F(BoardVideo, WithoutLensAndPlaceItSaysWhatItTakesThemFor) {
    // 2 atan(320 / 530): what the lens truly sees.
    const CameraTracker tracker(options("fov=62.24"));
    ASSERT_TRUE(comes(tracker, [](const CameraTrackerStatus& s) { return s.ended; }));
    const auto seen = pictures();
    const std::string assumptions = tracker.status().assumptions;
    EXPECT_THAT(assumptions, HasSubstr("62.24 degrees"));
    EXPECT_THAT(assumptions, HasSubstr("seen first"));
    ASSERT_TRUE(seen[4].pose) << "the fifth sighting tells where the camera is";
    EXPECT_FALSE(seen[0].pose);
    EXPECT_LT(glm::length(seen[4].pose->position), 0.02) << "and there is the middle of the world";
    // From then on ways and turns are true, in the frame that the body had then.
    const Pose& last = *seen.back().pose;
    const Pose &from = *seen[4].pose, trueFrom = truthAt(4 / kRate), trueTo = truthAt((kPictures - 1) / kRate);
    EXPECT_NEAR(glm::distance(last.position, from.position), glm::distance(trueTo.position, trueFrom.position), 2e-3);
    EXPECT_NEAR(test::degreesBetween(last.rotation, from.rotation),
                test::degreesBetween(trueTo.rotation, trueFrom.rotation), 0.5);
}

TEST_F(BoardVideo, BeginsAnewWhereItIsToldTo) {
    const CameraTracker tracker(options(std::string(kLens) + "&from=0.1,0.5,0.35&repeat=yes"));
    EXPECT_TRUE(comes(tracker, [](const CameraTrackerStatus& s) { return s.pictures > kPictures + 5; }));
    EXPECT_FALSE(tracker.status().ended);
    EXPECT_TRUE(tracker.status().open);
}

TEST_F(BoardVideo, AnotherBoardIsNotTakenForItsOwn) {
    const CameraTracker tracker(options("dictionary=6X6_250&repeat=yes"));
    EXPECT_TRUE(comes(tracker, [](const CameraTrackerStatus& s) {
        return s.advice.find("squares and dictionary") != std::string::npos;
    })) << tracker.status().advice;
    EXPECT_FALSE(tracker.status().sighting);
}

TEST(CameraTracker, SaysThatItsCameraOrFileIsNotThereOrNoVideo) {
    const auto adviceOf = [](const std::string& uri) {
        CameraTrackerOptions options;
        options.address = parseBoardAddress(uri);
        const CameraTracker tracker(options);
        for (int i = 0; i < 500 && tracker.status().advice.empty(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        EXPECT_FALSE(tracker.status().open);
        return tracker.status().advice;
    };
    EXPECT_THAT(adviceOf("board://camera99"), HasSubstr("There is no camera at /dev/video99"));
    EXPECT_THAT(adviceOf("board:///no/such/video.mp4"), HasSubstr("There is no file /no/such/video.mp4"));
    const TemporaryFolder folder;
    const auto file = folder / "no-video.mp4";
    std::ofstream(file) << "this is no video";
    EXPECT_THAT(adviceOf("board://" + file.string()), HasSubstr("is no video that can be read"));
}

// --- Why the board is not seen in a picture

std::string adviceOn(const cv::Mat& picture) {
    BoardAddress address;
    address.source = "/dev/video0";
    return BoardWatch(address).look(picture).advice;
}

TEST(BoardWatch, TellsDarkBlurredAndEmptyPicturesApart) {
    const MarkerBoard board;
    const Photographer photographer(board, camera());
    const cv::Mat good = pictureOf(photographer, {}, board);
    EXPECT_EQ(adviceOn(good), "");
    EXPECT_THAT(adviceOn(0.05 * good), HasSubstr("too dark"));
    EXPECT_THAT(adviceOn(good * 0.02 + 250), HasSubstr("too bright"));
    cv::Mat blurred;
    cv::GaussianBlur(good, blurred, {}, 14.0);
    EXPECT_THAT(adviceOn(blurred), HasSubstr("blurred"));
    cv::Mat empty(kSize.y, kSize.x, CV_8UC1, cv::Scalar(128));
    cv::randn(empty, 128, 25);
    EXPECT_THAT(adviceOn(empty), HasSubstr("not in the picture"));
}

TEST(BoardWatch, AsksForMoreOfABoardThatIsHalfCovered) {
    const MarkerBoard board;
    const cv::Mat good = pictureOf(Photographer(board, camera()), {}, board);
    std::vector<std::string> told; // as a hand covers more and more of it
    for (int hidden = 0; hidden <= kSize.y; hidden += 8) {
        cv::Mat covered = good.clone();
        covered(cv::Rect(0, 0, kSize.x, hidden)) = 128;
        const std::string advice = adviceOn(covered);
        if (told.empty() || told.back().substr(0, 4) != advice.substr(0, 4)) told.push_back(advice);
    }
    ASSERT_GE(told.size(), 3U) << ::testing::PrintToString(told);
    EXPECT_EQ(told[0], "");
    EXPECT_THAT(told[1], HasSubstr("corners of the board are in the picture. Show more of it"));
    EXPECT_THAT(told[2], ::testing::AnyOf(HasSubstr("not in the picture"), HasSubstr("blurred")));
}

TEST(BoardWatch, DoubtsABoardThatIsPrintedAtAnotherShape) {
    const MarkerBoard board;
    const Photographer photographer(board, camera());
    cv::Mat stretched;
    cv::resize(pictureOf(photographer, {}, board), stretched, {}, 1.0, 1.25);
    EXPECT_THAT(adviceOn(stretched), HasSubstr("does not fit"));
}

TEST(BoardWatch, IsStillWhenTheBoardIs) {
    const MarkerBoard board;
    const Photographer photographer(board, camera());
    BoardAddress address = parseBoardAddress(std::string("board://camera0?from=0.1,0.5,0.35&") + kLens);
    BoardWatch watch(address);
    PoseStream stream;
    const Pose truth = truthAt(0.5);
    double raw = 0.0;
    cv::theRNG().state = 5;
    const cv::Mat clean = pictureOf(photographer, truth, board, 0.0);
    std::vector<glm::dvec3> filtered;
    for (int i = 0; i < 60; ++i) {
        cv::Mat noise(clean.size(), CV_8UC1), picture;
        cv::randn(noise, 20, 6);
        cv::add(clean, noise, picture);
        const BoardView view = watch.look(picture);
        ASSERT_TRUE(view.world) << i;
        const Microseconds time(33'333 * (i + 1));
        EXPECT_TRUE(stream.push({time, true, *view.world}));
        if (i < 30) continue;
        raw = std::max(raw, glm::distance(view.world->position, truth.position));
        filtered.push_back(stream.at(time, time)->position);
    }
    double spread = 0.0;
    for (const glm::dvec3& one : filtered) spread = std::max(spread, glm::distance(one, filtered.back()));
    std::printf("[ board    ] at rest: raw within %.2f mm, after the filter still to %.3f mm\n", 1e3 * raw,
                1e3 * spread);
    EXPECT_LT(raw, 2e-3);
    EXPECT_LT(spread, 0.3e-3);
}

// --- Cameras

TEST(CameraSource, ListsWhatGivesPicturesByNumber) {
    const TemporaryFolder own;
    const std::filesystem::path& folder = own.path();
    const auto add = [&](const std::string& node, const std::string& index, const std::string& name) {
        std::filesystem::create_directories(folder / node);
        std::ofstream(folder / node / "index") << index << "\n";
        std::ofstream(folder / node / "name") << name << "\n";
    };
    add("video10", "0", "HD Pro Webcam C920");
    add("video2", "0", "Integrated Camera");
    add("video3", "1", "Integrated Camera"); // data about pictures
    add("radio0", "0", "no camera");
    const std::vector<CameraInfo> expected{{"/dev/video2", "Integrated Camera"},
                                           {"/dev/video10", "HD Pro Webcam C920"}};
    EXPECT_EQ(listCameras(folder), expected);
    EXPECT_TRUE(listCameras(folder / "gone").empty());
}

TEST(CameraSource, EveryReasonHasItsRemedy) {
    struct Row {
        const char* source;
        SourceFacts facts;
        const char* says;
    };
    const std::vector<CameraInfo> one{{"/dev/video2", "Integrated Camera"}};
    const Row rows[] = {
        {"/dev/video0", {true, false, false, "", {}}, "plug one in"},
        {"/dev/video0", {true, false, false, "", one}, "Those that are there: /dev/video2 (Integrated Camera)"},
        {"/dev/video0", {true, true, false, "", one}, "sudo usermod -aG video $USER"},
        {"/dev/video0", {true, true, true, "cheese (process 77)", one}, "in use by cheese (process 77)"},
        {"/dev/video0", {true, true, true, "", one}, "unplug it"},
        {"/a.mp4", {false, false, false, "", {}}, "There is no file /a.mp4"},
        {"/a.mp4", {false, true, false, "", {}}, "may not be read"},
        {"/a.mp4", {false, true, true, "", {}}, "Convert it"},
    };
    for (const Row& row : rows) EXPECT_THAT(adviceFor(row.source, row.facts), HasSubstr(row.says));
}

} // namespace
} // namespace lumorph

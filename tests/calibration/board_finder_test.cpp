#include "calibration/tracking/board_finder.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "calibration/tracking/camera_tracker.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

CalibratedCamera webcam(bool distorted) {
    CalibratedCamera camera = cameraLookingAt({0.15, 0.55, 0.45}, {0.0, 0.0, 0.0}, {960, 540}, 790.0);
    camera.principal += glm::dvec2(11.0, -7.0);
    if (distorted) camera.distortion = {-0.12, 0.04, 0.001, -0.0008, 0.0};
    return camera;
}

/// Takes pictures of a page that lies in the world, by rays: four a pixel, whose directions are found once.
class Photographer {
public:
    Photographer(const MarkerBoard& board, const CalibratedCamera& camera)
        : page_(BoardFinder::page(board, kFine)), from_(positionOf(camera)) {
        for (int y = 0; y < camera.size.y; ++y)
            for (int x = 0; x < camera.size.x; ++x)
                for (const glm::dvec2 part : {glm::dvec2(-0.25, -0.25), {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}})
                    ways_.push_back(directionOf(camera, glm::dvec2(x, y) + part));
    }

    [[nodiscard]] std::vector<std::uint8_t> picture(const glm::dmat4& worldFromBoard, double noise) const {
        const glm::dmat4 boardFromWorld = glm::inverse(worldFromBoard);
        const glm::dvec3 from(boardFromWorld * glm::dvec4(from_, 1.0));
        std::mt19937 random(7);
        std::normal_distribution<double> grain(0.0, noise);
        std::vector<std::uint8_t> grey;
        for (std::size_t i = 0; i < ways_.size(); i += 4) {
            double sum = 0.0;
            for (std::size_t k = i; k < i + 4; ++k) sum += lightAlong(from, glm::dmat3(boardFromWorld) * ways_[k]);
            grey.push_back(static_cast<std::uint8_t>(std::clamp(sum / 4.0 + grain(random), 0.0, 255.0)));
        }
        return grey;
    }

private:
    static constexpr double kFine = 4000.0; // pixels of the page a metre

    [[nodiscard]] double lightAlong(const glm::dvec3& from, const glm::dvec3& way) const {
        const glm::dvec3 at = from - way * (from.z / way.z);
        const int column = static_cast<int>(std::floor(at.x * kFine));
        const int row = page_.size().y - 1 - static_cast<int>(std::floor(at.y * kFine));
        const bool on = column >= 0 && row >= 0 && column < page_.size().x && row < page_.size().y;
        return on ? 20.0 + page_.at(column, row)[0] * 0.75 : 230.0;
    }

    Image page_;
    glm::dvec3 from_;
    std::vector<glm::dvec3> ways_;
};

double degreesBetween(const glm::dquat& a, const glm::dquat& b) {
    return glm::degrees(2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b)))));
}

struct Case {
    const char* name;
    MarkerBoard board;
    bool distorted;
    double millimetres; ///< of 700 between camera and board; a marker's corner is less sharp than one of a chessboard
};

class BoardFinderPose : public ::testing::TestWithParam<Case> {};

TEST_P(BoardFinderPose, IsTheTruth) {
    const auto& [name, board, distorted, millimetres] = GetParam();
    const CalibratedCamera camera = webcam(distorted);
    BoardFinder finder(board, camera);
    const Photographer photographer(board, camera);
    // The board lies 4 mm above the device's middle, turned a little; the device stands somewhere, and tilts.
    const Pose deviceFromBoard{{-0.07, 0.040, 0.09}, glm::angleAxis(glm::radians(-90.0), glm::dvec3(1.0, 0.0, 0.0))};
    for (int number = 0; number < 2; ++number) {
        const Pose truth{{0.02 * number, 0.01 * number, -0.015},
                         glm::angleAxis(glm::radians(12.0 * number - 9.0), glm::normalize(glm::dvec3(0.3, 1.0, 0.2)))};
        const auto matrix = [](const Pose& pose) {
            return glm::translate(glm::dmat4(1.0), pose.position) * glm::mat4_cast(pose.rotation);
        };
        const auto picture = photographer.picture(matrix(truth) * matrix(deviceFromBoard), 3.0);
        const auto sighting = finder.find(picture);
        ASSERT_TRUE(sighting) << number;
        const Pose found = worldFromDevice(*sighting, camera, deviceFromBoard);
        EXPECT_LT(glm::distance(found.position, truth.position), 1e-3 * millimetres) << number;
        EXPECT_LT(degreesBetween(found.rotation, truth.rotation), 0.25) << number;
        EXPECT_LT(sighting->reprojectionError, 0.5);
        EXPECT_GT(sighting->coverage, 0.9);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Boards, BoardFinderPose,
    ::testing::Values(Case{"charuco", {}, false, 0.8}, Case{"charucoThroughALens", {}, true, 0.8},
                      Case{"aruco", {MarkerBoard::Kind::aruco, 4, 5, 0.035, 0.028, "6X6_250"}, true, 1.5}),
    [](const auto& one) { return one.param.name; });

TEST(BoardFinder, SeesNothingWhereThereIsNoBoard) {
    const CalibratedCamera camera = webcam(false);
    BoardFinder finder({}, camera);
    const std::vector<std::uint8_t> grey(static_cast<std::size_t>(camera.size.x * camera.size.y), 128);
    EXPECT_FALSE(finder.find(grey));
    std::mt19937 random(1);
    std::vector<std::uint8_t> noise(grey.size());
    for (auto& pixel : noise) pixel = static_cast<std::uint8_t>(random());
    EXPECT_FALSE(finder.find(noise));
    EXPECT_THROW((void)finder.find(std::span(grey).first(100)), InvalidInput);
}

TEST(BoardFinder, RefusesBoardsThatCannotBe) {
    const CalibratedCamera camera = webcam(false);
    MarkerBoard board;
    board.marker = board.square;
    EXPECT_THROW(BoardFinder(board, camera), InvalidInput);
    board = {};
    board.dictionary = "nonsense";
    EXPECT_THROW(BoardFinder(board, camera), InvalidInput);
    board = {};
    board.columns = board.rows = 20; // 200 markers, and the dictionary has 50
    EXPECT_THROW(BoardFinder(board, camera), InvalidInput);
    board = {};
    board.square = std::nan("");
    EXPECT_THROW(BoardFinder(board, camera), InvalidInput);
}

TEST(CameraTracker, SaysThatItsCameraIsNotThere) {
    CameraTrackerOptions options;
    options.source = "/dev/video-that-is-not-there";
    options.camera = webcam(false);
    const CameraTracker tracker(options);
    for (int i = 0; i < 250 && tracker.status().advice.empty(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_NE(tracker.status().advice.find("cannot be opened"), std::string::npos);
    EXPECT_FALSE(tracker.status().open);
}

} // namespace
} // namespace lumorph

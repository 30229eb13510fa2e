#include "calibration/tracking/board_finder.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/calibration/photographer.h"

namespace lumorph {
namespace {

using test::degreesBetween;
using test::Photographer;

CalibratedCamera webcam(bool distorted) {
    CalibratedCamera camera = cameraLookingAt({0.15, 0.55, 0.45}, {0.0, 0.0, 0.0}, {960, 540}, 790.0);
    camera.principal += glm::dvec2(11.0, -7.0);
    if (distorted) camera.distortion = {-0.12, 0.04, 0.001, -0.0008, 0.0};
    return camera;
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
        const auto picture = photographer.picture(matrixOf(truth) * matrixOf(deviceFromBoard), 3.0);
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

/// The other pose in which a board looks the same from very far: its normal mirrored at the line of sight.
glm::dquat flippedOver(const glm::dquat& cameraFromBoard, const glm::dvec3& sight) {
    return glm::angleAxis(glm::pi<double>(), glm::normalize(sight)) * cameraFromBoard *
           glm::angleAxis(glm::pi<double>(), glm::dvec3(0.0, 0.0, 1.0));
}

class BoardFinderFlip : public ::testing::Test {
protected:
    /// What is found of a board that is tilted by so many degrees, at a distance that fills the picture alike.
    void look(double metres, double tilt, double turn) {
        const CalibratedCamera camera =
            cameraLookingAt({0.0, 0.0, metres}, {0.0, 0.0, 0.0}, {640, 480}, 1500.0 * metres);
        const Photographer photographer(board_, camera);
        const glm::dquat rotation = glm::angleAxis(glm::radians(turn), glm::dvec3(0.0, 0.0, 1.0)) *
                                    glm::angleAxis(glm::radians(tilt), glm::dvec3(1.0, 0.0, 0.0));
        const glm::dvec3 middle(0.5 * sizeOf(board_), 0.0);
        const Pose worldFromBoard{rotation * -middle, rotation};
        picture_ = photographer.picture(matrixOf(worldFromBoard), 4.0);
        const glm::dmat4 cameraFromBoard = camera.cameraFromWorld * matrixOf(worldFromBoard);
        truth_ = {glm::dvec3(cameraFromBoard[3]), glm::normalize(glm::quat_cast(glm::dmat3(cameraFromBoard)))};
        other_ = truth_;
        other_.rotation = flippedOver(truth_.rotation, truth_.position);
        finder_.emplace(board_, camera);
    }
    /// Degrees from a pose, of what is found with a hint.
    double degreesFrom(const Pose& pose, const std::optional<Pose>& hint) {
        const auto sighting = finder_->find(picture_, hint);
        if (!sighting) {
            ADD_FAILURE() << "not found";
            return 180.0;
        }
        return degreesBetween(sighting->cameraFromBoard.rotation, pose.rotation);
    }
    static Pose turnedALittle(Pose pose) {
        pose.rotation = glm::angleAxis(glm::radians(4.0), glm::normalize(glm::dvec3(0.4, 1.0, 0.3))) * pose.rotation;
        return pose;
    }

    MarkerBoard board_;
    std::vector<std::uint8_t> picture_;
    Pose truth_, other_;
    std::optional<BoardFinder> finder_;
};

TEST_F(BoardFinderFlip, WhereTwoPosesFitAlikeTheOneOfBeforeGoesOn) {
    for (const auto& [tilt, turn] : {std::pair(-30.0, 0.0), {25.0, 30.0}, {25.0, 115.0}}) {
        look(60.0, tilt, turn);
        ASSERT_GT(degreesBetween(truth_.rotation, other_.rotation), 45.0);
        EXPECT_LT(degreesFrom(truth_, turnedALittle(truth_)), 6.0) << tilt << " turned " << turn;
        EXPECT_LT(degreesFrom(other_, turnedALittle(other_)), 6.0) << tilt << " turned " << turn;
    }
}

TEST_F(BoardFinderFlip, WhereOneFitsClearlyBetterNoHintMisleads) {
    for (const auto& [tilt, turn] : {std::pair(-35.0, 0.0), {25.0, 115.0}, {40.0, 0.0}}) {
        look(0.7, tilt, turn);
        EXPECT_LT(degreesFrom(truth_, std::nullopt), 1.0) << tilt << " turned " << turn;
        EXPECT_LT(degreesFrom(truth_, other_), 1.0) << tilt << " turned " << turn;
        EXPECT_LT(degreesFrom(truth_, truth_), 1.0) << tilt << " turned " << turn;
    }
}

TEST(BoardFinder, BlackBoxesAreTheBlackOfThePage) {
    for (const MarkerBoard& board : {MarkerBoard{}, MarkerBoard{MarkerBoard::Kind::aruco, 3, 2, 0.05, 0.04, "5X5_50"},
                                     MarkerBoard{MarkerBoard::Kind::charuco, 4, 6, 0.024, 0.018, "6X6_250"}}) {
        const double perMetre = 5000.0;
        const Image page = BoardFinder::page(board, perMetre);
        std::vector<int> black(static_cast<std::size_t>(page.size().x * page.size().y), 0);
        for (const BlackBox& box : BoardFinder::blackBoxes(board)) {
            const glm::dvec2 low = box.corner * perMetre, high = (box.corner + box.size) * perMetre;
            for (int y = 0; y < page.size().y; ++y)
                for (int x = 0; x < page.size().x; ++x) {
                    const glm::dvec2 middle(x + 0.5, page.size().y - 1 - y + 0.5);
                    if (middle.x >= low.x && middle.x < high.x && middle.y >= low.y && middle.y < high.y)
                        ++black[static_cast<std::size_t>(y * page.size().x + x)];
                }
        }
        int differ = 0, twice = 0;
        for (std::size_t i = 0; i < black.size(); ++i) {
            differ += (black[i] > 0) != (page.pixels()[i][0] < 128) ? 1 : 0;
            twice += black[i] > 1 ? 1 : 0;
        }
        // Borders may fall on either side of a pixel.
        EXPECT_LT(differ, static_cast<int>(black.size()) / 50) << board.dictionary;
        EXPECT_EQ(twice, 0) << board.dictionary;
    }
}

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

} // namespace
} // namespace lumorph

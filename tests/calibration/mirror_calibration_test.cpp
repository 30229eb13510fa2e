#include "calibration/solve/mirror_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/long_tests.h"
#include "tests/support/procam_capture.h"

namespace lumorph::test {
namespace {

/// A camera that looks over a mirror at boards, which a projector lights whose light it does not see directly.
struct MirrorRoom {
    ProcamSetup setup = ProcamSetup::usual();
    glm::dvec3 normal;
    double distance;
    std::vector<glm::dmat4> boards; ///< camera from board

    /// The mirror stands at the left, the boards at the right: a wide camera has both in its picture.
    explicit MirrorRoom(double tilt = 0.0) {
        normal = glm::normalize(glm::dvec3(-1.0, 0.05, 0.1 + tilt));
        distance = 120.0;
        setup.camera.size = {640, 360};
        setup.camera.focal = glm::dvec2(640.0);
        setup.camera.principal = {325.0, 172.0};
        setup.camera.distortion = {-0.12, 0.0, 0.0, 0.001, 0.0};
        setup.projector.distortion = {-0.06, 0.0, 0.0, 0.0, 0.0};
        setup.cameraFromBoard.push_back(setup.pose(-20, 25, 15));
        setup.cameraFromBoard.push_back(setup.pose(15, -22, 70));
        const glm::dmat4 aside = glm::translate(glm::dmat4(1.0), {150.0, 0.0, -50.0});
        for (const glm::dmat4& board : setup.cameraFromBoard) boards.push_back(aside * board);
        setup.projector.cameraFromWorld = setup.projector.cameraFromWorld * glm::inverse(aside);
    }

    [[nodiscard]] glm::dvec3 reflected(const glm::dvec3& p) const {
        return p - 2.0 * (glm::dot(normal, p) - distance) * normal;
    }
    /// `direct`: how many poses the camera also sees past the mirror, by what its lens would see there.
    [[nodiscard]] std::vector<MirrorView> capture(std::size_t direct, double cameraNoise, double projectorNoise,
                                                  std::uint32_t seed, int columns = 10, int rows = 8) const {
        std::mt19937 random(seed);
        std::normal_distribution<double> grain(0.0, 1.0);
        std::vector<MirrorView> views;
        const double wide = setup.square * (setup.columns - 1), high = setup.square * (setup.rows - 1);
        for (std::size_t pose = 0; pose < boards.size(); ++pose) {
            MirrorView& view = views.emplace_back();
            view.name = "pose_" + std::to_string(pose);
            const auto place = [&](double x, double y) {
                return glm::dvec3(boards[pose] * glm::dvec4(x, y, 0.0, 1.0));
            };
            const auto add = [&](BoardPoints& points, double x, double y, const glm::dvec3& at, bool turned) {
                const auto seen = pixelOf(setup.camera, at);
                ASSERT_TRUE(seen);
                points.board.emplace_back(turned ? wide - x : x, turned ? high - y : y, 0.0);
                points.seen.emplace_back(seen->x + cameraNoise * grain(random), seen->y + cameraNoise * grain(random));
            };
            for (int row = 0; row < setup.rows; ++row)
                for (int column = 0; column < setup.columns; ++column) {
                    const double x = column * setup.square, y = row * setup.square;
                    add(view.mirrored, x, y, reflected(place(x, y)), false);
                    if (pose < direct) add(view.direct, x, y, place(x, y), pose % 2 == 1);
                }
            for (int row = 0; row < rows; ++row)
                for (int column = 0; column < columns; ++column) {
                    const glm::dvec3 at = place(column / (columns - 1.0) * wide, row / (rows - 1.0) * high);
                    const auto seen = pixelOf(setup.camera, reflected(at));
                    const auto lit = pixelOf(setup.projector, at);
                    view.light.push_back(
                        {{seen->x, seen->y},
                         {lit->x + projectorNoise * grain(random), lit->y + projectorNoise * grain(random)}});
                }
        }
        return views;
    }
};

TEST(MirrorCalibration, ExactObservationsGiveLensesPosesAndTheMirror) {
    const MirrorRoom room;
    const MirrorCalibration result = calibrateMirrored(room.capture(3, 0.0, 0.0, 1), {640, 360}, {256, 192});
    EXPECT_NEAR(result.procam.projector.lens[kFocalLength], 470.0, 0.05);
    EXPECT_NEAR(result.procam.projector.lens[kPrincipalY], 213.0, 0.05);
    EXPECT_NEAR(result.procam.camera.lens[kFocalLength], 640.0, 0.05);
    EXPECT_NEAR(result.procam.camera.lens[kPrincipalX], 325.0, 0.05);
    ASSERT_TRUE(result.mirror);
    const glm::dvec3 normal(result.mirror->normal[0], result.mirror->normal[1], result.mirror->normal[2]);
    EXPECT_LT(glm::length(normal - room.normal), 1e-4);
    EXPECT_NEAR(result.mirror->distance, 120.0, 0.05);
    const glm::dvec3 way(room.setup.projector.cameraFromWorld[3]);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(result.procam.projectorFromCamera[static_cast<std::size_t>(3 + i)], way[i], 0.1);
    EXPECT_LT(result.procam.rms, 1e-2);
}

// Bar: the projector's focal length within 0.2 %. The noise is that of a tenth of a pixel in a projector of 1024 x 768.
TEST(MirrorCalibration, NoiseLeavesTheFocalLengthWithinAFifthOfAPercent) {
    const int redraws = longTests() ? 20 : 2;
    double worst = 0.0, sum = 0.0, place = 0.0;
    for (int i = 0; i < redraws; ++i) {
        const MirrorRoom room(0.05 * (i % 3 - 1));
        const MirrorCalibration result = calibrateMirrored(
            room.capture(3, 0.05, 0.025, 10 + static_cast<std::uint32_t>(i), 20, 16), {640, 360}, {256, 192});
        const double off = std::abs(result.procam.projector.lens[kFocalLength] / 470.0 - 1.0);
        worst = std::max(worst, off);
        sum += off * off;
        const glm::dvec3 way(room.setup.projector.cameraFromWorld[3]);
        for (int k = 0; k < 3; ++k) {
            const auto at = static_cast<std::size_t>(3 + k);
            place = std::max(place, std::abs(result.procam.projectorFromCamera[at] - way[k]));
            EXPECT_NEAR(result.procam.projectorFromCamera[at], way[k],
                        5.0 * result.procam.projectorFromCameraSigma[at]);
        }
        EXPECT_NEAR(result.mirror->distance, 120.0, 5.0 * result.mirror->distanceSigma);
    }
    std::printf("focal length of the projector over %d redraws: RMS %.3f %%, worst %.3f %%; its place within %.2f mm\n",
                redraws, 100.0 * std::sqrt(sum / redraws), 100.0 * worst, place);
    EXPECT_LT(worst, 0.002);
}

TEST(MirrorCalibration, WithoutADirectSightTheLensIsKnownAndItIsSaidThatTheMirrorIsNot) {
    const MirrorRoom room;
    const MirrorCalibration result = calibrateMirrored(room.capture(0, 0.05, 0.025, 2), {640, 360}, {256, 192});
    EXPECT_FALSE(result.mirror);
    EXPECT_NEAR(result.procam.projector.lens[kFocalLength], 470.0, 0.002 * 470.0);
    EXPECT_NEAR(result.procam.camera.lens[kPrincipalX], 325.0, 5.0);
    EXPECT_TRUE(std::ranges::any_of(result.procam.warnings,
                                    [](const Finding& warning) { return warning.cause == Cause::mirrorUnknown; }));
}

TEST(MirrorCalibration, AMirrorThatMovedIsRefused) {
    const MirrorRoom room, moved(0.06);
    auto views = room.capture(4, 0.05, 0.025, 3);
    const auto later = moved.capture(4, 0.05, 0.025, 4);
    views[0].mirrored = later[0].mirrored;
    views[0].light = later[0].light;
    try {
        (void)calibrateMirrored(views, {640, 360}, {256, 192});
        FAIL() << "it was accepted";
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(refused.finding().cause, Cause::modelDoesNotFit);
    }
}

} // namespace
} // namespace lumorph::test

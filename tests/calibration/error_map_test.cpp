#include "calibration/solve/error_map.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/support/long_tests.h"
#include "tests/support/procam_observations.h"

namespace lumorph::test {
namespace {

/// A table before the setup's camera: the board's plane of its first pose, and where its corners are in that plane.
constexpr double kWorldNoise = 0.15; // pixels

BoardPoints seenTable(const ProcamSetup& setup, std::mt19937& random) {
    return observePose(setup, setup.cameraFromBoard.front(), {kWorldNoise, 0.1}, random).corners;
}

/// Where on the table the real projector's light falls that was meant for a place, by the calibration.
glm::dvec2 lightOnTable(const ProcamSetup& setup, const ProcamCalibration& found, const WorldPose& world,
                        const cv::Point3d& place) {
    const auto move = [](const PoseVector& pose, const glm::dvec3& point) {
        const glm::dvec3 axis(pose[0], pose[1], pose[2]);
        const double angle = glm::length(axis);
        const glm::dmat4 turn = angle > 0.0 ? glm::rotate(glm::dmat4(1.0), angle, axis / angle) : glm::dmat4(1.0);
        return glm::dvec3(turn * glm::dvec4(point, 1.0)) + glm::dvec3(pose[3], pose[4], pose[5]);
    };
    CalibratedCamera projector = setup.projector;
    const Lens& lens = found.projector.lens;
    projector.focal = {lens[kFocalLength], lens[kFocalLength] * lens[kAspect]};
    projector.principal = {lens[kPrincipalX], lens[kPrincipalY]};
    projector.distortion = {lens[kK1], lens[kK2], lens[kP1], lens[kP2], lens[kK3]};
    projector.cameraFromWorld = glm::dmat4(1.0);
    const glm::dvec3 inCamera = move(world.cameraFromWorld, {place.x, place.y, place.z});
    const auto pixel = pixelOf(projector, move(found.projectorFromCamera, inCamera));
    const glm::dmat4 tableFromProjector = glm::inverse(setup.projector.cameraFromWorld * setup.cameraFromBoard.front());
    CalibratedCamera real = setup.projector; // the world of `directionOf` is the camera's frame
    const glm::dvec3 way =
        glm::dmat3(glm::inverse(setup.cameraFromBoard.front())) * directionOf(real, pixel.value_or(glm::dvec2(0.0)));
    const glm::dvec3 from(tableFromProjector[3]);
    return glm::dvec2(from - way * (from.z / way.z));
}

TEST(ErrorMap, TheTruePlaceOfTheLightIsWithinTheErrorInNineteenOfTwentyRedraws) {
    const ProcamSetup setup = ProcamSetup::usual();
    const int redraws = longTests() ? 400 : 120;
    std::vector<LitPlace> places;
    for (const double x : {0.0, 120.0, 240.0})
        for (const double y : {0.0, 90.0, 180.0}) places.push_back({{x, y, 0.0}, {0.0, 0.0, 1.0}});
    SolveOptions quick;
    quick.cameraModel = quick.projectorModel = "k1";
    quick.judge = false;
    std::vector<int> within(places.size(), 0);
    double allowed = 0.0;
    for (int seed = 0; seed < redraws; ++seed) {
        std::mt19937 random(static_cast<std::uint32_t>(5000 + seed));
        const ProcamCalibration found =
            solve(setup, observe(setup, {0.15, 0.1}, 900U + static_cast<unsigned>(seed)), quick);
        if (seed == 0) quick.start = found.state;
        const WorldPose world = worldPoseFrom(found, seenTable(setup, random), kWorldNoise);
        const std::vector<double> errors = errorMap(found, world, places);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::dvec2 fell = lightOnTable(setup, found, world, places[i].point);
            const double off = glm::distance(fell, glm::dvec2(places[i].point.x, places[i].point.y));
            within[i] += off <= errors[i] ? 1 : 0;
            allowed += errors[i] / (redraws * static_cast<double>(places.size()));
        }
    }
    double all = 0.0;
    for (const int count : within) all += 100.0 * count / (redraws * static_cast<double>(places.size()));
    std::printf("within the 95 %% error (mean %.3f mm): %.1f %% of %d redraws at nine places\n", allowed, all, redraws);
    EXPECT_GE(all, 93.0);
    EXPECT_LE(all, 97.0);
}

TEST(ErrorMap, TheRadiusHoldsItsShareOfNormalNoise) {
    std::mt19937 random(3);
    std::normal_distribution<double> grain(0.0, 1.0);
    for (const double ratio : {1.0, 0.5, 0.1, 0.01, 0.0}) {
        Eigen::Matrix2d turn;
        turn << std::cos(0.4), -std::sin(0.4), std::sin(0.4), std::cos(0.4);
        const Eigen::Matrix2d root = turn * Eigen::Vector2d(3.0, 3.0 * ratio).asDiagonal();
        const double radius = radiusOf(root * root.transpose(), 0.95);
        int inside = 0;
        constexpr int kDraws = 40000;
        for (int i = 0; i < kDraws; ++i)
            inside += (root * Eigen::Vector2d(grain(random), grain(random))).norm() < radius;
        EXPECT_NEAR(inside / static_cast<double>(kDraws), 0.95, 0.005) << ratio;
    }
    EXPECT_NEAR(radiusOf(Eigen::Matrix2d::Identity(), 0.95), std::sqrt(-2.0 * std::log(0.05)), 1e-6); // Rayleigh
}

TEST(ErrorMap, APlaceBehindTheProjectorOrEdgeOnHasNoBound) {
    const ProcamSetup setup = ProcamSetup::usual();
    const ProcamCalibration found = solve(setup, observe(setup, {0.1, 0.1}, 1));
    const std::vector<double> errors =
        errorMap(found, {}, {{{0, 0, 1000}, {}}, {{0, 0, -1000}, {}}, {{0, 0, 1000}, {1, 0, 0}}});
    EXPECT_LT(errors[0], 5.0); // of the frame of a camera of 480 pixels
    EXPECT_TRUE(std::isinf(errors[1]));
    EXPECT_GT(errors[2], 5.0 * errors[0]);
    BoardPoints few{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0}, {1, 0}, {0, 1}}};
    EXPECT_THROW((void)worldPoseFrom(found, few, 0.1), InvalidInput);
}

} // namespace
} // namespace lumorph::test

#include "calibration/solve/next_pose.h"

#include <cmath>
#include <cstdio>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/support/long_tests.h"
#include "tests/support/procam_observations.h"

namespace lumorph::test {
namespace {

CalibrationBoard boardOf(const ProcamSetup& setup) {
    return {CalibrationBoard::Kind::chess, setup.columns, setup.rows, setup.square, 0.0};
}

glm::dmat4 matrixOf(const PoseVector& pose) {
    const glm::dvec3 axis(pose[0], pose[1], pose[2]);
    const double angle = glm::length(axis);
    const glm::dmat4 turn = angle > 0.0 ? glm::rotate(glm::dmat4(1.0), angle, axis / angle) : glm::dmat4(1.0);
    return glm::translate(glm::dmat4(1.0), {pose[3], pose[4], pose[5]}) * turn;
}

/// How far light falls beside a place that is meant, over the volume where both devices see: root mean square,
/// millimetres at that depth, in the camera's frame.
double trueError(const ProcamSetup& setup, const ProcamCalibration& found) {
    double sum = 0.0;
    int count = 0;
    for (const double depth : {1500.0, 2000.0, 2500.0})
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 8; ++x) {
                const glm::dvec2 pixel((x + 0.5) / 8.0 * setup.camera.size.x, (y + 0.5) / 6.0 * setup.camera.size.y);
                glm::dvec3 at = directionOf(setup.camera, pixel);
                at *= depth / at.z;
                const auto truth = pixelOf(setup.projector, at);
                if (!truth || truth->x < 0.0 || truth->y < 0.0 || truth->x >= setup.projector.size.x ||
                    truth->y >= setup.projector.size.y)
                    continue;
                const cv::Point2d lit = projectorPixel({at.x, at.y, at.z}, found.state);
                const glm::dvec3 inProjector(setup.projector.cameraFromWorld * glm::dvec4(at, 1.0));
                const double off = glm::distance(*truth, glm::dvec2(lit.x, lit.y));
                sum += std::pow(off * inProjector.z / setup.projector.focal.x, 2.0);
                ++count;
            }
    return std::sqrt(sum / count);
}

ProcamCalibration solvePoses(const ProcamSetup& setup, std::uint32_t seed) {
    SolveOptions options;
    options.judge = false;
    return solve(setup, observe(setup, {0.1, 0.1}, seed), options);
}

/// As quick as can be: the terms are those of the truth.
SolveOptions quick() {
    SolveOptions options;
    options.judge = false;
    options.cameraModel = "k1 k2";
    options.projectorModel = "k1";
    return options;
}

/// Mean square of the true error over redraws of the noise.
double meanSquare(const ProcamSetup& setup, int redraws, SolveOptions options) {
    double sum = 0.0;
    for (int i = 0; i < redraws; ++i) {
        const auto found = solve(setup, observe(setup, {0.1, 0.1}, 7000U + static_cast<std::uint32_t>(i)), options);
        options.start = found.state;
        sum += std::pow(trueError(setup, found), 2.0) / redraws;
    }
    return sum;
}

TEST(NextPose, SeventyPercentOfThePosesDoWhatRandomOnesDo) {
    constexpr std::size_t kRandom = 10;
    constexpr std::size_t kGuided = 7;
    constexpr std::size_t kFirst = 3;
    constexpr int kSetups = 10;
    const int redraws = longTests() ? 12 : 2;
    double random = 0.0;
    double guided = 0.0;
    for (int number = 0; number < kSetups; ++number) {
        const auto seed = static_cast<std::uint32_t>(40 + number);
        ProcamSetup setup = randomSetup(seed, kRandom);
        random += meanSquare(setup, redraws, quick()) / kSetups;
        SolveOptions options = quick();
        setup.cameraFromBoard.resize(kFirst); // the same to begin with
        while (setup.cameraFromBoard.size() < kGuided) {
            const ProcamCalibration found = solve(setup, observe(setup, {0.1, 0.1}, seed), options);
            options.start = found.state;
            const auto next = suggestNextPose(found, boardOf(setup), {{}, 1500.0, 2500.0, 0.1});
            ASSERT_TRUE(next);
            setup.cameraFromBoard.push_back(matrixOf(next->cameraFromBoard));
        }
        guided += meanSquare(setup, redraws, options) / kSetups;
    }
    std::printf("true error over %d set-ups: %zu random poses %.3f mm, %zu suggested ones %.3f mm\n", kSetups, kRandom,
                std::sqrt(random), kGuided, std::sqrt(guided));
    EXPECT_LE(guided, random);
}

TEST(NextPose, ThePoseIsSeenByBothDevicesAndItsOutlineIsWhereTheCameraSeesIt) {
    const ProcamSetup setup = randomSetup(3, 4);
    const ProcamCalibration found = solvePoses(setup, 3);
    const auto next = suggestNextPose(found, boardOf(setup));
    ASSERT_TRUE(next);
    EXPECT_LT(next->meanAfter, next->meanBefore);
    EXPECT_TRUE(next->worthIt);
    ASSERT_EQ(next->outline.size(), 4U);
    const glm::dmat4 pose = matrixOf(next->cameraFromBoard);
    const glm::dvec2 span(setup.square * (setup.columns - 1), setup.square * (setup.rows - 1));
    const glm::dvec2 corners[] = {{0, 0}, {span.x, 0}, span, {0, span.y}};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto seen = pixelOf(setup.camera, glm::dvec3(pose * glm::dvec4(corners[i], 0.0, 1.0)));
        ASSERT_TRUE(seen);
        EXPECT_NEAR(next->outline[i].x, seen->x, 5.0);
        EXPECT_NEAR(next->outline[i].y, seen->y, 5.0);
        EXPECT_GE(next->outline[i].x, 0.0);
        EXPECT_LE(next->outline[i].x, setup.camera.size.x);
    }
}

TEST(NextPose, LiesWhereTheProjectorShines) {
    for (const std::uint32_t seed : {23U, 24U, 25U, 26U}) {
        ProcamSetup setup = randomSetup(seed, 4);
        // A tele lens, so that the light is a part of what the camera sees.
        setup.projector.focal *= 1.5;
        const auto next = suggestNextPose(solvePoses(setup, seed), boardOf(setup));
        ASSERT_TRUE(next) << seed;
        const glm::dmat4 pose = matrixOf(next->cameraFromBoard);
        int lit = 0;
        for (int row = 0; row < setup.rows; ++row)
            for (int column = 0; column < setup.columns; ++column) {
                const glm::dvec4 at = pose * glm::dvec4(setup.square * column, setup.square * row, 0.0, 1.0);
                const auto pixel = pixelOf(setup.projector, glm::dvec3(at));
                lit += pixel && pixel->x > -2.0 && pixel->y > -2.0 && pixel->x < setup.projector.size.x + 1.0 &&
                       pixel->y < setup.projector.size.y + 1.0;
            }
        EXPECT_GE(lit, 0.75 * setup.rows * setup.columns) << seed;
    }
}

TEST(NextPose, WhatItPromisesIsWhatCapturingItBrings) {
    ProcamSetup setup = randomSetup(5, 4);
    const ProcamCalibration before = solvePoses(setup, 5);
    std::vector<LitPlace> places;
    for (const double x : {-200.0, 0.0, 200.0}) places.push_back({{x, 0.0, 2000.0}, {}});
    const auto next = suggestNextPose(before, boardOf(setup), {places, 1500.0, 2500.0, 0.1});
    ASSERT_TRUE(next);
    setup.cameraFromBoard.push_back(matrixOf(next->cameraFromBoard));
    const ProcamCalibration after = solvePoses(setup, 5);
    const auto again = suggestNextPose(after, boardOf(setup), {places, 1500.0, 2500.0, 0.1});
    ASSERT_TRUE(again);
    EXPECT_NEAR(again->meanBefore, next->meanAfter, 0.15 * next->meanAfter);
}

TEST(NextPose, ItIsToldWhenAnotherIsNoLongerWorthIt) {
    ProcamSetup setup = randomSetup(7, 4);
    SolveOptions options = quick();
    double before = 1e9;
    for (;;) {
        const ProcamCalibration found = solve(setup, observe(setup, {0.1, 0.1}, 7), options);
        options.start = found.state;
        const auto next = suggestNextPose(found, boardOf(setup));
        ASSERT_TRUE(next);
        EXPECT_LT(next->meanBefore, before);
        before = next->meanBefore;
        EXPECT_EQ(next->worthIt, next->meanAfter < 0.9 * next->meanBefore);
        if (!next->worthIt) break;
        setup.cameraFromBoard.push_back(matrixOf(next->cameraFromBoard));
        ASSERT_LT(setup.cameraFromBoard.size(), 16U);
    }
    EXPECT_GT(setup.cameraFromBoard.size(), 5U);
}

TEST(NextPose, ABoardThatNeitherSeesWholeHasNoPose) {
    const ProcamSetup setup = randomSetup(8, 4);
    EXPECT_FALSE(suggestNextPose(solvePoses(setup, 8), {CalibrationBoard::Kind::chess, 9, 7, 2000.0, 0.0}));
}

} // namespace
} // namespace lumorph::test

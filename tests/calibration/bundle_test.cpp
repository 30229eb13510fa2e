#include "calibration/solve/bundle.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "tests/support/procam_observations.h"

namespace lumorph::test {
namespace {

/// All numbers of a state with one view, in the order of a covariance.
std::vector<double*> numbersOf(BundleState& state) {
    std::vector<double*> all;
    const auto add = [&all](auto& block) {
        for (double& number : block) all.push_back(&number);
    };
    add(state.camera);
    add(state.projector);
    add(state.projectorFromCamera);
    add(state.board.terms);
    add(state.cameraFromBoard.front());
    return all;
}

/// Errors of corners and points one below the other, in standard deviations.
Eigen::VectorXd errorsOf(const ViewObservations& view, const BundleState& state, const BundleOptions& options) {
    std::vector<double> all;
    for (const cv::Point2d& e : cameraErrors(view, state, state.cameraFromBoard.front()))
        for (const double v : {e.x, e.y}) all.push_back(v / options.cameraSigma);
    for (const cv::Point2d& e : projectorErrors(view, state, state.cameraFromBoard.front()))
        for (const double v : {e.x, e.y}) all.push_back(v / options.projectorSigma);
    return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

TEST(Bundle, SlopesAreThoseOfFiniteDifferencesEvenOnABentBoard) {
    ProcamSetup setup = ProcamSetup::usual();
    setup.cameraFromBoard = {setup.pose(32, 5, 4)};
    const std::vector<ViewObservations> views = observe(setup, {0.1, 0.1}, 1);
    BundleState state;
    state.camera = {960.0, 1.01, 245.0, 172.0, -0.2, 0.1, 0.002, -0.003, 0.05};
    state.projector = {470.0, 0.99, 126.0, 213.0, -0.08, 0.05, -0.001, 0.002, 0.03};
    state.projectorFromCamera = {0.01, -0.07, 0.03, 25.0, -255.0, 60.0};
    state.board = flatBoard(views);
    state.board.terms = {2.0, -1.0, 1.5, 0.5, -0.4, 0.3, 0.6, 0.004};
    state.cameraFromBoard = {{0.55, 0.1, 0.08, -120.0, -90.0, 1000.0}};
    BundleOptions options;
    options.camera.fill(true);
    options.projector.fill(true);
    options.board.fill(true);
    const Eigen::MatrixXd normal = normalMatrixOf(views, {0}, options, state);

    const std::vector<double*> numbers = numbersOf(state);
    ASSERT_EQ(static_cast<Eigen::Index>(numbers.size()), normal.cols());
    Eigen::MatrixXd slopes(errorsOf(views[0], state, options).size(), normal.cols());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double here = *numbers[i];
        const double step = 1e-6 * std::max(1.0, std::abs(here));
        *numbers[i] = here + step;
        const Eigen::VectorXd above = errorsOf(views[0], state, options);
        *numbers[i] = here - step;
        const Eigen::VectorXd below = errorsOf(views[0], state, options);
        *numbers[i] = here;
        slopes.col(static_cast<Eigen::Index>(i)) = (above - below) / (2.0 * step);
    }
    const Eigen::MatrixXd differences = slopes.transpose() * slopes;
    for (Eigen::Index i = 0; i < normal.rows(); ++i)
        for (Eigen::Index k = 0; k < normal.cols(); ++k)
            EXPECT_NEAR(normal(i, k), differences(i, k), 1e-5 * std::sqrt(differences(i, i) * differences(k, k)))
                << i << " " << k;
}

TEST(Bundle, WhatIsFarOffTellsNothing) {
    const ProcamSetup setup = ProcamSetup::usual();
    for (const std::uint32_t seed : {61U, 62U}) {
        const std::vector<ViewObservations> sound = observe(setup, {0.15, 0.1}, seed);
        const ProcamCalibration solved = solve(setup, sound);
        std::vector<ViewObservations> spoiled = sound, without = sound;
        // Every second point of three views, anywhere.
        std::mt19937 random(seed);
        std::normal_distribution<double> anywhere(0.0, 60.0);
        ViewChoice use;
        for (std::size_t v = 0; v < sound.size(); ++v) {
            use.push_back(static_cast<int>(v));
            if (v % 2 == 0) continue;
            without[v].projector.clear();
            for (std::size_t i = 0; i < sound[v].projector.size(); ++i) {
                if (i % 2 == 1) {
                    without[v].projector.push_back(sound[v].projector[i]);
                    continue;
                }
                spoiled[v].projector[i].projector.x += 30.0 + std::abs(anywhere(random));
                spoiled[v].projector[i].projector.y += anywhere(random);
            }
        }
        const BundleState& state = solved.state;
        const Eigen::MatrixXd full = covarianceOf(sound, use, solved.bundle, state).matrix;
        const Eigen::MatrixXd far = covarianceOf(spoiled, use, solved.bundle, state).matrix;
        const Eigen::MatrixXd less = covarianceOf(without, use, solved.bundle, state).matrix;
        // Without a loss noise tells as much as before, so that clean captures are as sure as ever.
        const Eigen::MatrixXd normal = normalMatrixOf(sound, use, solved.bundle, state);
        double grown = 0.0;
        for (Eigen::Index i = 0; i < full.rows(); ++i) {
            if (!(full(i, i) > 0.0)) continue;
            EXPECT_NEAR(std::sqrt(far(i, i) / less(i, i)), 1.0, 0.01) << i;
            grown = std::max(grown, less(i, i) / full(i, i));
        }
        EXPECT_GT(grown, 1.1) << "it matters";
        std::vector<Eigen::Index> free;
        for (Eigen::Index i = 0; i < full.rows(); ++i)
            if (full(i, i) > 0.0) free.push_back(i);
        const Eigen::MatrixXd plain = normal(free, free).inverse();
        for (std::size_t k = 0; k < free.size(); ++k)
            EXPECT_NEAR(std::sqrt(full(free[k], free[k]) / plain(Eigen::Index(k), Eigen::Index(k))), 1.0, 0.04)
                << free[k];
    }
}

TEST(Bundle, PointsThatAreFarOffOrMissTheBoardFailNoViewAndAreNamed) {
    const ProcamSetup setup = ProcamSetup::usual();
    const std::vector<ViewObservations> sound = observe(setup, {0.15, 0.1}, 71);
    std::vector<ViewObservations> spoiled = sound;
    spoiled[1].projector[7].camera = {1e5, 400.0}; // beyond the board's horizon, or of no direction at all
    spoiled[2].projector[30].projector += cv::Point2d(40.0, 5.0);
    spoiled[2].projector[90].projector += cv::Point2d(-25.0, 60.0);
    spoiled[4].corners.seen[3] += cv::Point2d(9.0, 0.0);
    const ProcamCalibration found = solve(setup, spoiled);
    std::vector<std::string> named;
    for (const Finding& warning : found.warnings) {
        EXPECT_EQ(warning.cause, Cause::pointSuspicious) << sentenceOf(warning);
        named.push_back(warning.view + ": " + warning.why.substr(0, 2));
        std::printf("  %s\n", sentenceOf(warning).c_str());
    }
    std::ranges::sort(named);
    EXPECT_EQ(named, (std::vector<std::string>{"pose_1: 1 ", "pose_2: 2 ", "pose_4: 1 "}));
    // As if they had never been there.
    std::vector<ViewObservations> without = sound;
    const auto erase = [](auto& all, std::ptrdiff_t at) { all.erase(all.begin() + at); };
    erase(without[1].projector, 7);
    erase(without[2].projector, 90);
    erase(without[2].projector, 30);
    erase(without[4].corners.seen, 3);
    erase(without[4].corners.board, 3);
    const ProcamCalibration clean = solve(setup, without);
    EXPECT_TRUE(clean.warnings.empty());
    EXPECT_EQ(clean.camera.lens, found.camera.lens);
    EXPECT_EQ(clean.projector.lens, found.projector.lens);
    EXPECT_EQ(clean.camera.sigma, found.camera.sigma);
    for (std::size_t v = 0; v < clean.views.size(); ++v) EXPECT_EQ(clean.views[v].heldOut, found.views[v].heldOut);
}

TEST(Bundle, TheNoiseOfErrorsIsFoundThoughSomeAreStrays) {
    std::mt19937 random(1);
    std::normal_distribution<double> grain(0.0, 0.3);
    std::vector<cv::Point2d> errors;
    for (int i = 0; i < 2000; ++i) errors.emplace_back(grain(random), grain(random));
    EXPECT_NEAR(sigmaOf(errors, 0.0), 0.3, 0.01);
    EXPECT_NEAR(sigmaOf(errors, 1000.0), 0.3 * std::sqrt(4000.0 / 3000.0), 0.012); // what was solved for counts
    errors.emplace_back(500.0, 0.0);
    EXPECT_LT(sigmaOf(errors, 0.0), 0.35);
    EXPECT_EQ(sigmaOf({}, 0.0), 0.0);
}

/// A camera and a projector that stand anyhow, a bent board before them, and a mirror behind it.
InstallationState crookedState() {
    InstallationState state;
    state.cameras = {
        {{960.0, 1.01, 245.0, 172.0, -0.2, 0.1, 0.002, -0.003, 0.05}, {0.05, -0.1, 0.2, 40.0, -20.0, 30.0}}};
    state.projectors = {
        {{470.0, 0.99, 126.0, 213.0, -0.08, 0.05, -0.001, 0.002, 0.03}, {0.01, -0.07, 0.03, 25.0, -255.0, 60.0}}};
    state.worldFromBody = {{0.55, 0.1, 0.08, -120.0, -90.0, 1000.0}};
    state.board = {{120.0, 90.0}, 120.0, {2.0, -1.0, 1.5, 0.5, -0.4, 0.3, 0.6, 0.004}};
    state.mirror = {40.0, -60.0, 1900.0};
    return state;
}

/// Points of the board and light on it and on a plane, straight and by way of the mirror.
InstallationObservations seenBy(const InstallationState& state) {
    InstallationObservations seen;
    for (const bool mirrored : {false, true})
        for (const double x : {10.0, 90.0, 200.0})
            for (const double y : {20.0, 150.0}) {
                SeenPoint point{0, 0, mirrored, {x, y, 0.0}, {}};
                const cv::Point2d pixel = errorsOf({point}, state)[0].value();
                point.pixel = pixel + cv::Point2d(0.5, -0.2);
                seen.points.push_back(point);
                SeenLight light{0, 0, 0, mirrored, {pixel, {}}};
                seen.lights.push_back(light);
                light.plane = SeenLight::Plane{cv::normalize(cv::Vec3d(0.1, -0.2, 1.0)), 12.0};
                light.weight = 0.25;
                seen.lights.push_back(light);
            }
    return seen;
}

std::vector<double*> allNumbers(InstallationState& state) {
    std::vector<double*> all;
    const auto add = [&all](auto& block) {
        for (double& number : block) all.push_back(&number);
    };
    for (auto* device : {&state.cameras[0], &state.projectors[0]}) {
        add(device->lens);
        add(device->fromWorld);
    }
    add(state.board.terms);
    add(state.mirror);
    add(state.worldFromBody[0]);
    return all;
}

Eigen::VectorXd weightedErrors(const InstallationObservations& seen, const InstallationState& state,
                               const InstallationNoise& noise) {
    std::vector<double> all;
    for (const auto& error : errorsOf(seen.points, state))
        for (const double number : {error.value().x, error.value().y}) all.push_back(number / noise.camera);
    const auto lights = errorsOf(seen.lights, state);
    for (std::size_t i = 0; i < lights.size(); ++i)
        for (const double number : {lights[i].value().x, lights[i].value().y})
            all.push_back(number / noise.projector * std::sqrt(seen.lights[i].weight));
    return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

TEST(RigidMotion, TurnsAsOpenCvDoes) {
    for (const double angle : {1e-9, 0.3, 2.0, 3.14159})
        for (const cv::Vec3d& axis : {cv::Vec3d(1.0, 0.0, 0.0), cv::normalize(cv::Vec3d(0.3, -0.5, 0.8))}) {
            const cv::Vec3d turn = angle * axis;
            cv::Matx33d expected;
            cv::Rodrigues(turn, expected);
            const Rigid rigid = Rigid::exp({turn[0], turn[1], turn[2], 0.0, 0.0, 0.0});
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 3; ++column)
                    EXPECT_NEAR(rigid.rotation[column][row], expected(row, column), 1e-14);
                EXPECT_NEAR(rigid.log()[static_cast<std::size_t>(row)], turn[row], 1e-13);
            }
        }
}

TEST(InstallationBundle, SlopesOfAllNumbersAreThoseOfFiniteDifferences) {
    InstallationState state = crookedState();
    const InstallationObservations seen = seenBy(state);
    const InstallationNoise noise;
    const InstallationNormals normals = installationNormals(seen, noise, state, Counts::inFull);
    const Eigen::MatrixXd normal = normals.points + normals.lights;
    const std::vector<double*> numbers = allNumbers(state);
    ASSERT_EQ(static_cast<Eigen::Index>(numbers.size()), normal.cols());
    Eigen::MatrixXd slopes(weightedErrors(seen, state, noise).size(), normal.cols());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double here = *numbers[i];
        const double step = 1e-6 * std::max(1.0, std::abs(here));
        *numbers[i] = here + step;
        const Eigen::VectorXd above = weightedErrors(seen, state, noise);
        *numbers[i] = here - step;
        const Eigen::VectorXd below = weightedErrors(seen, state, noise);
        *numbers[i] = here;
        slopes.col(static_cast<Eigen::Index>(i)) = (above - below) / (2.0 * step);
    }
    const Eigen::MatrixXd differences = slopes.transpose() * slopes;
    for (Eigen::Index i = 0; i < normal.rows(); ++i) {
        EXPECT_GT(normal(i, i), 0.0) << i;
        for (Eigen::Index k = 0; k < normal.cols(); ++k)
            EXPECT_NEAR(normal(i, k), differences(i, k), 1e-5 * std::sqrt(differences(i, i) * differences(k, k)))
                << i << " " << k;
    }
}

TEST(InstallationBundle, AStateThatWasMovedReturnsToWhatWasSeen) {
    const InstallationState truth = crookedState();
    InstallationObservations seen = seenBy(truth);
    for (std::size_t i = 0; i < seen.points.size(); ++i) seen.points[i].pixel -= cv::Point2d(0.5, -0.2);
    for (SeenLight& light : seen.lights) light.pixels.projector = errorsOf({light}, truth)[0].value();
    InstallationState moved = truth;
    for (double& number : moved.projectors[0].fromWorld) number += 0.01;
    for (double& number : moved.worldFromBody[0]) number -= 0.01;
    moved.mirror[2] += 5.0;
    InstallationFree free;
    free.projectors = {{{}, true}};
    free.bodies = {true};
    free.mirror = true;
    EXPECT_LT(refineInstallation(seen, free, {}, moved), 1e-9);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(moved.projectors[0].fromWorld[i], truth.projectors[0].fromWorld[i], 1e-4);
        EXPECT_NEAR(moved.worldFromBody[0][i], truth.worldFromBody[0][i], 1e-4);
    }
    EXPECT_NEAR(moved.mirror[2], truth.mirror[2], 1e-3);
    EXPECT_EQ(moved.cameras[0], truth.cameras[0]);
    const InstallationState sigma = installationSigmas(seen, free, {}, truth);
    EXPECT_GT(sigma.mirror[2], 0.0);
    EXPECT_EQ(sigma.cameras[0], InstallationState::Device{});
}

} // namespace
} // namespace lumorph::test

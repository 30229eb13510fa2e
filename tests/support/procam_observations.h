#pragma once

#include <algorithm>
#include <functional>

#include "calibration/solve/procam_calibration.h"
#include "tests/support/procam_capture.h"

namespace lumorph::test {

/// What spoils observations.
struct ObservationNoise {
    double camera = 0.1;    ///< of each coordinate of a corner, pixels
    double projector = 0.1; ///< of each coordinate of a projector point, pixels
    /// Height of the board over its plane, by the place from its middle in half sides; the board's unit.
    std::function<double(double u, double v)> bend = [](double, double) { return 0.0; };
};

/// What a perfect decoder would see of one pose of a setup: every corner, and 20 x 16 points of the board that the
/// projector's picture reaches.
inline ViewObservations observePose(const ProcamSetup& setup, const glm::dmat4& pose, const ObservationNoise& noise,
                                    std::mt19937& random) {
    std::normal_distribution<double> grain(0.0, 1.0);
    ViewObservations view;
    const glm::dvec2 span(setup.square * (setup.columns - 1), setup.square * (setup.rows - 1));
    const auto place = [&](const glm::dvec2& at) {
        const glm::dvec2 from = (at - 0.5 * span) / (0.5 * std::max(span.x, span.y));
        return glm::dvec3(pose * glm::dvec4(at, noise.bend(from.x, from.y), 1.0));
    };
    for (int row = 0; row < setup.rows; ++row)
        for (int column = 0; column < setup.columns; ++column) {
            const glm::dvec2 board(column * setup.square, row * setup.square);
            const auto seen = pixelOf(setup.camera, place(board));
            const double x = grain(random);
            const double y = grain(random);
            if (!seen) continue;
            view.corners.board.emplace_back(board.x, board.y, 0.0);
            view.corners.seen.emplace_back(seen->x + noise.camera * x, seen->y + noise.camera * y);
        }
    for (int row = 0; row < 16; ++row)
        for (int column = 0; column < 20; ++column) {
            const glm::dvec3 at = place(glm::dvec2(column / 19.0, row / 15.0) * span);
            const auto camera = pixelOf(setup.camera, at);
            const auto lit = pixelOf(setup.projector, at);
            const double x = grain(random);
            const double y = grain(random);
            if (!camera || !lit || lit->x < 0.0 || lit->y < 0.0 || lit->x > setup.projector.size.x - 1 ||
                lit->y > setup.projector.size.y - 1)
                continue;
            view.projector.push_back(
                {{camera->x, camera->y}, {lit->x + noise.projector * x, lit->y + noise.projector * y}});
        }
    return view;
}

inline std::vector<ViewObservations> observe(const ProcamSetup& setup, const ObservationNoise& noise,
                                             std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<ViewObservations> views;
    for (const glm::dmat4& pose : setup.cameraFromBoard) {
        views.push_back(observePose(setup, pose, noise, random));
        views.back().name = "pose_" + std::to_string(views.size() - 1);
    }
    return views;
}

inline ProcamCalibration solve(const ProcamSetup& setup, const std::vector<ViewObservations>& views,
                               const SolveOptions& options = {}) {
    return calibrateProcam(views, {setup.camera.size.x, setup.camera.size.y},
                           {setup.projector.size.x, setup.projector.size.y}, options);
}

/// Whether camera and projector see all of the board.
inline bool seesBoard(const ProcamSetup& setup, const glm::dmat4& pose) {
    for (const double x : {0.0, setup.square * (setup.columns - 1)})
        for (const double y : {0.0, setup.square * (setup.rows - 1)}) {
            const glm::dvec3 at(pose * glm::dvec4(x, y, 0.0, 1.0));
            for (const CalibratedCamera* device : {&setup.camera, &setup.projector}) {
                const auto pixel = pixelOf(*device, at);
                if (!pixel || pixel->x < 4 || pixel->y < 4 || pixel->x > device->size.x - 5 ||
                    pixel->y > device->size.y - 5)
                    return false;
            }
        }
    return true;
}

/// A pose of the board that both see, anywhere between 1.5 and 2.5 m from the camera, tilted by up to 40 degrees, as a
/// person would hold it.
inline glm::dmat4 randomPose(const ProcamSetup& setup, std::mt19937& random) {
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    const glm::dvec3 middle(0.5 * setup.square * (setup.columns - 1), 0.5 * setup.square * (setup.rows - 1), 0.0);
    for (;;) {
        const double depth = 2000.0 + 500.0 * share(random);
        const glm::dvec2 at = depth * glm::dvec2(setup.camera.size) / (2.0 * setup.camera.focal.x) *
                              glm::dvec2(share(random), share(random));
        glm::dmat4 pose = glm::translate(glm::dmat4(1.0), {at, depth});
        pose = glm::rotate(pose, glm::radians(40.0 * share(random)), {1.0, 0.0, 0.0});
        pose = glm::rotate(pose, glm::radians(40.0 * share(random)), {0.0, 1.0, 0.0});
        pose = glm::rotate(pose, glm::radians(20.0 * share(random)), {0.0, 0.0, 1.0});
        pose = glm::translate(pose, -middle);
        if (seesBoard(setup, pose)) return pose;
    }
}

/// A camera and a projector with lens shift, as somebody might put them up 2 m before a device; millimetres.
inline ProcamSetup randomSetup(std::uint32_t seed, int poses) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    ProcamSetup setup;
    setup.square = 60.0;
    setup.camera.size = {1280, 1024};
    setup.camera.focal = glm::dvec2(1280.0 * (1.4 + 0.3 * share(random)));
    setup.camera.principal = {639.5 + 15.0 * share(random), 511.5 + 15.0 * share(random)};
    setup.camera.distortion = {-0.1 + 0.1 * share(random), 0.05 * share(random), 0.0, 0.0, 0.0};
    setup.projector.size = {1024, 768};
    setup.projector.focal = glm::dvec2(1024.0 * (1.6 + 0.2 * share(random)));
    setup.projector.principal = {511.5 + 10.0 * share(random), 384.0 + 384.0 * std::abs(share(random))};
    setup.projector.distortion = {0.05 * share(random), 0.0, 0.0, 0.0, 0.0};
    // Its picture's middle falls on the camera's, 2 m away.
    const double side = 300.0 + 150.0 * share(random);
    const double below = 250.0 * share(random);
    const glm::dvec3 at(side, below, 100.0 * share(random));
    const glm::dvec2 off = (glm::dvec2(setup.projector.size) * 0.5 - setup.projector.principal) / setup.projector.focal;
    const glm::dvec3 want = glm::normalize(glm::dvec3(0.0, 0.0, 2000.0) - at);
    const glm::dvec3 have = glm::normalize(glm::dvec3(off, 1.0));
    const glm::dvec3 axis = glm::cross(want, have);
    setup.projector.cameraFromWorld =
        glm::rotate(glm::dmat4(1.0), std::asin(glm::length(axis)), axis / glm::length(axis)) *
        glm::translate(glm::dmat4(1.0), -at);
    while (static_cast<int>(setup.cameraFromBoard.size()) < poses)
        setup.cameraFromBoard.push_back(randomPose(setup, random));
    return setup;
}

} // namespace lumorph::test

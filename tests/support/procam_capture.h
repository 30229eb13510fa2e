#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "core/base/image.h"
#include "core/geometry/calibrated_camera.h"

namespace lumorph::test {

/// A simulated projector, camera and board, photographed by rays from the formulas of a pinhole with distortion: it
/// shares the lens of `core/geometry` with nothing in `calibration`. Lengths in the board's unit; the camera is the
/// world.
struct ProcamSetup {
    CalibratedCamera camera, projector;
    std::vector<glm::dmat4> cameraFromBoard;
    int columns = 9, rows = 7; ///< inner corners
    double square = 30.0;
    double noise = 0.8; ///< grey levels
    double gain = 1.0;

    /// Six tilted poses before a camera of 480 x 360 and a projector of 256 x 192, whose principal point lies below its
    /// picture.
    static ProcamSetup usual() {
        ProcamSetup setup;
        setup.camera.size = {480, 360};
        setup.camera.focal = glm::dvec2(960.0);
        setup.camera.principal = {245.0, 172.0};
        setup.camera.distortion = {-0.2, 0.0, 0.0, 0.0, 0.0};
        setup.projector.size = {256, 192};
        setup.projector.focal = glm::dvec2(470.0);
        setup.projector.principal = {126.0, 213.0};
        setup.projector.distortion = {-0.08, 0.0, 0.0, 0.0, 0.0};
        setup.projector.cameraFromWorld = glm::translate(glm::dmat4(1.0), {25.0, -255.0, 60.0}) *
                                          glm::rotate(glm::dmat4(1.0), glm::radians(-4.0), {0.0, 1.0, 0.0}) *
                                          glm::rotate(glm::dmat4(1.0), glm::radians(1.5), {0.0, 0.0, 1.0});
        constexpr double kTilts[][3] = {{4, 3, 0}, {32, 5, 4}, {-30, -8, -6}, {6, 34, 10}, {-4, -33, -8}, {24, 24, 30}};
        for (const auto& tilt : kTilts) setup.cameraFromBoard.push_back(setup.pose(tilt[0], tilt[1], tilt[2]));
        return setup;
    }

    /// The board's middle before the camera, tilted; degrees.
    [[nodiscard]] glm::dmat4 pose(double x, double y, double z) const {
        const glm::dvec3 middle(0.5 * square * (columns - 1), 0.5 * square * (rows - 1), 0.0);
        glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), {2.0 * y / 5.0, -x / 3.0, 1000.0 + 2.0 * x});
        matrix = glm::rotate(matrix, glm::radians(x), {1.0, 0.0, 0.0});
        matrix = glm::rotate(matrix, glm::radians(y), {0.0, 1.0, 0.0});
        matrix = glm::rotate(matrix, glm::radians(z), {0.0, 0.0, 1.0});
        return glm::translate(matrix, -middle);
    }
};

/// What one camera pixel sees, at one of its four samples.
struct SeenSample {
    double albedo = 0.0;
    double column = -1e9, row = -1e9; ///< projector pixels; far outside where no light falls
};

/// What the camera's pixels see of one pose, four samples a pixel.
inline std::vector<SeenSample> seenSamples(const ProcamSetup& setup, const glm::dmat4& cameraFromBoard) {
    const glm::dmat4 boardFromCamera = glm::inverse(cameraFromBoard);
    const glm::dvec3 from(boardFromCamera[3]);
    std::vector<SeenSample> samples;
    for (int y = 0; y < setup.camera.size.y; ++y)
        for (int x = 0; x < setup.camera.size.x; ++x)
            for (const glm::dvec2 part : {glm::dvec2(-0.25, -0.25), {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}}) {
                SeenSample& sample = samples.emplace_back();
                const glm::dvec3 way = glm::dmat3(boardFromCamera) * directionOf(setup.camera, glm::dvec2(x, y) + part);
                const glm::dvec3 at = from - way * (from.z / way.z);
                const double u = at.x / setup.square + 1.0; // squares from the board's first edge
                const double v = at.y / setup.square + 1.0;
                const bool onBoard = u > 0 && v > 0 && u < setup.columns + 1 && v < setup.rows + 1;
                const bool black = onBoard && (static_cast<int>(u) + static_cast<int>(v)) % 2 == 0;
                const bool onPaper = u > -1 && v > -1 && u < setup.columns + 2 && v < setup.rows + 2;
                sample.albedo = black ? 0.12 : onPaper ? 0.85 : 0.3;
                const auto lit = pixelOf(setup.projector, glm::dvec3(cameraFromBoard * glm::dvec4(at, 1.0)));
                if (lit) sample.column = lit->x, sample.row = lit->y;
            }
    return samples;
}

/// One picture: `light` gives what the projector shows at a pixel, 0 to 1. Pixels are squares of even light.
inline Image photograph(const ProcamSetup& setup, const std::vector<SeenSample>& samples,
                        const std::function<double(int column, int row)>& light, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> grain(0.0, setup.noise);
    Image picture(setup.camera.size);
    for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
        double grey = 0.0;
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
            const int column = static_cast<int>(std::floor(samples[k].column + 0.5));
            const int row = static_cast<int>(std::floor(samples[k].row + 0.5));
            const bool lit = column >= 0 && row >= 0 && column < setup.projector.size.x && row < setup.projector.size.y;
            grey += 0.25 * samples[k].albedo * (12.0 + (lit ? 200.0 * light(column, row) : 0.0));
        }
        const double noisy = setup.gain * grey + grain(random);
        const auto value = static_cast<std::uint8_t>(std::lround(std::clamp(noisy, 0.0, 255.0)));
        picture.pixels()[i] = {value, value, value, 255};
    }
    return picture;
}

/// What a projector shows in each image, by column and row.
using Light = std::function<double(int, int)>;

/// Columns then rows, the most significant bit first, each followed by its inverse, then white and black.
inline std::vector<Light> grayCodeLights(glm::ivec2 size) {
    std::vector<Light> lights;
    for (int axis = 0; axis < 2; ++axis) {
        int bits = 0;
        while ((1 << bits) < size[axis]) ++bits;
        for (int bit = bits - 1; bit >= 0; --bit)
            for (int inverse = 0; inverse < 2; ++inverse)
                lights.emplace_back([=](int column, int row) {
                    const int n = axis == 0 ? column : row;
                    return static_cast<double>((((n ^ (n / 2)) >> bit) & 1) ^ inverse);
                });
    }
    lights.emplace_back([](int, int) { return 1.0; });
    lights.emplace_back([](int, int) { return 0.0; });
    return lights;
}

/// Columns then rows, three steps of `fine` periods, three of one.
inline std::vector<Light> phaseLights(glm::ivec2 size, int fine) {
    std::vector<Light> lights;
    for (int axis = 0; axis < 2; ++axis)
        for (const int periods : {fine, 1})
            for (int step = 0; step < 3; ++step)
                lights.emplace_back([=](int column, int row) {
                    const double share = ((axis == 0 ? column : row) + 0.5) / size[axis];
                    return 0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * (periods * share - step / 3.0));
                });
    return lights;
}

inline std::vector<Image> photographAll(const ProcamSetup& setup, const glm::dmat4& cameraFromBoard,
                                        const std::vector<Light>& lights, std::uint32_t seed) {
    const std::vector<SeenSample> samples = seenSamples(setup, cameraFromBoard);
    std::vector<Image> images;
    for (const Light& light : lights)
        images.push_back(photograph(setup, samples, light, seed * 1000 + static_cast<std::uint32_t>(images.size())));
    return images;
}

inline std::string imageName(std::size_t index) {
    return "image_" + std::string(index < 10 ? "0" : "") + std::to_string(index) + ".png";
}

/// A capture on disk: one folder a pose.
inline void writeCapture(const std::filesystem::path& folder, const std::vector<std::vector<Image>>& poses) {
    for (std::size_t pose = 0; pose < poses.size(); ++pose) {
        const auto place = folder / ("pose_" + std::to_string(pose));
        std::filesystem::create_directories(place);
        for (std::size_t i = 0; i < poses[pose].size(); ++i) writePng(poses[pose][i], place / imageName(i));
    }
}

} // namespace lumorph::test

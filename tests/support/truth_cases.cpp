#include "tests/support/truth_cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/rig/templates/bundled_rigs.h"

namespace lumorph::test {
namespace {

constexpr glm::vec3 kDeviceMiddle{0.0F, 0.02F, 0.0F};
constexpr glm::ivec2 kEyeSize{1280, 800};

template <typename Row> const Row& find(std::span<const Row> rows, const std::string& name) {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return name == row.name; });
    if (found == rows.end()) throw std::out_of_range(name);
    return *found;
}

} // namespace

TruthDevice truthDevice() { return {std::make_shared<Rig>(bakedTablet()), defaultSceneInRoom()}; }

std::span<const TruthState> truthStates() {
    static const std::array<TruthState, 8> states{{
        {"rest", {0, 0, 0, 0, 0, 0}},
        {"all", {1, 1, 1, 1, 1, 1}},
        {"mixed", {0.6, 0.2, 0.8, 0.3, 0.5, 0.1}},
        {"first flap", {1, 0, 0, 0, 0, 0}},
        {"last corner", {0, 0, 0, 0.7, 0, 0}},
        {"middle", {0, 0, 0, 0, 0.9, 0.4}},
        {"diagonal", {0.5, 0, 0, 0.5, 0, 0.5}},
        {"low relief", {0.15, 0.25, 0.1, 0.2, 0.3, 0.25}},
    }};
    return states;
}

const TruthState& truthState(const std::string& name) { return find(truthStates(), name); }

std::span<const TruthEye> truthEyes() {
    static const std::array<TruthEye, 6> eyes{{
        {"front", 0.0, 45.0, 0.7},
        {"front low", 8.0, 25.0, 0.9},
        {"right", 75.0, 40.0, 0.6},
        {"left", -60.0, 35.0, 0.8},
        {"steep", 20.0, 75.0, 0.5},
        {"front right", 30.0, 55.0, 0.65},
    }};
    return eyes;
}

glm::vec3 positionOf(const TruthEye& eye) {
    const double azimuth = eye.azimuthDegrees * std::numbers::pi / 180.0;
    const double elevation = eye.elevationDegrees * std::numbers::pi / 180.0;
    return kDeviceMiddle +
           glm::vec3(eye.distance * glm::dvec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                               std::cos(elevation) * std::cos(azimuth)));
}

glm::vec3 truthEye(const std::string& name) { return positionOf(find(truthEyes(), name)); }

CalibratedCamera truthView(const TruthDevice& device, const glm::vec3& eye) {
    ShowFrame frame;
    frame.rig = device.rig;
    frame.worldFromDevice = device.scene.worldFromDevice;
    return deviceView(frame, eye, kEyeSize);
}

TruthSetup truthSetup(const TruthDevice& device, const TruthState& state, const glm::vec3& eye) {
    return {truthMesh(device, state), tableMesh(device.scene.tableSize), device.scene.projectors.front(),
            truthView(device, eye)};
}

TriangleMesh truthMesh(const TruthDevice& device, const TruthState& state) {
    TriangleMesh mesh = deformed(*device.rig, state.strokes);
    for (glm::vec3& point : mesh.positions) point = glm::vec3(device.scene.worldFromDevice * glm::vec4(point, 1.0F));
    return mesh;
}

TriangleMesh tableMesh(glm::vec2 size) {
    const glm::vec2 half = 0.5F * size;
    return {{{-half.x, 0, -half.y}, {-half.x, 0, half.y}, {half.x, 0, half.y}, {half.x, 0, -half.y}},
            {{0, 1, 2}, {0, 2, 3}}};
}

} // namespace lumorph::test

#pragma once

#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/scene/show_frame.h"
#include "tests/support/scene_in_room.h"
#include "tests/support/truth.h"

namespace lumorph::test {

/// The tablet on its table under the default projector, as the truth test uses it.
struct TruthDevice {
    std::shared_ptr<const Rig> rig;
    SceneInRoom scene; ///< table and projector
};
[[nodiscard]] TruthDevice truthDevice();

/// Strokes of the tablet's six actuators.
struct TruthState {
    const char* name;
    std::vector<double> strokes;
    friend std::ostream& operator<<(std::ostream& out, const TruthState& state) { return out << state.name; }
};
[[nodiscard]] std::span<const TruthState> truthStates();
[[nodiscard]] const TruthState& truthState(const std::string& name);

/// Where a visitor's eye may be: 0.5 to 0.9 m from the device, 25 to 75 degrees above it.
struct TruthEye {
    const char* name;
    double azimuthDegrees; ///< 0 in front (+z), 90 to the right (+x)
    double elevationDegrees;
    double distance; ///< metres, from the middle of the device
};
[[nodiscard]] std::span<const TruthEye> truthEyes();
/// World metres.
[[nodiscard]] glm::vec3 positionOf(const TruthEye& eye);
[[nodiscard]] glm::vec3 truthEye(const std::string& name);

/// The frame that the eye pass has of the device alone, 1280 x 800.
[[nodiscard]] CalibratedCamera truthView(const TruthDevice& device, const glm::vec3& eye);

[[nodiscard]] TruthSetup truthSetup(const TruthDevice& device, const TruthState& state, const glm::vec3& eye);

/// The device at a state, world metres.
[[nodiscard]] TriangleMesh truthMesh(const TruthDevice& device, const TruthState& state);
/// The plane y = 0 of a table's size.
[[nodiscard]] TriangleMesh tableMesh(glm::vec2 size);

} // namespace lumorph::test

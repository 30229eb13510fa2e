#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/capsule.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"
#include "core/scene/posed_scene.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph {

/// All that the passes of one frame need, as a value: what is physically there, what is to be seen, and from where.
struct ShowFrame {
    std::shared_ptr<const Scene> scene;               ///< skin, table, exposure
    std::shared_ptr<const Installation> installation; ///< projectors, size of the table, bare colours
    std::shared_ptr<const SceneAssets> assets;        ///< its pictures
    PosedScene posed;
    std::shared_ptr<const Rig> rig;
    std::shared_ptr<const std::vector<glm::vec3>> devicePositions; ///< of the estimated state, device metres
    glm::mat4 worldFromDevice{1.0F};
    std::optional<glm::vec3> eye; ///< of the viewer who is followed, world metres; none: view-independent
    std::vector<Capsule> hands;   ///< tracked hands and arms, in the world: what keeps light from the device
};

/// Corners, in the world, of a box around what is seen of a surface; none: nothing is, as of what only the servos
/// follow, or its numbers are not finite.
[[nodiscard]] std::optional<std::array<glm::vec3, 8>> seenCorners(const PosedSurface& surface);

/// An eye as far from the world's middle, but lower by so many radians: from there one sees what bends.
[[nodiscard]] glm::vec3 loweredEye(const glm::vec3& eye, double by);
/// The off-axis camera of the eye pass: from `eye`, tight around the device as it is and everything above it up to its
/// reach, so that it does not swim while the device moves.
[[nodiscard]] CalibratedCamera deviceView(const ShowFrame& frame, const glm::vec3& eye, glm::ivec2 size);
/// The same around the table.
[[nodiscard]] CalibratedCamera tableView(const ShowFrame& frame, const glm::vec3& eye, glm::ivec2 size);

} // namespace lumorph

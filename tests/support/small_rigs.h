#pragma once

#include "core/rig/rig.h"

namespace lumorph::test {

/// A closed box from `min` to `max`, its top divided into `cells` x `cells` squares.
[[nodiscard]] TriangleMesh boxMesh(const glm::vec3& min, const glm::vec3& max, int cells = 1);

/// Three actuators that all lift the same top of a box, each most in a place of its own: every voxel
/// above the box depends on all three. The solid holds its path.
[[nodiscard]] Rig cushionRig();

/// A plate whose middle never moves: two small boxes slide up out of opposite corners.
[[nodiscard]] Rig cornersRig();

/// A beam that is turned by three hinges one after the other; a body that sweeps through space, so
/// the solid does not hold its path.
[[nodiscard]] Rig armRig();

/// Three overlapping boxes that slide up out of a base, two of them through one another.
[[nodiscard]] Rig lifterRig();

} // namespace lumorph::test

#pragma once

#include "core/scene/scene.h"
#include "core/voxels/height_grid.h"

/// Items of the bundled demonstrations.
namespace lumorph {

/// y of the tablet's sheet at rest, metres.
inline constexpr float kSheet = 0.02F;

[[nodiscard]] SceneItem demoItem(int id, std::string name, ItemKind kind, int parent = 0);

/// Puts the scene's sun into a group, the new item `group`, that turns about the table's middle once in `period`
/// seconds; 0 lets it stand.
void turnSun(Scene& scene, int group, double period);

/// What servos are to follow of a height field at a moment, over all of it; device metres.
[[nodiscard]] HeightGrid gridOf(const SceneItem& item, double seconds);

} // namespace lumorph

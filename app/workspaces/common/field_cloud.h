#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "app/workspaces/common/field_display.h"
#include "core/loop/match_frame.h"
#include "core/mdf/field.h"
#include "core/render/viewport/viewport_scene.h"

namespace lumorph::studio {

/// Colour of a level of `levels`, sRGB in [0, 1]: from `low` at level 0 to `high` at the last.
[[nodiscard]] glm::vec3 levelColor(int level, int levels, const glm::vec3& low, const glm::vec3& high) noexcept;

/// The voxels of a field that `display` asks for, coloured by the level that first covers them. `touchedBy` as in
/// FieldViewOptions.
[[nodiscard]] std::vector<ViewportVoxel> fieldCloud(const Field& field, const FieldDisplay& display,
                                                    const BitColumns* touchedBy, const glm::vec3& low,
                                                    const glm::vec3& high);

/// The classes that are worth a colour: unmatched and overfilled voxels with a neighbour of their class along each
/// axis. A layer one voxel thin is the grid's own error; on two surfaces that nearly meet it would show as stripes.
[[nodiscard]] std::vector<std::uint8_t> thickClasses(const VoxelFrame& frame, const std::vector<std::uint8_t>& classes);

/// The voxels of a target as MatchFrame::classes tells them: matched and unmatched ones.
[[nodiscard]] BitColumns targetVoxels(const VoxelFrame& frame, const std::vector<std::uint8_t>& classes);

/// The twelve edges of a box.
void addBox(std::vector<ViewportLine>& lines, const Box& box, const glm::vec3& color, float width, bool onTop = false);

} // namespace lumorph::studio

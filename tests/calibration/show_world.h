#pragma once

#include "calibration/lab/lab.h"
#include "calibration/lab/lab_light.h"
#include "core/render/spatial_renderer.h"
#include "tests/support/show_frames.h"

namespace lumorph {

/// The device and the table as they physically are, lit by what the renderer sends out.
inline LabWorld labOf(const ShowFrame& frame, const SpatialRenderer& renderer) {
    LabWorld world;
    const glm::vec2 half = 0.5F * frame.scene->table.size;
    const TriangleMesh table{
        {{-half.x, 0.0F, -half.y}, {half.x, 0.0F, -half.y}, {-half.x, 0.0F, half.y}, {half.x, 0.0F, half.y}},
        {{0, 2, 1}, {1, 2, 3}}};
    world.surfaces = {{physicalDevice(frame), lightOfSrgb(frame.scene->device.surfaceColor)},
                      {table, lightOfSrgb(frame.scene->table.surfaceColor)}};
    for (std::size_t i = 0; i < frame.scene->projectors.size(); ++i)
        if (frame.scene->projectors[i].enabled)
            world.projectors.push_back({frame.scene->projectors[i], renderer.readProjector(i)});
    return world;
}

} // namespace lumorph

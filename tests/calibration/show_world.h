#pragma once

#include "calibration/lab/lab.h"
#include "calibration/lab/lab_light.h"
#include "core/render/spatial_renderer.h"
#include "tests/support/show_frames.h"

namespace lumorph {

/// The device and the table as they physically are, lit by what the renderer sends out.
inline LabWorld labOf(const ShowFrame& frame, const SpatialRenderer& renderer) {
    LabWorld world;
    const glm::vec2 half = 0.5F * frame.installation->tableSize;
    const TriangleMesh table{
        {{-half.x, 0.0F, -half.y}, {half.x, 0.0F, -half.y}, {-half.x, 0.0F, half.y}, {half.x, 0.0F, half.y}},
        {{0, 2, 1}, {1, 2, 3}}};
    world.surfaces = {{physicalDevice(frame), lightOfSrgb(frame.installation->deviceColor)},
                      {table, lightOfSrgb(frame.installation->tableColor)}};
    for (std::size_t i = 0; i < frame.installation->projectors.size(); ++i)
        if (frame.installation->projectors[i].enabled)
            world.projectors.push_back({frame.installation->projectors[i], renderer.readProjector(i)});
    return world;
}

} // namespace lumorph

#pragma once

#include <functional>

#include "app/applications/ice/meltwater.h"
#include "core/geometry/model.h"
#include "core/scene/scene_assets.h"

namespace lumorph::ice {

/// From a floe's home coordinates to the device: on its top, with the direction that is up there.
struct OnFloe {
    glm::dvec3 place{0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
};
using FloePlaces = std::function<OnFloe(int floe, const glm::dvec2& home)>;

/// Puddles and rivulets as domed surfaces in device coordinates, without a material of their own; empty where there is
/// no water.
[[nodiscard]] SceneModel waterModel(const Meltwater& water, const FloePlaces& places);

/// A flat ring of radius 1 in the plane of x and z.
[[nodiscard]] SceneModel ringModel();

} // namespace lumorph::ice

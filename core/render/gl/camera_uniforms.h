#pragma once

#include <string>

#include "core/geometry/calibrated_camera.h"
#include "core/geometry/triangle_mesh.h"
#include "core/render/gl/program.h"

namespace lumorph {

/// Sets what `camera.glsl` needs in the current program: `vec4 clipOf(vec3 world)`, lens distortion included, depth
/// from `near` to `far` metres. Straight edges stay straight between vertices, so a surface drawn through a distorting
/// lens wants triangles of a few pixels. The viewport must have the camera's size.
/// `lens` names another uniform of type Lens, for programs with more than one.
void setCamera(Program& program, const CalibratedCamera& camera, double near, double far,
               const std::string& lens = "lens");

/// Near and far that hold a box seen by a camera as tightly as precision needs.
struct DepthRange {
    double near = 0.01;
    double far = 10.0;
};
[[nodiscard]] DepthRange depthRange(const CalibratedCamera& camera, const Box& box);

} // namespace lumorph

#pragma once

#include <span>
#include <string>

#include "core/geometry/triangle_mesh.h"
#include "core/rig/rig.h"

namespace lumorph::cli {

/// Draws the device at rest, the target above it, and the device matched to it, side by side, into a
/// PNG file. Needs no display.
void drawMatch(const Rig& rig, const TriangleMesh& target, std::span<const double> strokes, double iou,
               double milliseconds, const std::string& file);

} // namespace lumorph::cli

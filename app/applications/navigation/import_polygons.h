#pragma once

#include <memory>
#include <vector>

#include <ogr_geometry.h>

#include <glm/vec2.hpp>

#include "app/applications/navigation/map_assembly.h"

namespace lumorph::navigation {

using Geometry = std::unique_ptr<OGRGeometry>;

/// Whether all its coordinates are numbers.
[[nodiscard]] bool isFinite(const OGRGeometry& geometry);
/// Closes rings whose last point is not their first; how many there were.
[[nodiscard]] std::size_t closeRings(OGRGeometry& geometry);
/// The polygons of a geometry of any kind; what else is in it is no area.
[[nodiscard]] std::vector<const OGRPolygon*> polygonsOf(const OGRGeometry& geometry);
/// Square metres.
[[nodiscard]] double areaOf(const OGRGeometry& geometry);
/// One face by its corners; null for one without area.
[[nodiscard]] Geometry faceOf(const std::vector<glm::dvec2>& corners,
                              const std::vector<std::vector<glm::dvec2>>& holes);
/// All that one of them covers, seams closed; null where that is nothing.
[[nodiscard]] Geometry unionOf(const std::vector<Geometry>& faces);

/// Adds an outline with its courtyards for each polygon, metres of the map. Returns how many there were.
std::size_t addOutlines(MapSources& sources, const OGRGeometry& geometry, const BuildingShape& shape,
                        const Words& name);

} // namespace lumorph::navigation

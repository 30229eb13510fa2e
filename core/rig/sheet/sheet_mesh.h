#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/rig/sheet/elastic_sheet.h"

namespace lumorph {

/// A mirror image of a mesh that is the mesh itself.
struct MeshMirror {
    int axis = 0;                      ///< of `points` that changes its sign about the sheet's middle: 0 for x, 1 for z
    std::vector<std::uint32_t> nodes;  ///< the image of each node
    std::vector<std::uint32_t> edges;  ///< the image of each edge
    std::vector<std::uint32_t> levers; ///< the image of each line
};

/// A triangle mesh of a flat sheet.
struct SheetMesh {
    std::vector<glm::dvec2> points;                    ///< (x, z), metres
    std::vector<glm::uvec3> triangles;                 ///< their normals are +y
    std::vector<std::array<std::uint32_t, 2>> edges;   ///< the lower node first
    std::vector<glm::uvec3> triangleEdges;             ///< edge k of a triangle is opposite to its corner k
    std::vector<std::uint32_t> padNodes;               ///< in the pad or on its rim, ascending
    std::vector<std::vector<std::uint32_t>> lineNodes; ///< of each lever's line, ascending
    std::vector<MeshMirror> mirrors;                   ///< at most one about x and one about z
};

/// Numbers the edges of a mesh of which points and triangles are given.
[[nodiscard]] SheetMesh sheetMesh(std::vector<glm::dvec2> points, std::vector<glm::uvec3> triangles);

/// Throws InvalidInput when nothing holds the sheet, a lever's line is too short, leaves the sheet, touches the pad or
/// the line of another lever, or cannot turn; or when the layers fail `checkLayers`.
void checkSheet(const ElasticSheet& sheet);

/// Meshes a sheet with edges of about this length (metres): an equilateral lattice inside, the outline, the pad's rim
/// and the levers' lines as edges. Where the drawing is its own mirror image about the middle of its outline, so is the
/// mesh. The same on every machine. Throws what `checkSheet` throws, and InvalidInput when the mesh would have more
/// than 100,000 nodes.
[[nodiscard]] SheetMesh meshSheet(const ElasticSheet& sheet, double edgeLength);

} // namespace lumorph

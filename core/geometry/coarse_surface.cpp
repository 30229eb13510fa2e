#include "core/geometry/coarse_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {
namespace {

using Vertices = std::span<const ShadedMesh::Vertex>;

constexpr double kWorthIt = 1.4;    // triangles of the fine form for one of the coarse
constexpr float kNoWidth = 0.01F;   // of a cell: what is narrower is a line already
constexpr float kSameSide = 0.766F; // cosine between normals that become one

// Side of a cell, metres; 0 for a surface without a sound area.
float cellOf(Vertices vertices, std::span<const glm::uvec3> triangles, std::size_t wanted) {
    double area = 0.0;
    for (const glm::uvec3& t : triangles) {
        const glm::vec3 a = vertices[t.x].position;
        const glm::vec3 cross = glm::cross(vertices[t.y].position - a, vertices[t.z].position - a);
        area += 0.5 * static_cast<double>(glm::length(cross));
    }
    const auto cell = static_cast<float>(std::sqrt(2.0 * area / static_cast<double>(wanted)));
    return std::isfinite(cell) ? cell : 0.0F;
}

struct Grid {
    std::vector<std::uint32_t> cells;   // of each vertex
    std::vector<std::uint32_t> nearest; // of each cell: the vertex nearest to the middle of its vertices
};

// For each part the first corner of its grid, and the side of a cell there: two cells at least across a pin, or it
// would become a line.
struct PartGrid {
    Box box;
    float cell = 0.0F;
};

std::unordered_map<std::uint32_t, PartGrid> gridsOf(Vertices vertices, std::span<const std::uint32_t> parts,
                                                    float cell) {
    std::unordered_map<std::uint32_t, PartGrid> grids;
    for (std::size_t i = 0; i < vertices.size(); ++i) grids[parts[i]].box.include(vertices[i].position);
    for (auto& [part, grid] : grids) {
        std::array<float, 3> sides{};
        for (int k = 0; k < 3; ++k) sides[static_cast<std::size_t>(k)] = grid.box.size()[k];
        std::sort(sides.begin(), sides.end());
        const float across = 0.5F * sides[1];
        grid.cell = across > kNoWidth * cell ? std::min(cell, across) : cell;
    }
    return grids;
}

struct CellKey {
    std::uint32_t part;
    std::uint64_t cell;
    bool operator==(const CellKey&) const = default;
};
struct HashOfCell {
    std::size_t operator()(const CellKey& key) const noexcept {
        return std::hash<std::uint64_t>()(key.cell ^ std::uint64_t{key.part} * 0x9E3779B97F4A7C15U);
    }
};

Grid gridOf(Vertices vertices, std::span<const std::uint32_t> parts, float cell) {
    const auto grids = gridsOf(vertices, parts, cell);
    Grid grid;
    std::unordered_map<CellKey, std::uint32_t, HashOfCell> numbers;
    std::vector<glm::vec4> sums;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const PartGrid& of = grids.at(parts[i]);
        const glm::uvec3 at = glm::min((vertices[i].position - of.box.min) / of.cell, glm::vec3(1e6F));
        const std::uint64_t key = at.x | std::uint64_t{at.y} << 21 | std::uint64_t{at.z} << 42;
        const auto [entry, added] = numbers.try_emplace({parts[i], key}, static_cast<std::uint32_t>(sums.size()));
        if (added) sums.emplace_back(0.0F);
        sums[entry->second] += glm::vec4(vertices[i].position, 1.0F);
        grid.cells.push_back(entry->second);
    }
    grid.nearest.resize(sums.size());
    std::vector<float> distances(sums.size(), std::numeric_limits<float>::infinity());
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        const glm::vec4& sum = sums[grid.cells[i]];
        const float distance = glm::distance(vertices[i].position, glm::vec3(sum) / sum.w);
        if (!(distance < distances[grid.cells[i]])) continue;
        distances[grid.cells[i]] = distance;
        grid.nearest[grid.cells[i]] = i;
    }
    return grid;
}

// For each fine vertex the coarse one, which is added where it is missing.
std::vector<std::uint32_t> merge(Vertices vertices, const Grid& grid, CoarseSurface& coarse) {
    std::vector<std::vector<std::uint32_t>> sides(grid.nearest.size()); // coarse vertices of each cell
    std::vector<std::uint32_t> merged(vertices.size());
    std::vector<glm::vec3> normals; // of the coarse vertices
    const auto take = [&](std::uint32_t i) {
        std::vector<std::uint32_t>& there = sides[grid.cells[i]];
        const auto found = std::find_if(there.begin(), there.end(), [&](std::uint32_t side) {
            return glm::dot(normals[side], vertices[i].normal) > kSameSide;
        });
        if (found == there.end()) {
            merged[i] = static_cast<std::uint32_t>(coarse.vertices.size());
            there.push_back(merged[i]);
            coarse.vertices.push_back(grid.nearest[grid.cells[i]]);
            normals.push_back(vertices[i].normal);
        } else {
            merged[i] = *found;
        }
    };
    for (const std::uint32_t i : grid.nearest) take(i);
    for (std::uint32_t i = 0; i < vertices.size(); ++i) take(i);
    return merged;
}

} // namespace

CoarseSurface coarseSurface(Vertices vertices, std::span<const std::uint32_t> parts,
                            std::span<const glm::uvec3> triangles, std::size_t wanted) {
    CoarseSurface coarse;
    if (static_cast<double>(triangles.size()) <= kWorthIt * static_cast<double>(wanted)) return coarse;
    const float cell = cellOf(vertices, triangles, wanted);
    if (!(cell > 0.0F)) return coarse;
    const Grid grid = gridOf(vertices, parts, cell);
    const std::vector<std::uint32_t> merged = merge(vertices, grid, coarse);
    for (const glm::uvec3& t : triangles) {
        const glm::uvec3 c(grid.cells[t.x], grid.cells[t.y], grid.cells[t.z]);
        if (c.x != c.y && c.y != c.z && c.z != c.x)
            coarse.triangles.emplace_back(merged[t.x], merged[t.y], merged[t.z]);
    }
    return coarse;
}

} // namespace lumorph

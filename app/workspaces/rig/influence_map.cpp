#include "app/workspaces/rig/influence_map.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph::studio {

namespace {

constexpr float kOpacity = 0.72F;
constexpr float kStill = 1e-6F; // metres
const Angle kCrease = Angle::degrees(40.0);

/// Metres that each vertex goes, at most, while the actuator alone goes through its stroke.
std::vector<float> waysOf(const Rig& rig, std::size_t actuator) {
    constexpr int kSteps = 4; // what turns may come back
    const auto vertices = rig.verticesOf(actuator);
    const Rig::Subset subset = rig.subset(vertices);
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    std::vector<glm::vec3> rest(vertices.size()), now(vertices.size());
    subset.deform(strokes, rest);
    std::vector<float> ways(rig.restMesh().positions.size(), 0.0F);
    for (int step = 1; step <= kSteps; ++step) {
        strokes[actuator] = static_cast<double>(step) / kSteps;
        subset.deform(strokes, now);
        for (std::size_t v = 0; v < now.size(); ++v)
            ways[vertices[v]] = std::max(ways[vertices[v]], glm::distance(now[v], rest[v]));
    }
    return ways;
}

} // namespace

InfluenceMap::InfluenceMap(const Rig& rig, std::size_t actuator) : shadings_(kBands) {
    const TriangleMesh& mesh = rig.restMesh();
    const std::vector<float> ways = waysOf(rig, actuator);
    const float farthest = ways.empty() ? 0.0F : std::ranges::max(ways);
    bands_.assign(mesh.triangles.size(), -1);
    std::vector<std::vector<glm::uvec3>> triangles(kBands);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& corners = mesh.triangles[t];
        const float way = (ways[corners.x] + ways[corners.y] + ways[corners.z]) / 3.0F;
        if (way <= kStill) continue;
        bands_[t] = std::clamp(static_cast<int>(way / farthest * kBands), 0, kBands - 1);
        triangles[static_cast<std::size_t>(bands_[t])].push_back(corners);
    }
    for (int b = 0; b < kBands; ++b) {
        if (triangles[b].empty()) continue;
        TriangleMesh band;
        band.positions = mesh.positions;
        band.triangles = std::move(triangles[b]);
        shadings_[b] = std::make_shared<const SurfaceShading>(band, kCrease);
    }
}

std::vector<ViewportSurface> InfluenceMap::surfaces(std::shared_ptr<const std::vector<glm::vec3>> positions,
                                                    const glm::vec3& low, const glm::vec3& high) const {
    std::vector<ViewportSurface> shown;
    for (int b = 0; b < kBands; ++b) {
        if (!shadings_[b] || !positions || positions->size() != shadings_[b]->meshVertexCount()) continue;
        ViewportSurface surface;
        surface.shading = shadings_[b];
        surface.positions = positions;
        surface.color = glm::mix(low, high, static_cast<float>(b) / (kBands - 1));
        surface.opacity = kOpacity;
        shown.push_back(std::move(surface));
    }
    return shown;
}

} // namespace lumorph::studio

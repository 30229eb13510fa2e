#include "app/workspaces/rig/surface_bands.h"

#include <algorithm>

namespace lumorph::studio {

namespace {

constexpr float kOpacity = 0.72F; ///< the surface's own shades stay visible
const Angle kCrease = Angle::degrees(40.0);

} // namespace

int SurfaceBands::bandOf(double value) { return std::clamp(static_cast<int>(value * kBands), 0, kBands - 1); }

SurfaceBands::SurfaceBands(const TriangleMesh& mesh, std::span<const int> bands) : shadings_(kBands) {
    std::vector<std::vector<glm::uvec3>> triangles(kBands);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (bands[t] >= 0) triangles[static_cast<std::size_t>(bands[t])].push_back(mesh.triangles[t]);
    for (std::size_t b = 0; b < kBands; ++b) {
        if (triangles[b].empty()) continue;
        TriangleMesh band;
        band.positions = mesh.positions;
        band.triangles = std::move(triangles[b]);
        shadings_[b] = std::make_shared<const SurfaceShading>(band, kCrease);
    }
}

std::vector<ViewportSurface> SurfaceBands::surfaces(const std::shared_ptr<const std::vector<glm::vec3>>& positions,
                                                    std::span<const glm::vec3> colors) const {
    std::vector<ViewportSurface> shown;
    for (std::size_t b = 0; b < kBands; ++b) {
        if (!shadings_[b] || !positions || positions->size() != shadings_[b]->meshVertexCount()) continue;
        ViewportSurface surface;
        surface.shading = shadings_[b];
        surface.positions = positions;
        surface.color = colors[b];
        surface.opacity = kOpacity;
        shown.push_back(std::move(surface));
    }
    return shown;
}

} // namespace lumorph::studio

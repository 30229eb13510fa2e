#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/render/viewport/viewport_scene.h"

namespace lumorph::studio {

/// A scale of a few colours over a surface, by triangle, however its vertices move.
class SurfaceBands {
public:
    static constexpr int kBands = 8;

    /// The band in [0, kBands) that a value in [0, 1] belongs to.
    [[nodiscard]] static int bandOf(double value);

    /// `bands`: one a triangle of the mesh; -1: it keeps its own colour.
    SurfaceBands(const TriangleMesh& mesh, std::span<const int> bands);

    /// What to draw over a surface whose vertices are there now, in `colors`, one a band. Nothing for the vertices of
    /// another mesh.
    [[nodiscard]] std::vector<ViewportSurface> surfaces(const std::shared_ptr<const std::vector<glm::vec3>>& positions,
                                                        std::span<const glm::vec3> colors) const;

private:
    std::vector<std::shared_ptr<const SurfaceShading>> shadings_; ///< one a band; null: it is empty
};

} // namespace lumorph::studio

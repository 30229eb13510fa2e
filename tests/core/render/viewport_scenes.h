#pragma once

#include <cmath>

#include <glm/geometric.hpp>

#include "core/render/frame_target.h"
#include "core/render/viewport_renderer.h"
#include "tests/core/render/shapes.h"

namespace lumorph {

inline ViewportSurface surfaceOf(const TriangleMesh& mesh, const glm::vec3& color, std::uint32_t id = 1) {
    ViewportSurface surface;
    surface.id = id;
    surface.shading = std::make_shared<const SurfaceShading>(mesh, Angle::degrees(35.0));
    surface.positions = std::make_shared<const std::vector<glm::vec3>>(mesh.positions);
    surface.color = color;
    return surface;
}

/// A sphere around the origin.
inline TriangleMesh sphereMesh(float radius, int n) {
    TriangleMesh mesh = boxMesh(glm::vec3(-1.0F), glm::vec3(1.0F));
    for (int i = 0; i < n; ++i) {
        TriangleMesh finer;
        for (const glm::uvec3& t : mesh.triangles) {
            const auto k = static_cast<unsigned>(finer.positions.size());
            const glm::vec3 a = mesh.positions[t.x];
            const glm::vec3 b = mesh.positions[t.y];
            const glm::vec3 c = mesh.positions[t.z];
            finer.positions.insert(finer.positions.end(), {a, b, c, 0.5F * (a + b), 0.5F * (b + c), 0.5F * (c + a)});
            for (const glm::uvec3& s : {glm::uvec3(0, 3, 5), {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
                finer.triangles.push_back(s + k);
        }
        mesh = finer;
    }
    for (glm::vec3& p : mesh.positions) p = radius * glm::normalize(p);
    return mesh;
}

inline Image draw(ViewportRenderer& renderer, const ViewportScene& scene, const ViewCamera& camera, glm::ivec2 size,
                  ViewportQuality quality, float scale = 1.0F) {
    const FrameTarget target(size, 0);
    (void)renderer.draw(target.framebuffer(), size, scene, camera, quality, scale);
    return target.read();
}

/// How far two colours are apart, 0 to 255.
inline int apart(const Image::Pixel& a, const Image::Pixel& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

} // namespace lumorph

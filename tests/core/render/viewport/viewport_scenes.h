#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/render/gl/frame_target.h"
#include "core/render/viewport/viewport_renderer.h"
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

inline const glm::ivec2 kSize(400, 320);
inline constexpr std::array kBoth{ViewportQuality::moving, ViewportQuality::still};

inline ViewCamera cameraAt(double distance, double yaw = 20.0, double pitch = 30.0) {
    ViewCamera camera;
    camera.yaw = Angle::degrees(yaw);
    camera.pitch = Angle::degrees(pitch);
    camera.distance = distance;
    return camera;
}

inline ViewportScene sphereScene(const glm::vec3& color = {0.9F, 0.2F, 0.2F}) {
    ViewportScene scene;
    scene.surfaces = {surfaceOf(sphereMesh(0.05F, 5), color)};
    scene.bounds = {glm::vec3(-0.05F), glm::vec3(0.05F)};
    scene.groundHeight = -0.06F;
    scene.grid = false;
    return scene;
}

inline glm::ivec2 at(const ViewCamera& camera, const glm::vec3& point) {
    return {pixelOf(camera, point, glm::vec2(kSize)).value()};
}

inline int grey(const Image::Pixel& p) { return (p[0] + p[1] + p[2]) / 3; }
inline bool reddish(const Image::Pixel& p) { return p[0] > 1.6 * p[1] && p[0] > 1.6 * p[2]; }

/// How far two colours are apart, 0 to 255.
inline int apart(const Image::Pixel& a, const Image::Pixel& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

} // namespace lumorph

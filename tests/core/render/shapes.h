#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

inline TriangleMesh boxMesh(const glm::vec3& low, const glm::vec3& high) {
    TriangleMesh mesh;
    for (unsigned i = 0; i < 8; ++i)
        mesh.positions.push_back({i & 1U ? high.x : low.x, i & 2U ? high.y : low.y, i & 4U ? high.z : low.z});
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
}

/// A ring around +Y that stands on y = 0; n segments around and n / 2 across.
inline TriangleMesh torusMesh(float radius, float tube, int n) {
    TriangleMesh mesh;
    const int m = n / 2;
    const float turn = 2.0F * std::numbers::pi_v<float>;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            const float a = turn * static_cast<float>(i) / static_cast<float>(n);
            const float b = turn * static_cast<float>(j) / static_cast<float>(m);
            const float r = radius + tube * std::cos(b);
            mesh.positions.push_back({r * std::cos(a), tube + tube * std::sin(b), r * std::sin(a)});
        }
    const auto at = [&](int i, int j) { return static_cast<unsigned>((i % n) * m + j % m); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    return mesh;
}

/// A closed slab over [-half.x, half.x] x [-half.y, half.y] whose top is height(x, z), bottom y = 0.
inline TriangleMesh reliefMesh(const glm::vec2& half, int n, const std::function<float(float, float)>& height) {
    TriangleMesh mesh;
    const auto add = [&](bool top) {
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j) {
                const float x = half.x * (2.0F * static_cast<float>(i) / static_cast<float>(n) - 1.0F);
                const float z = half.y * (2.0F * static_cast<float>(j) / static_cast<float>(n) - 1.0F);
                mesh.positions.push_back({x, top ? height(x, z) : 0.0F, z});
            }
    };
    add(true);
    add(false);
    const auto top = [&](int i, int j) { return static_cast<unsigned>(i * (n + 1) + j); };
    const auto low = [&](int i, int j) { return top(i, j) + static_cast<unsigned>((n + 1) * (n + 1)); };
    const auto quad = [&](unsigned a, unsigned b, unsigned c, unsigned d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            quad(top(i, j), top(i, j + 1), top(i + 1, j + 1), top(i + 1, j));
            quad(low(i, j), low(i + 1, j), low(i + 1, j + 1), low(i, j + 1));
        }
    for (int i = 0; i < n; ++i) {
        quad(top(i, 0), top(i + 1, 0), low(i + 1, 0), low(i, 0));
        quad(top(i + 1, n), top(i, n), low(i, n), low(i + 1, n));
        quad(top(0, i + 1), top(0, i), low(0, i), low(0, i + 1));
        quad(top(n, i), top(n, i + 1), low(n, i + 1), low(n, i));
    }
    return mesh;
}

} // namespace lumorph

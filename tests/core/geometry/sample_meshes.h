#pragma once

#include <cmath>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// An axis-parallel cube that looks outwards: 8 vertices, 12 triangles.
inline TriangleMesh cubeAt(const glm::vec3& min, float size) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) mesh.positions.push_back(min + size * glm::vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1));
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

inline TriangleMesh turned(TriangleMesh mesh) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    return mesh;
}

inline TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
    append(a, b);
    return a;
}

/// The same triangles, each with three vertices of its own.
inline TriangleMesh shattered(const TriangleMesh& mesh) {
    TriangleMesh out;
    for (const glm::uvec3& t : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(out.positions.size());
        for (int k = 0; k < 3; ++k) out.positions.push_back(mesh.positions[t[k]]);
        out.triangles.emplace_back(first, first + 1, first + 2);
    }
    return out;
}

/// A closed torus of `2 * around * across` triangles.
inline TriangleMesh torus(std::uint32_t around, std::uint32_t across) {
    TriangleMesh mesh;
    constexpr double kTurn = 6.283185307179586;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const double a = kTurn * i / around;
            const double b = kTurn * j / across;
            const double r = 1.0 + 0.4 * std::cos(b);
            mesh.positions.emplace_back(r * std::cos(a), 0.4 * std::sin(b), -r * std::sin(a));
        }
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const std::uint32_t p = i * across + j;
            const std::uint32_t q = (i + 1) % around * across + j;
            const std::uint32_t r = (i + 1) % around * across + (j + 1) % across;
            const std::uint32_t s = i * across + (j + 1) % across;
            mesh.triangles.emplace_back(p, q, r);
            mesh.triangles.emplace_back(p, r, s);
        }
    return mesh;
}

} // namespace lumorph

#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "core/rig/sheet/sheet_mesh.h"

namespace lumorph {

/// A rectangle [0, length] x [0, width] of about square cells, each cut along a diagonal; nodes inside are shifted at
/// random by up to `shift` of a cell.
inline SheetMesh stripMesh(double length, double width, double edgeLength, double shift = 0.25) {
    const int columns = static_cast<int>(std::lround(length / edgeLength));
    const int rows = static_cast<int>(std::lround(width / edgeLength));
    std::mt19937 random(7);
    const auto shifted = [&] { return shift * edgeLength * (2.0 * random() / 4294967295.0 - 1.0); };
    std::vector<glm::dvec2> points;
    std::vector<glm::uvec3> triangles;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            points.emplace_back(length * i / columns, width * j / rows);
            if (i > 0 && j > 0 && i < columns && j < rows) points.back() += glm::dvec2(shifted(), shifted());
        }
    const auto node = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const std::uint32_t a = node(i, j);
            const std::uint32_t b = node(i + 1, j);
            const std::uint32_t c = node(i, j + 1);
            const std::uint32_t d = node(i + 1, j + 1);
            if ((i + j) % 2 == 0) {
                triangles.emplace_back(a, c, b);
                triangles.emplace_back(b, c, d);
            } else {
                triangles.emplace_back(a, d, b);
                triangles.emplace_back(a, c, d);
            }
        }
    return sheetMesh(std::move(points), std::move(triangles));
}

} // namespace lumorph

#include "core/render/eye/table_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {
namespace {

constexpr int kMostCells = 256;          // a side
constexpr double kStraightEnough = 0.02; // pixels

struct Rectangle {
    glm::dvec2 low;
    glm::dvec2 high;
};

// What of the table lies in the image; all of it where the image's border does not meet the table's plane.
Rectangle seenRectangle(const CalibratedCamera& camera, const glm::dvec2& half) {
    constexpr int kSteps = 16;
    const Rectangle all{-half, half};
    const glm::dvec3 from = positionOf(camera);
    glm::dvec2 low(1e9);
    glm::dvec2 high(-1e9);
    for (int i = 0; i < 4 * kSteps; ++i) {
        const double along = static_cast<double>(i % kSteps) / kSteps;
        const std::array<glm::dvec2, 4> sides{{{along, 0.0}, {1.0, along}, {1.0 - along, 1.0}, {0.0, 1.0 - along}}};
        const glm::dvec2 pixel = sides[static_cast<std::size_t>(i / kSteps)] * glm::dvec2(camera.size) - 0.5;
        const glm::dvec3 direction = directionOf(camera, pixel);
        const double way = -from.y / direction.y;
        if (!(way > 0.0) || !(way < 1e3)) return all;
        const glm::dvec3 at = from + way * direction;
        low = glm::min(low, glm::dvec2(at.x, at.z));
        high = glm::max(high, glm::dvec2(at.x, at.z));
    }
    const glm::dvec2 room = 0.02 * (high - low);
    low = glm::clamp(low - room, -half, half);
    high = glm::clamp(high + room, -half, half);
    return low.x < high.x && low.y < high.y ? Rectangle{low, high} : all;
}

// How far, in pixels, the middle of an edge is drawn from where it belongs.
double bendOf(const CalibratedCamera& camera, const glm::dvec2& from, const glm::dvec2& to) {
    const auto place = [](const glm::dvec2& at) { return glm::dvec3(at.x, 0.0, at.y); };
    const glm::dvec2 middle = 0.5 * (from + to);
    const auto start = pixelOf(camera, place(from));
    const auto end = pixelOf(camera, place(to));
    const auto expected = pixelOf(camera, place(middle));
    if (!start || !end || !expected) return 0.0;
    const double startDepth = (camera.cameraFromWorld * glm::dvec4(place(from), 1.0)).z;
    const double endDepth = (camera.cameraFromWorld * glm::dvec4(place(to), 1.0)).z;
    const glm::dvec2 drawn = (startDepth * *start + endDepth * *end) / (startDepth + endDepth);
    return glm::distance(drawn, *expected);
}

int cellsFor(const CalibratedCamera& camera, const Rectangle& area) {
    constexpr int kLeastCells = 4;
    if (camera.distortion == std::array<double, 5>{}) return kLeastCells;
    constexpr int kProbes = 6;
    int cells = kLeastCells;
    for (; cells < kMostCells; cells *= 2) {
        const glm::dvec2 cell = (area.high - area.low) / static_cast<double>(cells);
        double worst = 0.0;
        for (int i = 0; i <= kProbes; ++i)
            for (int j = 0; j <= kProbes; ++j) {
                const glm::dvec2 at = area.low + (area.high - area.low - cell) * glm::dvec2(i, j) / double{kProbes};
                worst = std::max(worst, bendOf(camera, at, at + cell));
            }
        if (worst < kStraightEnough) break;
    }
    return cells;
}

} // namespace

void TableGrid::fit(const CalibratedCamera& camera, glm::vec2 size) {
    if (camera_ == camera && size_ == size) return;
    camera_ = camera;
    size_ = size;
    const glm::dvec2 half = 0.5 * glm::dvec2(size);
    const Rectangle area = seenRectangle(camera, half);
    const int cells = cellsFor(camera, area);
    std::vector<glm::vec3> vertices;
    std::vector<glm::uvec3> triangles;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i) {
            const glm::dvec2 at = area.low + (area.high - area.low) * glm::dvec2(i, j) / static_cast<double>(cells);
            vertices.emplace_back(at.x, 0.0, at.y);
            if (i == cells || j == cells) continue;
            const auto corner = static_cast<unsigned>(j * (cells + 1) + i);
            const auto below = corner + static_cast<unsigned>(cells) + 1;
            triangles.emplace_back(corner, below, corner + 1);
            triangles.emplace_back(corner + 1, below, below + 1);
        }
    count_ = static_cast<GLsizei>(3 * triangles.size());
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(glm::vec3)), vertices.data(),
                 GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * sizeof(glm::uvec3)),
                 triangles.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    glBindVertexArray(0);
}

void TableGrid::draw() const {
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

} // namespace lumorph

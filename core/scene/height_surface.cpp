#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/scene/height_formula.h"
#include "core/scene/item_surfaces.h"

namespace lumorph {
namespace {

constexpr float kQuadSide = 0.0016F; ///< metres; the tablet gets 131 x 94 quads
constexpr int kMostQuads = 132;
constexpr int kFewestQuads = 8;

int quadsAlong(float side) {
    return std::clamp(static_cast<int>(std::lround(side / kQuadSide)), kFewestQuads, kMostQuads);
}

std::vector<float> steps(float side, int quads) {
    std::vector<float> at(static_cast<std::size_t>(quads) + 1);
    for (int i = 0; i <= quads; ++i)
        at[static_cast<std::size_t>(i)] = side * (static_cast<float>(i) / static_cast<float>(quads) - 0.5F);
    return at;
}

/// One wave along the grid's columns or rows: sin and cos of the phase there. A wave over the whole grid is then two
/// products a point (the sine of a sum), not a sine.
struct Line {
    std::vector<float> sine, cosine;
    Line(const std::vector<float>& at, double perMetre, double phase) : sine(at.size()), cosine(at.size()) {
        for (std::size_t i = 0; i < at.size(); ++i) {
            const double angle = perMetre * static_cast<double>(at[i]) + phase;
            sine[i] = static_cast<float>(std::sin(angle));
            cosine[i] = static_cast<float>(std::cos(angle));
        }
    }
};

} // namespace

HeightSurface::HeightSurface(const HeightItem& item, std::shared_ptr<const Image> image)
    : item_(item), image_(std::move(image)), quads_(quadsAlong(item.size.x), quadsAlong(item.size.y)),
      xs_(steps(item.size.x, quads_.x)), zs_(steps(item.size.y, quads_.y)) {
    setWaves(item.waves);
    for (const float z : zs_) {
        for (const float x : xs_) {
            if (item.calmEdge > 0.0) calm_.push_back(calmness(item, {x, z}));
            if (image_) pictured_.push_back(pictureHeight(item, *image_, {x, z}));
        }
    }
    SurfaceTopology topology;
    addTop(topology);
    addWalls(topology);
    topology_ = std::make_shared<const SurfaceTopology>(std::move(topology));
}

void HeightSurface::setWaves(const std::vector<Wave>& waves) {
    item_.waves = waves;
    still_ = std::ranges::none_of(waves, [](const Wave& w) { return w.period > 0.0 && w.amplitude != 0.0; });
}

void HeightSurface::addTop(SurfaceTopology& topology) const {
    for (const float z : zs_)
        for (const float x : xs_) topology.coordinates.emplace_back(x, z);
    for (int row = 0; row < quads_.y; ++row) {
        for (int column = 0; column < quads_.x; ++column) {
            const auto a = static_cast<std::uint32_t>(index(column, row));
            const auto below = static_cast<std::uint32_t>(index(column, row + 1));
            topology.triangles.emplace_back(a, below, below + 1);
            topology.triangles.emplace_back(a, below + 1, a + 1);
        }
    }
}

void HeightSurface::addWalls(SurfaceTopology& topology) {
    std::vector<std::uint32_t> rim;
    const auto addWall = [&](const glm::vec3& normal, glm::vec2 along) {
        const auto first = static_cast<std::uint32_t>(topology.coordinates.size());
        for (const std::uint32_t point : rim) {
            const glm::vec2 at = topology.coordinates[point];
            for (const bool foot : {false, true}) {
                walls_.push_back({point, foot, normal});
                topology.coordinates.emplace_back(glm::dot(at, along), foot ? static_cast<float>(-item_.floor) : 0.0F);
            }
        }
        for (std::uint32_t i = 0; i + 1 < rim.size(); ++i) {
            const std::uint32_t top = first + 2 * i;
            topology.triangles.emplace_back(top, top + 1, top + 3);
            topology.triangles.emplace_back(top, top + 3, top + 2);
        }
        rim.clear();
    };
    // Counter-clockwise seen from above, so that each wall looks outwards.
    for (int i = 0; i <= quads_.x; ++i) rim.push_back(static_cast<std::uint32_t>(index(i, quads_.y)));
    addWall({0.0F, 0.0F, 1.0F}, {1.0F, 0.0F});
    for (int i = quads_.y; i >= 0; --i) rim.push_back(static_cast<std::uint32_t>(index(quads_.x, i)));
    addWall({1.0F, 0.0F, 0.0F}, {0.0F, -1.0F});
    for (int i = quads_.x; i >= 0; --i) rim.push_back(static_cast<std::uint32_t>(index(i, 0)));
    addWall({0.0F, 0.0F, -1.0F}, {-1.0F, 0.0F});
    for (int i = 0; i <= quads_.y; ++i) rim.push_back(static_cast<std::uint32_t>(index(0, i)));
    addWall({-1.0F, 0.0F, 0.0F}, {0.0F, 1.0F});
}

void HeightSurface::computeHeights(double seconds, std::vector<float>& heights) const {
    heights.assign(xs_.size() * zs_.size(), 0.0F);
    for (const Wave& wave : item_.waves) {
        const WaveNumbers numbers = waveNumbers(wave, seconds);
        const Line x(xs_, numbers.x, numbers.phase);
        const Line z(zs_, numbers.z, 0.0);
        const auto amplitude = static_cast<float>(wave.amplitude);
        for (std::size_t row = 0; row < zs_.size(); ++row) {
            const float sine = amplitude * z.sine[row];
            const float cosine = amplitude * z.cosine[row];
            float* out = heights.data() + row * xs_.size();
            for (std::size_t i = 0; i < xs_.size(); ++i) out[i] += x.sine[i] * cosine + x.cosine[i] * sine;
        }
    }
    for (std::size_t i = 0; i < calm_.size(); ++i) heights[i] *= calm_[i];
    for (std::size_t i = 0; i < pictured_.size(); ++i) heights[i] += pictured_[i];
}

ItemSurface HeightSurface::at(double seconds) const {
    std::vector<float> heights;
    computeHeights(seconds, heights);
    auto positions = std::make_shared<std::vector<glm::vec3>>();
    auto normals = std::make_shared<std::vector<glm::vec3>>();
    positions->reserve(topology_->coordinates.size());
    normals->reserve(topology_->coordinates.size());
    const int lastColumn = quads_.x;
    const int lastRow = quads_.y;
    for (int row = 0; row <= lastRow; ++row) {
        const int above = std::max(row - 1, 0);
        const int below = std::min(row + 1, lastRow);
        const float z = zs_[static_cast<std::size_t>(row)];
        const float dz = zs_[static_cast<std::size_t>(below)] - zs_[static_cast<std::size_t>(above)];
        for (int column = 0; column <= lastColumn; ++column) {
            const int left = std::max(column - 1, 0);
            const int right = std::min(column + 1, lastColumn);
            const float x = xs_[static_cast<std::size_t>(column)];
            const float dx = xs_[static_cast<std::size_t>(right)] - xs_[static_cast<std::size_t>(left)];
            const float slopeX = (heights[index(right, row)] - heights[index(left, row)]) / dx;
            const float slopeZ = (heights[index(column, below)] - heights[index(column, above)]) / dz;
            positions->emplace_back(x, heights[index(column, row)], z);
            normals->push_back(glm::normalize(glm::vec3(-slopeX, 1.0F, -slopeZ)));
        }
    }
    for (const WallVertex& vertex : walls_) {
        glm::vec3 position = (*positions)[vertex.point];
        // Where the surface dips below the floor its wall has no height.
        if (vertex.foot) position.y = std::min(position.y, static_cast<float>(item_.floor));
        positions->push_back(position);
        normals->push_back(vertex.normal);
    }
    return {topology_, std::move(positions), std::move(normals)};
}

} // namespace lumorph

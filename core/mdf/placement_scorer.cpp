#include "core/mdf/placement_scorer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kClosedCells = 96; ///< along each side
constexpr int kOpenCells = 56;   ///< along the longest side: winding numbers take long
constexpr std::size_t kCoarseVoxels = 14'000;
constexpr int kCoarseLevels = 13;

/// A frame of the same room with few voxels, or the frame itself where it has no more.
VoxelFrame coarseFrame(const VoxelFrame& fine) {
    const double ratio = static_cast<double>(fine.voxelCount()) / static_cast<double>(kCoarseVoxels);
    if (ratio <= 1.0) return fine;
    VoxelFrame frame = fine;
    frame.voxelSize = fine.voxelSize * std::cbrt(ratio);
    for (int axis = 0; axis < 3; ++axis)
        frame.dimensions[axis] =
            std::max(1, static_cast<int>(std::ceil(fine.dimensions[axis] * fine.voxelSize / frame.voxelSize - 0.25)));
    return frame;
}

/// Points on the unit sphere, spread evenly.
glm::vec3 onSphere(int index, int count) {
    const double y = 1.0 - (2.0 * index + 1.0) / count;
    const double r = std::sqrt(1.0 - y * y);
    const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0)) * index; // the golden angle
    return {r * std::cos(turn), y, r * std::sin(turn)};
}

} // namespace

TargetGrid::TargetGrid(const Target& target, const Progress& progress) : box_(boundingBox(target.mesh.positions)) {
    const glm::vec3 size = box_.size();
    const float longest = std::max({size.x, size.y, size.z});
    const auto none = [] {
        return InvalidInput("target", "it is thinner than a voxel or has no volume",
                            "give a solid target, or build the field with a higher resolution");
    };
    if (!(std::min({size.x, size.y, size.z}) > 0.0F) || !std::isfinite(longest)) throw none();
    // A closed target is stretched to a cube, so that a flat one has as many cells across; an angle, of which winding
    // numbers are made, would not survive that.
    const glm::vec3 cellsPerMetre = target.closed ? glm::vec3(static_cast<float>(kClosedCells)) / size
                                                  : glm::vec3(static_cast<float>(kOpenCells) / longest);
    VoxelFrame frame{glm::vec3(0.0F), 1.0,
                     glm::max(glm::ivec3(1), glm::ivec3(glm::ceil(size * cellsPerMetre - 1e-3F)))};
    Target stretched{{{}, target.mesh.triangles}, target.closed, {}};
    stretched.mesh.positions.reserve(target.mesh.positions.size());
    for (const glm::vec3& p : target.mesh.positions) stretched.mesh.positions.push_back((p - box_.min) * cellsPerMetre);
    SolidVoxelizer voxelizer;
    BitColumns bits;
    voxelizeTarget(frame, stretched, voxelizer, bits, progress);
    const std::size_t count = bits.count();
    if (count == 0) throw none();
    cellsPerMetre_ = cellsPerMetre;
    cells_ = frame.dimensions + 2 * kPadding;
    inside_.resize(static_cast<std::size_t>(cells_.x) * static_cast<std::size_t>(cells_.y) *
                   static_cast<std::size_t>(cells_.z));
    constexpr std::size_t kSamples = 1000;
    const std::size_t stride = std::max<std::size_t>(1, count / kSamples);
    std::size_t seen = 0;
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int x = 0; x < frame.dimensions.x; ++x)
            for (int y = 0; y < frame.dimensions.y; ++y) {
                if (!bits.test(x, y, z)) continue;
                inside_[(static_cast<std::size_t>(y + kPadding) * static_cast<std::size_t>(cells_.z) +
                         static_cast<std::size_t>(z + kPadding)) *
                            static_cast<std::size_t>(cells_.x) +
                        static_cast<std::size_t>(x + kPadding)] = 1;
                if (seen++ % stride == 0) samples_.push_back(box_.min + (glm::vec3(x, y, z) + 0.5F) / cellsPerMetre);
            }
    const glm::dvec3 cell = 1.0 / glm::dvec3(cellsPerMetre);
    volume_ = static_cast<double>(count) * cell.x * cell.y * cell.z;
    findHull(target.mesh.positions);
}

void TargetGrid::findHull(std::span<const glm::vec3> positions) {
    constexpr int kDirections = 120;
    constexpr std::size_t kMostPoints = 60'000;
    const std::size_t stride = std::max<std::size_t>(1, positions.size() / kMostPoints);
    for (int k = 0; k < kDirections; ++k) {
        const glm::vec3 direction = onSphere(k, kDirections);
        float farthest = -INFINITY;
        glm::vec3 corner(0.0F);
        for (std::size_t i = 0; i < positions.size(); i += stride) {
            const float reach = glm::dot(direction, positions[i]);
            if (!(reach > farthest)) continue;
            farthest = reach;
            corner = positions[i];
        }
        if (std::ranges::find(hull_, corner) == hull_.end()) hull_.push_back(corner);
    }
}

void TargetGrid::lookUp(const VoxelFrame& frame, const glm::mat4& deviceFromTarget, BitColumns& out) const {
    if (out.dimensions() != frame.dimensions)
        out = BitColumns(frame.dimensions);
    else
        out.clear();
    const Box placed = boundingBox(cornersOf(box_, deviceFromTarget));
    const auto voxel = static_cast<float>(frame.voxelSize);
    glm::ivec3 low, high; // of voxels that can be inside
    for (int axis = 0; axis < 3; ++axis) {
        const float from = (placed.min[axis] - frame.origin[axis]) / voxel - 0.5F;
        const float to = (placed.max[axis] - frame.origin[axis]) / voxel - 0.5F;
        low[axis] = static_cast<int>(std::ceil(std::clamp(from, 0.0F, 1e6F)));
        high[axis] = std::min(static_cast<int>(std::floor(std::clamp(to, -1.0F, 1e6F))), frame.dimensions[axis] - 1);
    }
    const glm::mat4 targetFromDevice = glm::inverse(deviceFromTarget);
    const auto padding = static_cast<float>(kPadding);
    const auto cellOf = [&](const glm::vec3& device) {
        return (glm::vec3(targetFromDevice * glm::vec4(device, 1.0F)) - box_.min) * cellsPerMetre_ + padding;
    };
    const glm::vec3 step = glm::vec3(targetFromDevice[1]) * voxel * cellsPerMetre_; // a voxel up
    const auto width = static_cast<std::size_t>(cells_.x);
    const std::size_t layer = width * static_cast<std::size_t>(cells_.z);
    const auto words = static_cast<std::size_t>(out.wordsPerColumn());
    for (int z = low.z; z <= high.z; ++z)
        for (int x = low.x; x <= high.x; ++x) {
            const glm::vec3 foot = cellOf(glm::vec3(frame.centre(x, 0, z)));
            // The part of the column within the grid: an interval along each axis.
            float from = static_cast<float>(low.y), to = static_cast<float>(high.y);
            for (int axis = 0; axis < 3; ++axis) {
                const auto end = static_cast<float>(cells_[axis]) - padding;
                if (std::abs(step[axis]) < 1e-9F) {
                    if (foot[axis] < padding || foot[axis] >= end) to = -1.0F;
                    continue;
                }
                const float a = (padding - foot[axis]) / step[axis];
                const float b = (end - foot[axis]) / step[axis];
                from = std::max(from, std::min(a, b));
                to = std::min(to, std::max(a, b));
            }
            if (!(from <= to)) continue;
            const int first = static_cast<int>(std::ceil(from)), last = static_cast<int>(std::floor(to));
            std::uint64_t* const column = &out.words()[out.columnIndex(x, z) * words];
            for (int y = first; y <= last; ++y) {
                const glm::vec3 at = foot + static_cast<float>(y) * step; // within half a cell of the padding at most
                const std::size_t cell = static_cast<std::size_t>(at.y) * layer +
                                         static_cast<std::size_t>(at.z) * width + static_cast<std::size_t>(at.x);
                const auto bit = static_cast<unsigned>(y);
                column[bit >> 6U] |= static_cast<std::uint64_t>(inside_[cell]) << (bit & 63U);
            }
        }
}

PlacementScorer::PlacementScorer(const Coverage& coverage, const Progress& progress)
    : coverage_(coverage.rig(), coarseFrame(coverage.frame()), std::min(coverage.levels(), kCoarseLevels)) {
    actuators_.resize(coverage.rig().actuatorCount());
    tbb::parallel_for(std::size_t{0}, actuators_.size(), [&](std::size_t a) {
        progress.throwIfCancelled();
        actuators_[a] = levelsOf(coverage_, a);
    });
    findReaches();
}

void PlacementScorer::findReaches() {
    constexpr std::size_t kMost = 12;
    struct Reach {
        int count = 0;
        Box box;
    };
    std::vector<Reach> reaches;
    const VoxelFrame& frame = coverage_.frame();
    const auto words = static_cast<std::size_t>(coverage_.body().wordsPerColumn());
    Reach all;
    for (const ActuatorLevels& levels : actuators_) {
        if (levels.words.empty()) continue;
        Reach reach;
        std::vector<std::uint64_t> any(levels.words.front().size());
        for (const std::vector<std::uint64_t>& covered : levels.words)
            for (std::size_t i = 0; i < any.size(); ++i) any[i] |= covered[i];
        const auto width = static_cast<std::size_t>(levels.range.width());
        glm::ivec3 low = frame.dimensions;
        glm::ivec3 high(-1);
        for (std::size_t i = 0; i < any.size(); ++i) {
            if (any[i] == 0) continue;
            const std::size_t column = i / words;
            const int base = static_cast<int>(i % words) * 64;
            const glm::ivec3 lowest(levels.range.x0 + static_cast<int>(column % width), base + std::countr_zero(any[i]),
                                    levels.range.z0 + static_cast<int>(column / width));
            const glm::ivec3 highest(lowest.x, base + 63 - std::countl_zero(any[i]), lowest.z);
            low = glm::min(low, lowest);
            high = glm::max(high, highest);
            reach.count += std::popcount(any[i]);
        }
        if (reach.count == 0) continue;
        const auto size = static_cast<float>(frame.voxelSize);
        reach.box = {frame.origin + size * glm::vec3(low), frame.origin + size * glm::vec3(high + 1)};
        all.box.include(reach.box);
        reaches.push_back(reach);
    }
    std::ranges::stable_sort(reaches, [](const Reach& a, const Reach& b) { return a.count > b.count; });
    if (!all.box.empty()) reaches_.push_back(all.box);
    const auto alike = [](const Box& a, const Box& b) {
        const float near = 0.15F * glm::length(a.size());
        return glm::distance(a.min, b.min) < near && glm::distance(a.max, b.max) < near;
    };
    for (const Reach& reach : reaches)
        if (reaches_.size() <= kMost &&
            std::ranges::none_of(reaches_, [&](const Box& other) { return alike(other, reach.box); }))
            reaches_.push_back(reach.box);
}

double PlacementScorer::score(const TargetGrid& target, const glm::mat4& deviceFromTarget, Workspace& workspace) const {
    target.lookUp(coverage_.frame(), deviceFromTarget, workspace.wanted);
    workspace.wanted &= coverage_.domain();
    const auto wanted = static_cast<int>(workspace.wanted.count());
    if (wanted == 0) return 0.0;
    workspace.gains.resize(actuators_.size());
    for (std::size_t a = 0; a < actuators_.size(); ++a) countGains(actuators_[a], workspace.wanted, workspace.gains[a]);
    return std::clamp(bestBySums(workspace.gains, 0, 0, wanted).iou, 0.0, 1.0); // at rest nothing is covered
}

} // namespace lumorph

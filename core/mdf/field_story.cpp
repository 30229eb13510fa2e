#include "core/mdf/field_story.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/mdf/field_view.h"
#include "core/mdf/refine.h"

namespace lumorph {

namespace {

constexpr Microseconds kRefineSlice{40'000}; ///< between two looks at whether the user still wants it

/// The axis along which a plane runs.
int acrossOf(const VoxelPlane& plane) noexcept { return plane.axis == 0 ? 2 : 0; }

/// The upright plane across one of some axes that holds the most of these voxels; of a run of equals its middle.
VoxelPlane fullestOf(const BitColumns& voxels, std::span<const int> axes) {
    const glm::ivec3 size = voxels.dimensions();
    std::array<std::vector<std::size_t>, 3> counts;
    for (const int axis : {0, 2}) counts[static_cast<std::size_t>(axis)].resize(static_cast<std::size_t>(size[axis]));
    const auto words = static_cast<std::size_t>(voxels.wordsPerColumn());
    for (int z = 0; z < size.z; ++z)
        for (int x = 0; x < size.x; ++x) {
            const std::size_t count = countBits(voxels.words().subspan(voxels.columnIndex(x, z) * words, words));
            counts[0][static_cast<std::size_t>(x)] += count;
            counts[2][static_cast<std::size_t>(z)] += count;
        }
    VoxelPlane best{2, size.z / 2};
    std::size_t most = 0;
    for (const int axis : axes) {
        const std::vector<std::size_t>& own = counts[static_cast<std::size_t>(axis)];
        const auto first = std::ranges::max_element(own);
        if (*first <= most) continue;
        const auto last = std::find_if(first, own.end(), [&](std::size_t count) { return count != *first; });
        best = {axis, static_cast<int>((first - own.begin()) + (last - first - 1) / 2)};
        most = *first;
    }
    return best;
}

/// The axes along which an actuator moves least: both where it moves along both alike, or only upwards.
std::vector<int> axesOfLeastMotion(const Rig& rig, std::size_t actuator) {
    constexpr double kAlike = 0.8;
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    strokes[actuator] = 1.0;
    const auto vertices = rig.verticesOf(actuator);
    std::vector<glm::vec3> moved(vertices.size()), rest(vertices.size());
    rig.deform(strokes, vertices, moved);
    strokes[actuator] = 0.0;
    rig.deform(strokes, vertices, rest);
    glm::dvec3 motion(0.0);
    for (std::size_t v = 0; v < moved.size(); ++v) motion += glm::abs(glm::dvec3(moved[v] - rest[v]));
    const double least = std::min(motion.x, motion.z), other = std::max(motion.x, motion.z);
    if (least >= kAlike * other || other < 0.05 * motion.y) return {2, 0};
    return {motion.x < motion.z ? 0 : 2};
}

/// All voxels that single actuators reach.
BitColumns reachedAlone(const Coverage& coverage, const Progress& progress) {
    const std::size_t actuators = coverage.rig().actuatorCount();
    BitColumns alone(coverage.frame().dimensions), covered(coverage.frame().dimensions);
    CoverageScratch scratch;
    State state(actuators);
    for (std::size_t a = 0; a < actuators; ++a) {
        for (int level = 1; level < coverage.levels(); ++level) {
            progress.throwIfCancelled();
            state[a] = Level{level};
            coverage.covered(state, covered, scratch);
            alone |= covered;
        }
        state[a] = Level{0};
        progress.report(static_cast<double>(a + 1) / static_cast<double>(actuators), "each actuator alone");
    }
    return alone;
}

/// What two actuators reach in the columns that both change, over all their levels, and `alone` does not.
BitColumns reachedByPair(const Coverage& coverage, std::pair<std::size_t, std::size_t> pair, const BitColumns& alone,
                         const Progress& progress) {
    BitColumns together(coverage.frame().dimensions);
    const ColumnRange range = coverage.columnsMovedBy(pair.first).intersect(coverage.columnsMovedBy(pair.second));
    if (range.empty()) return together;
    const auto words = static_cast<std::size_t>(together.wordsPerColumn());
    const Coverage::Window window = coverage.window(range);
    std::vector<std::uint64_t> covered(range.size() * words), all(range.size() * words, 0);
    CoverageScratch scratch;
    State state(coverage.rig().actuatorCount());
    for (int first = 1; first < coverage.levels(); ++first) {
        progress.throwIfCancelled();
        state[pair.first] = Level{first};
        for (int second = 1; second < coverage.levels(); ++second) {
            state[pair.second] = Level{second};
            coverage.covered(state, window, covered, scratch);
            for (std::size_t w = 0; w < all.size(); ++w) all[w] |= covered[w];
        }
    }
    const auto width = static_cast<std::size_t>(range.width()) * words;
    for (int z = range.z0; z <= range.z1; ++z) {
        const std::size_t from = static_cast<std::size_t>(z - range.z0) * width;
        std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(from), width,
                    together.words().begin() + static_cast<std::ptrdiff_t>(together.columnIndex(range.x0, z) * words));
    }
    together -= alone;
    return together;
}

StoryMatch::Fit fitOf(const Coverage& coverage, const BitColumns& target, State state) {
    StoryMatch::Fit fit;
    CoverageScratch scratch;
    coverage.covered(state, fit.covered, scratch);
    fit.quality = compareVolumes(fit.covered, target);
    fit.state = std::move(state);
    return fit;
}

} // namespace

glm::ivec2 sizeOf(const VoxelPlane& plane, const glm::ivec3& dimensions) noexcept {
    return {dimensions[acrossOf(plane)], dimensions.y};
}

glm::ivec3 voxelOf(const VoxelPlane& plane, const glm::ivec3& dimensions, const glm::ivec2& at) noexcept {
    // Seen from the right, what lies in front is at the left.
    if (plane.axis == 0) return {plane.index, at.y, dimensions.z - 1 - at.x};
    return {at.x, at.y, plane.index};
}

glm::dvec2 placeIn(const VoxelPlane& plane, const VoxelFrame& frame, const glm::dvec3& point) noexcept {
    const glm::dvec3 voxels = (point - glm::dvec3(frame.origin)) / frame.voxelSize;
    return {plane.axis == 0 ? frame.dimensions.z - voxels.z : voxels.x, voxels.y};
}

double middleOf(const VoxelPlane& plane, const VoxelFrame& frame) noexcept {
    return static_cast<double>(frame.origin[plane.axis]) + frame.voxelSize * (plane.index + 0.5);
}

BitColumns changedVoxels(const Field& field, std::size_t actuator) {
    FieldViewOptions options;
    options.actuator = actuator;
    options.surfaceOnly = false;
    BitColumns changed(field.frame.dimensions);
    for (const FieldVoxel& one : fieldVoxels(field, options)) changed.set(one.voxel.x, one.voxel.y, one.voxel.z);
    return changed;
}

VoxelPlane tellingPlane(const Field& field, const Rig& rig, std::size_t actuator) {
    const BitColumns changed = changedVoxels(field, actuator); // looks whether it is there
    return fullestOf(changed, axesOfLeastMotion(rig, actuator));
}

VoxelPlane fullestPlane(const BitColumns& voxels) { return fullestOf(voxels, std::array{2, 0}); }

JointReach jointReach(const Coverage& coverage, const Progress& progress) {
    JointReach reach;
    reach.alone = reachedAlone(coverage, progress.part(0.0, 0.3));
    reach.together = BitColumns(coverage.frame().dimensions);
    const auto coupled = coverage.coupledPairs();
    std::mutex guard;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t{0}, coupled.size(), [&](std::size_t p) {
        const BitColumns own = reachedByPair(coverage, coupled[p], reach.alone, progress);
        const std::scoped_lock lock(guard);
        reach.together |= own;
        if (const std::size_t voxels = own.count(); voxels > 0)
            reach.pairs.push_back({coupled[p].first, coupled[p].second, voxels});
        progress.report(0.3 + 0.7 * static_cast<double>(++done) / static_cast<double>(coupled.size()),
                        "two actuators together");
    });
    std::ranges::sort(reach.pairs, [](const JointReach::Pair& a, const JointReach::Pair& b) {
        return std::tuple(b.voxels, a.first, a.second) < std::tuple(a.voxels, b.first, b.second);
    });
    return reach;
}

std::vector<std::size_t> candidateCounts(const Field& field, std::size_t actuator, const BitColumns& target) {
    FieldViewOptions options;
    options.actuator = actuator;
    options.touchedBy = &target;
    options.surfaceOnly = false;
    std::vector<std::size_t> counts(static_cast<std::size_t>(field.levels), 0);
    for (const FieldVoxel& voxel : fieldVoxels(field, options)) ++counts[static_cast<std::size_t>(voxel.level)];
    return counts;
}

StoryMatch matchStory(const Coverage& coverage, const Voting& voting, BitColumns target, const Progress& progress) {
    if (target.dimensions() != coverage.frame().dimensions)
        throw InvalidInput("target", "its voxel grid has another shape than the field's",
                           "voxelise it into the field's own frame");
    StoryMatch match;
    match.target = std::move(target);
    match.target &= coverage.domain();
    progress.report(-1.0, "voting");
    match.votes = voting.match(match.target);
    match.voting = fitOf(coverage, match.target, match.votes.state());
    progress.report(-1.0, "refining");
    const SteadyClock clock;
    Refiner refiner(coverage);
    Refinement refined = refiner.refine(match.target, match.voting.state, kRefineSlice, clock);
    while (!refined.converged) {
        progress.throwIfCancelled();
        refined = refiner.resume(kRefineSlice, clock);
    }
    match.refined = fitOf(coverage, match.target, std::move(refined.state));
    return match;
}

} // namespace lumorph

#include "core/mdf/field_story.h"

#include <algorithm>
#include <mutex>
#include <set>
#include <tuple>
#include <utility>

#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/mdf/field_view.h"
#include "core/mdf/refine.h"

namespace lumorph {

namespace {

constexpr Microseconds kRefineSlice{40'000}; ///< between two looks at whether the user still wants it

/// The axis along which a plane runs.
int acrossOf(const VoxelPlane& plane) noexcept { return plane.axis == 0 ? 2 : 0; }

VoxelPlane middlePlane(const glm::ivec3& dimensions) noexcept { return {2, dimensions.z / 2}; }

/// The upright plane that `worth` rates highest; of a run of equals its middle.
template <typename Worth> VoxelPlane bestPlane(const glm::ivec3& dimensions, Worth&& worth) {
    VoxelPlane best = middlePlane(dimensions);
    double highest = 0.0;
    for (const int axis : {2, 0}) {
        int run = 0;
        for (int index = 0; index < dimensions[axis]; ++index) {
            const double own = worth(VoxelPlane{axis, index});
            if (own > highest) {
                best = {axis, index};
                highest = own;
                run = 1;
            } else if (run > 0 && own == highest && axis == best.axis) {
                best.index = index - run / 2;
                ++run;
            } else {
                run = 0;
            }
        }
    }
    return best;
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

VoxelPlane tellingPlane(const Field& field, std::size_t actuator) {
    const std::vector<std::uint8_t> levels = firstLevels(field, actuator);
    const glm::ivec3 size = field.frame.dimensions;
    return bestPlane(size, [&](const VoxelPlane& plane) {
        std::size_t voxels = 0;
        std::set<int> heights;
        const glm::ivec2 extent = sizeOf(plane, size);
        for (int across = 0; across < extent.x; ++across) {
            int height = 0;
            for (int up = 0; up < extent.y; ++up) {
                const glm::ivec3 v = voxelOf(plane, size, {across, up});
                height += levels[field.voxelIndex(v.x, v.y, v.z)] != kUnchanged ? 1 : 0;
            }
            voxels += static_cast<std::size_t>(height);
            if (height > 0) heights.insert(height);
        }
        return static_cast<double>(voxels) * static_cast<double>(heights.size());
    });
}

VoxelPlane fullestPlane(const BitColumns& voxels) {
    const glm::ivec3 size = voxels.dimensions();
    return bestPlane(size, [&](const VoxelPlane& plane) {
        double count = 0.0;
        const glm::ivec2 extent = sizeOf(plane, size);
        for (int across = 0; across < extent.x; ++across)
            for (int up = 0; up < extent.y; ++up) {
                const glm::ivec3 v = voxelOf(plane, size, {across, up});
                count += voxels.test(v.x, v.y, v.z) ? 1.0 : 0.0;
            }
        return count;
    });
}

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

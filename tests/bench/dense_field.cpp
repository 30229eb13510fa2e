#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/bench/literal_voting.h"

namespace lumorph::bench {

namespace {

/// Calls visit(voxel index of the field, index within the domain) for every voxel of the domain.
template <typename Visit> void eachDomainVoxel(const Field& field, Visit&& visit) {
    const glm::ivec3 size = field.frame.dimensions;
    std::size_t inDomain = 0;
    for (int z = 0; z < size.z; ++z)
        for (int x = 0; x < size.x; ++x)
            for (int y = 0; y < size.y; ++y)
                if (!field.body.test(x, y, z)) visit(glm::ivec3(x, y, z), inDomain++);
}

} // namespace

DenseField::DenseField(const Field& field)
    : actuators(field.actuators.size()), levels(static_cast<std::size_t>(field.levels)),
      voxels(field.frame.voxelCount() - field.body.count()), expectation(actuators * levels * voxels),
      changedBy(actuators) {
    for (std::size_t i = 0; i < actuators; ++i) {
        const std::vector<Ramp> ramps = denseRamps(field, i);
        eachDomainVoxel(field, [&](const glm::ivec3& at, std::size_t v) {
            const std::size_t index = field.voxelIndex(at.x, at.y, at.z);
            const bool changed = ramps[index].v0 != kUnchanged;
            if (changed) changedBy[i].push_back(static_cast<std::uint32_t>(v));
            for (std::size_t j = 0; j < levels; ++j)
                expectation[(i * levels + j) * voxels + v] = static_cast<float>(
                    changed ? expectationAt(ramps[index], static_cast<int>(j)) : field.background[index] / 255.0);
        });
    }
}

std::vector<float> denseTarget(const Field& field, const BitColumns& target) {
    std::vector<float> dense(field.frame.voxelCount() - field.body.count());
    eachDomainVoxel(
        field, [&](const glm::ivec3& at, std::size_t v) { dense[v] = target.test(at.x, at.y, at.z) ? 1.0F : 0.0F; });
    return dense;
}

std::vector<std::size_t> reachableVoxels(const DenseField& field, std::span<const float> target) {
    std::vector<std::size_t> counts;
    for (const std::vector<std::uint32_t>& changed : field.changedBy)
        counts.push_back(static_cast<std::size_t>(
            std::count_if(changed.begin(), changed.end(), [&](std::uint32_t v) { return target[v] > 0.0F; })));
    return counts;
}

State chosenState(const DenseField& field, const EquationSums& sums, const std::vector<std::size_t>& reachable) {
    constexpr double kTie = 1e-9;
    State state(field.actuators);
    for (std::size_t i = 0; i < field.actuators; ++i) {
        if (reachable[i] == 0) continue;
        const double least = std::max(1.0, 0.01 * static_cast<double>(reachable[i]));
        std::vector<double> ratios(field.levels, std::numeric_limits<double>::infinity());
        for (std::size_t j = 0; j < field.levels; ++j) {
            const std::size_t at = i * field.levels + j;
            if (sums.intersections[at] >= least) ratios[j] = sums.differences[at] / sums.intersections[at];
        }
        const double best = *std::min_element(ratios.begin(), ratios.end());
        if (!std::isfinite(best)) continue;
        const auto chosen =
            std::find_if(ratios.begin(), ratios.end(), [&](double ratio) { return ratio <= best * (1.0 + kTie); });
        state[i] = Level{static_cast<int>(chosen - ratios.begin())};
    }
    return state;
}

} // namespace lumorph::bench

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/units.h"
#include "core/mdf/field.h"

namespace lumorph::bench {

/// The field as dense grids of V~(i,j), one float for each voxel of the domain.
struct DenseField {
    explicit DenseField(const Field& field);

    std::size_t actuators = 0;
    std::size_t levels = 0;
    std::size_t voxels = 0;                            ///< of the domain
    std::vector<float> expectation;                    ///< [actuator][level][voxel]
    std::vector<std::vector<std::uint32_t>> changedBy; ///< [actuator]: the voxels that it changes

    [[nodiscard]] std::span<const float> grid(std::size_t actuator, std::size_t level) const noexcept {
        return {expectation.data() + (actuator * levels + level) * voxels, voxels};
    }
};

/// The two sums of Eq. 1, [actuator][level].
struct EquationSums {
    std::vector<double> differences;   ///< |V~(i,j) - V_T|
    std::vector<double> intersections; ///< V~(i,j) . V_T
};

/// V_T as a float for each voxel of the domain.
[[nodiscard]] std::vector<float> denseTarget(const Field& field, const BitColumns& target);

/// Eq. 1 as it stands, one multiplication and one difference for each voxel, actuator and level: what
/// a match costs without any thought. Its source is fixed, so that ratios can be compared over time.
void literalSums(const DenseField& field, std::span<const float> target, EquationSums& sums);

/// The same sums over the same grids with vector instructions: what a match costs with a good compiler.
void vectorisedSums(const DenseField& field, std::span<const float> target, EquationSums& sums);

/// For each actuator the target voxels that it changes.
[[nodiscard]] std::vector<std::size_t> reachableVoxels(const DenseField& field, std::span<const float> target);

/// The argmin of Eq. 1, under the rules of Voting.
[[nodiscard]] State chosenState(const DenseField& field, const EquationSums& sums,
                                const std::vector<std::size_t>& reachable);

} // namespace lumorph::bench

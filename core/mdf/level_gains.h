#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mdf/coverage.h"

namespace lumorph {

/// What one actuator covers alone, level by level, the others at rest.
struct ActuatorLevels {
    ColumnRange range;                             ///< of columns that it can change
    std::vector<std::vector<std::uint64_t>> words; ///< one a level: of `range`, rows along x
    std::vector<int> covered;                      ///< one a level, voxels
};

/// Throws what `Coverage` throws.
[[nodiscard]] ActuatorLevels levelsOf(const Coverage& coverage, std::size_t actuator);

/// What a level of one actuator adds to the volume at rest, in voxels.
struct LevelGain {
    int covered = 0;
    int both = 0; ///< of it what is wanted
};

/// The gains of all levels of all actuators for one target.
using LevelGains = std::vector<std::vector<LevelGain>>;

/// Gains of one actuator for a target; reuses the memory of `gains`.
void countGains(const ActuatorLevels& levels, const BitColumns& wanted, std::vector<LevelGain>& gains);

/// A joint state that was chosen as if no voxel were covered by two actuators.
struct SumState {
    State state;
    double iou = 0.0; ///< by the sums
};

/// The joint state of the largest (both + sum of gains) / (either + sum of gains): exact where actuators share no
/// voxel. By Dinkelbach's iteration (W. Dinkelbach, "On nonlinear fractional programming", Management Science 13,
/// 1967). `both`, `covered`: of the volume at rest; `wanted`: voxels of the target.
[[nodiscard]] SumState bestBySums(const LevelGains& gains, int both, int covered, int wanted);

} // namespace lumorph

#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/base/clock.h"
#include "core/base/units.h"
#include "core/mdf/coverage.h"

namespace lumorph {

struct Refinement {
    State state;
    FitQuality before; ///< of the start
    FitQuality after;
    int statesSeen = 0;     ///< joint states whose true coverage was looked at
    bool converged = false; ///< no change of a single actuator helps any more; else the time ran out
};

/// Levels that an actuator may take, both ends included.
struct LevelRange {
    int low = 0, high = 0;
    bool operator==(const LevelRange&) const = default;
};

/// Improves a joint state by the true coverage of the deformed rig: coordinate
/// moves of 4, 2, 1 levels while they raise the IoU, then every level of every actuator once more, then
/// moves of two coupled actuators at a time. The result is best with respect to any single actuator.
///
/// Only the columns that the moved actuator reaches are evaluated again. Keeps its buffers; one object
/// for each thread. The coverage must outlive it.
class Refiner {
public:
    explicit Refiner(const Coverage& coverage);
    ~Refiner();
    Refiner(Refiner&&) noexcept;
    Refiner& operator=(Refiner&&) noexcept;

    /// Actuators that stay at the level they start with, by index; none unless told. Throws InvalidInput for one that
    /// is not there.
    void hold(const std::vector<std::size_t>& actuators);

    /// Levels that actuators may take, one range each; empty: all. A start beyond them is brought to their ends.
    /// Throws InvalidInput for another number of ranges, or one that holds no level.
    void keepWithin(const std::vector<LevelRange>& ranges);

    /// `target` has the frame's shape; voxels inside the body are ignored. A budget of zero or less
    /// means no limit; the time is looked at after each state.
    /// Throws InvalidInput when target or state do not fit the coverage.
    [[nodiscard]] Refinement refine(const BitColumns& target, const State& start, Microseconds budget,
                                    const Clock& clock);

    /// Goes on with the same target where `refine` or `resume` last ran out of time (from a state given to `qualityOf`,
    /// if that came later), so that many short budgets do what one long one does.
    [[nodiscard]] Refinement resume(Microseconds budget, const Clock& clock);

    /// Quality of one joint state, nothing moved.
    [[nodiscard]] FitQuality qualityOf(const BitColumns& target, const State& state);

private:
    class Search;
    std::unique_ptr<Search> search_;
};

/// The IoU of V near a joint state with strokes between the levels too: moves of single actuators by a half, then by a
/// quarter of a level while they help. What it is more than the state's own is lost to the steps of levels. The target
/// lies in the domain. Ends with the best so far as soon as `isOver` says so; empty: never.
[[nodiscard]] double iouBetweenLevels(const Coverage& coverage, const BitColumns& target, const State& state,
                                      const std::function<bool()>& isOver = {});

} // namespace lumorph

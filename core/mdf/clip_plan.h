#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/mdf/coverage.h"
#include "core/motion/motion.h"

namespace lumorph {

/// Commands for the frames of a moving target, one stroke an actuator in each.
using FrameCommands = std::vector<std::vector<double>>;

/// Chooses the commands of a moving target's frames so that the volumes really reached under the velocity limits (R19)
/// meet it best. Starts with frame-by-frame matching; then each actuator in its turn gets the best plan against the
/// true coverage while the others keep theirs, until no plan gains any more. The others count at their nearest levels.
/// The coverage must outlive it; one object for each thread.
class ClipPlanner {
public:
    /// A frame lasts `seconds`.
    ClipPlanner(const Coverage& coverage, double seconds);
    ~ClipPlanner();

    /// Commands for as many frames as there are targets, given as voxels of the domain. `start` is the motion before
    /// the first, one an actuator; `wanted` is what matching found for each frame alone.
    /// Throws InvalidInput when the numbers of frames or actuators differ, Cancelled.
    [[nodiscard]] FrameCommands plan(std::span<const MotionState> start, std::span<const BitColumns> targets,
                                     std::span<const State> wanted, const Progress& progress = {});

private:
    class Search;
    std::unique_ptr<Search> search_;
};

} // namespace lumorph

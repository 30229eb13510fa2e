#pragma once

#include "core/base/clock.h"
#include "core/mdf/coverage.h"
#include "core/mdf/refine.h"
#include "core/mdf/voting.h"

namespace lumorph {

/// What matching found for one frame of a moving target.
struct FrameMatch {
    State voted;
    FitQuality votedQuality;
    State wanted;          ///< what the device is asked for
    FitQuality quality;    ///< of V(wanted)
    int statesSeen = 0;    ///< joint states that refinement looked at for this frame
    bool converged = true; ///< `resume` has nothing left to do
};

/// Matches one frame after another of a target that moves, without flicker: voting keeps the level of the frame before
/// unless another is clearly better, and refinement keeps the state of the frame before unless what it finds from the
/// votes is better by more than `kStay`, or the votes alone are better. Coverage and voting must outlive it; one object
/// for each thread.
class FrameMatcher {
public:
    /// By how much IoU a newly found state must be better than the one before.
    static constexpr double kStay = 0.002;

    FrameMatcher(const Coverage& coverage, const Voting& voting);

    /// Levels that actuators reach, one range each; empty: all. Neither votes nor refinement choose others, and the
    /// next frame stands for itself. Throws as Refiner::keepWithin does.
    void keepWithin(std::vector<LevelRange> ranges);
    /// The next frame stands for itself: another target, or the same one elsewhere.
    void forget();
    /// Votes for a new frame's target, given as voxels of the domain. To be called first for each frame.
    void vote(const BitColumns& target, Votes& votes);
    /// Takes the votes as they are.
    void keepVotes(const BitColumns& target);
    /// Refines them. A budget of zero or less means no limit.
    void refine(const BitColumns& target, Microseconds budget, const Clock& clock);
    /// Goes on refining while the target stands still.
    void resume(const BitColumns& target, Microseconds budget, const Clock& clock);

    [[nodiscard]] const FrameMatch& found() const noexcept { return found_; }

private:
    void take(const Refinement& refinement);

    const Voting& voting_;
    Refiner refiner_;
    std::vector<LevelRange> ranges_;
    Voting::Workspace workspace_;
    FrameMatch found_;
    bool hasLast_ = false;    ///< `found_.voted` is that of a frame before
    bool hasRefined_ = false; ///< `found_.wanted` is a refined state
    bool searching_ = false;  ///< the refiner stands at `found_.wanted`
};

} // namespace lumorph

#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/loop/match_frame.h"
#include "core/loop/match_wish.h"
#include "core/loop/target_voxels.h"
#include "core/mdf/frame_matcher.h"
#include "core/scene/measured_servos.h"

namespace lumorph {

/// Middle stages of a frame: the state that fits the target's voxels best, and how well volumes meet them. What has not
/// changed since the frame before is kept.
class MatchStage {
public:
    /// Gets ready for a field; an empty one lets go of the last. `reach`: what its actuators reach, one each; empty:
    /// all of their strokes. A level counts as reached where the servo comes nearer to it than to the next.
    void use(const std::shared_ptr<const MatchField>& field, std::span<const StrokeRange> reach);
    /// Matches the voxels of a target and writes votes, wanted state and strokes into the frame. `of` is what they are
    /// voxels of: as long as it is the same, levels do not flicker; `newVoxels`: they are other ones than before. When
    /// neither target nor program drives, the state is left alone.
    void match(const MatchWish& wish, const TargetVoxels& target, const std::shared_ptr<const void>& of, bool newVoxels,
               const Clock& clock, MatchFrame& frame);
    /// Compares V(wanted) and what is covered at the estimated strokes with the target's voxels.
    void judge(const MatchWish& wish, const TargetVoxels& target, MatchFrame& frame);
    /// Whether refinement has nothing left to try on these voxels.
    [[nodiscard]] bool converged() const noexcept { return !matcher_ || matcher_->found().converged; }

private:
    enum class Decided { nothing, byVoting, byRefinement };

    void vote(const TargetVoxels& target, const std::shared_ptr<const void>& of, const Clock& clock, MatchTimes& ms);
    void decide(const MatchWish& wish, const TargetVoxels& target, const Clock& clock, MatchTimes& ms);
    void judgeWanted(const TargetVoxels& target, MatchFrame& frame);
    void judgeEstimated(const TargetVoxels& target, MatchFrame& frame);

    std::shared_ptr<const MatchField> field_;
    std::vector<LevelRange> reach_; ///< empty: all levels
    std::optional<FrameMatcher> matcher_;
    std::shared_ptr<const void> target_; ///< what the votes are of
    std::shared_ptr<const Votes> votes_;
    Decided decided_ = Decided::nothing;

    bool newVoxels_ = true; ///< since the volumes below were compared with them
    CoverageScratch scratch_;
    State coveredState_;
    BitColumns covered_; ///< V(coveredState_)
    FitQuality quality_;
    std::shared_ptr<const std::vector<std::uint8_t>> classes_;
    std::vector<double> reachedStrokes_;
    BitColumns reached_; ///< covered at `reachedStrokes_`
    double iouReached_ = 0.0;
};

/// The class of each voxel, x fastest, then y, then z: kVoxelMatched and so on, 0 for what is in neither. Both grids
/// have one shape.
[[nodiscard]] std::vector<std::uint8_t> voxelClasses(const BitColumns& covered, const BitColumns& target);

} // namespace lumorph

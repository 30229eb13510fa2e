#include "core/mdf/frame_matcher.h"

#include <algorithm>
#include <utility>

namespace lumorph {
namespace {

/// Of an actuator that votes for a level that it does not reach: the best of those that it reaches, by the same ratio;
/// the lower one of two that are as good.
void voteWithin(ActuatorVote& vote, const LevelRange& range) {
    if (vote.level.index >= range.low && vote.level.index <= range.high) return;
    // Of two ratios without dividing: intersections may be zero.
    const auto isBetter = [&vote](int a, int b) {
        const auto i = static_cast<std::size_t>(a), k = static_cast<std::size_t>(b);
        return vote.errors[i] * vote.intersections[k] < vote.errors[k] * vote.intersections[i];
    };
    int best = range.low;
    for (int level = range.low + 1; vote.reached && level <= range.high; ++level)
        if (isBetter(level, best)) best = level;
    vote.level = Level{best};
    vote.stroke = strokeOf(vote.level, static_cast<int>(vote.errors.size()));
}

} // namespace

FrameMatcher::FrameMatcher(const Coverage& coverage, const Voting& voting) : voting_(voting), refiner_(coverage) {}

void FrameMatcher::keepWithin(std::vector<LevelRange> ranges) {
    refiner_.keepWithin(ranges);
    ranges_ = std::move(ranges);
    forget();
}

void FrameMatcher::forget() { hasLast_ = hasRefined_ = false; }

void FrameMatcher::vote(const BitColumns& target, Votes& votes) {
    voting_.match(target, votes, workspace_, hasLast_ ? &found_.voted : nullptr);
    for (std::size_t i = 0; i < ranges_.size(); ++i) voteWithin(votes.actuators[i], ranges_[i]);
    found_.voted = votes.state();
    hasLast_ = true;
}

void FrameMatcher::keepVotes(const BitColumns& target) {
    found_.wanted = found_.voted;
    found_.votedQuality = found_.quality = refiner_.qualityOf(target, found_.voted);
    found_.statesSeen = 0;
    found_.converged = true;
    hasRefined_ = false;
}

void FrameMatcher::refine(const BitColumns& target, Microseconds budget, const Clock& clock) {
    const State last = found_.wanted;
    // Before the search, which may be resumed from where it stops.
    const FitQuality stayed = hasRefined_ ? refiner_.qualityOf(target, last) : FitQuality{};
    const Refinement refinement = refiner_.refine(target, found_.voted, budget, clock);
    take(refinement);
    found_.votedQuality = refinement.before;
    searching_ = true;
    const bool betterThanVotes = stayed.iou() >= found_.votedQuality.iou();
    if (hasRefined_ && last != found_.wanted && betterThanVotes && stayed.iou() + kStay >= found_.quality.iou()) {
        found_.wanted = last;
        found_.quality = stayed;
        found_.converged = searching_ = false;
    }
    hasRefined_ = true;
}

void FrameMatcher::resume(const BitColumns& target, Microseconds budget, const Clock& clock) {
    take(searching_ ? refiner_.resume(budget, clock) : refiner_.refine(target, found_.wanted, budget, clock));
    searching_ = true;
}

void FrameMatcher::take(const Refinement& refinement) {
    found_.wanted = refinement.state;
    found_.quality = refinement.after;
    found_.statesSeen = refinement.statesSeen;
    found_.converged = refinement.converged;
}

} // namespace lumorph

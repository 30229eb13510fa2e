#include "core/mdf/frame_matcher.h"

#include <utility>

namespace lumorph {

FrameMatcher::FrameMatcher(const Coverage& coverage, const Voting& voting) : voting_(voting), refiner_(coverage) {}

void FrameMatcher::forget() { hasLast_ = hasRefined_ = false; }

void FrameMatcher::vote(const BitColumns& target, Votes& votes) {
    voting_.match(target, votes, workspace_, hasLast_ ? &found_.voted : nullptr);
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

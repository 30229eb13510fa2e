#include "calibration/registration/hand_eye.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "calibration/registration/clock_offset.h"
#include "calibration/registration/hand_eye_closed.h"
#include "calibration/registration/hand_eye_fit.h"
#include "calibration/registration/refusing.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::kDegree;
using registration::number;

using hand_eye::Deviation;
using hand_eye::Fit;
using hand_eye::kBodies;
using hand_eye::Place;
using hand_eye::Range;
using hand_eye::Unknowns;

constexpr double kLeastCorrelation = 0.5; ///< of angular speeds: below, they are of two bodies
constexpr double kJump = 0.05;            ///< seconds by which a clock that runs evenly does not err
constexpr std::size_t kBlocks = 8;        ///< of the recording, for sigmas

double turnBetween(const Pose& a, const Pose& b) { return angleOf(glm::conjugate(a.rotation) * b.rotation); }

/// What the recording says of its own worth.
void judge(HandEye& result, const Fit& fit, const Unknowns& solved, Place place, std::size_t poses,
           const Progress& progress) {
    const auto half = [&](Range use) { return fit.refined(solved, place, use).bFromA; };
    const Pose first = half({0, poses / 2}), second = half({poses / 2, poses});
    result.halvesTurn = turnBetween(first, second);
    result.halvesShift = glm::length(first.position - second.position);
    double turn = 0.0, shift = 0.0, offset = 0.0, drift = 0.0;
    for (std::size_t block = 0; block < kBlocks; ++block) {
        progress.throwIfCancelled();
        progress.report(0.4 + 0.6 * double(block) / double(kBlocks), "how sure it is");
        const Range leave{block * poses / kBlocks, (block + 1) * poses / kBlocks};
        const Unknowns without = fit.refined(solved, place, {0, poses}, leave);
        const double share = double(kBlocks - 1) / double(kBlocks); // jackknife
        turn += share * std::pow(turnBetween(without.bFromA, solved.bFromA), 2);
        shift += share * glm::dot(without.bFromA.position - solved.bFromA.position,
                                  without.bFromA.position - solved.bFromA.position);
        offset += share * std::pow(without.clocks.seconds - solved.clocks.seconds, 2);
        drift += share * std::pow(without.clocks.drift - solved.clocks.drift, 2);
    }
    result.turnSigma = std::sqrt(turn);
    result.shiftSigma = std::sqrt(shift);
    result.offsetSigma = std::sqrt(offset);
    result.driftSigma = std::sqrt(drift);
}

[[noreturn]] void refuseJump(double by, double from) {
    registration::refuse(Cause::clockJumps, kBodies,
                         "their clocks differ by " + number(by * 1000.0, 0) + " ms more or less from about " +
                             number(from, 0) + " s on",
                         "record again while both clocks run evenly, or cut the recording there");
}

/// A clock that jumped shows as another offset from there on.
void checkClocks(const Fit& fit, const PoseTrack& b, const Unknowns& solved, Place place) {
    std::vector<double> offsets;
    const std::size_t poses = b.poses.size();
    for (std::size_t block = 0; block < kBlocks; ++block)
        offsets.push_back(fit.refined(solved, place, {block * poses / kBlocks, (block + 1) * poses / kBlocks}, {}, true)
                              .clocks.seconds);
    const double usual = median(offsets);
    std::vector<double> from;
    for (const double offset : offsets) from.push_back(std::abs(offset - usual));
    const double spread = std::max(0.004, median(from));
    for (std::size_t cut = 1; cut < kBlocks; ++cut) {
        const std::vector<double> before(offsets.begin(), offsets.begin() + std::ptrdiff_t(cut));
        const std::vector<double> after(offsets.begin() + std::ptrdiff_t(cut), offsets.end());
        const auto [lowB, highB] = std::ranges::minmax(before);
        const auto [lowA, highA] = std::ranges::minmax(after);
        const double apart = std::max(lowA - highB, lowB - highA);
        if (apart > std::max(kJump, 2.0 * std::max({highB - lowB, highA - lowA, spread})) && before.size() > 1 &&
            after.size() > 1)
            registration::refuse(
                Cause::clockJumps, kBodies,
                "their clocks differ by " + number(apart * 1000.0, 0) + " ms more or less from about " +
                    number(b.poses[cut * poses / kBlocks].seconds - b.poses.front().seconds, 0) + " s on",
                "record again while both clocks run evenly, or cut the recording there");
    }
}

/// Clocks that jump by much spoil everything; quarters of the recording still tell their own offsets.
[[noreturn]] void explainMisfit(const HandEye& result, const PoseTrack& a, const PoseTrack& b) {
    constexpr std::size_t kQuarters = 4;
    std::optional<double> before;
    for (std::size_t k = 0; k < kQuarters; ++k) {
        PoseTrack quarter;
        const std::size_t n = b.poses.size();
        quarter.poses.assign(b.poses.begin() + std::ptrdiff_t(k * n / kQuarters),
                             b.poses.begin() + std::ptrdiff_t((k + 1) * n / kQuarters));
        const ClockOffset clocks = clockOffset(a, quarter);
        if (clocks.correlation < 0.9) continue;
        if (before && std::abs(clocks.seconds - *before) > kJump)
            refuseJump(std::abs(clocks.seconds - *before), quarter.poses.front().seconds - b.poses.front().seconds);
        before = clocks.seconds;
    }
    registration::refuse(Cause::modelDoesNotFit, kBodies,
                         "they do not move as one: poses differ by " + number(result.medianTurn / kDegree, 1) +
                             " degrees and " + number(1000.0 * result.medianShift, 0) + " mm",
                         "join the bodies rigidly, and see that the tracker does not swap them");
}

/// Stretches in which B is elsewhere than A says.
void tellStrays(HandEye& result, const std::vector<Deviation>& deviations, const PoseTrack& b) {
    const double far = std::max(0.02, 12.0 * result.medianShift),
                 turned = std::max(3.0 * kDegree, 12.0 * result.medianTurn);
    std::size_t strays = 0;
    double first = 0.0, last = 0.0;
    for (const Deviation& d : deviations) {
        if (glm::length(d.place) < far && glm::length(d.turn) < turned) continue;
        last = b.poses[d.pose].seconds - b.poses.front().seconds;
        if (strays++ == 0) first = last;
    }
    if (strays < 5) return;
    result.warnings.push_back({Cause::bodySwapped,
                               kBodies,
                               {},
                               std::to_string(strays) + " of " + std::to_string(deviations.size()) + " poses, from " +
                                   number(first, 1) + " s to " + number(last, 1) +
                                   " s, are of somewhere else; they count for nothing",
                               "see that the tracker neither swaps bodies nor takes reflections for markers"});
}

HandEye solveSparse(const PoseTrack& a, const PoseTrack& b, const Progress& progress) {
    const ClockOffset clocks = clockOffset(a, b, progress.part(0.0, 0.2));
    if (clocks.correlation < kLeastCorrelation)
        registration::refuse(
            Cause::clocksUnknown, kBodies,
            "their speeds of turning agree at no offset of the clocks (at best " + number(clocks.correlation, 2) + ")",
            "record both at the same time, joined rigidly, and turn them now fast, now slowly, for 20 s or more");
    progress.report(0.2, "joint");
    Unknowns solved = hand_eye::closedForm(a, b, clocks);
    const Fit fit(a, b, progress);
    const Range all{0, b.poses.size()};
    const auto as = [&](Place place) { return fit.refined(solved, place, all); };
    const Unknowns byBody = as(Place::body);
    progress.report(0.27, "joint");
    const Unknowns byOrigin = as(Place::origin);
    progress.report(0.33, "joint");
    const auto likely = [&](const Unknowns& u, Place place) {
        return hand_eye::Noise(fit.deviations(u), b, place).logarithm();
    };
    const Place place = likely(byBody, Place::body) <= likely(byOrigin, Place::origin) ? Place::body : Place::origin;
    solved = place == Place::body ? byBody : byOrigin;

    HandEye result;
    result.bFromA = solved.bFromA;
    result.worldBFromWorldA = solved.worldBFromWorldA;
    result.timeOffset = solved.clocks.seconds;
    result.clockDrift = solved.clocks.drift;
    result.middle = solved.clocks.middle;
    const std::vector<Deviation> deviations = fit.deviations(solved);
    std::vector<double> turns, shifts;
    for (const Deviation& d : deviations) {
        turns.push_back(glm::length(d.turn));
        shifts.push_back(glm::length(d.place));
    }
    result.poses = deviations.size();
    result.medianTurn = median(turns);
    result.medianShift = median(shifts);
    if (result.medianTurn > 6.0 * kDegree || result.medianShift > 0.08) explainMisfit(result, a, b);
    checkClocks(fit, b, solved, place);
    if (clocks.runnerUp > 0.98)
        result.warnings.push_back({Cause::clocksUnknown,
                                   kBodies,
                                   {},
                                   "another offset of the clocks agrees nearly as well",
                                   "turn the bodies less regularly"});
    tellStrays(result, deviations, b);
    judge(result, fit, solved, place, b.poses.size(), progress);
    return result;
}

double rateOf(const PoseTrack& track) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < track.poses.size(); ++i)
        steps.push_back(track.poses[i].seconds - track.poses[i - 1].seconds);
    return steps.empty() ? 0.0 : 1.0 / median(steps);
}

} // namespace

HandEye solveHandEye(const PoseTrack& a, const PoseTrack& b, const Progress& progress) {
    for (const PoseTrack* track : {&a, &b})
        if (track->poses.size() < 20)
            registration::refuse(Cause::tooFewPoints, kBodies, "a recording has fewer than 20 poses",
                                 "record both for 20 s or more");
    HandEye result;
    if (rateOf(a) >= rateOf(b)) {
        result = solveSparse(a, b, progress);
    } else { // the one with fewer is compared with the other, which is interpolated
        result = solveSparse(b, a, progress);
        result.bFromA = inverseOf(result.bFromA);
        result.worldBFromWorldA = inverseOf(result.worldBFromWorldA);
        result.middle -= result.timeOffset;
        result.timeOffset = -result.timeOffset;
        result.clockDrift = -result.clockDrift;
    }
    for (const PoseTrack* track : {&a, &b})
        result.warnings.insert(result.warnings.end(), track->warnings.begin(), track->warnings.end());
    return result;
}

} // namespace lumorph

#include "calibration/registration/hand_eye.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "calibration/registration/clock_offset.h"
#include "calibration/registration/hand_eye_attempt.h"
#include "calibration/registration/refusing.h"
#include "calibration/registration/time_unit.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::kDegree;
using registration::number;

using hand_eye::Deviation;
using hand_eye::Fit;
using hand_eye::Free;
using hand_eye::kBodies;
using hand_eye::Names;
using hand_eye::Place;
using hand_eye::Range;
using hand_eye::Unknowns;

constexpr double kLeastCorrelation = 0.5; ///< of angular speeds: below, they are of two bodies
constexpr double kJump = 0.05;            ///< seconds by which a clock that runs evenly does not err
constexpr double kSureOffset = 0.006;     ///< seconds: sigma of the offset in a part that tells it
constexpr std::size_t kBlocks = 8;        ///< of the recording, for sigmas

/// Few poses that stood still are no recording of a motion.
std::string remedyForStations(const PoseTrack& a, const PoseTrack& b) {
    constexpr std::size_t kMostStations = 60;
    return std::min(a.poses.size(), b.poses.size()) > kMostStations
               ? ""
               : "; poses that stood still, a row of each file for each, are solved with --stations";
}

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

/// A clock that jumped shows as another offset from there on. A part in which the bodies rest tells none.
void checkClocks(const Fit& fit, const PoseTrack& b, const Unknowns& solved, Place place) {
    std::vector<double> offsets;
    std::vector<std::size_t> begins; // of the blocks that tell it
    const std::size_t poses = b.poses.size();
    for (std::size_t block = 0; block < kBlocks; ++block) {
        const Range range{block * poses / kBlocks, (block + 1) * poses / kBlocks};
        if (fit.offsetSigma(solved, place, range) > kSureOffset) continue;
        offsets.push_back(fit.refined(solved, place, range, {}, Free::offset).clocks.seconds);
        begins.push_back(range.from);
    }
    const double usual = median(offsets);
    std::vector<double> from;
    from.reserve(offsets.size());
    for (const double offset : offsets) from.push_back(std::abs(offset - usual));
    const double spread = std::max(0.004, median(from));
    for (std::size_t cut = 2; cut + 1 < offsets.size(); ++cut) {
        const std::vector<double> before(offsets.begin(), offsets.begin() + std::ptrdiff_t(cut));
        const std::vector<double> after(offsets.begin() + std::ptrdiff_t(cut), offsets.end());
        const auto [lowB, highB] = std::ranges::minmax(before);
        const auto [lowA, highA] = std::ranges::minmax(after);
        const double apart = std::max(lowA - highB, lowB - highA);
        if (apart > std::max(kJump, 2.0 * std::max({highB - lowB, highA - lowA, spread})))
            refuseJump(apart, b.poses[begins[cut]].seconds - b.poses.front().seconds);
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

HandEye solveSparse(const PoseTrack& a, const PoseTrack& b, const Names& names, const Progress& progress,
                    bool isReread = false) {
    const ClockOffset clocks = clockOffset(a, b, progress.part(0.0, 0.2));
    if (clocks.correlation < kLeastCorrelation)
        registration::refuse(
            Cause::clocksUnknown, kBodies,
            "their speeds of turning agree at no offset of the clocks (at best " + number(clocks.correlation, 2) + ")",
            "record both at the same time, joined rigidly, and turn them now fast, now slowly, for 20 s or more" +
                remedyForStations(a, b));
    const hand_eye::Read read =
        hand_eye::readRecordings({a, b, clocks, false, names, isReread}, progress.part(0.2, 0.4));
    if (read.other) {
        HandEye result =
            solveSparse(readAs(a, read.other->a), readAs(b, read.other->b), names, progress.part(0.4, 1.0), true);
        const std::vector<Finding> warnings = hand_eye::warningsOf(*read.other, names);
        result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
        return result;
    }
    const hand_eye::Attempt& attempt = *read.attempt;
    HandEye result = hand_eye::resultOf(attempt);
    if (result.medianTurn > 6.0 * kDegree || result.medianShift > 0.08) explainMisfit(result, a, b);
    const Fit fit(a, b, progress);
    checkClocks(fit, b, attempt.solved, attempt.place);
    result.warnings = hand_eye::warningsOf(attempt, names);
    if (clocks.runnerUp > 0.98)
        result.warnings.push_back({Cause::clocksUnknown,
                                   kBodies,
                                   {},
                                   "another offset of the clocks agrees nearly as well",
                                   "turn the bodies less regularly"});
    tellStrays(result, attempt.deviations, b);
    judge(result, fit, attempt.solved, attempt.place, b.poses.size(), progress);
    return result;
}

std::string recordingOf(const char* name) { return "the " + std::string(name) + " recording"; }

PoseTrack knownFrames(const PoseTrack& other, PoseTrack frames, const std::string& name, const Progress& progress) {
    auto seconds = inSecondsBy(other, std::move(frames), name, progress);
    if (!seconds)
        registration::refuse(Cause::timeUnit, name.c_str(),
                             "its times are whole numbers that follow one another, as frames do; at no frame rate does "
                             "it turn as the other does",
                             "write seconds; record both at the same time");
    return std::move(*seconds);
}

double rateOf(const PoseTrack& track) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < track.poses.size(); ++i)
        steps.push_back(track.poses[i].seconds - track.poses[i - 1].seconds);
    return steps.empty() ? 0.0 : 1.0 / median(steps);
}

} // namespace

HandEye solveHandEye(const PoseTrack& first, const PoseTrack& second, const Progress& progress) {
    const Names names;
    for (const PoseTrack* track : {&first, &second})
        if (track->poses.size() < 20)
            registration::refuse(Cause::tooFewPoints, kBodies, "a recording has fewer than 20 poses",
                                 "record both for 20 s or more" + remedyForStations(first, second));
    PoseTrack a = inSeconds(first, recordingOf(names.a)), b = inSeconds(second, recordingOf(names.b));
    if (countsFrames(a) && countsFrames(b))
        registration::refuse(Cause::timeUnit, kBodies,
                             "the times of both count frames: nothing tells how many a second",
                             "divide them by the frame rate, so that they are seconds");
    if (countsFrames(a)) a = knownFrames(b, std::move(a), recordingOf(names.a), progress.part(0.0, 0.2));
    if (countsFrames(b)) b = knownFrames(a, std::move(b), recordingOf(names.b), progress.part(0.0, 0.2));
    HandEye result;
    if (rateOf(a) >= rateOf(b)) {
        result = solveSparse(a, b, names, progress);
    } else { // the one with fewer is compared with the other, which is interpolated
        result = solveSparse(b, a, {names.b, names.a}, progress);
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

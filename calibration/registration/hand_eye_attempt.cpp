#include "calibration/registration/hand_eye_attempt.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "calibration/registration/refusing.h"
#include "core/base/statistics.h"

namespace lumorph::hand_eye {

namespace {

using registration::kDegree;
using registration::number;

constexpr std::size_t kFewestMoments = 20;

// Medians beyond which another reading is looked for; much smaller ones are of a reading that is right.
constexpr double kDoubtfulTurn = 1.0 * kDegree, kDoubtfulShift = 0.01;
constexpr double kMostTurn = 3.0 * kDegree, kMostShift = 0.04; ///< of a reading that explains something
constexpr double kMuchBetter = 0.25;
constexpr double kNearlyAsGood = 3.0; ///< times the best: nothing tells which of the two is right

struct Medians {
    double turn = std::numeric_limits<double>::infinity(), shift = std::numeric_limits<double>::infinity();
    [[nodiscard]] double both() const { return turn + 5.0 * shift; } // 1 mm weighs as 0.3 degrees
};

Medians mediansOf(const std::vector<Deviation>& deviations) {
    std::vector<double> turns, shifts;
    for (const Deviation& d : deviations) {
        turns.push_back(glm::length(d.turn));
        shifts.push_back(glm::length(d.place));
    }
    return {median(std::move(turns)), median(std::move(shifts))};
}

/// A reading, and how well it fits without refinement.
struct Trial {
    OtherReading as;
    Medians medians;
    ClosedForm found;
    [[nodiscard]] bool oneIsInverted() const { return as.a.inverted != as.b.inverted; }
};

std::optional<Trial> trialOf(const Recordings& recordings, const OtherReading& as) {
    const PoseTrack a = readAs(recordings.a, as.a), b = readAs(recordings.b, as.b);
    try {
        const std::vector<Both> both = together(a, b, recordings.clocks);
        const ClosedForm found = closedForm(both, recordings.names);
        const Unknowns unknowns{found.bFromA, found.worldBFromWorldA, recordings.clocks};
        return Trial{as, mediansOf(Fit(a, b).deviations(unknowns)), found};
    } catch (const CaptureRefused&) {
        return std::nullopt;
    }
}

bool explains(const Trial& trial, const Medians& usual) {
    const Medians& m = trial.medians;
    const bool isBetter = m.turn < kMuchBetter * usual.turn || m.shift < kMuchBetter * usual.shift;
    const bool isNoWorse = m.turn < 1.5 * usual.turn + 0.2 * kDegree && m.shift < 1.5 * usual.shift;
    return m.turn < kMostTurn && m.shift < kMostShift && isBetter && isNoWorse;
}

/// All that differ: two recordings that are both inverted fit as well as none, with the bodies for the worlds, and
/// likewise which of two it is makes no difference.
constexpr std::array kReadings{
    OtherReading{{true, false}, {false, false}}, OtherReading{{false, false}, {true, false}},
    OtherReading{{true, false}, {true, false}},  OtherReading{{false, true}, {false, false}},
    OtherReading{{true, true}, {false, false}},  OtherReading{{false, false}, {true, true}},
    OtherReading{{true, true}, {true, false}},
};

std::string wFirstIn(const OtherReading& as, const Names& names) {
    if (as.a.wFirst && as.b.wFirst) return "both have the quaternion's w first";
    return std::string("the ") + (as.a.wFirst ? names.a : names.b) + " has the quaternion's w first";
}

std::string distanceOf(double metres) { return number(1000.0 * metres, 0) + " mm"; }

[[noreturn]] void refuseInverted(const Trial& trial, const Names& names) {
    const double joint = glm::length(trial.found.bFromA.position);
    const double worlds = glm::length(trial.found.worldBFromWorldA.position);
    // With the other one inverted the worlds take the place of the bodies.
    const bool isA = trial.as.a.inverted;
    std::string why = std::string("they fit if one of them has the world in the body's frame, not the body in the "
                                  "world's; nothing tells which: if the ") +
                      names.a + " has, the bodies are " + distanceOf(isA ? joint : worlds) + " apart, if the " +
                      names.b + " has, " + distanceOf(isA ? worlds : joint);
    if (trial.as.a.wFirst || trial.as.b.wFirst) why += "; and " + wFirstIn(trial.as, names);
    registration::refuse(Cause::inverted, kBodies, std::move(why),
                         "invert each pose of that one; what a camera tells of a board (solvePnP) is the board in the "
                         "camera's frame. On the command line --inverted a or --inverted b does it");
}

std::optional<OtherReading> otherReading(const Recordings& recordings, const Medians& usual, const Progress& progress) {
    std::vector<Trial> explaining;
    for (const OtherReading& as : kReadings) {
        progress.throwIfCancelled();
        if (const auto trial = trialOf(recordings, as); trial && explains(*trial, usual)) explaining.push_back(*trial);
    }
    if (explaining.empty()) return std::nullopt;
    std::ranges::stable_sort(explaining, {}, [](const Trial& trial) { return trial.medians.both(); });
    const Trial& best = explaining.front();
    if (explaining.size() > 1 && explaining[1].medians.both() < kNearlyAsGood * best.medians.both()) {
        const bool oneIs = best.oneIsInverted() || explaining[1].oneIsInverted();
        registration::refuse(oneIs ? Cause::inverted : Cause::quaternionOrder, kBodies,
                             oneIs ? "one of them is inverted, or has the quaternion's w first: both would fit"
                                   : "one of them has the quaternion's w first: which, nothing tells",
                             "write x, y, z, w in both, and both bodies in their worlds; and move them about as well "
                             "as turning them");
    }
    if (best.oneIsInverted()) refuseInverted(best, recordings.names);
    return best.as;
}

/// Causes that a wrong reading may be taken for.
bool mayBeReading(Cause cause) {
    return cause == Cause::modelDoesNotFit || cause == Cause::wrongUnits || cause == Cause::mirrored;
}

Medians mediansOf(const Attempt& attempt) { return {attempt.medianTurn, attempt.medianShift}; }

} // namespace

Attempt attemptOf(const Recordings& recordings, const Progress& progress) {
    const PoseTrack &a = recordings.a, &b = recordings.b;
    const ClockOffset& clocks = recordings.clocks;
    const bool areStations = recordings.areStations;
    const std::vector<Both> both = together(a, b, clocks);
    if (!areStations && both.size() < kFewestMoments)
        registration::refuse(Cause::tooFewPoints, kBodies, "they share fewer than 20 moments",
                             "record both at the same time, for 20 s or more");
    const ClosedForm closed = closedForm(both, recordings.names);
    const Unknowns start{closed.bFromA, closed.worldBFromWorldA, clocks};
    const Fit fit(a, b, progress);
    const auto as = [&](Place place) {
        return fit.refined(start, place, {0, b.poses.size()}, {}, areStations ? Free::poses : Free::all);
    };
    progress.report(0.0, "joint");
    const Unknowns byBody = as(Place::body);
    progress.report(0.5, "joint");
    const Unknowns byOrigin = as(Place::origin);
    progress.report(1.0, "joint");
    const auto likely = [&](const Unknowns& u, Place place) { return Noise(fit.deviations(u), b, place).logarithm(); };
    Attempt attempt;
    attempt.place = likely(byBody, Place::body) <= likely(byOrigin, Place::origin) ? Place::body : Place::origin;
    attempt.solved = attempt.place == Place::body ? byBody : byOrigin;
    attempt.deviations = fit.deviations(attempt.solved);
    const Medians medians = mediansOf(attempt.deviations);
    attempt.medianTurn = medians.turn;
    attempt.medianShift = medians.shift;
    attempt.aInPlace = closed.aInPlace;
    attempt.bInPlace = closed.bInPlace;
    return attempt;
}

Read readRecordings(const Recordings& recordings, const Progress& progress) {
    Read read;
    std::optional<Finding> refusal;
    try {
        read.attempt = attemptOf(recordings, progress.part(0.0, 0.8));
    } catch (const CaptureRefused& refused) {
        if (!mayBeReading(refused.finding().cause)) throw;
        refusal = refused.finding();
    }
    const Medians usual = read.attempt ? mediansOf(*read.attempt) : Medians{};
    if (recordings.isReread) {
        if (refusal) throw CaptureRefused(*refusal);
        return read;
    }
    if (usual.turn > kDoubtfulTurn || usual.shift > kDoubtfulShift)
        read.other = otherReading(recordings, usual, progress);
    if (refusal && !read.other) throw CaptureRefused(*refusal);
    return read;
}

std::vector<Finding> warningsOf(const OtherReading& other, const Names& names) {
    return {{Cause::quaternionOrder,
             kBodies,
             {},
             wFirstIn(other, names),
             "they were read as w, x, y, z, by which they fit; write x, y, z, w"}};
}

std::vector<Finding> warningsOf(const Attempt& attempt, const Names& names) {
    std::vector<Finding> warnings;
    if (attempt.aInPlace || attempt.bInPlace) {
        const std::string which =
            attempt.aInPlace && attempt.bInPlace
                ? "both turned about their own origins"
                : std::string("the ") + (attempt.aInPlace ? names.a : names.b) + " turned about its own origin";
        warnings.push_back({Cause::turnsInPlace,
                            kBodies,
                            {},
                            which + ": nothing tells whether both are in one unit, and whether its world is "
                                    "right-handed",
                            "taken as metres of right-handed worlds; move the bodies about, too"});
    }
    const double joint = glm::length(attempt.solved.bFromA.position);
    constexpr double kFarJoint = 1.0, kFarther = 3.0; // metres; times
    if (joint > kFarJoint && joint > kFarther * glm::length(attempt.solved.worldBFromWorldA.position))
        warnings.push_back({Cause::inverted,
                            kBodies,
                            {},
                            "the bodies would be " + distanceOf(joint) +
                                " apart, and their worlds nearer: if both recordings have the world in the body's "
                                "frame, bodies and worlds are exchanged in what was found",
                            "see that both have the body in the world's frame"});
    return warnings;
}

HandEye resultOf(const Attempt& attempt) {
    HandEye result;
    result.bFromA = attempt.solved.bFromA;
    result.worldBFromWorldA = attempt.solved.worldBFromWorldA;
    result.timeOffset = attempt.solved.clocks.seconds;
    result.clockDrift = attempt.solved.clocks.drift;
    result.middle = attempt.solved.clocks.middle;
    result.poses = attempt.deviations.size();
    result.medianTurn = attempt.medianTurn;
    result.medianShift = attempt.medianShift;
    return result;
}

} // namespace lumorph::hand_eye

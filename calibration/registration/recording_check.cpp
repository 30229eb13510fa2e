#include "calibration/registration/recording_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <glm/geometric.hpp>

#include "calibration/registration/refusing.h"
#include "calibration/registration/time_unit.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::kDegree;
using registration::number;

constexpr double kFarthestSeen = 200.0; ///< metres
constexpr double kLongestGap = 0.35;    ///< seconds, as poseAt has it
constexpr double kMostAhead = 5.0;      ///< seconds: no body is lost for so long and found where it was
constexpr double kNeighbours = 0.1;     ///< seconds between poses that may be compared
constexpr double kFastestBody = 8.0;    ///< metres a second; hands are slower
constexpr double kJumpAside = 0.08;     ///< metres, at least
constexpr double kJumpRound = 45.0 * kDegree;
constexpr std::size_t kGlitch = 2; ///< poses of somewhere else that may be left out
constexpr double kLate = 0.2;      ///< seconds that a row may come behind another, of programs that share a file
constexpr double kSetBack = 0.05;  ///< seconds that a clock that was set back spoils little
constexpr std::size_t kOften = 5;  ///< runs of late rows: of a second program, whose clock is another
constexpr double kLatest = 1.0;    ///< seconds by which that clock is behind

bool isSound(const TimedPose& at) {
    const Pose& p = at.pose;
    const double sum = at.seconds + p.position.x + p.position.y + p.position.z + p.rotation.w + p.rotation.x +
                       p.rotation.y + p.rotation.z;
    return std::isfinite(sum) && std::abs(glm::length(p.rotation) - 1.0) < 0.02;
}

bool jumps(const TimedPose& from, const TimedPose& to) {
    const double passed = to.seconds - from.seconds;
    if (passed > kNeighbours) return false;
    return glm::distance(from.pose.position, to.pose.position) > std::max(kJumpAside, kFastestBody * passed) ||
           angleOf(glm::conjugate(from.pose.rotation) * to.pose.rotation) > kJumpRound;
}

void checkNumbers(const PoseTrack& track, const std::string& name) {
    if (track.poses.empty())
        registration::refuse(Cause::tooFewPoints, name.c_str(), "nothing was recorded of it",
                             "see that its tracker runs and sees it");
    for (std::size_t i = 0; i < track.poses.size(); ++i) {
        if (!isSound(track.poses[i]))
            registration::refuse(Cause::notANumber, name.c_str(),
                                 "pose " + std::to_string(i + 1) + " holds numbers that are no pose",
                                 "see what the tracker sends while it does not see the body, and record again");
        if (glm::length(track.poses[i].pose.position) > kFarthestSeen)
            registration::refuse(Cause::wrongUnits, name.c_str(), "it is farther than 200 m",
                                 "let the tracker tell metres");
    }
}

/// How far two poses of a body a hand's breadth wide are apart, metres.
double apart(const Pose& a, const Pose& b) {
    constexpr double kReach = 0.1;
    return glm::distance(a.position, b.position) + kReach * angleOf(glm::conjugate(a.rotation) * b.rotation);
}

/// Rows whose time is before that of one written earlier.
struct LateRows {
    std::vector<std::size_t> rows;
    std::size_t runs = 0; ///< of them that follow one another
    double deepest = 0.0; ///< seconds that one of them goes back
    double beside = 0.0;  ///< metres between a late pose and where the others have the body at its time; median
    double moved = 0.0;   ///< metres that the body moved between that time and the row before; median
    /// They are of the times that they bear, as of two senders that share a file; not of a clock that was set back.
    [[nodiscard]] bool fitIn() const { return moved > 0.005 && beside < 0.3 * moved; }
    [[nodiscard]] bool fitInNot() const { return moved > 0.01 && beside > 0.6 * moved; }
};

LateRows lateRowsOf(const PoseTrack& track) {
    LateRows late;
    PoseTrack others;
    for (std::size_t i = 0; i < track.poses.size(); ++i) {
        const TimedPose& at = track.poses[i];
        if (others.poses.empty() || at.seconds > others.poses.back().seconds)
            others.poses.push_back(at);
        else if (at.seconds < others.poses.back().seconds) {
            late.runs += late.rows.empty() || late.rows.back() + 1 < i ? 1 : 0;
            late.rows.push_back(i);
            late.deepest = std::max(late.deepest, others.poses.back().seconds - at.seconds);
        }
    }
    std::vector<double> beside, moved;
    for (const std::size_t i : late.rows) {
        const auto then = poseAt(others, track.poses[i].seconds, std::numeric_limits<double>::infinity());
        if (!then) continue;
        beside.push_back(apart(*then, track.poses[i].pose));
        moved.push_back(apart(*then, track.poses[i - 1].pose));
    }
    late.beside = median(std::move(beside));
    late.moved = median(std::move(moved));
    return late;
}

PoseTrack withoutDoubles(const PoseTrack& track, const std::string& name, std::span<const std::string> places,
                         const std::vector<std::size_t>& order) {
    PoseTrack kept{{}, track.warnings};
    std::size_t doubled = 0, first = 0;
    for (const std::size_t row : order) {
        const TimedPose& at = track.poses[row];
        if (kept.poses.empty() || at.seconds != kept.poses.back().seconds)
            kept.poses.push_back(at);
        else if (doubled++ == 0)
            first = row;
    }
    if (doubled > 0)
        kept.warnings.push_back({Cause::doubledRows,
                                 name,
                                 {},
                                 std::to_string(doubled) + " rows have the time of another, first " +
                                     (places.empty() ? "pose " + std::to_string(first + 1) : places[first]),
                                 "they are left out; record each pose once, with its time to the millisecond"});
    return kept;
}

/// Runs of poses that follow one another without a jump; short ones are glitches.
PoseTrack inOnePlace(PoseTrack track, const std::string& name) {
    std::vector<std::vector<TimedPose>> runs;
    for (const TimedPose& at : track.poses) {
        if (runs.empty() || jumps(runs.back().back(), at)) runs.emplace_back();
        runs.back().push_back(at);
    }
    const std::size_t before = track.poses.size();
    const double begin = track.poses.front().seconds;
    track.poses.clear();
    for (const std::vector<TimedPose>& run : runs) {
        if (run.size() <= kGlitch && runs.size() > 1) continue;
        if (!track.poses.empty() && jumps(track.poses.back(), run.front()))
            registration::refuse(
                Cause::bodySwapped, name.c_str(),
                number(run.front().seconds - begin, 1) + " s after the beginning it is " +
                    number(1000.0 * glm::distance(track.poses.back().pose.position, run.front().pose.position), 0) +
                    " mm away at once",
                "see that the tracker neither swaps bodies nor takes reflections for markers, and "
                "record again");
        track.poses.insert(track.poses.end(), run.begin(), run.end());
    }
    const std::size_t left = before - track.poses.size();
    if (2 * left > before)
        registration::refuse(Cause::bodySwapped, name.c_str(), "it jumps to and fro",
                             "see that the tracker neither swaps bodies nor takes reflections for markers");
    if (left > 0)
        track.warnings.push_back({Cause::bodySwapped,
                                  name,
                                  {},
                                  std::to_string(left) + " single poses are of somewhere else",
                                  "they are left out"});
    return track;
}

/// A gap in which the body moved no farther than between two poses is one of the clock alone.
void checkGaps(const PoseTrack& track, const std::string& name) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < track.poses.size(); ++i)
        steps.push_back(glm::distance(track.poses[i - 1].pose.position, track.poses[i].pose.position));
    const double usual = median(steps);
    for (std::size_t i = 1; i < track.poses.size(); ++i) {
        const double gap = track.poses[i].seconds - track.poses[i - 1].seconds;
        if (gap <= kLongestGap) continue;
        const bool wouldHaveMoved = usual > 0.004;
        if (gap > kMostAhead || (wouldHaveMoved && steps[i - 1] < 3.0 * usual))
            registration::refuse(Cause::clockJumps, name.c_str(),
                                 "its clock goes " + number(gap, 1) + " s ahead at once",
                                 "record again while the tracker's clock runs evenly");
        registration::refuse(Cause::trackerLost, name.c_str(),
                             "the tracker saw nothing of it for " + number(gap, 1) + " s (or its clock jumped)",
                             "keep its markers in sight of the tracker, and record again");
    }
}

Pose mirroredAlongX(const Pose& p) {
    return {{-p.position.x, p.position.y, p.position.z}, {p.rotation.w, p.rotation.x, -p.rotation.y, -p.rotation.z}};
}
Pose mirroredAlongY(const Pose& p) {
    return {{p.position.x, -p.position.y, p.position.z}, {p.rotation.w, -p.rotation.x, p.rotation.y, -p.rotation.z}};
}
Pose mirroredAlongZ(const Pose& p) {
    return {{p.position.x, p.position.y, -p.position.z}, {p.rotation.w, -p.rotation.x, -p.rotation.y, p.rotation.z}};
}
glm::dvec3 same(const glm::dvec3& point) { return point; }

constexpr const char* kLeftHanded = "it fits only as a mirror image: the tracker's coordinates are left-handed";
constexpr const char* kTurnRight = "let the tracker tell right-handed coordinates: for left-handed ones with y up, "
                                   "negate z, qx and qy";

const std::array kFaults{
    CaptureFault{Cause::wrongUnits, "the tracker tells centimetres", "let it tell metres",
                 [](const Pose& p) {
                     return Pose{0.01 * p.position, p.rotation};
                 },
                 same},
    CaptureFault{Cause::wrongUnits, "the tracker tells millimetres", "let it tell metres",
                 [](const Pose& p) {
                     return Pose{0.001 * p.position, p.rotation};
                 },
                 same},
    CaptureFault{Cause::mirrored, kLeftHanded, kTurnRight, mirroredAlongZ, same},
    CaptureFault{Cause::mirrored, kLeftHanded, kTurnRight, mirroredAlongZ,
                 [](const glm::dvec3& p) { return glm::dvec3(p.x, p.y, -p.z); }},
    CaptureFault{Cause::mirrored, kLeftHanded, kTurnRight, mirroredAlongX, same},
    CaptureFault{Cause::mirrored, kLeftHanded, kTurnRight, mirroredAlongY, same},
    CaptureFault{Cause::bodySwapped, "it fits if pointer and body are each other: the tracker takes one for the other",
                 "give the tracker's bodies their names again, and let their markers differ",
                 [](const Pose& p) { return p; }, same, true},
};

} // namespace

PoseTrack inTimeOrder(const PoseTrack& track, const std::string& name, std::span<const std::string> places) {
    std::vector<std::size_t> order(track.poses.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const LateRows late = lateRowsOf(track);
    if (late.rows.empty()) return withoutDoubles(track, name, places, order);
    const std::size_t first = late.rows.front();
    const double back = late.deepest * likelyTimeUnit(track).seconds;
    const bool isOften = late.runs >= kOften && back < kLatest;
    if (late.fitInNot() ? back > kSetBack && !isOften : back > kLate && !late.fitIn())
        registration::refuse(Cause::clockJumps, places.empty() ? name.c_str() : places[first].c_str(),
                             "its clock goes back by " + number(back, 2) + " s",
                             "record again while the tracker's clock runs evenly, or cut the recording there");
    std::string why = std::to_string(late.rows.size()) + " rows stand behind later ones, by up to " +
                      number(1000.0 * back, 0) + " ms, first " +
                      (places.empty() ? "pose " + std::to_string(first + 1) : places[first]);
    std::string remedy = "they were sorted by their times; let one program write the recording";
    if (late.fitInNot()) {
        why += "; they are " + number(1000.0 * late.beside, 0) +
               " mm from where the others have the body then, as by another clock";
        remedy = "they are left out; let one program write the recording";
        std::erase_if(order, [&](std::size_t row) { return std::ranges::binary_search(late.rows, row); });
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t row) { return track.poses[row].seconds; });
    PoseTrack sorted = withoutDoubles(track, name, places, order);
    sorted.warnings.push_back({Cause::rowsOutOfOrder, name, {}, std::move(why), std::move(remedy)});
    return sorted;
}

PoseTrack soundTrack(const PoseTrack& track, const std::string& name) {
    checkNumbers(track, name);
    PoseTrack sound = inOnePlace(inTimeOrder(track, name), name);
    checkGaps(sound, name);
    return sound;
}

std::span<const CaptureFault> captureFaults() { return kFaults; }

PoseTrack withoutFault(PoseTrack track, const CaptureFault& fault) {
    for (TimedPose& at : track.poses) at.pose = fault.pose(at.pose);
    return track;
}

} // namespace lumorph

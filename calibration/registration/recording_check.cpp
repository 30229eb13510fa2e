#include "calibration/registration/recording_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "calibration/registration/refusing.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::kDegree;
using registration::number;

constexpr double kFarthestSeen = 200.0; ///< metres
constexpr double kLongestGap = 0.35;    ///< seconds, as poseAt has it
constexpr double kMostAhead = 5.0;      ///< seconds: no body is lost for so long and found where it was
constexpr double kNeighbours = 0.1;     ///< seconds between poses that may be compared
constexpr double kFastest = 8.0;        ///< metres a second; hands are slower
constexpr double kJumpAside = 0.08;     ///< metres, at least
constexpr double kJumpRound = 45.0 * kDegree;
constexpr std::size_t kGlitch = 2; ///< poses of somewhere else that may be left out

bool isSound(const TimedPose& at) {
    const Pose& p = at.pose;
    const double sum = at.seconds + p.position.x + p.position.y + p.position.z + p.rotation.w + p.rotation.x +
                       p.rotation.y + p.rotation.z;
    return std::isfinite(sum) && std::abs(glm::length(p.rotation) - 1.0) < 0.02;
}

bool jumps(const TimedPose& from, const TimedPose& to) {
    const double passed = to.seconds - from.seconds;
    if (passed > kNeighbours) return false;
    return glm::distance(from.pose.position, to.pose.position) > std::max(kJumpAside, kFastest * passed) ||
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

/// In order and each once.
PoseTrack inOrder(const PoseTrack& track, const std::string& name) {
    PoseTrack kept{{}, track.warnings};
    std::size_t doubled = 0;
    for (const TimedPose& at : track.poses) {
        if (!kept.poses.empty() && at.seconds < kept.poses.back().seconds)
            registration::refuse(Cause::clockJumps, name.c_str(),
                                 "its clock goes back by " + number(kept.poses.back().seconds - at.seconds, 2) + " s",
                                 "record again while the tracker's clock runs evenly");
        if (!kept.poses.empty() && at.seconds == kept.poses.back().seconds)
            ++doubled;
        else
            kept.poses.push_back(at);
    }
    if (doubled > 0)
        kept.warnings.push_back({Cause::doubledRows,
                                 name,
                                 {},
                                 std::to_string(doubled) + " poses have the time of the pose before",
                                 "they are left out; record each pose once"});
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

PoseTrack soundTrack(const PoseTrack& track, const std::string& name) {
    checkNumbers(track, name);
    PoseTrack sound = inOnePlace(inOrder(track, name), name);
    checkGaps(sound, name);
    return sound;
}

std::span<const CaptureFault> captureFaults() { return kFaults; }

PoseTrack withoutFault(PoseTrack track, const CaptureFault& fault) {
    for (TimedPose& at : track.poses) at.pose = fault.pose(at.pose);
    return track;
}

} // namespace lumorph

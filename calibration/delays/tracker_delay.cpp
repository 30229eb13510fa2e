#include "calibration/delays/tracker_delay.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "calibration/registration/clock_offset.h"
#include "calibration/registration/hand_eye.h"
#include "calibration/registration/recording_check.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

constexpr double kSlowestBoard = 0.125; ///< seconds between poses of the camera
constexpr double kTrackSmooth = 0.08;   ///< seconds
constexpr double kLeastTurn = 0.175;    ///< radians
constexpr double kAmbiguous = 0.9;      ///< of the evidence for the best offset

double turnedBy(const PoseTrack& track) {
    double most = 0.0;
    for (const TimedPose& at : track.poses)
        most = std::max(most, angleOf(glm::conjugate(track.poses.front().pose.rotation) * at.pose.rotation));
    return most;
}

/// Without most of the noise, and not shifted: each pose by a parabola through those within kTrackSmooth on both sides.
/// A pose between two others is less noisy than they are, and where the camera keeps step with the tracker a fit would
/// take it for the better one: it would err by some milliseconds.
PoseTrack smoothed(const PoseTrack& track) {
    PoseTrack smooth = track;
    const std::vector<TimedPose>& all = track.poses;
    std::size_t first = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const TimedPose& middle = all[i];
        while (all[first].seconds < middle.seconds - kTrackSmooth) ++first;
        Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
        Eigen::Matrix<double, 3, 6> right = Eigen::Matrix<double, 3, 6>::Zero();
        std::size_t before = 0, after = 0;
        for (std::size_t k = first; k < all.size() && all[k].seconds <= middle.seconds + kTrackSmooth; ++k) {
            const double t = all[k].seconds - middle.seconds, weight = 1.0 - std::abs(t) / (1.05 * kTrackSmooth);
            const glm::dvec3 place = all[k].pose.position - middle.pose.position;
            const glm::dvec3 turn = turnOf(glm::conjugate(middle.pose.rotation) * all[k].pose.rotation);
            const Eigen::Vector3d row(1.0, t, t * t);
            Eigen::Matrix<double, 1, 6> values;
            values << place.x, place.y, place.z, turn.x, turn.y, turn.z;
            normal += weight * row * row.transpose();
            right += weight * row * values;
            ++(k < i ? before : after);
        }
        if (before < 2 || after < 3) continue; // its own counts as after
        const Eigen::Matrix<double, 3, 6> solved = normal.ldlt().solve(right);
        Pose& pose = smooth.poses[i].pose;
        pose.position += glm::dvec3(solved(0, 0), solved(0, 1), solved(0, 2));
        pose.rotation = glm::normalize(pose.rotation * rotationOfTurn({solved(0, 3), solved(0, 4), solved(0, 5)}));
    }
    return smooth;
}

/// Half of the recording may lack a motion that the whole has: nothing is known then.
std::optional<double> halvesDiffer(const PoseTrack& tracked, const PoseTrack& seen, const Progress& progress) {
    PoseTrack early = seen, late = seen;
    const auto middle = static_cast<std::ptrdiff_t>(seen.poses.size() / 2);
    early.poses.erase(early.poses.begin() + middle, early.poses.end());
    late.poses.erase(late.poses.begin(), late.poses.begin() + middle);
    try {
        return std::abs(solveHandEye(tracked, early, progress).timeOffset -
                        solveHandEye(tracked, late, progress).timeOffset);
    } catch (const CaptureRefused&) {
        return std::nullopt;
    }
}

} // namespace

MeasuredDelay solveTrackerDelay(const PoseTrack& tracker, const PoseTrack& camera, const Progress& progress) {
    const char* what = "tracker and camera";
    const PoseTrack tracked = smoothed(soundTrack(tracker, "tracked body")),
                    seen = soundTrack(camera, "body in the camera");
    std::vector<double> steps;
    for (std::size_t i = 1; i < seen.poses.size(); ++i)
        steps.push_back(seen.poses[i].seconds - seen.poses[i - 1].seconds);
    if (steps.size() < 30 || median(steps) > kSlowestBoard)
        delays::refuse(Cause::cameraSlow, what, "the camera finds the body too seldom",
                       "use one that gives 15 pictures a second or more, and more light");
    if (turnedBy(tracked) < kLeastTurn || turnedBy(seen) < kLeastTurn)
        delays::refuse(Cause::nothingMoves, what, "the body is hardly turned",
                       "turn it about all axes before the camera for half a minute, now fast, now slow");
    if (const ClockOffset clocks = clockOffset(tracked, seen); clocks.correlation > 0.3 && clocks.runnerUp > kAmbiguous)
        delays::refuse(Cause::motionPeriodic, what,
                       "the motion repeats itself so evenly that several delays explain it",
                       "turn the body unevenly: now fast, now slow, and about all axes");
    const HandEye joined = solveHandEye(tracked, seen, progress);
    // What the tracker says at a time was seen by the camera before.
    MeasuredDelay delay;
    delay.seconds = -joined.timeOffset;
    if (std::abs(delay.seconds) > kLongestDelay)
        delays::refuse(Cause::clockJumps, what,
                       "tracker and camera go by clocks that differ by more than half a second",
                       "record both by the clock of one machine");
    delay.residual = joined.medianTurn;
    delay.events = static_cast<int>(joined.poses);
    delay.warnings = joined.warnings;
    delay.halvesDiffer = halvesDiffer(tracked, seen, progress);
    delay.sigma = std::max(joined.offsetSigma, 0.5 * delay.halvesDiffer.value_or(0.0));
    return delay;
}

} // namespace lumorph

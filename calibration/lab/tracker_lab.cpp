#include "calibration/lab/tracker_lab.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <opencv2/calib3d.hpp>

#include "calibration/lab/lab_lens.h"

namespace lumorph {

namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kRate = 60.0;                                                    ///< poses a second
constexpr double kCameraRate = 15.0;                                              ///< pictures a second
constexpr double kCornerNoise = 0.15;                                             ///< camera pixels
constexpr double kTilt = 25.0 * kRadians;                                         ///< by which a pointer is held aslant
const Pose kBoardFromBody{{0.04, -0.06, 0.02}, rotationOfTurn({0.4, -0.2, 0.9})}; ///< anyhow

Pose rigidOf(const glm::mat4& m) {
    return {glm::dvec3(m[3]), glm::normalize(glm::quat_cast(glm::dmat3(glm::mat3(m))))};
}

/// A slow wave of amplitude 1.
double wave(double seconds, double speed, double phase) {
    return (std::sin(speed * seconds + phase) + 0.5 * std::sin(1.7 * speed * seconds + 2.0 * phase)) / 1.5;
}

PoseTrack withoutMiddle(PoseTrack track, double seconds) {
    const double middle = 0.5 * (track.poses.front().seconds + track.poses.back().seconds);
    std::erase_if(track.poses, [&](const TimedPose& at) { return std::abs(at.seconds - middle) < 0.5 * seconds; });
    return track;
}

/// A head whose -z looks along `way`, upright.
glm::dquat looking(const glm::dvec3& way) {
    const glm::dvec3 back = -glm::normalize(way);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), back));
    return glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back));
}

constexpr std::pair<const char*, TrackerFault> kTrackerFaults[] = {
    {"drops_out", TrackerFault::dropsOut},
    {"swaps_bodies", TrackerFault::swapsBodies},
    {"clock_jumps_back", TrackerFault::clockJumpsBack},
    {"clock_jumps_ahead", TrackerFault::clockJumpsAhead},
    {"left_handed", TrackerFault::leftHanded},
    {"centimetres", TrackerFault::centimetres},
    {"doubled_rows", TrackerFault::doubledRows},
    {"not_a_number", TrackerFault::notANumber},
};

} // namespace

std::string trackerFaultKeys() {
    std::string keys;
    for (const auto& [key, fault] : kTrackerFaults) keys += (keys.empty() ? "" : ", ") + std::string(key);
    return keys;
}

TrackerFault parseTrackerFault(std::string_view key) {
    for (const auto& [name, fault] : kTrackerFaults)
        if (key == name) return fault;
    throw InvalidInput("fault '" + std::string(key) + "'", "a tracker has no such fault",
                       "choose one of: " + trackerFaultKeys());
}

PoseTrack withFault(PoseTrack track, TrackerFault fault) {
    const std::size_t n = track.poses.size();
    switch (fault) {
    case TrackerFault::none:
        break;
    case TrackerFault::dropsOut:
        return withoutMiddle(std::move(track), 0.6);
    case TrackerFault::swapsBodies:
        for (std::size_t i = n / 3; i < 2 * n / 3; ++i)
            track.poses[i].pose = {track.poses[i].pose.position + glm::dvec3(0.3, 0.1, -0.2),
                                   rotationOfTurn({0.0, 1.7, 0.4}) * track.poses[i].pose.rotation};
        break;
    case TrackerFault::clockJumpsBack:
        for (std::size_t i = n / 2; i < n; ++i) track.poses[i].seconds -= 0.25;
        break;
    case TrackerFault::clockJumpsAhead:
        for (std::size_t i = n / 2; i < n; ++i) track.poses[i].seconds += 60.0;
        break;
    case TrackerFault::leftHanded:
        for (TimedPose& at : track.poses) {
            at.pose.position.z = -at.pose.position.z;
            at.pose.rotation.x = -at.pose.rotation.x;
            at.pose.rotation.y = -at.pose.rotation.y;
        }
        break;
    case TrackerFault::centimetres:
        for (TimedPose& at : track.poses) at.pose.position *= 100.0;
        break;
    case TrackerFault::doubledRows:
        for (std::size_t i = 1; i < n; i += 2) track.poses[i].seconds = track.poses[i - 1].seconds;
        break;
    case TrackerFault::notANumber:
        track.poses[n / 2].pose.position.y = std::numeric_limits<double>::quiet_NaN();
        break;
    }
    return track;
}

TrackerLab::TrackerLab(Installation truth, std::uint32_t seed, const LabErrors& errors, const LabHands& hands,
                       TrackerFault fault)
    : truth_(std::move(truth)), errors_(errors), hands_(hands), fault_(fault), engine_(seed),
      trackerFromWorld_(inverseOf(rigidOf(truth_.worldFromTracker))),
      worldFromDeviceBody_(rigidOf(truth_.worldFromDevice) * inverseOf(rigidOf(truth_.bodyFromDevice))),
      tip_(truth_.pointerTip) {}

glm::dvec3 TrackerLab::dice(double sigma) {
    std::normal_distribution<double> normal(0.0, sigma);
    return {normal(engine_), normal(engine_), normal(engine_)};
}

PoseTrack TrackerLab::record(const Motion& worldFromBody, double seconds, bool pass) {
    PoseTrack track;
    const auto count = static_cast<std::size_t>(seconds * kRate);
    for (std::size_t i = 0; i < count; ++i) {
        const double t = double(i) / kRate;
        // What a tracker stamps with a time, it saw a little before.
        Pose pose = trackerFromWorld_ * worldFromBody(t - truth_.trackerSeconds);
        pose.position += dice(1e-3 * errors_.trackerNoiseMillimetres);
        pose.rotation = glm::normalize(pose.rotation * rotationOfTurn(dice(kRadians * errors_.trackerNoiseDegrees)));
        track.poses.push_back({now_ + t, pose});
    }
    if (pass) now_ += seconds + 1.0;
    return withFault(std::move(track), fault_);
}

TrackerLab::Motion TrackerLab::trembling(const glm::dvec3& place, const glm::dquat& turn) {
    const glm::dvec3 phase = dice(3.0), other = dice(3.0);
    const double tremor = 1e-3 * hands_.tremorMillimetres;
    return [=, tip = tip_](double t) {
        const glm::dvec3 at =
            place + tremor * glm::dvec3(wave(t, 19.0, phase.x), wave(t, 23.0, phase.y), wave(t, 17.0, phase.z));
        const glm::dquat held = turn * rotationOfTurn(0.008 * glm::dvec3(wave(t, 3.0, other.x), wave(t, 2.0, other.y),
                                                                         wave(t, 4.0, other.z)));
        return Pose{at - held * tip, held};
    };
}

PoseTrack TrackerLab::swing(const glm::dvec3& place, double seconds) {
    const glm::dvec3 phase = dice(3.0);
    return record(
        [=, tip = tip_](double t) {
            const glm::dquat turn = rotationOfTurn({0.0, 0.6 * wave(t, 0.7, phase.y), 0.0}) *
                                    rotationOfTurn({0.6 * wave(t, 1.3, phase.x), 0.0, 0.0}) *
                                    rotationOfTurn({0.0, 0.0, 0.6 * wave(t, 1.7, phase.z)});
            return Pose{place - turn * tip, turn};
        },
        seconds);
}

Touch TrackerLab::hold(const std::string& name, const glm::dvec3& place, bool onDevice) {
    const glm::dvec3 way = dice(1.0);
    const glm::dquat turn = rotationOfTurn({0.0, 1.5 * way.y, 0.0}) *
                            rotationOfTurn({kTilt * std::tanh(way.x), 0.0, kTilt * std::tanh(way.z)});
    Touch touch;
    touch.name = name;
    touch.pointer = record(trembling(place, turn), hands_.touchSeconds, !onDevice);
    if (onDevice) touch.body = recordDevice(hands_.touchSeconds);
    return touch;
}

Touch TrackerLab::touchDot(const std::string& name, const glm::dvec3& place) {
    glm::dvec3 beside = dice(1e-3 * hands_.dotMillimetres);
    beside.y *= 0.2; // the table holds the tip
    return hold(name, place + beside, false);
}

Touch TrackerLab::touchDimple(const std::string& name, const glm::dvec3& place) {
    return hold(name, place + dice(1e-4), false);
}

Touch TrackerLab::touchDevice(const std::string& name, const glm::dvec3& onModel) {
    const glm::dvec3 place = rigidOf(truth_.worldFromDevice) * onModel;
    return hold(name, place + dice(1e-3 * hands_.landmarkMillimetres), true);
}

PoseTrack TrackerLab::recordDevice(double seconds) {
    return record([body = worldFromDeviceBody_](double) { return body; }, seconds);
}

Alignment TrackerLab::align(const std::string& name, const glm::dvec3& mark, const glm::dvec3& eye,
                            double turnDegrees) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const double most = kRadians * turnDegrees;
    const glm::dquat head = looking(mark - eye) *
                            rotationOfTurn({most * uniform(engine_), most * uniform(engine_), most * uniform(engine_)});
    const glm::dvec3 aim = dice(hands_.aimPixels / kEyeFocal), phase = dice(3.0);
    const glm::dvec3 aside = glm::normalize(glm::cross(mark - eye, glm::dvec3(0.0, 1.0, 0.0)));
    const glm::dvec3 upwards = glm::normalize(glm::cross(aside, mark - eye));
    const double share = 0.38 + 0.05 * uniform(engine_);
    const glm::dvec3 eyeFromHead(truth_.eyeFromHead);
    const double tremor = 1e-3 * hands_.tremorMillimetres;
    // The eye sways by a millimetre or two, and the hand follows what it sees.
    const auto eyeAt = [=](double t) {
        return eye + 0.0015 * glm::dvec3(wave(t, 2.0, phase.x), wave(t, 2.6, phase.y), wave(t, 1.6, phase.z));
    };
    const auto tipAt = [=](double t) {
        const glm::dvec3 from = eyeAt(t), sight = mark - from;
        return from + share * (sight + glm::length(sight) * (aim.x * aside + aim.y * upwards));
    };
    const glm::dquat held = rotationOfTurn({0.5, 0.3 * phase.x, 0.2});
    Alignment alignment;
    alignment.mark = mark;
    alignment.touch.name = name;
    alignment.touch.pointer = record(
        [&](double t) {
            return Pose{tipAt(t) + tremor * glm::dvec3(wave(t, 19.0, aim.z), wave(t, 23.0, phase.x), 0.0) - held * tip_,
                        held};
        },
        hands_.touchSeconds, false);
    alignment.touch.body = record(
        [&](double t) {
            return Pose{eyeAt(t) - head * eyeFromHead, head};
        },
        hands_.touchSeconds);
    return alignment;
}

Pose TrackerLab::seenBoard(const CalibratedCamera& camera, const std::vector<cv::Point3d>& points,
                           const Pose& worldFromBoard) {
    const LabLens lens = lensOf(camera, "camera of the lab");
    std::normal_distribution<double> noise(0.0, kCornerNoise);
    std::vector<cv::Point3d> seenPoints;
    std::vector<cv::Point2d> pixels;
    for (const cv::Point3d& p : points)
        if (const auto pixel = imageOf(lens, worldFromBoard * glm::dvec3(p.x, p.y, p.z))) {
            seenPoints.push_back(p);
            pixels.emplace_back(pixel->x + noise(engine_), pixel->y + noise(engine_));
        }
    const cv::Matx33d matrix(camera.focal.x, 0.0, camera.principal.x, 0.0, camera.focal.y, camera.principal.y, 0.0, 0.0,
                             1.0);
    const std::vector<double> distortion(camera.distortion.begin(), camera.distortion.end());
    cv::Vec3d turn, way;
    cv::solvePnP(seenPoints, pixels, matrix, distortion, turn, way, false, cv::SOLVEPNP_IPPE);
    cv::solvePnPRefineLM(seenPoints, pixels, matrix, distortion, turn, way);
    const Pose cameraFromBoard{{way[0], way[1], way[2]}, rotationOfTurn({turn[0], turn[1], turn[2]})};
    const Pose cameraFromWorld{glm::dvec3(camera.cameraFromWorld[3]),
                               glm::normalize(glm::quat_cast(glm::dmat3(camera.cameraFromWorld)))};
    return inverseOf(cameraFromWorld) * cameraFromBoard;
}

namespace {

std::vector<cv::Point3d> metresOf(const CalibrationBoard& board, double metresPerUnit) {
    std::vector<cv::Point3d> points = pointsOf(board);
    cv::Point3d mean(0.0, 0.0, 0.0);
    for (const cv::Point3d& p : points) mean += p * (1.0 / double(points.size()));
    for (cv::Point3d& p : points) p = (p - mean) * metresPerUnit;
    return points;
}

} // namespace

BoardCapture TrackerLab::moveBoard(const CalibratedCamera& camera, const CalibrationBoard& board, double metresPerUnit,
                                   const glm::dvec3& turns, double seconds, double clockOffset) {
    const std::vector<cv::Point3d> points = metresOf(board, metresPerUnit);
    const glm::dvec3 phase = dice(3.0), other = dice(3.0);
    // Its printed side towards the camera, more or less.
    const glm::dquat facing = looking(positionOf(camera) - glm::dvec3(0.0, 0.15, 0.0));
    const Motion moved = [=](double t) {
        const glm::dvec3 place(0.1 * wave(t, 0.5, phase.x), 0.15 + 0.06 * wave(t, 0.7, phase.y),
                               0.08 * wave(t, 0.6, phase.z));
        const glm::dquat turn = rotationOfTurn({0.0, turns.y * wave(t, 0.9, other.y), 0.0}) *
                                rotationOfTurn({turns.x * wave(t, 1.2, other.x), 0.0, 0.0}) *
                                rotationOfTurn({0.0, 0.0, turns.z * wave(t, 1.5, other.z)});
        return Pose{place, turn * facing};
    };
    BoardCapture capture;
    const double begin = now_;
    capture.body = record([&](double t) { return moved(t) * kBoardFromBody; }, seconds);
    for (double t = 0.05; t < seconds - 0.1; t += 1.0 / kCameraRate)
        capture.board.poses.push_back(
            {begin + t + clockOffset + truth_.trackerSeconds, seenBoard(camera, points, moved(t))});
    return capture;
}

} // namespace lumorph

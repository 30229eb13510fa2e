#include "calibration/delays/delays_lab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab.h"
#include "calibration/lab/lab_lens.h"
#include "calibration/lab/lab_world.h"
#include "calibration/lab/tracker_lab.h"
#include "calibration/servos/servo_lab.h"
#include "core/base/error.h"
#include "core/scene/measured_servos.h"

namespace lumorph {

namespace {

constexpr std::array<std::string_view, 9> kDelayFaults = {"none",    "frames", "camera", "slow",  "covered",
                                                          "tracker", "still",  "dead",   "jammed"};
constexpr double kLoopRate = 60.0;                     ///< frames a second
constexpr std::size_t kFaultyServo = 1;                ///< the one that is dead or jammed
constexpr double kFlashTop = 0.4, kFlashBottom = 0.55; ///< of the picture's height: the region of the flashes
constexpr int kPathPoints = 65;                        ///< of a part's way through the camera's picture
constexpr double kHidden = 0.003;                      ///< metres by which something else is seen nearer
constexpr std::size_t kMarks = 6;                      ///< points of a part that are followed, at most
constexpr float kMarksApart = 0.008F;                  ///< metres
constexpr double kBeyond = 0.08;                       ///< strokes
constexpr double kFastPath = 30.0;                     ///< camera pixels a stroke that are enough
constexpr double kLeastPath = 10.0;                    ///< camera pixels a stroke

/// The times of a camera's pictures from 0 on: the middle of the exposure of its first row.
std::vector<double> pictureTimes(double seconds, std::uint32_t seed, const DelaysLabOptions& options) {
    std::mt19937 dice(seed);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    const double rate = options.fault == DelayFault::cameraSlow ? 8.0 : options.cameraRate;
    std::vector<double> times;
    const double begin = any(dice) / rate;
    for (int k = 0; begin + k / rate < seconds; ++k) {
        const double t = begin + k / rate + 2e-4 * (any(dice) - 0.5);
        if (options.fault == DelayFault::cameraUnplugged && t > seconds / 3.0) break;
        if (options.fault == DelayFault::framesLost && any(dice) < 1.0 / 6.0) continue;
        times.push_back(t);
    }
    return times;
}

/// A hand: slow waves of several speeds.
glm::dvec3 handAt(double t, const glm::dvec3& phase) {
    return {0.09 * std::sin(2.9 * t + phase.x) + 0.03 * std::sin(5.1 * t + phase.y), 0.01 * std::sin(1.9 * t),
            0.05 * std::sin(2.3 * t + phase.z) + 0.02 * std::sin(4.3 * t + phase.x)};
}

/// Where some points of an actuator's part are in the camera's picture, by strokes from 0 to 1.
using Path = std::vector<std::vector<glm::dvec2>>;

std::vector<TriangleMesh> posesOf(const Rig& rig, std::size_t actuator, const glm::mat4& worldFromDevice) {
    std::vector<TriangleMesh> poses;
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    for (int k = 0; k < kPathPoints; ++k) {
        strokes[actuator] = k / (kPathPoints - 1.0);
        poses.push_back(deformed(rig, strokes));
        for (glm::vec3& point : poses.back().positions) point = glm::vec3(worldFromDevice * glm::vec4(point, 1.0F));
    }
    return poses;
}

/// Empty where one of them leaves the picture.
Path pathOf(const std::vector<TriangleMesh>& poses, const std::vector<std::size_t>& vertices, const LabLens& lens) {
    Path path;
    for (const TriangleMesh& pose : poses) {
        path.emplace_back();
        for (const std::size_t vertex : vertices) {
            const auto pixel = imageOf(lens, glm::dvec3(pose.positions[vertex]));
            if (!pixel || !inImage(lens, *pixel)) return {};
            path.back().push_back(*pixel);
        }
    }
    return path;
}

/// Of the path's points between two strokes.
std::pair<std::size_t, std::size_t> pointsOf(const Path& path, const StepRange& range) {
    const double last = double(path.size() - 1);
    return {static_cast<std::size_t>(std::floor(std::max(0.0, range.low) * last)),
            static_cast<std::size_t>(std::ceil(std::min(1.0, range.high) * last))};
}

/// Pixels a stroke where points go slowest, all together.
double slowestOf(const Path& path, const StepRange& range) {
    if (path.empty()) return 0.0;
    double slowest = HUGE_VAL;
    const auto [first, last] = pointsOf(path, range);
    for (std::size_t k = first; k < last; ++k) {
        double square = 0.0;
        for (std::size_t m = 0; m < path[k].size(); ++m) {
            const glm::dvec2 way = path[k + 1][m] - path[k][m];
            square += glm::dot(way, way);
        }
        slowest = std::min(slowest, std::sqrt(square) * double(path.size() - 1));
    }
    return slowest;
}

/// Pixels that a point goes in all.
double lengthOf(const Path& path) {
    double length = 0.0;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) length += glm::distance(path[k].front(), path[k + 1].front());
    return length;
}

Lab labOf(const TriangleMesh& pose, const Installation& room) {
    LabWorld world;
    world.surfaces = {{pose, glm::vec3(1.0F)}};
    world.projectors = {{room.projectors.front(), Image(room.projectors.front().camera.size)}};
    return Lab(std::move(world));
}

/// The points of an actuator's part whose way the camera sees best, apart from one another; none where it sees none.
std::vector<std::size_t> marksOf(const std::vector<TriangleMesh>& poses, const Installation& room,
                                 const CalibratedCamera& camera) {
    const LabLens lens = lensOf(camera, "camera of the lab");
    std::vector<std::pair<double, std::size_t>> ways;
    const std::vector<glm::vec3>&rest = poses.front().positions, &end = poses.back().positions;
    for (std::size_t v = 0; v < rest.size(); ++v)
        if (glm::distance(rest[v], end[v]) > 0.002F) ways.emplace_back(-lengthOf(pathOf(poses, {v}, lens)), v);
    std::ranges::sort(ways);
    const std::size_t middle = poses.size() / 2, last = poses.size() - 1;
    std::vector<Lab> labs;
    for (const std::size_t k : {std::size_t{0}, middle, last}) labs.push_back(labOf(poses[k], room));
    const glm::dvec3 eye = positionOf(camera);
    const auto seen = [&](std::size_t v) {
        for (std::size_t k = 0; k < labs.size(); ++k) {
            const glm::dvec3 place(poses[k == 0 ? 0 : k == 1 ? middle : last].positions[v]);
            const auto hit = labs[k].trace(eye, glm::normalize(place - eye));
            if (hit && glm::distance(eye, hit->point) < glm::distance(eye, place) - kHidden) return false;
        }
        return true;
    };
    std::vector<std::size_t> marks;
    for (const auto& [way, v] : ways) {
        if (-way < kLeastPath || marks.size() == kMarks) break;
        const bool apart = std::ranges::none_of(
            marks, [&, v = v](std::size_t mark) { return glm::distance(rest[mark], rest[v]) < kMarksApart; });
        if (apart && seen(v)) marks.push_back(v);
    }
    return marks;
}

std::vector<glm::dvec2> pixelsAt(const Path& path, double stroke) {
    const double at = std::clamp(stroke, 0.0, 1.0) * double(path.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), path.size() - 2);
    std::vector<glm::dvec2> pixels;
    for (std::size_t m = 0; m < path[low].size(); ++m)
        pixels.push_back(glm::mix(path[low][m], path[low + 1][m], at - double(low)));
    return pixels;
}

/// Where a part that comes towards the camera hardly moves in its picture, or goes back, no stroke can be told: steps
/// stay within the rest of its range. None where that is too little.
std::optional<StepRange> rangeOf(const Path& path) {
    if (const StepRange whole; slowestOf(path, whole) >= kFastPath) return whole;
    std::optional<StepRange> best;
    double most = kLeastPath;
    for (double low = 0.1; low < 0.47; low += 0.05) {
        const StepRange range{low, low + 0.5};
        const double slowest = slowestOf(path, {range.low - kBeyond, range.high + kBeyond});
        if (slowest <= most) continue;
        most = slowest;
        best = range;
    }
    return best;
}

/// The stroke in this range, or a little beyond, at which the points are nearest to where they were seen.
double strokeAt(const Path& path, const StepRange& range, const std::vector<glm::dvec2>& pixels) {
    double least = HUGE_VAL, stroke = 0.0;
    const auto [first, last] = pointsOf(path, {range.low - kBeyond, range.high + kBeyond});
    for (std::size_t k = first; k < last; ++k) {
        double along = 0.0, length = 0.0, off = 0.0;
        for (std::size_t m = 0; m < pixels.size(); ++m) {
            const glm::dvec2 way = path[k + 1][m] - path[k][m];
            along += glm::dot(pixels[m] - path[k][m], way);
            length += glm::dot(way, way);
        }
        // Noise beyond the ends is noise all the same: cut off, it would shift where the part rests.
        const double share =
            std::clamp(length > 0.0 ? along / length : 0.0, k == first ? -5.0 : 0.0, k + 1 == last ? 5.0 : 1.0);
        for (std::size_t m = 0; m < pixels.size(); ++m) {
            const glm::dvec2 beside = pixels[m] - glm::mix(path[k][m], path[k + 1][m], share);
            off += glm::dot(beside, beside);
        }
        if (off >= least) continue;
        least = off;
        stroke = (double(k) + share) / double(path.size() - 1);
    }
    return stroke;
}

/// A horn with a dead time and a speed, and the part on it by the servo's true curve.
class StepServo {
public:
    StepServo(MeasuredServo servo, double velocity, DelayFault fault)
        : servo_(std::move(servo)), velocity_(velocity), fault_(fault) {}
    /// Times must rise. Gives the part's stroke.
    double at(double seconds, const std::vector<StepRecording::Step>& steps) {
        constexpr double kStep = 0.0005;
        for (; now_ < seconds; now_ += kStep) {
            while (next_ < steps.size() && steps[next_].seconds + servo_.lagSeconds <= now_)
                target_ = steps[next_++].commanded;
            horn_ += std::clamp(target_ - horn_, -velocity_ * kStep, velocity_ * kStep);
            part_ = realStroke(servo_, horn_, part_);
            if (fault_ == DelayFault::servoJammed) part_ = std::min(part_, kLabStop);
        }
        return fault_ == DelayFault::servoDead ? 0.0 : part_;
    }

private:
    MeasuredServo servo_;
    double velocity_;
    DelayFault fault_;
    double now_ = 0.0, target_ = 0.0, horn_ = 0.0, part_ = 0.0;
    std::size_t next_ = 0;
};

StepRecording stepInLab(const Actuator& actuator, const MeasuredServo& truth, const Path& seen, const StepRange& range,
                        const Path& real, std::uint32_t seed, DelayFault fault, const DelaysLabOptions& options) {
    StepRecording recording;
    recording.servo = actuator.name;
    recording.steps = planSteps(actuator.maxVelocity, 0.2, seed, range, options.stepRounds);
    const double end = recording.steps.back().seconds + restAfter(0.4, actuator.maxVelocity) / 0.75;
    std::mt19937 dice(seed + 5U);
    std::normal_distribution<double> noise(0.0, options.pixelNoise);
    StepServo servo(truth, actuator.maxVelocity, fault);
    for (const double t : pictureTimes(end, seed + 3U, options)) {
        std::vector<glm::dvec2> pixels = pixelsAt(real, servo.at(t, recording.steps));
        for (glm::dvec2& pixel : pixels) pixel += glm::dvec2(noise(dice), noise(dice));
        recording.samples.push_back({t, strokeAt(seen, range, pixels)});
    }
    return recording;
}

/// One servo after the other. Those whose part the camera does not see are left out.
std::vector<StepRecording> recordStepsInLab(const Rig& rig, const Installation& believed, const Installation& truth,
                                            std::uint32_t seed, const Progress& progress,
                                            const DelaysLabOptions& options) {
    std::vector<StepRecording> recordings;
    const CalibratedCamera camera = labCamera(believed);
    const LabLens lens = lensOf(camera, "camera of the lab"), real = lensOf(labCamera(truth), "camera of the lab");
    for (std::size_t i = 0; i < rig.actuatorCount(); ++i) {
        progress.throwIfCancelled();
        progress.report(double(i) / double(rig.actuatorCount()), "hands off: the servos move");
        const std::vector<TriangleMesh> poses = posesOf(rig, i, believed.worldFromDevice);
        const std::vector<std::size_t> marks = marksOf(poses, believed, camera);
        if (marks.empty()) continue;
        const Path seen = pathOf(poses, marks, lens);
        const std::optional<StepRange> range = rangeOf(seen);
        if (!range) continue;
        const Actuator& actuator = rig.actuators()[i];
        const auto found = std::ranges::find(truth.servos, actuator.name, &MeasuredServo::actuator);
        const MeasuredServo servo = found == truth.servos.end() ? MeasuredServo{actuator.name, {}, 0.0} : *found;
        const Path way = pathOf(posesOf(rig, i, truth.worldFromDevice), marks, real);
        if (way.empty()) continue;
        const bool faulty =
            i == std::min(kFaultyServo, rig.actuatorCount() - 1) || options.fault < DelayFault::servoDead;
        recordings.push_back(stepInLab(actuator, servo, seen, *range, way, seed + 100U * static_cast<std::uint32_t>(i),
                                       faulty ? options.fault : DelayFault::none, options));
    }
    return recordings;
}

} // namespace

DelayFault parseDelayFault(std::string_view text) {
    const auto found = std::ranges::find(kDelayFaults, text);
    if (found == kDelayFaults.end() || found == kDelayFaults.begin())
        throw InvalidInput("fault \"" + std::string(text) + "\"", "measuring delays has no such fault",
                           "use frames, camera, slow, covered, tracker, still, dead or jammed");
    return static_cast<DelayFault>(found - kDelayFaults.begin());
}

FlashRecording recordFlashesInLab(const Installation& truth, std::uint32_t seed, const DelaysLabOptions& options) {
    FlashRecording recording;
    recording.exposure = options.exposure;
    recording.firstRow = kFlashTop * options.readout;
    recording.lastRow = kFlashBottom * options.readout;
    // Light is asked for by frames of the loop.
    recording.flashes = planFlashes(options.flashes, 0.5, seed);
    for (FlashRecording::Flash& flash : recording.flashes) {
        flash.on = std::ceil(flash.on * kLoopRate) / kLoopRate;
        flash.off = std::ceil(flash.off * kLoopRate) / kLoopRate;
    }
    std::mt19937 dice(seed + 1U);
    std::normal_distribution<double> normal;
    std::vector<FlashRecording::Flash> lit;
    for (const FlashRecording::Flash& flash : recording.flashes)
        lit.push_back({flash.on + truth.predictionSeconds + options.pacingSeconds * normal(dice),
                       flash.off + truth.predictionSeconds + options.pacingSeconds * normal(dice)});
    constexpr int kRows = 15;
    for (const double t : pictureTimes(recording.flashes.back().off + 0.6, seed + 2U, options)) {
        double share = 0.0;
        for (int row = 0; row < kRows; ++row) {
            const double from = t + options.readout * (kFlashTop + (kFlashBottom - kFlashTop) * (row + 0.5) / kRows);
            for (const FlashRecording::Flash& light : lit)
                share += std::max(0.0, std::min(from + options.exposure, light.off) - std::max(from, light.on));
        }
        share /= kRows * options.exposure;
        if (options.fault == DelayFault::lightCovered) share = 0.0;
        recording.pictures.push_back(
            {t, 24.0 + 0.6 * std::sin(0.8 * t) + 150.0 * (share + options.brightnessNoise * normal(dice))});
    }
    return recording;
}

MarkRecording recordMarkInLab(const Installation& truth, std::uint32_t seed, const DelaysLabOptions& options) {
    std::mt19937 dice(seed + 21U);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> any(0.0, 2.0 * std::numbers::pi);
    const auto noise = [&](double sigma) { return sigma * glm::dvec3(normal(dice), normal(dice), normal(dice)); };
    const glm::dvec3 phase(any(dice), any(dice), any(dice));
    const bool still = options.fault == DelayFault::nothingMoves;
    const auto bodyAt = [&](double t) { return still ? glm::dvec3(0.0) : handAt(t, phase); };
    // What the loop makes of the tracker's poses without looking ahead: the places of its marks, by frames.
    PoseStream stream;
    std::vector<glm::dvec3> marks;
    const double begin = -1.0; // the filter is at work before one looks
    const auto frames = static_cast<std::size_t>((options.markSeconds - begin) * kLoopRate);
    for (std::size_t k = 0; k < frames; ++k) {
        const double stamped = begin + double(k) / kLoopRate;
        const Pose pose{bodyAt(stamped - truth.trackerSeconds) + noise(1e-3 * options.errors.trackerNoiseMillimetres),
                        {1.0, 0.0, 0.0, 0.0}};
        const Microseconds time(std::llround(1e6 * (stamped + 2.0)));
        stream.push({time, true, pose});
        marks.push_back(stream.at(time, time).value_or(pose).position);
    }
    MarkRecording recording;
    recording.shownSeconds = 1.0 / kLoopRate;
    const glm::dvec3 beside(0.03, 0.0, -0.02);
    for (const double t : pictureTimes(options.markSeconds - 0.2, seed + 22U, options)) {
        const double frame = (t - truth.predictionSeconds - begin) * kLoopRate;
        const auto shown = static_cast<std::size_t>(std::clamp(frame, 0.0, double(marks.size() - 1)));
        recording.pictures.push_back({t, bodyAt(t) + noise(0.0003), marks[shown] + beside + noise(0.0003)});
    }
    return recording;
}

DelaysCapture captureDelaysInLab(const Rig& rig, const Installation& believed, const Installation& truth,
                                 std::uint32_t seed, const Progress& progress, const DelaysLabOptions& options) {
    const auto begin = [&](double share, const char* stage) {
        progress.throwIfCancelled();
        progress.report(share, stage);
    };
    (void)labCamera(believed); // throws without a projector
    DelaysCapture capture;
    begin(0.0, "flashing");
    capture.flashes = recordFlashesInLab(truth, seed, options);
    begin(0.1, "moving a body that a mark follows");
    capture.mark = recordMarkInLab(truth, seed, options);
    begin(0.2, "moving a board before tracker and camera");
    const TrackerFault fault =
        options.fault == DelayFault::trackerDropsOut ? TrackerFault::dropsOut : TrackerFault::none;
    TrackerLab lab(truth, seed + 11U, options.errors, {}, fault);
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:20");
    // Both by this machine's clock: a pose of the tracker is older than it says, one of the camera is not.
    BoardCapture turned =
        lab.moveBoard(labCamera(truth), board, 0.001, glm::dvec3(0.5), options.boardSeconds, -truth.trackerSeconds);
    capture.tracked = std::move(turned.body);
    capture.seen = std::move(turned.board);
    capture.seconds = capture.flashes.flashes.back().off + options.markSeconds + options.boardSeconds;
    begin(0.4, "hands off: the servos move");
    if (rig.actuatorCount() > kMostSteppedServos) return capture;
    capture.steps = recordStepsInLab(rig, believed, truth, seed, progress.part(0.4, 1.0), options);
    for (const StepRecording& steps : capture.steps) capture.seconds += steps.steps.back().seconds;
    return capture;
}

PredictionGain slipInLab(const Installation& believed, const Installation& truth, std::uint32_t seed) {
    const LabErrors errors;
    CarriedDevice carried;
    carried.noiseMetres = 1e-3 * errors.trackerNoiseMillimetres;
    carried.noiseRadians = errors.trackerNoiseDegrees * std::numbers::pi / 180.0;
    carried.seed = seed;
    return predictionGain(believed, truth, carried);
}

} // namespace lumorph

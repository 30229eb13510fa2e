#include "calibration/registration/registration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "calibration/registration/hand_eye.h"
#include "calibration/registration/landmarks.h"
#include "calibration/registration/pivot.h"
#include "calibration/registration/refusing.h"
#include "calibration/registration/surface_fit.h"
#include "core/scene/measured_sigma.h"

namespace lumorph {

namespace {

using registration::Figures;
using registration::FittedPlace;
using registration::kDegree;
using registration::number;
using registration::TipRow;

// What fresh points may be off, metres RMS. They are touched no better than the others, so this is more than what the
// figures are good for.
constexpr double kFreshTip = 0.0015, kFreshTracker = 0.0025, kFreshBoard = 0.006, kFreshDevice = 0.002,
                 kFreshEye = 0.01;
// How well a tip is known along each axis, metres: one that was measured but not said how well, and one that was typed
// in. A pivot believes too much of itself where neighbouring poses err alike for long.
constexpr double kUsualTip = 0.0002, kEnteredTip = 0.001, kLeastTip = 5e-5;
constexpr double kRecordedSigma =
    0.0005;                           ///< metres: how well a point is met by a tip that rests on it, tracker and all
constexpr std::size_t kHeldShare = 4; ///< of recorded touches, one in so many is a check point
constexpr std::size_t kFewestRecorded = 7; // four to solve by, and three
constexpr double kTable = 0.004;           ///< metres over the table from which on a point may be of the device
constexpr std::size_t kFreshShare = 5;     ///< of a board's recording, one in so many is kept for the fresh points
constexpr std::size_t kFreshBoards = 8;

std::string mm(double metres) { return number(1000.0 * metres, 2) + " mm"; }

glm::mat4 matrix(const Pose& pose) { return glm::mat4(matrixOf(pose)); }
Pose poseOf(const glm::mat4& rigid) {
    return {glm::dvec3(rigid[3]), glm::normalize(glm::quat_cast(glm::dmat3(glm::mat3(rigid))))};
}
Figures figuresIn(const Installation& room) {
    return {poseOf(room.worldFromTracker), glm::dvec3(room.pointerTip), poseOf(room.bodyFromDevice),
            glm::dvec3(room.eyeFromHead)};
}

/// The tip that is believed, and how well it is known along each axis.
TipRow tipOf(const Installation& room, const glm::dvec3& tip) {
    const Origin& origin = room.origins.pointer;
    const double said = sigmaOf(origin).metres / std::numbers::sqrt3;
    const double sigma = !origin.isCalibrated() ? kEnteredTip : said > 0.0 ? std::max(said, kLeastTip) : kUsualTip;
    return {tip, glm::dvec3(sigma)};
}

/// How well tip and tracker are known for lines of sight. A tracker that was not measured has no sigma to carry.
SightBase sightBaseOf(const Installation& room, const glm::dvec3& tip) {
    SightBase base{tipOf(room, tip)};
    const Origin& tracker = room.origins.tracker;
    if (!tracker.isCalibrated()) return base;
    const MeasuredSigma said = sigmaOf(tracker);
    base.trackerShift = said.metres / std::numbers::sqrt3;
    base.trackerTurn = said.radians / std::numbers::sqrt3;
    if (tracker.date < room.origins.pointer.date) return base; // another tip
    const double shared = std::min(said.tipMetres / std::numbers::sqrt3, base.trackerShift);
    base.tipShare = std::min(1.0, shared / base.tip.sigma.x);
    base.trackerShift = std::sqrt(base.trackerShift * base.trackerShift - shared * shared);
    return base;
}

/// Runs a registration as a whole or not at all: what is refused leaves the installation as it was.
template <typename Work> Registration orRefusal(const Installation& believed, const Work& work) {
    Registration result;
    result.installation = believed;
    try {
        work(result);
    } catch (const CaptureRefused& refused) {
        Registration nothing;
        nothing.installation = believed;
        nothing.refusal = refused.finding();
        nothing.summary = sentenceOf(refused.finding());
        return nothing;
    }
    return result;
}

/// The same, where a fault that all poses share is named in place of what it leads to; `work` undoes the one given.
template <typename Work> Registration orNamedFault(const char* what, const Installation& believed, const Work& work) {
    return orRefusal(believed, [&](Registration& result) {
        result = orNamed(what, [&](const CaptureFault* undo) {
            Registration one = result;
            work(undo, one);
            return one;
        });
    });
}

std::string worthOf(const Registration& result) {
    return std::to_string(result.fresh.points.size()) + " check points that the fit never saw lie " +
           mm(result.fresh.rms) + " off (RMS), the worst " + mm(result.fresh.worst);
}

Origin measured(std::string method, const MeasuredSigma& sigma) {
    return {Origin::Way::measured, withSigma(std::move(method), sigma), utcDate()};
}
Origin measured(std::string method, const Registration& result) {
    return measured(std::move(method), {result.shiftSigma, result.turnSigma, 0.0, result.tipSigma});
}

void take(Registration& result, FittedPlace place) {
    result.rms = place.rms;
    result.points = std::move(place.points);
    result.turnSigma = place.turnSigma;
    result.shiftSigma = place.shiftSigma;
    result.tipSigma = place.tipSigma;
    result.warnings = std::move(place.warnings);
}

/// Errors of rows that no fit saw.
template <typename AnyRows> std::vector<PointError> errorsOf(const AnyRows& fresh, const Figures& figures) {
    std::vector<PointError> errors;
    for (std::size_t i = 0; i < fresh.rows.size(); ++i)
        errors.push_back({fresh.names[i], registration::missOf(fresh.rows[i], figures)});
    return errors;
}

// A pointer.

/// Where the tip should be is unknown at a fresh dimple; that it is one place is not. Of n touches the mean takes part
/// of each error, which the factor gives back.
std::vector<PointError> dimpleErrors(const PointerCapture& capture, const glm::dvec3& tip,
                                     std::vector<Finding>& warnings) {
    std::vector<PointError> errors;
    for (const std::vector<Touch>& dimple : capture.fresh) {
        if (dimple.size() < 2) continue; // alone it tells nothing
        std::vector<glm::dvec3> places;
        glm::dvec3 mean(0.0);
        for (const Touch& touch : dimple) {
            const Rest rest = restOf(touch, tip);
            warnings.insert(warnings.end(), rest.warnings.begin(), rest.warnings.end());
            places.push_back(rest.pointer * tip);
            mean += places.back() / double(dimple.size());
        }
        double squares = 0.0;
        for (const glm::dvec3& place : places) squares += glm::dot(place - mean, place - mean);
        errors.push_back({dimple.front().name, std::sqrt(squares / double(places.size() - 1))});
    }
    return errors;
}

void solvePointer(const PointerCapture& capture, Registration& result) {
    const Pivot pivot = solvePivot(soundTrack(capture.swings, "swings of the pointer"));
    result.warnings = pivot.warnings;
    result.rms = pivot.rms;
    result.shiftSigma = glm::length(pivot.tipSigma);
    result.fresh = checkFresh(dimpleErrors(capture, pivot.tip, result.warnings), kFreshTip);
    result.installation.pointerTip = glm::vec3(pivot.tip);
    result.installation.origins.pointer = measured("pivoting, " + std::to_string(pivot.poses) + " poses", result);
    result.summary = "The pointer's tip is known to " + mm(result.shiftSigma) + "; " + worthOf(result) + ".";
}

// The tracker.

void keepTracker(Registration& result, const Pose& worldFromTracker, std::string method) {
    result.installation.worldFromTracker = matrix(worldFromTracker);
    result.installation.origins.tracker = measured(std::move(method), result);
    result.summary = "The tracker's world lies in the room's to " + mm(result.shiftSigma) + " and " +
                     number(result.turnSigma / kDegree, 2) + " degrees; " + worthOf(result) + ".";
}

void solveDots(const DotCapture& capture, const CaptureFault* undo, const Progress& progress, Registration& result) {
    const Installation& room = result.installation;
    const glm::dvec3 tip = withoutFault(glm::dvec3(room.pointerTip), undo);
    FittedPlace place =
        placeTracker(rowsOf(capture.dots, room, tip, capture.tableHeight, undo), tipOf(room, tip), progress);
    const Figures figures = place.figures;
    take(result, std::move(place));
    result.fresh =
        checkFresh(errorsOf(rowsOf(capture.fresh, room, tip, capture.tableHeight, undo), figures), kFreshTracker);
    keepTracker(result, figures.worldFromTracker, "touched dots, " + std::to_string(capture.dots.size()));
}

/// Moments of the board that the fit never saw: how far the tracker has it from where the camera does.
std::vector<PointError> boardErrors(const HandEye& joint, const PoseTrack& body, const PoseTrack& board,
                                    std::size_t from) {
    std::vector<PointError> errors;
    const std::size_t count = board.poses.size() - from;
    for (std::size_t k = 0; k < kFreshBoards; ++k) {
        // The mean of a stretch: a single view of a board is worse than what is judged by it.
        glm::dvec3 off(0.0);
        double views = 0.0;
        for (std::size_t i = from + k * count / kFreshBoards; i < from + (k + 1) * count / kFreshBoards; ++i)
            if (const auto at = poseAt(body, joint.toA(board.poses[i].seconds))) {
                const Pose told = joint.worldBFromWorldA * *at * inverseOf(joint.bFromA);
                off += told.position - board.poses[i].pose.position;
                views += 1.0;
            }
        if (views > 0.0) errors.push_back({"view " + std::to_string(k + 1), glm::length(off / views)});
    }
    return errors;
}

void solveBoard(const BoardCapture& capture, const CaptureFault* undo, const Progress& progress, Registration& result) {
    const PoseTrack body = soundTrack(undo ? withoutFault(capture.body, *undo) : capture.body, "body of the board");
    const PoseTrack board = soundTrack(capture.board, "board before the camera");
    const std::size_t used = board.poses.size() - board.poses.size() / kFreshShare;
    PoseTrack seen = board;
    seen.poses.resize(used);
    const HandEye joint = solveHandEye(body, seen, progress);
    result.rms = joint.medianShift;
    result.turnSigma = joint.turnSigma;
    result.shiftSigma = joint.shiftSigma;
    result.warnings = joint.warnings;
    result.fresh = checkFresh(boardErrors(joint, body, board, used), kFreshBoard);
    keepTracker(result, joint.worldBFromWorldA, "tracked board, " + std::to_string(joint.poses) + " views");
}

// The device.

void keepDevice(Registration& result, const Pose& bodyFromDevice, std::string method) {
    result.installation.bodyFromDevice = matrix(bodyFromDevice);
    result.installation.origins.deviceBody = measured(std::move(method), result);
    result.summary = "The device lies on its body to " + mm(result.shiftSigma) + " and " +
                     number(result.turnSigma / kDegree, 2) + " degrees; " + worthOf(result) + ".";
}

void judgeDevice(FittedPlace place, const std::vector<TouchedLandmark>& fresh, const CaptureFault* undo,
                 std::string method, Registration& result) {
    const glm::dvec3 tip = withoutFault(glm::dvec3(result.installation.pointerTip), undo);
    Figures figures = place.figures;
    figures.tip = tip;
    take(result, std::move(place));
    result.fresh = checkFresh(errorsOf(rowsOf(fresh, tip, undo), figures), kFreshDevice);
    keepDevice(result, figures.bodyFromDevice, std::move(method));
}

void solveLandmarks(const LandmarkCapture& capture, const CaptureFault* undo, const Progress& progress,
                    Registration& result) {
    const glm::dvec3 tip = withoutFault(glm::dvec3(result.installation.pointerTip), undo);
    judgeDevice(placeDevice(rowsOf(capture.touches, tip, undo), tipOf(result.installation, tip), progress),
                capture.fresh, undo, "touched points, " + std::to_string(capture.touches.size()), result);
}

/// Which of so many points are held out: spread evenly, by nothing but their order.
std::vector<bool> heldOutOf(std::size_t count) {
    const std::size_t held = std::max(FreshCheck::kFewest, count / kHeldShare);
    std::vector<bool> out(count, false);
    for (std::size_t k = 0; k < held; ++k) out[(2 * k + 1) * count / (2 * held)] = true;
    return out;
}

void solveRecorded(const RecordedLandmarks& capture, const Progress& progress, Registration& result) {
    const glm::dvec3 tip(result.installation.pointerTip);
    LandmarkFit found = fitLandmarks(capture.pointer, capture.body, capture.model, tip);
    std::erase_if(found.points, [](const Landmark& point) { return !point.touched; });
    const std::size_t count = found.points.size();
    if (count < kFewestRecorded)
        registration::refuse(Cause::tooFewPoints, "touched points",
                             std::to_string(count) + " points are too few to hold out three of them as check points",
                             "name and touch seven or more");
    const std::vector<bool> isHeldOut = heldOutOf(count);
    LandmarkRows fitted, held;
    for (std::size_t i = 0; i < count; ++i) {
        const Landmark& point = found.points[i];
        LandmarkRows& rows = isHeldOut[i] ? held : fitted;
        rows.rows.push_back({point.pointer, point.onModel, kRecordedSigma});
        rows.outward.emplace_back();
        rows.names.push_back(point.name);
    }
    FittedPlace place = placeDevice(fitted, tipOf(result.installation, tip), progress);
    Figures figures = place.figures;
    figures.tip = tip;
    take(result, std::move(place));
    result.warnings.insert(result.warnings.end(), found.warnings.begin(), found.warnings.end());
    result.fresh = checkFresh(errorsOf(held, figures), kFreshDevice);
    keepDevice(result, figures.bodyFromDevice, "recorded touches, " + std::to_string(fitted.rows.size()) + " points");
}

/// Where the device lies as far as is known.
Pose startOf(const SurfaceCapture& capture, const Installation& room, const Figures& figures) {
    if (!room.origins.deviceBody.isCalibrated() || capture.body.poses.empty()) return poseOf(room.worldFromDevice);
    return figures.worldFromTracker * capture.body.poses.front().pose * figures.bodyFromDevice;
}

void solveSurface(const SurfaceCapture& capture, const CaptureFault* undo, const Progress& progress,
                  Registration& result) {
    const Figures figures = figuresIn(result.installation);
    SurfaceCapture right = capture;
    if (undo) right.body = withoutFault(capture.body, *undo);
    right.body = soundTrack(right.body, "body of the device");
    std::vector<glm::dvec3> above;
    std::ranges::copy_if(capture.points, std::back_inserter(above),
                         [](const glm::dvec3& p) { return !(p.y < kTable); });
    const SurfaceFit fit =
        fitSurface(capture.model, above, capture.seenFrom, startOf(right, result.installation, figures), progress);
    judgeDevice(placeDeviceBySurface(fit, right.body, figures.worldFromTracker), capture.fresh, undo,
                "structured light, " + std::to_string(above.size()) + " points", result);
}

// The eye.

void solveEye(const EyeCapture& capture, const CaptureFault* undo, const Progress& progress, Registration& result) {
    Figures figures = figuresIn(result.installation);
    figures.tip = withoutFault(figures.tip, undo);
    EyePlace place = placeEye(rowsOf(capture.alignments, figures.tip, undo), figures.worldFromTracker,
                              sightBaseOf(result.installation, figures.tip), progress);
    figures.eyeFromHead = place.eyeFromHead;
    result.rms = place.rms;
    result.points = std::move(place.points);
    result.shiftSigma = glm::length(place.sigma);
    result.tipSigma = place.tipSigma;
    result.warnings = std::move(place.warnings);
    result.fresh = checkFresh(errorsOf(rowsOf(capture.fresh, figures.tip, undo), figures), kFreshEye);
    result.installation.eyeFromHead = glm::vec3(figures.eyeFromHead);
    result.installation.origins.eyeOffset =
        measured("alignments, " + std::to_string(capture.alignments.size()), result);
    result.summary = "The eye is known to " + mm(result.shiftSigma) + "; " + worthOf(result) + ".";
}

} // namespace

Registration registerPointer(const PointerCapture& capture, const Installation& believed, const Progress& progress) {
    progress.report(0.0, "the pointer's tip");
    return orRefusal(believed, [&](Registration& result) { solvePointer(capture, result); });
}

Registration registerTracker(const DotCapture& capture, const Installation& believed, const Progress& progress) {
    progress.report(0.0, "the tracker in the room");
    return orNamedFault("touched dots", believed, [&](const CaptureFault* undo, Registration& result) {
        solveDots(capture, undo, progress, result);
    });
}

Registration registerTracker(const BoardCapture& capture, const Installation& believed, const Progress& progress) {
    progress.report(0.0, "the tracker in the room");
    return orNamedFault("tracked board", believed, [&](const CaptureFault* undo, Registration& result) {
        solveBoard(capture, undo, progress, result);
    });
}

Registration registerDevice(const LandmarkCapture& capture, const Installation& believed, const Progress& progress) {
    progress.report(0.0, "the device on its body");
    return orNamedFault("touched points of the device", believed, [&](const CaptureFault* undo, Registration& result) {
        solveLandmarks(capture, undo, progress, result);
    });
}

Registration registerDevice(const RecordedLandmarks& capture, const Installation& believed, const Progress& progress) {
    progress.report(0.0, "finding which point is which");
    return orRefusal(believed, [&](Registration& result) { solveRecorded(capture, progress, result); });
}

Registration registerDevice(const SurfaceCapture& capture, const Installation& believed, const Progress& progress) {
    return orNamedFault("the device's surface", believed, [&](const CaptureFault* undo, Registration& result) {
        solveSurface(capture, undo, progress, result);
    });
}

Registration registerEye(const EyeCapture& capture, const Installation& believed, const Progress& progress) {
    progress.report(0.0, "the eye in its head");
    return orNamedFault("alignments of the eye", believed, [&](const CaptureFault* undo, Registration& result) {
        solveEye(capture, undo, progress, result);
    });
}

} // namespace lumorph

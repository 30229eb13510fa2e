#include "calibration/registration/device_place.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "calibration/registration/layout_check.h"
#include "calibration/registration/refusing.h"
#include "calibration/registration/rigid_fit.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::kDegree;
using registration::number;

constexpr const char* kTouchedModel = "touched points of the device";
constexpr const char* kGluedBoard = "board on the device";

constexpr double kLandmarkSigma = 0.0004; ///< metres: how well a visitor meets a corner
constexpr std::size_t kFewestLandmarks = 4;
constexpr double kLeastApart = 0.05;      ///< metres between the two that are farthest apart
constexpr double kLandmarkAstray = 0.004; ///< metres by which a single point errs too much
constexpr std::size_t kFewestMoments = 20;
constexpr double kMostScatter = 0.02;              ///< metres, in the median
constexpr double kMostTurnScatter = 3.0 * kDegree; ///< likewise

void judgeTouches(DevicePlace& place, const LandmarkRows& touches) {
    std::size_t astray = 0;
    double squares = 0.0;
    for (std::size_t i = 0; i < touches.rows.size(); ++i) {
        const double miss = registration::missOf(touches.rows[i], place.figures);
        place.points.push_back({touches.names[i], miss});
        if (miss < kLandmarkAstray) {
            squares += miss * miss;
            continue;
        }
        ++astray;
        place.warnings.push_back({Cause::pointSuspicious,
                                  touches.names[i],
                                  {},
                                  "it lies " + number(1000.0 * miss, 1) + " mm from where the others have it",
                                  "it counts for little; touch it again"});
    }
    if (4 * astray > touches.rows.size())
        registration::refuse(Cause::modelDoesNotFit, kTouchedModel,
                             std::to_string(astray) + " of " + std::to_string(touches.rows.size()) +
                                 " points contradict the others, by " + number(1000.0 * rmsOf(place.points), 0) +
                                 " mm RMS of all",
                             "touch the points of this model in the order that is asked for, with the tip that was "
                             "measured");
    place.rms = std::sqrt(squares / double(touches.rows.size() - astray));
}

/// A mirror image of points in a plane is the plane turned over: then the pointer would stand inside the device.
void checkOutside(const LandmarkRows& touches, const registration::Figures& figures) {
    double inside = 0.0;
    for (std::size_t i = 0; i < touches.rows.size(); ++i)
        if (touches.outward[i]) {
            const glm::dvec3 toPointer = touches.rows[i].pointer.rotation * -figures.tip;
            inside += glm::dot(figures.bodyFromDevice.rotation * *touches.outward[i], toPointer) < 0.0 ? 1.0 : -1.0;
        }
    if (inside > 0.0)
        registration::refuse(Cause::mirrored, kTouchedModel,
                             "the pointer would stand inside the device: the tracker's coordinates are left-handed, "
                             "or its tip is at the other end",
                             "let the tracker tell right-handed coordinates, and calibrate the tip by pivoting");
}

double turnBetweenPoses(const Pose& a, const Pose& b) { return angleOf(glm::conjugate(a.rotation) * b.rotation); }

std::vector<Pose> momentsOfBoard(const BoardOnDevice& capture, const Pose& worldFromTracker) {
    const PoseTrack body = soundTrack(capture.body, "body of the device");
    const PoseTrack board = soundTrack(capture.board, kGluedBoard);
    std::vector<Pose> all;
    for (const TimedPose& at : board.poses)
        if (const auto tracked = poseAt(body, at.seconds))
            all.push_back(inverseOf(worldFromTracker * *tracked) * at.pose * inverseOf(capture.deviceFromBoard));
    if (all.size() < kFewestMoments)
        registration::refuse(Cause::tooFewPoints, kGluedBoard,
                             "camera and tracker share " + std::to_string(all.size()) + " moments only",
                             "record both at the same time and by one clock, for 5 s or more");
    return all;
}

} // namespace

LandmarkRows rowsOf(std::span<const TouchedLandmark> touches, const glm::dvec3& tip, const CaptureFault* undo) {
    LandmarkRows all;
    for (const TouchedLandmark& landmark : touches) {
        if (!landmark.touch.body)
            registration::refuse(Cause::trackerLost, landmark.touch.name.c_str(), "the device's body was not recorded",
                                 "track the device while its points are touched");
        const Rest rest = restOf(withoutFault(landmark.touch, undo), tip);
        all.rows.push_back({rest.pointer, landmark.onModel, std::hypot(kLandmarkSigma, noiseOf(rest))});
        all.outward.push_back(landmark.outward);
        all.names.push_back(landmark.touch.name);
        all.warnings.insert(all.warnings.end(), rest.warnings.begin(), rest.warnings.end());
    }
    return all;
}

DevicePlace placeDevice(const LandmarkRows& touches, const registration::TipRow& tip, const Progress& progress) {
    if (touches.rows.size() < kFewestLandmarks)
        registration::refuse(Cause::tooFewPoints, kTouchedModel,
                             std::to_string(touches.rows.size()) + " points are too few",
                             "touch six or more, all around the device");
    std::vector<glm::dvec3> touched, model;
    for (const registration::ModelRow& row : touches.rows) {
        touched.push_back(row.pointer * tip.tip);
        model.push_back(row.onModel);
    }
    registration::checkLayout(model, kTouchedModel, kLeastApart);
    const registration::Figures start{{}, tip.tip, fitRigid(model, touched).toFromFrom, {}};
    checkOutside(touches, start);
    const registration::Refined refined =
        registration::refine({{}, touches.rows, {}, tip}, start, {false, true, true, false}, progress);
    DevicePlace place;
    place.figures = refined.figures;
    place.turnSigma = refined.sigmas.deviceTurn;
    place.shiftSigma = refined.sigmas.deviceShift;
    place.tipSigma = refined.sigmas.deviceTip;
    place.warnings = touches.warnings;
    judgeTouches(place, touches);
    return place;
}

DevicePlace placeDeviceByBoard(const BoardOnDevice& capture, const Pose& worldFromTracker) {
    const std::vector<Pose> moments = momentsOfBoard(capture, worldFromTracker);
    Pose mean = meanPose(moments);
    std::vector<double> shifts, turns;
    const auto measure = [&] {
        shifts.clear();
        turns.clear();
        for (const Pose& at : moments) {
            shifts.push_back(glm::distance(at.position, mean.position));
            turns.push_back(turnBetweenPoses(at, mean));
        }
    };
    measure();
    // Without those that stray: a board that is seen half is found anywhere.
    const double shift = median(shifts), turn = median(turns);
    std::vector<Pose> kept;
    for (std::size_t i = 0; i < moments.size(); ++i)
        if (shifts[i] <= 3.0 * shift && turns[i] <= 3.0 * turn) kept.push_back(moments[i]);
    mean = meanPose(kept);
    measure();
    if (median(shifts) > kMostScatter || median(turns) > kMostTurnScatter)
        registration::refuse(Cause::modelDoesNotFit, kGluedBoard,
                             "single moments differ by " + number(1000.0 * median(shifts), 0) + " mm and " +
                                 number(median(turns) / kDegree, 1) + " degrees",
                             "see that the board is fixed to the device, that its body is the one that is tracked, and "
                             "that tracker and room were brought together");
    DevicePlace place;
    place.figures.bodyFromDevice = mean;
    place.rms = median(shifts);
    const double share = 1.0 / std::sqrt(double(kept.size()));
    place.shiftSigma = share * median(shifts);
    place.turnSigma = share * median(turns);
    return place;
}

} // namespace lumorph

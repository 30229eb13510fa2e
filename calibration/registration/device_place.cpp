#include "calibration/registration/device_place.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "calibration/registration/layout_check.h"
#include "calibration/registration/refusing.h"
#include "calibration/registration/rigid_fit.h"

namespace lumorph {

namespace {

using registration::FittedPlace;

constexpr const char* kTouchedModel = "touched points of the device";

constexpr double kLandmarkSigma = 0.0004; ///< metres: how well a visitor meets a corner
constexpr std::size_t kFewestLandmarks = 4;
constexpr double kLeastApart = 0.05;      ///< metres between the two that are farthest apart
constexpr double kLandmarkAstray = 0.004; ///< metres by which a single point errs too much

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

FittedPlace placeDevice(const LandmarkRows& touches, const registration::TipRow& tip, const Progress& progress) {
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
    FittedPlace place;
    place.figures = refined.figures;
    place.turnSigma = refined.sigmas.deviceTurn;
    place.shiftSigma = refined.sigmas.deviceShift;
    place.tipSigma = refined.sigmas.deviceTip;
    place.warnings = touches.warnings;
    registration::judgePoints(place, touches, kLandmarkAstray, kTouchedModel,
                              "touch the points of this model in the order that is asked for, with the tip that was "
                              "measured");
    return place;
}

} // namespace lumorph

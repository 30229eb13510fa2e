#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "calibration/registration/fresh_points.h"
#include "calibration/registration/refusing.h"
#include "core/base/progress.h"

/// The robust refinement of all that trackers are registered by. Every kind of measurement is a row, every figure is
/// free or kept; so one solver serves tracker, device and eye.
namespace lumorph::registration {

struct Figures {
    Pose worldFromTracker;
    glm::dvec3 tip{0.0}; ///< in the pointer's frame, metres
    Pose bodyFromDevice;
    glm::dvec3 eyeFromHead{0.0};
};

/// Which of them are solved for.
struct Free {
    bool tracker = false, tip = false, device = false, eye = false;
};

/// The pointer's tip on a ray of the room and, where `height` is known, so high in it.
struct RayRow {
    Pose pointer; ///< in the tracker's world
    glm::dvec3 origin{0.0}, direction{0.0, -1.0, 0.0};
    std::optional<double> height; ///< metres
    double sigma = 0.001;         ///< metres
};

/// The tip on a point of the device.
struct ModelRow {
    Pose pointer; ///< in the frame of the device's body
    glm::dvec3 onModel{0.0};
    double sigma = 0.0005; ///< metres
};

/// An eye that sees the tip cover a mark of the room.
struct SightRow {
    Pose pointer; ///< in the head's frame
    Pose head;    ///< in the tracker's world
    glm::dvec3 mark{0.0};
    double aimSigma = 0.0015; ///< radians, of the eye
    double tipSigma = 0.0005; ///< metres
};

/// Swings of a pointer about its tip in a dimple, as their pivot summed them up.
struct TipRow {
    glm::dvec3 tip{0.0};
    glm::dvec3 sigma{0.0005}; ///< metres
};

/// Rows of one kind, as touches make them.
template <typename Row> struct NamedRows {
    std::vector<Row> rows;
    std::vector<std::string> names; ///< one a row
    std::vector<Finding> warnings;
};

struct Rows {
    std::vector<RayRow> rays;
    std::vector<ModelRow> models;
    std::vector<SightRow> sights;
    std::optional<TipRow> tip;
};

/// A figure's standard deviation, of a pose at the middle of what was measured; infinite where the rows leave it open.
struct Sigmas {
    double trackerTurn = 0.0, trackerShift = 0.0, deviceTurn = 0.0, deviceShift = 0.0; ///< radians, metres
    glm::dvec3 tip{0.0}, eye{0.0};                                                     ///< metres
    /// What of the shifts, and of the eye over all axes, the error of the row of the tip makes, metres.
    double trackerTip = 0.0, deviceTip = 0.0, eyeTip = 0.0;
};

/// Where the tracker's world lies in the room's, or the device on its body.
struct FittedPlace {
    Figures figures;                          ///< this one, and the tip as it fits best
    double rms = 0.0;                         ///< metres by which the points miss
    std::vector<PointError> points;           ///< one a row
    double turnSigma = 0.0, shiftSigma = 0.0; ///< radians; metres, in the middle of the points
    double tipSigma = 0.0;                    ///< metres: what of `shiftSigma` the pointer's tip makes
    std::vector<Finding> warnings;
};

struct Refined {
    Figures figures;
    Sigmas sigmas;
};

/// Least squares (Ceres) with Cauchy's loss, from `start`, whose figures are right to a few centimetres and degrees.
[[nodiscard]] Refined refine(const Rows& rows, const Figures& start, const Free& free, const Progress& progress = {});

/// How far a row is from what the figures say: metres between ray or point and tip; of a sight, between the eye and
/// the line from the mark through the tip.
[[nodiscard]] double missOf(const RayRow& row, const Figures& figures);
[[nodiscard]] double missOf(const ModelRow& row, const Figures& figures);
[[nodiscard]] double missOf(const SightRow& row, const Figures& figures);

/// Adds the miss of each row to a place that was fitted to them. One that misses by `astray` metres or more is named in
/// a warning; throws CaptureRefused, `model_does_not_fit` about `what`, where more than a quarter does.
template <typename Row>
void judgePoints(FittedPlace& place, const NamedRows<Row>& fitted, double astray, const char* what,
                 const char* remedy) {
    std::size_t count = 0;
    double squares = 0.0;
    for (std::size_t i = 0; i < fitted.rows.size(); ++i) {
        const double miss = missOf(fitted.rows[i], place.figures);
        place.points.push_back({fitted.names[i], miss});
        if (miss < astray) {
            squares += miss * miss;
            continue;
        }
        ++count;
        place.warnings.push_back({Cause::pointSuspicious,
                                  fitted.names[i],
                                  {},
                                  "it lies " + number(1000.0 * miss, 1) + " mm from where the others have it",
                                  "it counts for little; touch it again"});
    }
    if (4 * count > fitted.rows.size())
        refuse(Cause::modelDoesNotFit, what,
               std::to_string(count) + " of " + std::to_string(fitted.rows.size()) +
                   " points contradict the others, by " + number(1000.0 * rmsOf(place.points), 0) + " mm RMS of all",
               remedy);
    place.rms = std::sqrt(squares / double(fitted.rows.size() - count));
}

} // namespace lumorph::registration

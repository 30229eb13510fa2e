#pragma once

#include <optional>
#include <vector>

#include "calibration/registration/pose_track.h"
#include "core/base/progress.h"

/// The joint, robust refinement of all that trackers are registered by. Every kind of measurement is a row, every
/// figure is free or kept; so one solver serves the tracker alone as well as all of it together.
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

/// A point that the tracker knows, on a ray of the room and, where `height` is known, so high in it.
struct RayRow {
    Pose pointer;    ///< in the tracker's world
    bool tip = true; ///< its tip is the point; else its origin is, as of a single marker
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

} // namespace lumorph::registration

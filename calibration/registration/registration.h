#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/registration/device_place.h"
#include "calibration/registration/eye_alignment.h"
#include "calibration/registration/fresh_points.h"
#include "calibration/registration/pose_file.h"
#include "calibration/registration/touched_dots.h"
#include "core/geometry/triangle_mesh.h"
#include "core/scene/installation.h"

/// Tracker, pointer, device and eye: from what was recorded, in the lab or of hardware, to figures of the installation.
/// All of them end with check points, which the fit never saw; without three of them, or where they contradict it,
/// nothing is kept. The code calls them fresh.
namespace lumorph {

/// What a registration came to.
struct Registration {
    /// As it was believed to be, with the measured part replaced and its origin said; unchanged where it was refused.
    Installation installation;
    std::optional<Finding> refusal;
    std::vector<Finding> warnings;

    std::string summary;            ///< one sentence with the figures that count
    double rms = 0.0;               ///< metres: the fit's own residual
    std::vector<PointError> points; ///< of the fit
    FreshCheck fresh;               ///< of the check points
    /// How well it is known, radians and metres: by the fit, with the noise of the tracker and what is open of tip and
    /// tracker, as the origins of `believed` say.
    double turnSigma = 0.0, shiftSigma = 0.0;
    double tipSigma = 0.0; ///< metres: what of `shiftSigma` the pointer's tip makes
    [[nodiscard]] bool good() const { return !refusal && fresh.good(); }
};

/// A pointer swung about its tip in one dimple; then held in three others or more, each twice or more as differently as
/// the hand can, which the fit does not see.
struct PointerCapture {
    PoseTrack swings;
    std::vector<std::vector<Touch>> fresh; ///< by dimple
};
[[nodiscard]] Registration registerPointer(const PointerCapture& capture, const Installation& believed,
                                           const Progress& progress = {});

/// Projected dots that a pointer touches.
struct DotCapture {
    std::vector<TouchedDot> dots, fresh;
    std::optional<double> tableHeight = 0.0; ///< of the plane on which they lie; empty: unknown
};
[[nodiscard]] Registration registerTracker(const DotCapture& capture, const Installation& believed,
                                           const Progress& progress = {});

/// A marker board that is tracked and moved before a calibrated camera, each by its own clock. Of its last fifth
/// the fit sees nothing: what the camera sees then is the fresh points.
struct BoardCapture {
    PoseTrack body;  ///< in the tracker's world
    PoseTrack board; ///< in the room's
};
[[nodiscard]] Registration registerTracker(const BoardCapture& capture, const Installation& believed,
                                           const Progress& progress = {});

/// Points of the device's model that a pointer touches.
struct LandmarkCapture {
    std::vector<TouchedLandmark> touches, fresh;
};
[[nodiscard]] Registration registerDevice(const LandmarkCapture& capture, const Installation& believed,
                                          const Progress& progress = {});

/// One recording of a pointer that rests on one point of the device's model after another (landmarks.h).
struct RecordedLandmarks {
    PoseTrack pointer, body; ///< in the tracker's world, by one clock
    std::vector<NamedPoint> model;
};
/// Of the points that were touched one in four, three at least, are held out before it is solved, as check points: they
/// are spread over the order of the model, whatever their errors are. Which place is which point is found by all of
/// them. Refuses `too_few_points` for fewer than seven, and as fitLandmarks.
[[nodiscard]] Registration registerDevice(const RecordedLandmarks& capture, const Installation& believed,
                                          const Progress& progress = {});

/// The device's surface by structured light, while its body is tracked and rests; and landmarks as fresh points. It
/// begins where the device's body was measured to have it, else at the installation's place of the device.
struct SurfaceCapture {
    TriangleMesh model;             ///< device frame, metres, as it stood
    std::vector<glm::dvec3> points; ///< room, metres; the table's may be among them
    glm::dvec3 seenFrom{0.0};       ///< where the camera stands, room, metres
    PoseTrack body;                 ///< in the tracker's world
    std::vector<TouchedLandmark> fresh;
};
[[nodiscard]] Registration registerDevice(const SurfaceCapture& capture, const Installation& believed,
                                          const Progress& progress = {});

/// Marks that the pointer's tip covers for the visitor's eye.
struct EyeCapture {
    std::vector<Alignment> alignments, fresh;
};
[[nodiscard]] Registration registerEye(const EyeCapture& capture, const Installation& believed,
                                       const Progress& progress = {});

} // namespace lumorph

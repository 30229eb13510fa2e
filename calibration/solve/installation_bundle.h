#pragma once

#include <array>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/solve/bundle.h"

namespace lumorph {

/// All that is solved for together: any number of cameras and projectors, the bodies that they see (boards in their
/// poses, or the device), and a mirror. Lengths in the bodies' unit.
struct InstallationState {
    struct Device {
        Lens lens{};
        PoseVector fromWorld{}; ///< a point X of the world is R X + t in its frame
        bool operator==(const Device&) const = default;
    };
    std::vector<Device> cameras, projectors;
    std::vector<PoseVector> worldFromBody;
    std::array<double, 3> mirror{}; ///< the point of its plane that is nearest to the world's origin
};

/// A known point of a body, and where a camera saw it.
struct SeenPoint {
    int camera = 0, body = 0;
    bool mirrored = false; ///< by way of the mirror
    cv::Point3d point;     ///< in the body's frame
    cv::Point2d pixel;
};

/// A camera pixel that saw a projector's light on a known plane of a body.
struct SeenLight {
    int camera = 0, projector = 0, body = 0;
    bool mirrored = false;
    cv::Vec3d normal{0.0, 0.0, 1.0}; ///< of the plane, of length 1, in the body's frame
    double distance = 0.0;           ///< of the plane from the body's origin, along its normal
    ProjectorPoint pixels;
    double weight = 1.0; ///< beside others: how many independent ones it counts for
};

struct InstallationObservations {
    std::vector<SeenPoint> points;
    std::vector<SeenLight> lights;
};

/// What may move. Lists shorter than what there is leave the rest held.
struct InstallationFree {
    struct Device {
        LensMask lens{};
        bool pose = false;
    };
    std::vector<Device> cameras, projectors;
    std::vector<bool> bodies;
    bool mirror = false;
};

/// How sure one is of observations, and of lenses beforehand.
struct InstallationNoise {
    double camera = 0.2, projector = 0.2; ///< standard deviations of a coordinate, pixels
    /// Lenses that are known beforehand to within these standard deviations; 0: nothing is known of a number.
    struct Known {
        Lens lens{}, sigma{};
    };
    std::vector<Known> cameras, projectors;
    double robust = 3.0; ///< standard deviations from which an observation of light counts less
};

/// Moves `state` to where the robust sum of squares is least (Ceres). Returns the cost, infinite where it cannot be
/// evaluated at the start.
double refineInstallation(const InstallationObservations& observations, const InstallationFree& free,
                          const InstallationNoise& noise, InstallationState& state, int steps = 60);

/// Standard deviations of all that may move, from the normal matrix; the rest 0.
[[nodiscard]] InstallationState installationSigmas(const InstallationObservations& observations,
                                                   const InstallationFree& free, const InstallationNoise& noise,
                                                   const InstallationState& state);

/// Where the state puts a point or a light, less where it was seen; pixels of the camera, or of the projector. Nothing
/// where the camera looks past it.
[[nodiscard]] std::optional<cv::Point2d> errorOf(const SeenPoint& seen, const InstallationState& state);
[[nodiscard]] std::optional<cv::Point2d> errorOf(const SeenLight& seen, const InstallationState& state);

/// Light on a board that a camera saw: the plane is that of the board there, which need not be flat.
[[nodiscard]] SeenLight lightOnBoard(const ProjectorPoint& pixels, const Lens& camera,
                                     const PoseVector& cameraFromBoard, const BoardShape& board);

/// A board's points as they are called when it is taken for turned by 180 degrees; nothing where those are others.
[[nodiscard]] std::optional<std::vector<cv::Point3d>> turnedBoard(const std::vector<cv::Point3d>& board);

} // namespace lumorph

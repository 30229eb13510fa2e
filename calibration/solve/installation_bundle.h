#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "calibration/solve/lens_model.h"
#include "calibration/solve/observations.h"
#include "calibration/solve/residuals.h"
#include "core/geometry/rigid.h"

namespace lumorph {

/// How far a board is from the plane it was printed as: terms of its height over the plane z = 0, by u and v, which run
/// from -1 to 1 over the longer side (uu, uv, vv, uuu, uuv, uvv, vvv; the board's unit), and how much longer it is
/// along x than was said, as a share of it. That a board is larger or smaller in both directions alike, no picture
/// tells: it scales all lengths.
inline constexpr int kBoardParameters = 8;
enum BoardParameter { kBendUU, kBendUV, kBendVV, kBendUUU, kBendUUV, kBendUVV, kBendVVV, kBoardStretch };
using BoardMask = std::array<bool, kBoardParameters>;
struct BoardShape {
    cv::Point2d middle;
    double half = 1.0; ///< of the longer side
    std::array<double, kBoardParameters> terms{};
};

/// A flat board around the points of all views.
[[nodiscard]] BoardShape flatBoard(const std::vector<ViewObservations>& views);
/// Where a printed point of the board lies.
[[nodiscard]] cv::Point3d onBoard(const BoardShape& board, const cv::Point3d& printed);
/// How many lengths of `way` from a place the board is met, all in its frame; not above 0 or no number where it is not.
[[nodiscard]] double depthOfBoard(const Eigen::Vector3d& from, const Eigen::Vector3d& way, const BoardShape& board);

/// All that is solved for together: any number of cameras and projectors, the bodies that they see (boards in their
/// poses, or the device), the shape of the boards, and a mirror. Lengths in the bodies' unit.
struct InstallationState {
    struct Device {
        Lens lens{};
        PoseVector fromWorld{}; ///< a point X of the world is R X + t in its frame
        bool operator==(const Device&) const = default;
    };
    std::vector<Device> cameras, projectors;
    std::vector<PoseVector> worldFromBody;
    std::array<double, 3> mirror{}; ///< the point of its plane that is nearest to the world's origin
    BoardShape board;               ///< the same in all poses
};

/// A known point of a body, and where a camera saw it.
struct SeenPoint {
    int camera = 0, body = 0;
    bool mirrored = false; ///< by way of the mirror
    cv::Point3d point;     ///< in the body's frame, as it was printed
    cv::Point2d pixel;
    double weight = 1.0; ///< of how many independent ones it counts as
};

/// A camera pixel that saw a projector's light on a body: on the board as it is shaped, or on a plane.
struct SeenLight {
    struct Plane {
        cv::Vec3d normal{0.0, 0.0, 1.0}; ///< of length 1, in the body's frame
        double distance = 0.0;           ///< from the body's origin, along its normal
    };
    int camera = 0, projector = 0, body = 0;
    bool mirrored = false;
    ProjectorPoint pixels;
    double weight = 1.0;
    std::optional<Plane> plane = {};
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
    BoardMask board{};
};

/// How sure one is of observations, and of lenses beforehand.
struct InstallationNoise {
    double camera = 0.2, projector = 0.2; ///< standard deviations of a coordinate, pixels
    /// Lenses that are known beforehand to within these standard deviations; 0: nothing is known of a number.
    struct Known {
        Lens lens{}, sigma{};
    };
    std::vector<Known> cameras, projectors;
    double robust = 3.0; ///< standard deviations from which an observation counts less
};

/// Moves `state` to where the sum of losses is least (Ceres): Huber's of errors of points in cameras, Cauchy's of
/// errors of light in projectors. Single observations that cannot be there, as one whose ray misses the body, count as
/// far off; a tenth of what a camera has on a body makes it impossible. Returns the cost, infinite where it cannot be
/// evaluated at the start.
double refineInstallation(const InstallationObservations& observations, const InstallationFree& free,
                          const InstallationNoise& noise, InstallationState& state, int steps = 60);

/// Places of a state's numbers in vectors and matrices of all: each camera's lens and pose, each projector's, the
/// board's shape, the mirror, and each body's pose.
struct InstallationPlaces {
    int projectors, board, mirror, bodies, count;

    explicit InstallationPlaces(const InstallationState& state);
    [[nodiscard]] int camera(std::size_t i) const { return kOfDevice * static_cast<int>(i); }
    [[nodiscard]] int projector(std::size_t i) const { return projectors + kOfDevice * static_cast<int>(i); }
    [[nodiscard]] int body(std::size_t i) const { return bodies + 6 * static_cast<int>(i); }

    static constexpr int kOfDevice = kLensParameters + 6;
};

/// How much an error counts in a normal matrix: as the loss lets it, noise in full and what is far off hardly; or all
/// in full, for what planned observations would tell.
enum class Counts { asLossLets, inFull };

/// Normal matrices of all numbers, whether they may move or not, by kind of observation, and what is known beforehand.
struct InstallationNormals {
    Eigen::MatrixXd points, lights, known;
};
[[nodiscard]] InstallationNormals installationNormals(const InstallationObservations& observations,
                                                      const InstallationNoise& noise, const InstallationState& state,
                                                      Counts counts);

/// The inverse of a normal matrix, whose parameters may have very different units. What the data cannot tell gets a
/// huge variance.
[[nodiscard]] Eigen::MatrixXd inverseOfNormal(const Eigen::MatrixXd& normal);

/// Standard deviations of all that may move, from the normal matrix as the loss lets errors count; the rest 0.
[[nodiscard]] InstallationState installationSigmas(const InstallationObservations& observations,
                                                   const InstallationFree& free, const InstallationNoise& noise,
                                                   const InstallationState& state);

/// Where the state puts points or light, less where they were seen; pixels of the camera, or of the projector. Nothing
/// where the camera looks past it.
[[nodiscard]] std::vector<std::optional<cv::Point2d>> errorsOf(const std::vector<SeenPoint>& seen,
                                                               const InstallationState& state);
[[nodiscard]] std::vector<std::optional<cv::Point2d>> errorsOf(const std::vector<SeenLight>& seen,
                                                               const InstallationState& state);

/// Names of devices and poses, for messages.
struct InstallationNames {
    std::vector<std::string> cameras, projectors, bodies;
};
/// Takes out what is farther off than 20 standard deviations by `noise`, or not there at all, where that is little of
/// what one camera saw on a body, of it or of one projector's light. Returns what was left out, in words.
[[nodiscard]] std::vector<Finding> dropOutliers(InstallationObservations& observations, const InstallationState& state,
                                                const InstallationNoise& noise, const InstallationNames& names);

/// A board's points as they are called when it is taken for turned by 180 degrees; nothing where those are others.
[[nodiscard]] std::optional<std::vector<cv::Point3d>> turnedBoard(const std::vector<cv::Point3d>& board);

} // namespace lumorph

#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "calibration/solve/installation_bundle.h"

namespace lumorph {

// One camera and one projector, as a thin layer over the bundle of an installation whose world is the camera's frame.

/// Everything that is solved for. A point X of the first frame is R X + t in the other.
struct BundleState {
    Lens camera{}, projector{};
    PoseVector projectorFromCamera{};
    BoardShape board;                        ///< the same in all views
    std::vector<PoseVector> cameraFromBoard; ///< one a view
};

/// What may move, and how much each kind of observation counts.
struct BundleOptions {
    LensMask camera{}, projector{};
    BoardMask board{};
    bool rig = true;   ///< the projector against the camera
    bool poses = true; ///< the boards against the camera
    bool projectorPoints = true;
    double cameraSigma = 0.2;    ///< of one coordinate of a corner, camera pixels
    double projectorSigma = 0.2; ///< of one coordinate of a projector point, projector pixels
    /// How many of the corners, and of the projector points, count as independent of their neighbours.
    double independentCorners = 1.0, independentPoints = 1.0;
    int most = 1 << 30; ///< projector points of a view that are used, spread evenly
};

/// Views of a capture, by index.
using ViewChoice = std::vector<int>;

/// Moves `state` to where the sum of losses is least, as `refineInstallation` does. Returns the cost, infinite where it
/// cannot be evaluated at the start.
double refine(const std::vector<ViewObservations>& views, const ViewChoice& use, const BundleOptions& options,
              BundleState& state);

/// Places of parameters in a covariance or normal matrix: the camera's lens, the projector's, the rig, the board, and
/// from `kPosePlace` on 6 a view.
inline constexpr int kProjectorPlace = kLensParameters;
inline constexpr int kRigPlace = 2 * kLensParameters;
inline constexpr int kBoardPlace = kRigPlace + 6;
inline constexpr int kPosePlace = kBoardPlace + kBoardParameters;

/// How well a state is known.
struct BundleCovariance {
    Eigen::MatrixXd matrix; ///< kPosePlace + 6 a view, square; zero for what is held
    /// Of how many free numbers each kind of observation carries the cost: that many fewer than there are coordinates
    /// of errors are free.
    double cameraFreedom = 0.0, projectorFreedom = 0.0;
};

/// Covariance of all parameters at `state`, from the normal matrix of the same problem, all points taken to have the
/// noise that `options` says, and to tell as much as the loss lets them count: noise in full, what is far off hardly.
/// What the data cannot tell gets a huge variance.
[[nodiscard]] BundleCovariance covarianceOf(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                            const BundleOptions& options, const BundleState& state);

/// The normal matrix itself, of all parameters at those places, whether they may move or not.
[[nodiscard]] Eigen::MatrixXd normalMatrixOf(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                             const BundleOptions& options, const BundleState& state);

/// What one view tells of the lenses, the rig and the board when its own pose is unknown: its normal matrix with the
/// pose eliminated, `kPosePlace` square. Of errors it uses nothing, so that a view may be a planned one.
[[nodiscard]] Eigen::MatrixXd informationOf(const ViewObservations& view, const BundleOptions& options,
                                            const BundleState& state, const PoseVector& cameraFromBoard);

/// Errors of a view's board points in the camera; pixels. One that cannot be seen at all is 1000 pixels off.
[[nodiscard]] std::vector<cv::Point2d> cameraErrors(const ViewObservations& view, const BundleState& state,
                                                    const PoseVector& cameraFromBoard);
/// Errors of a view's projector points in the projector; pixels. One whose ray misses the board is 1000 pixels off.
[[nodiscard]] std::vector<cv::Point2d> projectorErrors(const ViewObservations& view, const BundleState& state,
                                                       const PoseVector& cameraFromBoard);
/// Where a camera pixel meets the board, in the camera's frame.
[[nodiscard]] cv::Point3d pointOnBoard(const cv::Point2d& pixel, const Lens& camera, const PoseVector& cameraFromBoard,
                                       const BoardShape& board = {});
/// The projector pixel of a point in the camera's frame.
[[nodiscard]] cv::Point2d projectorPixel(const cv::Point3d& point, const BundleState& state);

} // namespace lumorph

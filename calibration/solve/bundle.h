#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "calibration/solve/lens_model.h"
#include "calibration/solve/observations.h"

namespace lumorph {

/// A rotation vector (radians) and a translation (the board's unit).
using PoseVector = std::array<double, 6>;

/// Everything that is solved for. A point X of the first frame is R X + t in the other.
struct BundleState {
    Lens camera{}, projector{};
    PoseVector projectorFromCamera{};
    std::vector<PoseVector> cameraFromBoard; ///< one a view
};

/// What may move, and how much each kind of observation counts.
struct BundleOptions {
    LensMask camera{}, projector{};
    bool rig = true;   ///< the projector against the camera
    bool poses = true; ///< the boards against the camera
    bool projectorPoints = true;
    double cameraSigma = 0.2;    ///< of one coordinate of a corner, camera pixels
    double projectorSigma = 0.2; ///< of one coordinate of a projector point, projector pixels
    double independent = 1.0;    ///< how many of the projector points count as independent of their neighbours
    int most = 1 << 30;          ///< projector points of a view that are used, spread evenly
};

/// Views of a capture, by index.
using ViewChoice = std::vector<int>;

/// Moves `state` to where the robust sum of squares of reprojection errors is least: of the board's points in the
/// camera, and of decoded camera pixels, cut with the board's plane, in the projector. One problem, solved jointly
/// (Ceres). Returns the cost, infinite where it cannot be evaluated at the start.
double refine(const std::vector<ViewObservations>& views, const ViewChoice& use, const BundleOptions& options,
              BundleState& state);

/// Covariance of all parameters at `state`, from the normal matrix of the same problem: 9 of the camera, 9 of the
/// projector, 6 of the rig; zero for those that are held. What the data cannot tell gets a huge variance. Poses are
/// accounted for.
[[nodiscard]] Eigen::Matrix<double, 24, 24> covarianceOf(const std::vector<ViewObservations>& views,
                                                         const ViewChoice& use, const BundleOptions& options,
                                                         const BundleState& state);

/// Errors of a view's board points in the camera; pixels.
[[nodiscard]] std::vector<cv::Point2d> cameraErrors(const ViewObservations& view, const Lens& camera,
                                                    const PoseVector& cameraFromBoard);
/// Errors of a view's projector points in the projector; pixels.
[[nodiscard]] std::vector<cv::Point2d> projectorErrors(const ViewObservations& view, const BundleState& state,
                                                       const PoseVector& cameraFromBoard);
/// Where a camera pixel meets the board's plane, in the camera's frame.
[[nodiscard]] cv::Point3d pointOnBoard(const cv::Point2d& pixel, const Lens& camera, const PoseVector& cameraFromBoard);
/// The projector pixel of a point in the camera's frame.
[[nodiscard]] cv::Point2d projectorPixel(const cv::Point3d& point, const BundleState& state);

/// Root mean square length; 0 of none.
[[nodiscard]] double rmsOf(const std::vector<cv::Point2d>& errors);

} // namespace lumorph

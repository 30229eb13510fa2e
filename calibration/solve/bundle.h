#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "calibration/solve/lens_model.h"
#include "calibration/solve/observations.h"
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

/// Moves `state` to where the robust sum of squares of reprojection errors is least: of the board's points in the
/// camera, and of decoded camera pixels, cut with the board, in the projector. One problem, solved jointly (Ceres).
/// Single points that cannot be there, as one whose ray misses the board, count as far off; a tenth of a view's make it
/// impossible. Returns the cost, infinite where it cannot be evaluated at the start.
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

/// Standard deviation of one coordinate of errors, pixels: what they leave when `freedom` of the coordinates were used
/// up by what was solved for. Strays count as if they were twelve of it off.
[[nodiscard]] double sigmaOf(const std::vector<cv::Point2d>& errors, double freedom);

/// Root mean square length; 0 of none.
[[nodiscard]] double rmsOf(const std::vector<cv::Point2d>& errors);

} // namespace lumorph

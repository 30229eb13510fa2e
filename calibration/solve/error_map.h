#pragma once

#include <vector>

#include <Eigen/Core>

#include "calibration/solve/procam_calibration.h"

namespace lumorph {

/// Of how many calibrations an error map speaks.
inline constexpr double kErrorShare = 0.95;

/// Where the world is, and how far that can be trusted. By default the world is the camera's frame, which nobody can be
/// wrong about.
struct WorldPose {
    PoseVector cameraFromWorld{}; ///< radians; the calibration's unit
    /// Of what it was measured from, the calibration taken as it is.
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    /// How it moves when the camera's lens is found to be another.
    Eigen::Matrix<double, 6, kLensParameters> byCamera = Eigen::Matrix<double, 6, kLensParameters>::Zero();
};

/// The world from points that the camera saw: `seen.board` are their places in the world (the calibration's unit; not
/// on one line, at least four), `sigma` the standard deviation of one coordinate of where they were seen, camera
/// pixels. Throws InvalidInput with fewer.
[[nodiscard]] WorldPose worldPoseFrom(const ProcamCalibration& calibration, const BoardPoints& seen, double sigma);

/// A place that is to be lit, in world coordinates, the calibration's unit.
struct LitPlace {
    cv::Point3d point;
    /// Of the surface there, any length; the zero vector: it faces the projector.
    cv::Vec3d normal{0.0, 0.0, 0.0};
};

/// How far light that is meant for each place may fall beside it on the surface: in 95 of 100 calibrations as good as
/// this one it falls within that distance, in the calibration's unit. From the covariance of both lenses, the rig and
/// the world's pose, to first order. Places behind the projector, and surfaces seen edge-on, get infinity.
[[nodiscard]] std::vector<double> errorMap(const ProcamCalibration& calibration, const WorldPose& world,
                                           const std::vector<LitPlace>& places);

/// Covariance of the light's place on the surface, along two directions of it, were the calibration known by
/// `covariance` (places of parameters as in bundle.h, at least the first `kBoardPlace`). What `errorMap` is made from.
[[nodiscard]] std::vector<Eigen::Matrix2d> lightUncertainty(const ProcamCalibration& calibration,
                                                            const Eigen::MatrixXd& covariance, const WorldPose& world,
                                                            const std::vector<LitPlace>& places);

/// Covariance of the camera pixels at which points in the camera's frame are seen, when the camera is told again from
/// noise as large. A lens that is a little off is made up for by boards that are put a little elsewhere, so each point
/// is held fast to each board in turn and the pixel's moves are averaged, as mrcal does (mrcal.secretsauce.net,
/// "projection uncertainty", mean-pcam).
[[nodiscard]] std::vector<Eigen::Matrix2d> cameraUncertainty(const ProcamCalibration& calibration,
                                                             const std::vector<cv::Point3d>& points);

/// The radius around the mean that holds `share` of a normal distribution of that covariance.
[[nodiscard]] double radiusOf(const Eigen::Matrix2d& covariance, double share);

} // namespace lumorph

#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "calibration/solve/procam_calibration.h"

namespace lumorph {

/// A known point of device or room, and the projector pixel to which a user moved the crosshair to lie on it.
struct Crosshair {
    std::string name;   ///< as a user is told: "corner front left, raised"
    cv::Point3d point;  ///< metres; device or world frame, the same for all
    cv::Point2d pixel;  ///< projector pixels, the centre of the first at 0
    bool aimed = false; ///< whether the user has put it there; others take no part
};

struct CrosshairOptions {
    /// Of a projector that is known and has only been moved: its pose alone is solved for, from four points.
    std::optional<Lens> lens;
    double aimingSigma = 1.0; ///< how well a user aims: standard deviation of one coordinate, projector pixels
};

/// How well one crosshair agrees with the others.
struct CrosshairFit {
    cv::Point2d error; ///< where the solution puts the point, less where the crosshair is; projector pixels
    /// How far the other points would put it from its crosshair, in standard deviations of that; the larger the more it
    /// is contradicted.
    double contradiction = 0.0;
    bool suspicious = false; ///< it, or another that is marked so, does not lie where it is said to
};

/// A projector, calibrated from crosshairs alone.
struct CrosshairCalibration {
    CalibratedDevice projector;
    PoseVector projectorFromWorld{};      ///< radians, metres
    PoseVector projectorFromWorldSigma{}; ///< standard deviations
    std::vector<CrosshairFit> points;     ///< one a crosshair, in their order; empty fits of those not aimed
    std::vector<Finding> warnings;        ///< parameters that were held, suspicious points
    /// Set where the crosshairs contradict one another so that the solution must not be used: what to look at.
    std::optional<Finding> refusal;

    /// Where the projector's light for a point goes; projector pixels.
    [[nodiscard]] cv::Point2d pixelOf(const cv::Point3d& point) const;
    /// How far, across the light, the light that is meant for a point may lie from it in 95 % of cases; metres.
    [[nodiscard]] double error95At(const cv::Point3d& point) const;

    cv::Point3d middle; ///< of the points, about which the covariance holds
    /// Of the parameters in `crosshairJacobian`.
    Eigen::Matrix<double, 15, 15> covariance = Eigen::Matrix<double, 15, 15>::Zero();
};

/// Solves for lens and pose of a projector from known points and the pixels that light them, without a camera and
/// without a guess: focal length and principal point, with twelve points also aspect and k1. What the points tell less
/// of than what holds for projectors in general stays near that, and is named in the warnings. Takes a few
/// milliseconds. Throws CaptureRefused: fewer than six points (four of a known lens), points on one line, in one plane
/// (of an unknown lens), nothing that fits; InvalidInput for numbers that are not finite or a size that is none.
[[nodiscard]] CrosshairCalibration calibrateCrosshairs(const std::vector<Crosshair>& crosshairs, cv::Size projector,
                                                       const CrosshairOptions& options = {});

/// How a point's pixel follows nine numbers of the lens, each as a share of how much it differs among projectors, and
/// the pose (rotation vector, translation) about `middle`. A parameter of the lens that is not free has no effect.
[[nodiscard]] Eigen::Matrix<double, 2, 15> crosshairJacobian(const Lens& lens, const LensMask& free, cv::Size projector,
                                                             const PoseVector& projectorFromMiddle,
                                                             const cv::Point3d& fromMiddle);

/// Crosshairs as a user works on them: each step solves anew, so that arrows and advice follow every key.
class CrosshairSession {
public:
    explicit CrosshairSession(cv::Size projector, CrosshairOptions options = {});

    /// Adds a point, its crosshair where the present solution puts it, else in the picture's middle. Returns its index.
    std::size_t add(const std::string& name, const cv::Point3d& point);
    /// Moves a crosshair, within the picture, which makes it aimed. Throws InvalidInput for an index out of range, as
    /// all below.
    void move(std::size_t index, const cv::Point2d& by);
    void aimAt(std::size_t index, const cv::Point2d& pixel);
    /// It lies right where it is; or is to take no part.
    void setAimed(std::size_t index, bool aimed);
    void remove(std::size_t index);

    [[nodiscard]] const std::vector<Crosshair>& crosshairs() const noexcept { return crosshairs_; }
    /// Of what is aimed so far; nothing while `missing` says why.
    [[nodiscard]] const std::optional<CrosshairCalibration>& result() const noexcept { return result_; }
    [[nodiscard]] const std::optional<Finding>& missing() const noexcept { return missing_; }

private:
    Crosshair& at(std::size_t index);
    void solve();

    cv::Size projector_;
    CrosshairOptions options_;
    std::vector<Crosshair> crosshairs_;
    std::optional<CrosshairCalibration> result_;
    std::optional<Finding> missing_;
};

} // namespace lumorph

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/decode/refusal.h"
#include "calibration/solve/bundle.h"
#include "core/base/progress.h"

namespace lumorph {

/// A camera or a projector, calibrated.
struct CalibratedDevice {
    cv::Size size;
    Lens lens{};
    LensMask free{};   ///< parameters that were solved for; the others were held
    Lens sigma{};      ///< standard deviations; 0 of those that were held
    double rms = 0.0;  ///< reprojection error, root mean square length, its own pixels
    std::string model; ///< "k1 k2", "pinhole"
};

/// How well one pose fits.
struct ViewQuality {
    std::string name;
    double cameraRms = 0.0;    ///< camera pixels
    double projectorRms = 0.0; ///< projector pixels
    /// With the view left out of the solution: its pose from the camera alone, decoded camera pixels on its plane
    /// reprojected into the projector, root mean square length, pixels. Of a camera alone: the error of its corners.
    std::optional<double> heldOut;
};

/// Everything that a capture says of a projector and a camera.
struct ProcamCalibration {
    CalibratedDevice camera, projector;
    PoseVector projectorFromCamera{}; ///< radians; the board's unit
    PoseVector projectorFromCameraSigma{};
    double rms = 0.0; ///< of both devices alike: root of the mean of the squares of both
    std::vector<ViewQuality> views;
    std::string worstView;
    /// How far apart the solutions of two halves of the views put the same light in the projector, pixels, and how far
    /// their uncertainties allow; nothing with fewer than four views.
    std::optional<double> halvesDiffer, halvesAllowed;
    double boardBend = 0.0; ///< between the board's highest and lowest point; 0 where a flat one explains all as well
    std::vector<Finding> warnings;
    bool degenerate = false;
    BundleState state;          ///< with the boards' poses, by view
    BundleOptions bundle;       ///< what was free, and the noise that was found
    Eigen::MatrixXd covariance; ///< of everything that was free, places as in bundle.h
    /// What all views tell of lenses, rig and board, free or not: the normal matrix without the poses, `kPosePlace`
    /// square.
    Eigen::MatrixXd information;
    double pointsOfView = 0.0; ///< how many independent projector points a view has, on average
};

struct SolveOptions {
    std::optional<double> cameraFocal = {};    ///< pixels; one more value to begin with
    std::optional<double> projectorFocal = {}; ///< likewise
    /// An earlier result to begin with instead; poses of views that it lacks are worked out.
    std::optional<BundleState> start = {};
    std::string cameraModel = {}, projectorModel = {}; ///< "k1 k2", "pinhole"; empty: chosen
    /// Whether the board's shape is tried, views are held out and halves compared. Without, a calibration takes a tenth
    /// of the time: for many in a row.
    bool judge = true;
    bool judgesFit = true; ///< refuses errors that no lens explains; else that is the caller's to do
};

/// Solves for camera, projector and boards together. Distortion terms of each device, and the board's bend, are let go
/// one after another where they lower the error on views left out of the solution. What the data cannot tell is locked
/// and named in the warnings. Throws CaptureRefused: too few views, boards not tilted, nothing that fits; Cancelled;
/// InvalidInput where a model is none.
[[nodiscard]] ProcamCalibration calibrateProcam(const std::vector<ViewObservations>& views, cv::Size camera,
                                                cv::Size projector, const SolveOptions& options = {},
                                                const Progress& progress = {});

/// Why a solution is to be refused for the errors that remain; nothing where they are bearable.
[[nodiscard]] std::optional<Finding> misfitOf(const ProcamCalibration& result);

/// The camera alone; the projector's part stays empty.
[[nodiscard]] ProcamCalibration calibrateIntrinsics(const std::vector<ViewObservations>& views, cv::Size camera,
                                                    const SolveOptions& options = {}, const Progress& progress = {});

} // namespace lumorph

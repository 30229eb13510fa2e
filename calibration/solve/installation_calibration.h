#pragma once

#include <string>
#include <vector>

#include "calibration/solve/installation_bundle.h"
#include "calibration/solve/procam_calibration.h"

namespace lumorph {

/// A camera or projector, as it is told about.
struct NamedDevice {
    std::string name;
    cv::Size size; ///< pixels
};

/// What all cameras saw of one pose of the board.
struct InstallationView {
    std::string name;
    std::vector<BoardPoints> corners; ///< one a camera; empty where it did not see the board
    /// By camera, then by projector: light on the board; empty where there was none to see. The whole list may be
    /// empty.
    std::vector<std::vector<std::vector<ProjectorPoint>>> light;
};

/// Any number of cameras and projectors in one world.
struct InstallationCalibration {
    std::vector<CalibratedDevice> cameras, projectors;
    InstallationState state; ///< the world is the first camera's frame, in the board's unit; its bodies are the boards
    InstallationState sigma; ///< standard deviations of the numbers in `state`
    double rms = 0.0;        ///< root of the mean of the squares of all devices'
    std::vector<ViewQuality> views; ///< without errors of views left out
    std::string worstView;
    std::vector<Finding> warnings;
};

/// Solves for all cameras, projectors and boards together. Cameras find one another by boards that both see, or by a
/// projector whose light both see in three poses; no guess is needed, and boards that look the same when turned by 180
/// degrees may be found either way. Throws CaptureRefused: devices that share nothing with the first camera, by name;
/// what calibrateProcam and calibrateIntrinsics refuse of a part; nothing that fits all. InvalidInput where the lists
/// do not agree in length; Cancelled.
[[nodiscard]] InstallationCalibration calibrateInstallation(const std::vector<InstallationView>& views,
                                                            const std::vector<NamedDevice>& cameras,
                                                            const std::vector<NamedDevice>& projectors,
                                                            const Progress& progress = {});

} // namespace lumorph

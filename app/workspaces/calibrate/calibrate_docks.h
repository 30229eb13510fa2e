#pragma once

#include <QWidget>

#include "app/studio/calibration/calibration_service.h"
#include "app/studio/calibration/chain_service.h"
#include "app/studio/calibration/crosshair_service.h"
#include "app/studio/shell/studio.h"
#include "app/workspaces/calibrate/calibrate_selection.h"

namespace lumorph::studio {

/// What the parts of the Calibrate workspace have in common; outlived by all of it.
struct CalibrateParts {
    Studio& studio;
    CalibrationService& service;
    CrosshairService& crosshairs;
    LiveService& live;
    ChainService& chain;
    CalibrateSelection& selection;
};

/// The steps, the poses, and what is calibrated with.
[[nodiscard]] QWidget* makeStepsDock(const CalibrateParts& parts);
/// Figures in words, residuals, and what is to be doubted.
[[nodiscard]] QWidget* makeResultDock(const CalibrateParts& parts);
/// Earlier results, beside what is in use.
[[nodiscard]] QWidget* makeVersionsDock(const CalibrateParts& parts);
/// The card with the next step over the picture.
[[nodiscard]] QWidget* makeCalibrateView(const CalibrateParts& parts);
/// The same without a camera: points of the device, and the crosshair that is laid onto them.
[[nodiscard]] QWidget* makeCrosshairView(const CalibrateParts& parts);

} // namespace lumorph::studio

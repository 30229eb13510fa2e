#pragma once

#include <optional>
#include <vector>

#include "calibration/decode/refusal.h"
#include "calibration/patterns/capture_order.h"
#include "calibration/solve/procam_calibration.h"
#include "core/base/progress.h"

namespace lumorph {

/// A suspected cause, simulated: the capture solved again with what it would do to it.
struct Alternative {
    Cause cause = Cause::modelDoesNotFit;
    double amount = 0.0;    ///< of what the cause does, as a share of what is bearable
    double explained = 0.0; ///< of the squares of all errors that remain without it
    double sigmas = 0.0;    ///< standard deviations by which it explains more than nothing would
    std::string view;       ///< where it begins, or empty
    std::string words;      ///< what was found, with its figures
    std::string remedy;
};

/// Solves the capture again under each cause that residuals alone do not tell apart: the projector's picture warped or
/// stretched, the board bent or its squares not square, the camera refocused or moved between poses, phases bent by the
/// projector's gamma. The cause that explains most first. Throws Cancelled.
[[nodiscard]] std::vector<Alternative> alternativesOf(const std::vector<ViewObservations>& views,
                                                      const ProcamCalibration& result, const CaptureOrder& order,
                                                      const Progress& progress = {});

/// The cause that keeps a camera from being found, told from the board's points in a camera of that size alone: a bent
/// board or a camera that refocused takes a plain lens to a focal length at which all boards seem to lie the same way,
/// or nowhere. Nothing where a plain lens explains the points as well. Throws Cancelled.
[[nodiscard]] std::optional<Finding> causeInCamera(const std::vector<ViewObservations>& views, cv::Size camera,
                                                   const Progress& progress = {});

/// What was found to be wrong, and whether the calibration is worth nothing for it.
struct Explanation {
    Finding finding;
    bool refused = true;
};

/// The cause that explains what was seen, where one is needed: it does more than is bearable and takes away a good part
/// of the errors. Where none does and large errors remain, a lens that bends its picture in any smooth way is tried;
/// and a projector whose pixels are certainly askew is named however small the errors are. Nothing for a sound capture.
/// That all of a board is larger or smaller than said no capture can tell: it scales all lengths. Throws Cancelled.
[[nodiscard]] std::optional<Explanation> explanationOf(const std::vector<ViewObservations>& views,
                                                       const ProcamCalibration& result, const CaptureOrder& order,
                                                       const Progress& progress = {});

} // namespace lumorph

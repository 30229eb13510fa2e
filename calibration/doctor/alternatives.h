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
    std::string view;       ///< where it begins, or empty
    std::string words;      ///< what was found, with its figures
};

/// Solves the capture again under each cause that residuals alone do not tell apart: the projector's picture warped or
/// stretched, the board bent or its squares not square, the camera refocused between poses, phases bent by the
/// projector's gamma, a lens that bends its picture as no radial or tangential term does. From the cause that explains
/// most on. Throws Cancelled.
[[nodiscard]] std::vector<Alternative> alternativesOf(const std::vector<ViewObservations>& views,
                                                      const ProcamCalibration& result, const CaptureOrder& order,
                                                      const Progress& progress = {});

/// The cause that explains what was seen, where one is needed: it does more than is bearable and takes away a good part
/// of the errors. Nothing for a sound capture.
[[nodiscard]] std::optional<Finding> explanationOf(const std::vector<Alternative>& alternatives);

} // namespace lumorph

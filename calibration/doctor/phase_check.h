#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/capture_folder.h"
#include "calibration/patterns/capture_order.h"

namespace lumorph {

/// Looks for phase patterns that are not as said: a curve under which they swing more than light can
/// (`projector_gamma`, or `clipped` where that is cut off), another number of periods (`period_count`), steps in
/// another order (`phase_order`). The last two show where a set of phases is compared with the next coarser one. All
/// sets of an axis reversed alike is a mirror image, which one pose alone does not tell. Nothing for Gray codes.
[[nodiscard]] std::optional<Finding> checkPhases(const CapturedView& view, const std::vector<cv::Mat>& images,
                                                 const CaptureOrder& order);

/// How strong the finest phases of an axis are beside the coarsest.
struct FineContrast {
    double contrast = 1.0; ///< median ratio of their amplitudes
    int periods = 1;       ///< of the finest
};
/// Nothing for Gray codes, or where there is one set alone.
[[nodiscard]] std::optional<FineContrast> fineContrast(const std::vector<cv::Mat>& images, const CaptureOrder& order,
                                                       PatternAxis axis);

} // namespace lumorph

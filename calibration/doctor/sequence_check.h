#pragma once

#include <optional>
#include <vector>

#include "calibration/decode/capture_folder.h"
#include "calibration/decode/refusal.h"
#include "calibration/patterns/capture_order.h"

namespace lumorph {

/// Whether each pose has as many images as the order; what is wrong is told by the names of the files, and by whether
/// all poses have the same number. Nothing where they are right.
[[nodiscard]] std::optional<Finding> checkCounts(const std::vector<CapturedView>& views, const CaptureOrder& order);

/// Whether the images of one pose show what the order says: a pattern and its inverse, or the steps of a phase set,
/// make the same even light everywhere, and from where on they do so one image later or earlier tells a late frame from
/// a missing one. Finds late frames, doubled images, white and black swapped. Nothing where all is well.
[[nodiscard]] std::optional<Finding> checkSequence(const CapturedView& view, const std::vector<cv::Mat>& images,
                                                   const CaptureOrder& order);

} // namespace lumorph

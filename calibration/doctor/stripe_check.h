#pragma once

#include <optional>
#include <vector>

#include "calibration/decode/capture_folder.h"
#include "calibration/decode/refusal.h"
#include "calibration/patterns/capture_order.h"

namespace lumorph {

/// Whether the stripes of a Gray code are those that the order says: each bit has twice as many edges as the next
/// coarser one, all bits of an axis run the same way, and codes on both sides of an edge follow one another, which
/// fails from a bit on whose pattern and inverse are exchanged. Bits that the camera does not resolve tell nothing.
/// Nothing where all is well, or where there is no Gray code.
[[nodiscard]] std::optional<Finding> checkStripes(const CapturedView& view, const std::vector<cv::Mat>& images,
                                                  const CaptureOrder& order);

} // namespace lumorph

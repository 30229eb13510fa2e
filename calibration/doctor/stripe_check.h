#pragma once

#include <optional>
#include <vector>

#include "calibration/decode/capture_folder.h"
#include "calibration/decode/refusal.h"
#include "calibration/patterns/capture_order.h"

namespace lumorph {

/// Whether the stripes of a Gray code are those that the order says: all bits of an axis run the same way, and codes on
/// both sides of an edge follow one another. Where they do not, what makes them so is tried: a pattern and its inverse
/// exchanged, two bits exchanged, all inverses exchanged. Bits that the camera does not resolve tell nothing, and the
/// coarsest pattern exchanged with its inverse makes a mirror image, which is told elsewhere. Nothing where all is
/// well, or where there is no Gray code.
[[nodiscard]] std::optional<Finding> checkStripes(const CapturedView& view, const std::vector<cv::Mat>& images,
                                                  const CaptureOrder& order);

} // namespace lumorph

#pragma once

#include <opencv2/core.hpp>

namespace lumorph {

/// Which of a projector's two coordinates a pattern tells.
enum class PatternAxis { columns, rows };

/// One cosine of a phase shift pattern: along the axis of `size` pixels, pixel n (its centre, counted from 0) shows
///     127.5 + 127.5 cos(2 pi periods (n + 0.5) / length - 2 pi step / steps),
/// so that the phase is 0 at the projector's first edge and 2 pi `periods` at its last. 8-bit grey. Throws InvalidInput
/// for an empty size, fewer than three steps, or a period shorter than four pixels.
[[nodiscard]] cv::Mat phaseShiftPattern(cv::Size size, PatternAxis axis, int periods, int step, int steps);

} // namespace lumorph

#pragma once

#include <span>

#include "calibration/registration/hand_eye.h"
#include "calibration/registration/pose_file.h"

namespace lumorph {

/// As solveHandEye, from poses at which both bodies stood still: no clocks. Stations belong together by their names,
/// or, where the names of both differ and there are as many of each, by their order. The halves are every other
/// station, and are not a number below 12 stations; sigmas come from leaving out one station after another.
///
/// A station that the others contradict counts for nothing, and is told: `point_suspicious`. Throws CaptureRefused as
/// solveHandEye does, but for clocks and times; `too_few_points` for fewer than six pairs; Cancelled.
[[nodiscard]] HandEye solveHandEyeStations(std::span<const Station> a, std::span<const Station> b,
                                           const Progress& progress = {});

} // namespace lumorph

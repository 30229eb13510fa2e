#pragma once

#include <filesystem>

#include "calibration/patterns/capture_order.h"
#include "core/base/progress.h"

namespace lumorph {

/// Exports patterns to a new folder, to show them with another program and photograph them by hand: each pattern as a
/// picture whose name begins with its number, `order.txt` with what each shows (`readCaptureOrder` reads it), and
/// `patterns.mp4`, where each stands for `seconds`. Throws InvalidInput for a folder that holds something, seconds
/// outside [0.2, 60] or a projector that no film can have; DeviceError where it cannot be written; Cancelled. Then
/// nothing is left.
void writePatterns(const CaptureOrder& order, const std::filesystem::path& folder, double seconds,
                   const Progress& progress = {});

} // namespace lumorph

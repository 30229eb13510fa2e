#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/mdf/library_fit.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// What knowing the servos is worth: of shapes that are matched, what the real device makes of them.
struct ServoGain {
    double wanted = 0.0;                     ///< mean IoU of V(s) at the strokes that matching asks for
    double told = 0.0;                       ///< of the real device whose servos are told just these
    double measured = 0.0;                   ///< of the real device whose servos are told what the measured curves say
    double toldOff = 0.0, measuredOff = 0.0; ///< mean distance of real from projected vertices, metres
};

/// Matches each shape of the library, and has the servos of `truth` go from one to the next, first as if nothing were
/// known of them, then by the curves of `known`. Projection believes the device at the wanted strokes without, and
/// where the curves put it with, measured servos. Throws InvalidInput as LibraryMatcher does; Cancelled.
[[nodiscard]] ServoGain servoGain(const Rig& rig, std::span<const LibraryTarget> library, const Installation& known,
                                  const Installation& truth, const LibraryFitOptions& options,
                                  const Progress& progress = {});

} // namespace lumorph

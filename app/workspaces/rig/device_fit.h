#pragma once

#include <span>
#include <string>
#include <vector>

#include <QString>

#include "app/workspaces/common/fit_relief.h"
#include "core/mdf/library_fit.h"
#include "core/rig/servo_types.h"
#include "core/rig/shape_resolution.h"

namespace lumorph::studio {

/// How well a rig takes the shapes of a library, and what their pictures are drawn from.
struct DeviceFit {
    LibraryFit fit;
    std::vector<FitRelief> reliefs; ///< one a target
};

/// Throws what `LibraryMatcher` throws.
[[nodiscard]] DeviceFit fitDevice(const Rig& rig, std::span<const LibraryTarget> library,
                                  const LibraryFitOptions& options, const Progress& progress);

/// The joint state of a target's best fit, one stroke an actuator.
[[nodiscard]] std::vector<double> strokesOf(const LibraryFit& fit, std::size_t target);

/// "corner_low" as "Corner low".
[[nodiscard]] QString targetTitle(const std::string& name);
/// One sentence on all targets together.
[[nodiscard]] QString fitText(const LibraryFit& fit);
/// What the device makes of one target, in numbers.
[[nodiscard]] QString targetText(const TargetFit& target);
/// Which servos are too weak, and which would do; empty where none is.
[[nodiscard]] QString weakServosText(std::span<const ServoLoad> loads);

} // namespace lumorph::studio

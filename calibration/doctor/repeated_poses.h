#pragma once

#include <cstddef>
#include <vector>

#include "calibration/solve/procam_calibration.h"

namespace lumorph {

/// For each view the first one that shows the same: board and light within the noise of each other. Itself where it is
/// the first. What is there twice predicts itself well, so that held-out errors and halves would say nothing.
[[nodiscard]] std::vector<std::size_t> firstLike(const std::vector<ViewObservations>& views);

/// A result of the views that are the first of their kind, given back for all: those that repeat one have its pose, its
/// quality and its uncertainty.
void repeatFor(const std::vector<ViewObservations>& views, const std::vector<std::size_t>& first,
               ProcamCalibration& result);

} // namespace lumorph

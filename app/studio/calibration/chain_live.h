#pragma once

#include "app/studio/calibration/chain.h"
#include "calibration/registration/registration.h"

namespace lumorph::studio {

// Links of the chain measured with the tracker that is connected, step by step: what a person is asked to do, and what
// comes of the poses that were recorded then. The last points of each plan are fresh ones, which the fit never sees.
// What is solved throws as recordings do.

/// Swings in one dimple; then three others, two ways to hold the pointer in each.
[[nodiscard]] std::vector<LiveStep> pointerSteps(const Rig& rig, const Installation& room);
[[nodiscard]] Registration pointerFromLive(const LiveTask& task, const Progress& progress);

/// Dots that the first projector shows on the table.
[[nodiscard]] std::vector<LiveStep> trackerSteps(const Rig& rig, const Installation& room);
[[nodiscard]] Registration trackerFromLive(const LiveTask& task, const Progress& progress);

/// Corners of the device, whose body is tracked too.
[[nodiscard]] std::vector<LiveStep> deviceSteps(const Rig& rig, const Installation& room);
[[nodiscard]] Registration deviceFromLive(const LiveTask& task, const Progress& progress);

/// Dots that the tip covers for the eye, while the head is tracked.
[[nodiscard]] std::vector<LiveStep> eyeSteps(const Rig& rig, const Installation& room);
[[nodiscard]] Registration eyeFromLive(const LiveTask& task, const Progress& progress);

} // namespace lumorph::studio

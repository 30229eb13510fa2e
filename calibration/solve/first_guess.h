#pragma once

#include <optional>

#include "calibration/solve/bundle.h"

namespace lumorph {

/// Camera and board poses to begin with: for several focal lengths, and for `focal` (pixels) if given, the boards'
/// poses are worked out, all is refined with one radial term, and the best is kept. Returns the state, its camera free
/// of any bound: the principal point goes where the data want it. Throws CaptureRefused where no start leads anywhere.
[[nodiscard]] BundleState firstCamera(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                      cv::Size camera, const std::optional<double>& focal);

/// Adds the projector to `state`: as a general projection (direct linear transform, decomposed) of the points at which
/// decoded camera pixels meet the boards, so that its principal point may lie anywhere; and from several focal lengths
/// and lens shifts, for boards that lie nearly in one plane. Also from `focal`, if given. The best is kept.
void addFirstProjector(const std::vector<ViewObservations>& views, const ViewChoice& use, cv::Size projector,
                       const std::optional<double>& focal, BundleState& state);

/// A board's pose from the camera alone.
[[nodiscard]] PoseVector poseFromCamera(const ViewObservations& view, const Lens& camera);

} // namespace lumorph

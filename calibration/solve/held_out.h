#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibration/solve/bundle.h"

namespace lumorph {

/// The terms that a lens may have besides focal length and principal point, as they are tried: one after another.
[[nodiscard]] std::span<const std::vector<LensParameter>> lensTerms();

/// What of a lens is solved for, in words: "pinhole", "k1 k2".
[[nodiscard]] std::string lensModelName(const LensMask& free);
/// The reverse. Throws InvalidInput where a word is none of aspect, k1, k2, p1, p2, k3.
[[nodiscard]] LensMask lensModelOf(const std::string& name);

/// Corner errors of each view in `use` under a camera solved from the others, the view's own pose alone fitted to it;
/// root mean square lengths, camera pixels. Needs three views.
[[nodiscard]] std::vector<double> heldOutCorners(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                                 const BundleOptions& options, const BundleState& state);

/// Projector errors of each view in `use` under a solution from the others: its pose from the camera alone, its decoded
/// camera pixels on that plane reprojected into the projector; root mean square lengths, projector pixels. Needs three
/// views.
[[nodiscard]] std::vector<double> heldOutTransfers(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                                   const BundleOptions& options, const BundleState& state);

/// How far two halves of the views agree.
struct HalvesComparison {
    double differ = 0.0;  ///< root mean square distance in the projector, pixels
    double allowed = 0.0; ///< three times what their uncertainties make of it
};

/// Solves the even and the odd of `use` apart, from `state`, and compares where they put the light of the decoded
/// camera pixels at their depth. With few views a half cannot tell distortion, which both then take from `state`.
/// Needs four views.
[[nodiscard]] HalvesComparison compareHalves(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                             const BundleOptions& options, const BundleState& state);

} // namespace lumorph

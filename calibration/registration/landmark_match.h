#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calibration/registration/rigid_fit.h"

/// Which of some places is which point of a model. Private to landmarks.h.
namespace lumorph {

struct LandmarkMatch {
    std::vector<std::optional<std::size_t>> placeOf; ///< one a model point
    std::size_t count = 0;                           ///< that have a place
    RigidFit fit;                                    ///< of places to model points
    bool inOrder = false;                            ///< the places come in the order of the model's points
    bool ambiguous = false;                          ///< another choice fits as well, and neither is in order
};

/// Of all rigid ways to lay the places on the model, the one in which most points have a place within `radius` metres;
/// of equally good ones that in which they come in order. Nothing where fewer than three have.
[[nodiscard]] std::optional<LandmarkMatch> matchLandmarks(std::span<const glm::dvec3> places,
                                                          std::span<const glm::dvec3> model, double radius = 0.006);

} // namespace lumorph

#pragma once

#include <span>
#include <vector>

#include "core/loop/pose_stream.h"

namespace lumorph {

/// A rigid motion from points to points, least squares by singular values (Kabsch 1976; Umeyama 1991).
struct RigidFit {
    Pose toFromFrom;       ///< takes a point of `from` to `to`
    double rms = 0.0;      ///< of what is left, in the points' unit
    double scale = 1.0;    ///< by how much `to` is larger, were it free; 1 where the units agree
    bool mirrored = false; ///< a reflection fits far better: one of the two worlds is left-handed
};
/// Of at least three points that are not on a line; `weights` are one each, or empty. Throws InvalidInput for fewer
/// points, for another number of them, and for points on a line.
[[nodiscard]] RigidFit fitRigid(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to,
                                std::span<const double> weights = {});

} // namespace lumorph

#pragma once

#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/calibrated_camera.h"

namespace lumorph {

/// A camera or projector as the virtual lab projects through it: from the plain numbers of a CalibratedCamera, by
/// arithmetic of its own, so that the lab can judge what the renderer's cameras do.
struct LabLens {
    glm::ivec2 size{0};
    glm::dvec2 focal{1.0};
    glm::dvec2 principal{0.0};
    double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;
    glm::dmat3 worldFromLens{1.0};
    glm::dvec3 position{0.0};   ///< world metres
    double steepestSlope = 0.0; ///< tangent of the widest angle up to which distortion does not fold back
};

/// Throws InvalidInput, naming `what`, for a size or focal length that is not positive, or numbers that are not finite.
[[nodiscard]] LabLens lensOf(const CalibratedCamera& camera, const char* what);

/// Where a world point falls, in pixels (centres at whole numbers); empty behind the lens and where the distortion
/// folds back.
[[nodiscard]] std::optional<glm::dvec2> imageOf(const LabLens& lens, const glm::dvec3& point) noexcept;

/// The world direction, of length 1, seen through a place of the image; empty where no direction falls.
[[nodiscard]] std::optional<glm::dvec3> rayThrough(const LabLens& lens, const glm::dvec2& pixel) noexcept;

/// Whether a place lies in the image: [-0.5, size - 0.5).
[[nodiscard]] bool inImage(const LabLens& lens, const glm::dvec2& pixel) noexcept;

} // namespace lumorph

#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace lumorph {

/// A camera, a projector or a tracked eye as calibration knows it: pinhole with Brown distortion, in OpenCV's
/// conventions. Its frame has +X right, +Y down, +Z forward; pixel centres lie at whole numbers, (0, 0) is that of the
/// top left pixel, so the image covers [-0.5, size - 0.5). The principal point may lie outside the image (lens shift,
/// off-axis frusta).
struct CalibratedCamera {
    glm::ivec2 size{1280, 800};         ///< pixels
    glm::dvec2 focal{1500.0};           ///< pixels
    glm::dvec2 principal{639.5, 399.5}; ///< pixels
    std::array<double, 5> distortion{}; ///< k1, k2, p1, p2, k3
    glm::dmat4 cameraFromWorld{1.0};    ///< a rotation and a translation, metres
    bool operator==(const CalibratedCamera&) const = default;
};

/// Where it stands, world metres.
[[nodiscard]] glm::dvec3 positionOf(const CalibratedCamera& camera);

/// Where a world point falls, distortion included; empty behind the camera and beyond the radius at which the
/// distortion's polynomial folds back.
[[nodiscard]] std::optional<glm::dvec2> pixelOf(const CalibratedCamera& camera, const glm::dvec3& point);

/// The world direction, of length 1, in which a pixel looks; distortion is inverted to 1e-9.
[[nodiscard]] glm::dvec3 directionOf(const CalibratedCamera& camera, const glm::dvec2& pixel);

/// The square of the radius (at distance 1) up to which the distortion is monotonic; infinite without distortion.
[[nodiscard]] double distortionLimit(const CalibratedCamera& camera);

/// Clip space (OpenGL) from the camera's frame, without distortion: depth from `near` to `far` metres, image row 0 at
/// the top of the viewport.
[[nodiscard]] glm::dmat4 clipFromCamera(const CalibratedCamera& camera, double near, double far);

/// A camera at `position` that looks at `centre` with world +Y up in its image, no distortion, the principal point in
/// the middle. Straight down, -Z is up.
[[nodiscard]] CalibratedCamera cameraLookingAt(const glm::dvec3& position, const glm::dvec3& centre, glm::ivec2 size,
                                               double focal);

/// The tightest off-axis frustum of an eye that holds all points with `margin` (a share of each side) around them and
/// has square pixels: it looks at the middle of their box, and only its principal point follows the points. Throws
/// InvalidInput when a point lies beside or behind the eye, or there is none.
[[nodiscard]] CalibratedCamera eyeCamera(const glm::dvec3& eye, std::span<const glm::vec3> points, glm::ivec2 size,
                                         double margin = 0.04);

/// Throws InvalidInput naming what is wrong: sizes, focal lengths, numbers that are not finite, a pose that is no
/// rotation and translation.
void checkCamera(const CalibratedCamera& camera);

} // namespace lumorph

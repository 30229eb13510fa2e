#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/model.h"
#include "core/scene/scene_assets.h"

/// Small solids of which the landscape is built; metres, y up.
namespace lumorph::ambient {

using Primitive = Model::Primitive;

/// A ball, flattened or stretched by its radii.
void addBall(Primitive& to, const glm::vec3& centre, const glm::vec3& radii, int around = 14);

/// What a profile (radius, height; from below to above) makes when it turns about a vertical axis, closed above and
/// below where it does not end on the axis.
void addTurned(Primitive& to, const glm::vec3& foot, std::span<const glm::vec2> profile, int around = 20);

/// A flat face, its corners counterclockwise seen from outside.
void addFace(Primitive& to, std::span<const glm::vec3> corners);

/// A flat ring around the origin from a share of its radius of 1 to that; faces up.
[[nodiscard]] Primitive flatRing(double inner, int around = 28);

/// The surface y = height(x, z) over a rectangle, with walls down to `floor` along the rim; texture coordinates go from
/// 0 to 1 over the rectangle.
[[nodiscard]] Primitive terrain(const glm::vec2& min, const glm::vec2& max, const glm::ivec2& quads, float floor,
                                const std::function<float(float, float)>& height);

/// A flat strip around a line from the origin along x, as far as `far`, its half width from `narrow` to `wide`; faces
/// up. Texture coordinates go from 0.5 to 1 along it, and from 0 to 1 across.
[[nodiscard]] Primitive strip(float far, float narrow, float wide, int pieces = 16);

/// A model of one node with these parts, the k-th in the k-th of the materials.
[[nodiscard]] std::shared_ptr<const SceneModel> modelOf(std::string name, std::vector<Primitive> parts,
                                                        std::vector<Material> materials = {});

/// Soft noise in [0, 1], the same for the same place; `at` in cells. It repeats every `period` cells where that is not
/// 0.
[[nodiscard]] double noiseAt(const glm::dvec2& at, std::uint32_t seed, int period = 0) noexcept;

/// White whose alpha is full in the middle and fades to nothing at all rims: light in a haze.
[[nodiscard]] std::shared_ptr<const Image> glowPicture(const glm::ivec2& size);

/// White lace that repeats: its alpha is full along the seams of so many bubbles along a side and fades into them.
[[nodiscard]] std::shared_ptr<const Image> lacePicture(int side, int bubbles, std::uint32_t seed);

/// A picture of noise in four octaves that repeats; grey, spread over all values evenly.
[[nodiscard]] std::shared_ptr<const Image> coverPicture(int side, int cells, std::uint32_t seed);

} // namespace lumorph::ambient

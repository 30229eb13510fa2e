#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/image.h"
#include "core/scene/installation.h"

namespace lumorph {

/// A projector's picture as the light it becomes, linear, each channel with its gain.
struct LabPicture {
    glm::ivec2 size{0};
    std::vector<glm::vec3> light; ///< row 0 is the top
};

/// `gamma` 0: the picture is sRGB; else light = value^gamma.
[[nodiscard]] LabPicture labPicture(const Image& image, double gamma, const glm::vec3& gain);
/// By all that is known of a projector's response: gain, black, and its curve or gamma.
[[nodiscard]] LabPicture labPicture(const Image& image, const InstalledProjector& projector);

/// Light at a place, between pixel centres linearly; beyond the outermost centres that of the nearest.
[[nodiscard]] glm::vec3 lightAt(const LabPicture& picture, const glm::vec2& pixel) noexcept;

/// Linear radiance as a picture, sRGB, what is above 1 cut off. Throws InvalidInput when the sizes differ.
[[nodiscard]] Image labImage(const std::vector<glm::vec3>& radiance, glm::ivec2 size);

/// Light of an sRGB value in [0, 1], and back.
[[nodiscard]] double lightOfSrgb(double value) noexcept;
[[nodiscard]] glm::vec3 lightOfSrgb(const glm::vec3& color) noexcept;
[[nodiscard]] double srgbOfLight(double light) noexcept;

} // namespace lumorph

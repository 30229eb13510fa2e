#pragma once

#include <glm/vec2.hpp>

#include "core/base/image.h"
#include "core/scene/scene.h"

/// The parts of a height field's formula. Private to core/scene.
namespace lumorph {

/// A wave at one moment: its height is amplitude * sin(x * px + z * pz + phase).
struct WaveNumbers {
    double x = 0.0; ///< radians a metre
    double z = 0.0;
    double phase = 0.0;
};
[[nodiscard]] WaveNumbers waveNumbers(const Wave& wave, double seconds);

/// The share of the waves that is left at a point by the calm edge.
[[nodiscard]] float calmness(const HeightItem& item, const glm::vec2& point);

/// What the picture adds at a point, metres.
[[nodiscard]] float pictureHeight(const HeightItem& item, const Image& image, const glm::vec2& point);

} // namespace lumorph

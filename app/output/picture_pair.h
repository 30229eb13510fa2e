#pragma once

#include <array>

#include "core/base/image.h"
#include "core/base/words.h"

namespace lumorph {

/// Two pictures of the same height side by side, a thin line between them, each with its caption on a plate near its
/// lower edge; as wide as both. Throws InvalidInput for other heights, DataError where the font is missing.
[[nodiscard]] Image besideEachOther(const Image& left, const Image& right, const std::array<Words, 2>& captions,
                                    Language language);

/// Pixels of a picture within another.
[[nodiscard]] glm::ivec2 inlaySize(glm::ivec2 picture);
/// Puts it into the upper right corner, with a thin line around it.
void putInlay(Image& picture, const Image& inlay);

} // namespace lumorph

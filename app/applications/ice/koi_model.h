#pragma once

#include "core/base/image.h"
#include "core/scene/scene_assets.h"

namespace lumorph::ice {

inline constexpr int kKoiPoses = 12; ///< of a stroke of its tail

/// A fish of length 1 that swims along +x, its back up, in one pose of its stroke.
[[nodiscard]] SceneModel koiModel(int pose);

/// Its back: red and white, each number another fish.
[[nodiscard]] Image koiPicture(int number);

} // namespace lumorph::ice

#pragma once

#include <vector>

#include <QRect>
#include <QSize>

namespace lumorph::studio {

/// The pictures of the scene's stage.
enum class ScenePane { lab, eye, projector, device, cropped, uncropped };

/// How they share its room. `pair`: the lab, and smaller beside it the eye.
enum class StageMode { pair, eye, projector, device, all, compare };

struct StagePlace {
    ScenePane part;
    QRect box;
};
/// Where the pictures are; those that are left out are not in sight. They fill `size` but for narrow gaps.
[[nodiscard]] std::vector<StagePlace> viewLayout(StageMode mode, const QSize& size);

} // namespace lumorph::studio

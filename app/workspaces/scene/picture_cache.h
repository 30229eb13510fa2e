#pragma once

#include <map>
#include <memory>
#include <string>

#include <QPixmap>

#include "core/scene/scene_assets.h"

namespace lumorph::studio {

/// Small copies of pictures of the scene, made when they are first asked for.
class PictureCache {
public:
    /// A square of `side` pixels; null while the picture is not there.
    [[nodiscard]] QPixmap of(const SceneAssets* assets, const std::string& asset, int side);

private:
    std::weak_ptr<const Image> shown_;
    QPixmap small_;
};

} // namespace lumorph::studio

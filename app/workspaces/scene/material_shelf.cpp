#include "app/workspaces/scene/material_shelf.h"

#include "app/workspaces/scene/material_picture.h"
#include "core/scene/material_library.h"
#include "core/scene/scene_assets.h"

namespace lumorph::studio {

std::vector<QImage> paintShelf(int side, const Progress& progress) {
    const std::vector<Material> materials = readyMaterials();
    Scene holder; // only to name what they need
    for (const Material& material : materials) {
        SceneItem item;
        item.kind = ShapeItem{};
        item.material = material;
        holder.items.push_back(std::move(item));
    }
    const auto assets = loadSceneAssets(holder, {}, nullptr, progress);
    std::vector<QImage> pictures;
    for (const Material& material : materials) {
        progress.throwIfCancelled();
        pictures.push_back(paintMaterial(material, assets.get(), side));
    }
    return pictures;
}

} // namespace lumorph::studio

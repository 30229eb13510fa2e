#pragma once

#include "core/scene/scene.h"

/// Where a scene names files. Private to core/scene.
namespace lumorph {

/// Calls `visit` with the name of every asset of a material; works on const materials and others.
template <typename MaterialType, typename Visit> void forEachImage(MaterialType& material, const Visit& visit) {
    visit(material.colorTexture.image);
    for (auto& map : material.normalMaps) visit(map.image);
    visit(material.holes.image);
}

/// Calls `image` with the name of every picture and `model` with that of every model that a scene names, empty names
/// included.
template <typename SceneType, typename VisitImage, typename VisitModel>
void forEachAsset(SceneType& scene, const VisitImage& image, const VisitModel& model) {
    forEachImage(scene.device.material, image);
    forEachImage(scene.table.material, image);
    for (auto& item : scene.items) {
        forEachImage(item.material, image);
        if (auto* height = std::get_if<HeightItem>(&item.kind)) image(height->image);
        if (auto* mesh = std::get_if<MeshItem>(&item.kind)) model(mesh->model);
    }
}

} // namespace lumorph

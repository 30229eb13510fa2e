#include "core/loop/scene_clock.h"

#include <algorithm>

namespace lumorph {

namespace {

bool moves(const SceneTexture& texture) {
    return !texture.image.empty() && (texture.velocity != glm::vec2(0.0F) || texture.framesPerSecond > 0.0);
}

bool moves(const Material& material) {
    return moves(material.colorTexture) || moves(material.holes) ||
           std::ranges::any_of(material.normalMaps, [](const SceneTexture& map) { return moves(map); });
}

bool moves(const ItemMotion& motion) { return motion.spin != 0.0 || motion.bob != 0.0; }

bool moves(const HeightItem& item) {
    return std::ranges::any_of(item.waves, [](const Wave& w) { return w.amplitude != 0.0 && w.period != 0.0; });
}

bool moves(const MeshItem& item, const SceneAssets* assets) {
    if (item.animation < 0 || item.speed == 0.0) return false;
    if (!assets) return true;
    const auto model = assets->models.find(item.model);
    return model == assets->models.end() || !model->second || !model->second->model.animations.empty();
}

bool moves(const SceneItem& item, const SceneAssets* assets) {
    if (moves(item.motion) || moves(item.material)) return true;
    if (const auto* mesh = std::get_if<MeshItem>(&item.kind)) return moves(*mesh, assets);
    if (const auto* height = std::get_if<HeightItem>(&item.kind)) return moves(*height);
    const auto* fog = std::get_if<FogItem>(&item.kind);
    return fog && fog->drift != glm::vec2(0.0F);
}

} // namespace

void SceneClock::step(const MatchWish& wish, double sinceLast) {
    if (wish.sceneSeek && wish.sceneSeek != sought_)
        seconds_ = *wish.sceneSeek;
    else if (wish.scenePlaying)
        seconds_ += sinceLast;
    sought_ = wish.sceneSeek;
    if (wish.scene != scene_ || wish.assets != assets_) animated_ = isAnimated(*wish.scene, wish.assets.get());
    scene_ = wish.scene;
    assets_ = wish.assets;
    moves_ = wish.scenePlaying && animated_;
}

bool isAnimated(const Scene& scene, const SceneAssets* assets) {
    if (moves(scene.device.material) || moves(scene.table.material)) return true;
    return std::ranges::any_of(scene.items,
                               [&](const SceneItem& item) { return moves(item, assets) && isShown(scene, item); });
}

} // namespace lumorph

#include "app/applications/ambient/scenery.h"

#include <algorithm>
#include <cmath>

#include "app/applications/ambient/coming.h"
#include "app/applications/ambient/parts.h"
#include "app/applications/demo_items.h"

namespace lumorph::ambient {

SceneItem& itemOf(Scene& scene, int id) { return *std::ranges::find(scene.items, id, &SceneItem::id); }

SceneItem& addModel(Scene& scene, SceneAssets& assets, int id, const std::string& name,
                    std::shared_ptr<const SceneModel> model, bool ownMaterials) {
    const std::string asset = "ambient " + name;
    assets.models.emplace(asset, std::move(model));
    return scene.items.emplace_back(demoItem(id, name, MeshItem{.model = asset, .ownMaterials = ownMaterials}));
}

Material plain(const std::string& name, const glm::vec3& color, float roughness) {
    Material material;
    material.name = name;
    material.color = color;
    material.roughness = roughness;
    return material;
}

Material shining(const std::string& name, const glm::vec3& color, float strength) {
    Material material = plain(name, color, 0.5F);
    material.emission = color;
    material.emissionStrength = strength;
    return material;
}

double rise(double from, double to, double value) noexcept {
    const double share = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

double nightOf(const View& view) noexcept {
    return 1.0 - rise(Angle::degrees(-9.0).inRadians(), Angle::degrees(2.0).inRadians(), view.sun.elevation);
}

glm::dvec2 stonePlace(const Place& place, const SkyPosition& sun) noexcept {
    return kGnomon - kDialRadius * onDevice(place, sun.azimuth);
}

Scenery::~Scenery() = default;

Scenery::Scenery() : still_(defaultScene()), coming_(std::make_unique<Coming>()) {
    still_.device.show = DeviceSkin::Show::content;
    still_.items.clear();
    SceneAssets assets;
    addDaylight(still_);
    addShore(still_, assets);
    addWater(still_, assets);
    addAir(still_, assets);
    // What materials of the library and the table name is read from the resources beside what is in memory alone.
    const std::shared_ptr<const SceneAssets> read = loadSceneAssets(still_, {}, &assets);
    for (const auto& [name, image] : read->images) assets.images.emplace(name, image);
    Coming::addTo(still_, assets); // whose pictures come later
    assets_ = std::make_shared<const SceneAssets>(std::move(assets));
}

std::shared_ptr<const Scene> Scenery::show(const View& view) {
    if (coming_->update(view)) {
        auto changed = std::make_shared<SceneAssets>(*assets_);
        coming_->pictures(*changed);
        assets_ = std::move(changed);
    }
    auto scene = std::make_shared<Scene>(still_);
    showDaylight(*scene, view);
    showShore(*scene, view);
    showWater(*scene, view);
    showAir(*scene, view);
    coming_->show(*scene, view);
    return scene;
}

} // namespace lumorph::ambient

#include "app/applications/ice/pond.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "app/applications/demo_items.h"
#include "app/applications/ice/floe_model.h"
#include "app/applications/ice/koi_model.h"
#include "app/applications/ice/pond_bed.h"
#include "core/scene/material_library.h"

namespace lumorph::ice {
namespace {

// Assets that are in memory alone.
constexpr const char* kBedModel = "ice pond";
constexpr int kKoiPictures = 6;
constexpr double kWarmthHeight = 0.035;                   ///< of its light over the ice, metres
constexpr double kDeepest = 0.0042, kShallowest = 0.0082; ///< of fish, device metres

std::string koiPose(int pose) { return "ice koi pose " + std::to_string(pose); }
std::string koiCoat(int number) { return "ice koi " + std::to_string(number); }
std::string floeAsset(int number) { return "ice floe " + std::to_string(number); }

SceneItem& itemOf(Scene& scene, int id) { return *std::ranges::find(scene.items, id, &SceneItem::id); }

SceneItem waterItem() {
    const glm::vec2 size(2.0 * kPondHalf - 0.004);
    SceneItem item = demoItem(kWaterItem, "Water", ShapeItem{ShapeItem::Form::plane, {size.x, 0.001F, size.y}});
    item.position.y = static_cast<float>(kWaterLevel);
    item.material = readyMaterial("Water");
    item.material.color = {0.03F, 0.24F, 0.32F};
    item.material.emission = {0.02F, 0.36F, 0.48F};
    item.material.emissionStrength = 0.30F;
    item.material.refraction = 0.0F;
    item.material.reflection = 0.10F;
    item.material.roughness = 0.12F;
    item.material.normalStrength = 0.22F;
    item.material.normalMaps[0].velocity *= 0.4F;
    item.material.normalMaps[1].velocity *= 0.4F;
    item.opacity = 0.38F;
    return item;
}

SceneItem fishItem(int number) {
    SceneItem item = demoItem(kFirstFish + number, "Koi " + std::to_string(number + 1),
                              MeshItem{.model = koiPose(0), .ownMaterials = false});
    item.material.name = "Koi";
    item.material.color = glm::vec3(1.0F);
    item.material.colorTexture.image = koiCoat(number % kKoiPictures);
    item.material.colorTexture.tile = glm::vec2(1.0F);
    item.material.roughness = 0.35F;
    item.material.emission = {1.0F, 0.40F, 0.16F};
    item.material.emissionStrength = 0.22F;
    return item;
}

SceneItem warmthItem() {
    SceneItem item = demoItem(
        kWarmthItem, "Warmth",
        LightItem{.kind = LightItem::Kind::lamp, .color = {1.0F, 0.72F, 0.38F}, .intensity = 0.0, .shadows = false});
    item.visible = false;
    return item;
}

Scene stillScene(std::size_t fish) {
    Scene scene = defaultScene();
    scene.device.show = DeviceSkin::Show::content;
    scene.sky = {0.30F, 0.36F, 0.46F};
    SceneItem& sun = scene.items.front();
    sun.position = {-0.62F, 0.62F, -0.42F}; // a low winter sun: long, soft shadows
    sun.kind = LightItem{.color = {1.0F, 0.94F, 0.84F}, .intensity = 0.92, .softness = 0.07};
    scene.items.push_back(warmthItem());
    SceneItem bed = demoItem(kBedItem, "Pond", MeshItem{.model = kBedModel});
    scene.items.push_back(std::move(bed));
    scene.items.push_back(waterItem());
    for (std::size_t k = 0; k < fish; ++k) scene.items.push_back(fishItem(static_cast<int>(k)));
    return scene;
}

/// What all shows of the pond need; pictures are read once.
std::shared_ptr<const SceneAssets> stillAssets(const Scene& scene, const Polygon& shore) {
    auto bed = std::make_shared<const SceneModel>(pondBed(shore));
    Scene pictured = scene;
    std::erase_if(pictured.items, [](const SceneItem& item) { return item.id >= kFirstFish || item.id == kBedItem; });
    const auto add = [&](const Material& material) {
        SceneItem item = demoItem(1000 + static_cast<int>(pictured.items.size()), material.name, ShapeItem{});
        item.material = material;
        pictured.items.push_back(std::move(item));
    };
    for (const Material& material : bed->materials) add(material);
    for (const Material& material : iceMaterials()) add(material);
    auto assets = std::make_shared<SceneAssets>(*loadSceneAssets(pictured, {}));
    assets->models[kBedModel] = std::move(bed);
    for (int pose = 0; pose < kKoiPoses; ++pose)
        assets->models[koiPose(pose)] = std::make_shared<const SceneModel>(koiModel(pose));
    for (int k = 0; k < kKoiPictures; ++k) assets->images[koiCoat(k)] = std::make_shared<const Image>(koiPicture(k));
    return assets;
}

/// Turned about the vertical, from x to z, and tilted by slopes along x and z.
glm::quat turnOf(double turn, const glm::dvec2& slope) {
    const glm::dvec3 up = glm::normalize(glm::dvec3(-slope.x, 1.0, -slope.y));
    const glm::dvec3 axis = glm::cross(glm::dvec3(0.0, 1.0, 0.0), up);
    const double sine = glm::length(axis);
    const glm::dquat yaw = glm::angleAxis(-turn, glm::dvec3(0.0, 1.0, 0.0));
    const glm::dquat tilt =
        sine > 1e-9 ? glm::angleAxis(std::asin(std::min(1.0, sine)), axis / sine) : glm::dquat(1.0, 0.0, 0.0, 0.0);
    return glm::normalize(glm::quat(tilt * yaw));
}

void showFish(Scene& scene, const School& school, const glm::dvec2& waterSlope) {
    int number = 0;
    for (const Fish& fish : school.fish()) {
        SceneItem& item = itemOf(scene, kFirstFish + number++);
        const double risen = fish.depth * glm::dot(waterSlope, fish.place);
        item.position = {glm::dvec3(fish.place.x, std::lerp(kDeepest, kShallowest, fish.depth) + risen, fish.place.y)};
        item.rotation = turnOf(fish.heading, {});
        item.scale = glm::vec3(fish.length);
        const double share = fish.stroke / (2.0 * std::numbers::pi);
        const int pose = static_cast<int>(std::lround((share - std::floor(share)) * kKoiPoses)) % kKoiPoses;
        std::get<MeshItem>(item.kind).model = koiPose(pose);
    }
}

void showWarmth(Scene& scene, std::span<const Warmth> warmths) {
    if (warmths.empty()) return;
    SceneItem& item = itemOf(scene, kWarmthItem);
    item.visible = true;
    item.position = {glm::dvec3(warmths.front().place.x, kIceTop + kWarmthHeight, warmths.front().place.y)};
    std::get<LightItem>(item.kind).intensity = 0.006 * std::clamp(warmths.front().power, 0.0, 2.0);
}

} // namespace

Pond::Pond(const Polygon& shore, std::size_t fish) : still_(stillScene(fish)), assets_(stillAssets(still_, shore)) {}

/// New models for floes whose shape has changed, none for those that are gone.
void Pond::updateShapes(const IceCover& ice) {
    std::shared_ptr<SceneAssets> changed;
    const auto change = [&]() -> SceneAssets& {
        if (!changed) changed = std::make_shared<SceneAssets>(*assets_);
        return *changed;
    };
    std::map<int, Shape> shapes;
    for (const Floe& floe : ice.floes()) {
        const auto known = shapes_.find(floe.number);
        Shape shape = known == shapes_.end() ? Shape{} : known->second;
        if (shape.model.empty() || shape.version != floe.version || ice.freezing() != shape.grows || shape.grows) {
            shape = {floe.version, floe.centre, floeAsset(floe.number), ice.freezing()};
            change().models[shape.model] = std::make_shared<const SceneModel>(floeModel(ice, floe));
        }
        shapes.emplace(floe.number, std::move(shape));
    }
    for (const auto& [number, shape] : shapes_)
        if (!shapes.contains(number)) change().models.erase(shape.model);
    shapes_ = std::move(shapes);
    if (changed) assets_ = std::move(changed);
}

SceneItem Pond::floeItem(const Floe& floe) const {
    const Shape& shape = shapes_.at(floe.number);
    SceneItem item = demoItem(kFirstFloe + floe.number, "Floe", MeshItem{.model = shape.model});
    const glm::dvec2 place = placed(floe.motion.placement, shape.middle);
    item.position = {glm::dvec3(place.x, kIceTop + floe.bob.rise, place.y)};
    item.rotation = turnOf(floe.motion.placement.turn, floe.bob.tilt);
    return item;
}

std::shared_ptr<const Scene> Pond::show(const IceCover& ice, const School& school, std::span<const Warmth> warmths,
                                        const glm::dvec2& waterSlope) {
    updateShapes(ice);
    auto scene = std::make_shared<Scene>(still_);
    itemOf(*scene, kWaterItem).rotation = turnOf(0.0, waterSlope);
    showFish(*scene, school, waterSlope);
    showWarmth(*scene, warmths);
    for (const Floe& floe : ice.floes())
        if (floe.area > 0.0) scene->items.push_back(floeItem(floe));
    return scene;
}

} // namespace lumorph::ice

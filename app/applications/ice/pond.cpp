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
#include "app/applications/ice/water_model.h"
#include "core/scene/material_library.h"

namespace lumorph::ice {
namespace {

// Assets that are in memory alone.
constexpr const char *kBedModel = "ice pond", *kMeltwaterModel = "ice meltwater", *kRingModel = "ice ring";
constexpr int kKoiPictures = 6;
constexpr double kMeltModelEvery = 0.10, kFrostModelEvery = 0.07; ///< seconds between two models of a floe that changes
constexpr double kSharePerFrame = 0.4;  ///< of the pond's area, in which models are made anew in a short frame
constexpr double kRingSide = 0.0065;    ///< of a drop's ring in the end, metres
constexpr double kKeepsDry = 0.75;      ///< of what ice stands over the water
constexpr double kLetsGo = 0.4;         ///< seconds in which water takes its slope again, by a factor of e
constexpr double kOverWater = 0.0004;   ///< metres
constexpr double kWarmthHeight = 0.035; ///< of its light over the ice, metres
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

SceneItem meltwaterItem() {
    SceneItem item = demoItem(kMeltwaterItem, "Meltwater", MeshItem{.model = kMeltwaterModel, .ownMaterials = false});
    item.material.name = "Meltwater";
    item.material.color = {0.20F, 0.54F, 0.72F};
    item.material.roughness = 0.16F;
    item.material.reflection = 0.35F;
    item.material.emission = {0.40F, 0.80F, 1.0F};
    item.material.emissionStrength = 0.04F;
    item.opacity = 0.80F;
    item.visible = false;
    return item;
}

SceneItem ringItem(int number) {
    SceneItem item = demoItem(kFirstRing + number, "Ring", MeshItem{.model = kRingModel, .ownMaterials = false});
    item.material.name = "Ring";
    item.material.color = {0.86F, 0.97F, 1.0F};
    item.material.roughness = 0.4F;
    item.visible = false;
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
    scene.items.push_back(meltwaterItem());
    for (int k = 0; k < static_cast<int>(Meltwater::kMostDrips); ++k) scene.items.push_back(ringItem(k));
    for (std::size_t k = 0; k < fish; ++k) scene.items.push_back(fishItem(static_cast<int>(k)));
    return scene;
}

/// What all shows of the pond need; pictures are read once.
std::shared_ptr<const SceneAssets> stillAssets(const Scene& scene, const Polygon& shore) {
    auto bed = std::make_shared<const SceneModel>(pondBed(shore));
    Scene pictured = scene;
    std::erase_if(pictured.items,
                  [](const SceneItem& item) { return item.id >= kMeltwaterItem || item.id == kBedItem; });
    const auto add = [&](const Material& material) {
        SceneItem item = demoItem(1000 + static_cast<int>(pictured.items.size()), material.name, ShapeItem{});
        item.material = material;
        pictured.items.push_back(std::move(item));
    };
    for (const Material& material : bed->materials) add(material);
    for (Material material : iceMaterials()) {
        material.colorTexture = {}; // made here, and read nowhere
        add(material);
    }
    auto assets = std::make_shared<SceneAssets>(*loadSceneAssets(pictured, {}));
    assets->models[kBedModel] = std::move(bed);
    assets->models[kRingModel] = std::make_shared<const SceneModel>(ringModel());
    assets->images[kRimPicture] = std::make_shared<const Image>(rimPicture());
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

Pond::Pond(const Polygon& shore, std::size_t fish, std::uint64_t seed)
    : still_(stillScene(fish)), picture_(seed), meltwater_(seed), assets_(stillAssets(still_, shore)) {}

SceneAssets& Pond::changing() {
    if (!changed_) changed_ = std::make_shared<SceneAssets>(*assets_);
    return *changed_;
}

/// New models for floes whose shape has changed, none for those that are gone. What melts changes all the time, and a
/// few times a second are enough for the eye; its picture follows a frame later, so that no frame bears both.
void Pond::updateShapes(const IceCover& ice, double seconds) {
    // Pieces that broke at once would all be due at once: a frame takes its share of the pond, and one piece at least.
    // Long frames take more, so that the last pieces in the list are not left out for ever.
    double left = std::max(kSharePerFrame, seconds / kFrostModelEvery) * ice.sheet().area();
    std::map<int, Shape> shapes;
    for (const Floe& floe : ice.floes()) {
        const auto known = shapes_.find(floe.number);
        Shape shape = known == shapes_.end() ? Shape{} : std::move(known->second);
        shape.age += seconds;
        const bool isNew = shape.model.empty() || ice.freezing() != shape.grows;
        const bool changes = shape.version != floe.version || shape.grows;
        if (isNew || (changes && left > 0.0 && shape.age > (shape.grows ? kFrostModelEvery : kMeltModelEvery))) {
            left -= floe.area;
            const bool first = shape.model.empty();
            if (!shape.paints) shape.painted = std::move(shape.field);
            shape.field = fieldOf(ice, floe);
            shape.version = floe.version;
            shape.middle = floe.centre;
            shape.model = floeAsset(floe.number);
            shape.grows = ice.freezing();
            shape.age = 0.0;
            if (first || shape.paints) picture_.paint(shape.field, first ? nullptr : &shape.painted);
            shape.paints = !first && !shape.paints;
            changing().models[shape.model] = std::make_shared<const SceneModel>(floeModel(ice, floe, shape.field));
        } else if (std::exchange(shape.paints, false)) {
            picture_.paint(shape.field, &shape.painted);
        }
        shapes.emplace(floe.number, std::move(shape));
    }
    for (const auto& [number, shape] : shapes_)
        if (!shapes.contains(number)) changing().models.erase(floeAsset(number));
    shapes_ = std::move(shapes);
    const auto shown = assets_->images.find(kSheetPicture);
    if (shown == assets_->images.end() || shown->second != picture_.image())
        changing().images[kSheetPicture] = picture_.image();
}

void Pond::updateWater(const IceCover& ice, Scene& scene, const glm::dvec2& waterSlope) {
    const auto onFloe = [&](int number, const glm::dvec2& home) {
        const auto floe = std::ranges::find(ice.floes(), number, &Floe::number);
        if (floe == ice.floes().end()) return OnFloe{};
        const SceneItem item = floeItem(*floe);
        const Shape& shape = shapes_.at(number);
        const glm::dquat turn(item.rotation);
        const glm::dvec2 from = home - shape.middle;
        return OnFloe{glm::dvec3(item.position) + turn * glm::dvec3(from.x, topAt(shape.field, home), from.y),
                      turn * glm::dvec3(0.0, 1.0, 0.0)};
    };
    SceneModel model = waterModel(meltwater_, onFloe);
    const bool wet = !model.model.meshes.front().primitives.empty();
    if (wet) changing().models[kMeltwaterModel] = std::make_shared<const SceneModel>(std::move(model));
    if (!wet && wet_) changing().models.erase(kMeltwaterModel);
    wet_ = wet;
    itemOf(scene, kMeltwaterItem).visible = wet;
    int ring = kFirstRing;
    for (const Drip& drip : meltwater_.drips()) {
        const double share = drip.age / Meltwater::kDripLasts;
        SceneItem& item = itemOf(scene, ring++);
        item.visible = true;
        const double radius = kRingSide * std::sqrt(drip.volume) * std::lerp(0.12, 1.0, std::sqrt(share));
        item.position = {
            glm::dvec3(drip.place.x, kWaterLevel + kOverWater + glm::dot(waterSlope, drip.place), drip.place.y)};
        item.rotation = turnOf(0.0, waterSlope);
        item.scale = {radius, 1.0, radius};
        item.opacity = static_cast<float>(0.49 * (1.0 - share) * (1.0 - share));
    }
}

SceneItem Pond::floeItem(const Floe& floe) const {
    const Shape& shape = shapes_.at(floe.number);
    SceneItem item = demoItem(kFirstFloe + floe.number, "Floe", MeshItem{.model = shape.model});
    const glm::dvec2 place = placed(floe.motion.placement, shape.middle);
    item.position = {glm::dvec3(place.x, kIceTop + floe.bob.rise, place.y)};
    // Its low side stays over the water, which is drawn level and would lie on it with a straight rim.
    const double steep = floe.radius * glm::length(floe.bob.tilt - slope_);
    const double share = std::min(1.0, kKeepsDry * (kIceTop - kWaterLevel) / std::max(steep, 1e-9));
    item.rotation = turnOf(floe.motion.placement.turn, slope_ + share * (floe.bob.tilt - slope_));
    return item;
}

/// As much of the water's slope as shows: under ice that holds to the bank it cannot rise over its top.
glm::dvec2 Pond::underFixedIce(const IceCover& ice, const glm::dvec2& slope, double seconds) {
    const bool held = std::ranges::any_of(ice.floes(), &Floe::fixed);
    held_ += ((held ? 1.0 : 0.0) - held_) * (1.0 - std::exp(-seconds / kLetsGo));
    const double rise = std::abs(slope.x) * kPondHalf.x + std::abs(slope.y) * kPondHalf.y;
    const double most = kKeepsDry * (kIceTop - kWaterLevel);
    return rise > most ? slope * std::lerp(1.0, most / rise, held_) : slope;
}

std::shared_ptr<const Scene> Pond::show(const IceCover& ice, const School& school, const MeltingWeather& weather,
                                        double seconds, const glm::dvec2& waterSlope) {
    updateShapes(ice, seconds);
    const auto fieldOfFloe = [&](int number) {
        const auto known = shapes_.find(number);
        return known == shapes_.end() ? nullptr : &known->second.field;
    };
    meltwater_.advance(ice, fieldOfFloe, weather, seconds);
    const glm::dvec2 shown = slope_ = underFixedIce(ice, waterSlope, seconds);
    auto scene = std::make_shared<Scene>(still_);
    itemOf(*scene, kWaterItem).rotation = turnOf(0.0, shown);
    showFish(*scene, school, shown);
    showWarmth(*scene, weather.warmths);
    updateWater(ice, *scene, shown);
    for (const Floe& floe : ice.floes())
        if (floe.area > 0.0) scene->items.push_back(floeItem(floe));
    if (changed_) assets_ = std::exchange(changed_, nullptr);
    return scene;
}

} // namespace lumorph::ice

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "app/applications/ambient/forms.h"
#include "app/applications/ambient/parts.h"
#include "app/applications/demo_items.h"
#include "core/scene/material_library.h"

namespace lumorph::ambient {
namespace {

constexpr double kFoamLift = 0.10; ///< by which the foam's waves are higher: it breaks through at crests
constexpr double kRingSeconds = 1.3;
constexpr double kRingSide = 0.0085; ///< its radius in the end, metres
constexpr int kTouchRings = 5;       ///< of all rings, for a visitor's pointer
constexpr double kShallow = 0.0008;  ///< over the land's height, metres: water deep enough for a ring

glm::vec3 onSea(const View& view, const glm::dvec2& place, double over) {
    return {glm::dvec3(place.x, kSeaLevel + heightOf(view.waves, place) + over, place.y)};
}

/// Leans as the water does across so many metres.
glm::quat leanOfSea(const View& view, const glm::dvec2& place, double across) {
    const auto slope = [&](const glm::dvec2& step) {
        return (heightOf(view.waves, place + step) - heightOf(view.waves, place - step)) / (2.0 * across);
    };
    const glm::dvec2 slopes(slope({across, 0.0}), slope({0.0, across}));
    return glm::quat(glm::vec3(0.0F, 1.0F, 0.0F), glm::normalize(glm::vec3(glm::dvec3(-slopes.x, 1.0, -slopes.y))));
}

void addSea(Scene& scene, SceneAssets& assets) {
    assets.images.emplace("ambient lace", lacePicture(256, 12, 31U));
    HeightItem sea;
    sea.floor = static_cast<double>(kSheet) - kSeaLevel - 0.010;
    SceneItem water = demoItem(kSea, "Sea", sea);
    water.position.y = static_cast<float>(kSeaLevel);
    water.material = readyMaterial("Water");
    water.material.refraction = 0.05F;
    water.material.reflection = 0.16F;
    scene.items.push_back(water);
    HeightItem crests;
    crests.floor = 1.0; // no walls
    SceneItem foam = demoItem(kFoam, "Foam", crests);
    foam.material = plain("Foam", {0.93F, 0.96F, 0.97F}, 0.9F);
    foam.material.holes.image = "ambient cover";
    foam.material.holes.tile = {0.083F, 0.034F}; // longer along the wind
    foam.material.holes.velocity = {0.004F, 0.002F};
    foam.material.colorTexture.image = "ambient lace";
    foam.material.colorTexture.tile = {0.032F, 0.021F};
    foam.material.colorTexture.velocity = {0.004F, 0.002F};
    foam.material.emission = {0.85F, 0.93F, 1.0F};
    foam.material.emissionStrength = 0.05F; // water full of air is bright within
    foam.opacity = 0.92F;
    foam.visible = false;
    scene.items.push_back(std::move(foam));
}

void addBoat(Scene& scene, SceneAssets& assets) {
    std::vector<Primitive> parts(3); // hull, deck and mast, sails
    const glm::vec3 bow(0.0125F, 0.0040F, 0.0F), keelBow(0.0085F, -0.0020F, 0.0F), keelStern(-0.0090F, -0.0020F, 0.0F);
    for (const float side : {-1.0F, 1.0F}) {
        const glm::vec3 middle(0.0020F, 0.0030F, 0.0042F * side), stern(-0.0105F, 0.0034F, 0.0032F * side);
        const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
            side > 0.0F ? addFace(parts[0], std::array{a, b, c}) : addFace(parts[0], std::array{a, c, b});
        };
        add(keelBow, bow, middle);
        add(keelBow, middle, keelStern);
        add(keelStern, middle, stern);
    }
    const glm::vec3 left(-0.0105F, 0.0034F, -0.0032F), right(-0.0105F, 0.0034F, 0.0032F);
    addFace(parts[0], std::array{keelStern, right, left});
    addFace(parts[1],
            std::array{left, right, glm::vec3(0.0020F, 0.0030F, 0.0042F), bow, glm::vec3(0.0020F, 0.0030F, -0.0042F)});
    addTurned(parts[1], {0.0015F, 0.0025F, 0.0F}, std::array{glm::vec2(0.0004F, 0.0F), glm::vec2(0.0003F, 0.0215F)}, 8);
    for (const float side : {-1.0F, 1.0F}) {
        const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
            side > 0.0F ? addFace(parts[2], std::array{a, b, c}) : addFace(parts[2], std::array{a, c, b});
        };
        add({0.0008F, 0.0060F, 0.0F}, {0.0008F, 0.0235F, 0.0F}, {-0.0105F, 0.0062F, 0.0030F});
        add({0.0022F, 0.0205F, 0.0F}, {0.0022F, 0.0060F, 0.0F}, {0.0118F, 0.0052F, 0.0014F});
    }
    const std::vector<Material> materials{plain("Hull", {0.72F, 0.17F, 0.13F}, 0.4F),
                                          plain("Deck", {0.74F, 0.54F, 0.33F}),
                                          plain("Sail", {0.97F, 0.95F, 0.88F}, 0.9F)};
    addModel(scene, assets, kBoat, "Boat", modelOf("boat", std::move(parts), materials), true);
}

void showSea(Scene& scene, const View& view) {
    SceneItem& sea = itemOf(scene, kSea);
    std::get<HeightItem>(sea.kind).waves = view.waves;
    const auto rough = static_cast<float>(rise(5.0, 17.0, view.sea.wind));
    const auto grey = static_cast<float>(rise(0.4, 1.0, view.weather.cloudCover));
    const glm::vec3 fair(0.050F, 0.385F, 0.510F), dull(0.13F, 0.30F, 0.35F), stormy(0.09F, 0.22F, 0.26F);
    sea.material.color = glm::mix(glm::mix(fair, dull, 0.8F * grey), stormy, rough);
    sea.material.roughness = 0.15F + 0.20F * grey; // no glitter without a sun
    sea.material.normalStrength = 0.16F + 0.40F * rough;
    const double foamy = rise(5.0, 19.0, view.sea.wind);
    SceneItem& foam = itemOf(scene, kFoam);
    foam.visible = foamy > 0.01;
    if (!foam.visible) return;
    // Its waves stand out where the sea is higher than a share of its deviation: at crests.
    const double deviation = 0.25 * Sea::significantHeight(view.sea.wind);
    auto& waves = std::get<HeightItem>(foam.kind).waves;
    waves = view.waves;
    for (Wave& wave : waves) wave.amplitude *= 1.0 + kFoamLift;
    foam.position.y = static_cast<float>(kSeaLevel - kFoamLift * deviation * (1.7 - 0.7 * foamy) + 0.00005);
    foam.material.holeThreshold = static_cast<float>(0.95 - 0.38 * foamy);
    const auto bearing = std::atan2(view.sea.towards.y, view.sea.towards.x);
    foam.material.holes.turn = foam.material.colorTexture.turn = Angle::radians(bearing);
}

void showBoat(Scene& scene, const View& view) {
    SceneItem& boat = itemOf(scene, kBoat);
    const double way = 2.0 * std::numbers::pi * std::fmod(view.seconds / 70.0, 1.0);
    const glm::dvec2 place(0.058 + 0.024 * std::cos(way), 0.018 + 0.036 * std::sin(way));
    const glm::dvec2 ahead(-0.024 * std::sin(way), 0.036 * std::cos(way));
    const glm::quat heading =
        glm::angleAxis(static_cast<float>(-std::atan2(ahead.y, ahead.x)), glm::vec3(0.0F, 1.0F, 0.0F));
    // Wind from the side lays it over.
    const double across = ahead.x * view.sea.towards.y - ahead.y * view.sea.towards.x;
    const double heel = 0.45 * std::tanh(view.sea.wind / 9.0) * across / glm::length(ahead);
    const glm::quat heeled = glm::angleAxis(static_cast<float>(heel), glm::vec3(1.0F, 0.0F, 0.0F));
    boat.position = onSea(view, place, 0.0002);
    boat.rotation = leanOfSea(view, place, 0.009) * heading * heeled;
}

void addRings(Scene& scene, SceneAssets& assets) {
    assets.models.emplace("ambient ring", modelOf("ring", {flatRing(0.80)}));
    for (int k = 0; k < kRings; ++k) {
        SceneItem ring = demoItem(kFirstRing + k, "Ring", MeshItem{.model = "ambient ring", .ownMaterials = false});
        ring.material = plain("Ring", {0.86F, 0.95F, 1.0F}, 0.3F);
        ring.visible = false;
        scene.items.push_back(std::move(ring));
    }
}

/// A ring that runs out from a place; `age` in shares of its life.
void showRing(SceneItem& ring, const View& view, const glm::dvec2& place, double age, double strength) {
    const bool onWater = landHeight(place) + kShallow < kSeaLevel + heightOf(view.waves, place);
    ring.visible = strength > 0.02 && onWater;
    if (!ring.visible) return;
    const auto side = static_cast<float>(std::lerp(0.0006, kRingSide, std::sqrt(age)));
    ring.position = onSea(view, place, 0.0005);
    ring.rotation = leanOfSea(view, place, 0.5 * static_cast<double>(side));
    ring.scale = {side, 1.0F, side};
    ring.opacity = static_cast<float>(strength * (1.0 - age) * (1.0 - age));
}

void showRings(Scene& scene, const View& view) {
    const double raining = rise(0.0, 3.0, view.weather.rain);
    for (int k = 0; k < kRings; ++k) {
        const bool touch = k >= kRings - kTouchRings;
        const double lives = touch ? (view.seconds + k * kRingSeconds / kTouchRings) / kRingSeconds
                                   : view.seconds / kRingSeconds + 0.37 * k;
        const double born = std::floor(lives);
        SceneItem& ring = itemOf(scene, kFirstRing + k);
        if (touch) {
            if (view.touched) showRing(ring, view, *view.touched, lives - born, 0.8);
            continue;
        }
        // Another place in each life, the same whenever it is asked for.
        const auto chance = [&](std::uint32_t seed) { return noiseAt({born + 0.0, 7.0 * k}, seed); };
        const glm::dvec2 place(0.205 * (chance(1U) - 0.5), 0.145 * (chance(2U) - 0.5));
        const double share = std::clamp(raining * (kRings - kTouchRings) - k, 0.0, 1.0);
        showRing(ring, view, place, lives - born, 0.75 * share);
    }
}

} // namespace

void addWater(Scene& scene, SceneAssets& assets) {
    addSea(scene, assets);
    addBoat(scene, assets);
    addRings(scene, assets);
}

void showWater(Scene& scene, const View& view) {
    showSea(scene, view);
    showBoat(scene, view);
    showRings(scene, view);
}

} // namespace lumorph::ambient

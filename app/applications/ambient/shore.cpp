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

namespace lumorph::ambient {
namespace {

constexpr glm::vec2 kLandMin{-0.105F, -0.075F}, kLandMax{0.046F, 0.062F}; ///< x and z, metres
constexpr double kPlateau = 0.0212;                                       ///< over the sheet, metres
constexpr double kBed = -0.0065;                                          ///< likewise
constexpr double kTowerHeight = 0.0330;

glm::vec3 onLand(const glm::dvec2& place, double over = 0.0) {
    return {glm::dvec3(place.x, landHeight(place) + over, place.y)};
}

glm::vec3 landColor(const glm::dvec2& place) {
    const double over = landHeight(place) - kSeaLevel;
    const double grain = noiseAt(900.0 * place, 5U) - 0.5, patches = noiseAt(110.0 * place, 9U);
    const auto grassy = static_cast<float>(rise(0.0030, 0.0052, over + 0.0016 * (patches - 0.5)));
    const auto high = static_cast<float>(rise(0.013, 0.020, over + 0.004 * (patches - 0.5)));
    const auto wet = static_cast<float>(1.0 - rise(-0.0005, 0.0020, over));
    const double fromDial = glm::distance(place, kGnomon);
    const auto paved = static_cast<float>(1.0 - rise(0.0275, 0.0290, fromDial));
    const glm::vec3 sand = glm::mix(glm::vec3(0.87F, 0.77F, 0.56F), glm::vec3(0.55F, 0.47F, 0.33F), wet);
    const glm::vec3 grass =
        glm::mix(glm::vec3(0.36F, 0.50F, 0.20F), glm::vec3(0.50F, 0.58F, 0.26F), static_cast<float>(patches));
    glm::vec3 color = glm::mix(sand, grass, grassy);
    color = glm::mix(color, glm::vec3(0.47F, 0.45F, 0.42F), high);
    color = glm::mix(color, glm::vec3(0.90F, 0.86F, 0.78F), paved);
    // A ring of darker stone, on which the hours stand.
    const auto band = static_cast<float>(1.0 - rise(0.0012, 0.0020, std::abs(fromDial - kDialRadius)));
    color = glm::mix(color, glm::vec3(0.66F, 0.60F, 0.52F), 0.8F * band);
    return glm::clamp(color * static_cast<float>(1.0 + 0.16 * grain), 0.0F, 1.0F);
}

std::shared_ptr<const Image> landPicture() {
    const glm::ivec2 size(453, 411);
    auto picture = std::make_shared<Image>(size);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::vec2 share = (glm::vec2(x, y) + 0.5F) / glm::vec2(size);
            const glm::vec3 color = 255.0F * landColor(glm::dvec2(glm::mix(kLandMin, kLandMax, share)));
            picture->at(x, y) = {static_cast<std::uint8_t>(color.r), static_cast<std::uint8_t>(color.g),
                                 static_cast<std::uint8_t>(color.b), 255};
        }
    }
    return picture;
}

/// A picture of the assets stretched over the land once.
SceneTexture overLand(const std::string& image) {
    SceneTexture texture;
    texture.image = image;
    texture.tile = glm::vec2(1.0F);
    return texture;
}

void addLand(Scene& scene, SceneAssets& assets) {
    const auto height = [](float x, float z) { return static_cast<float>(landHeight({x, z})); };
    const auto land =
        modelOf("land", {terrain(kLandMin, kLandMax, {150, 136}, static_cast<float>(kSheet) - 0.008F, height)});
    assets.images.emplace("ambient land picture", landPicture());
    assets.images.emplace("ambient cover", coverPicture(256, 14, 3U));
    SceneItem& item = addModel(scene, assets, kLand, "Land", land);
    item.material = plain("Land", glm::vec3(1.0F), 0.95F);
    item.material.colorTexture = overLand("ambient land picture");
    SceneItem snow = demoItem(kLandSnow, "Snow that lies", MeshItem{.model = "ambient Land", .ownMaterials = false});
    snow.position.y = 0.0004F;
    snow.material = plain("Snow", {0.96F, 0.97F, 1.0F}, 0.9F);
    snow.material.holes = overLand("ambient cover");
    scene.items.push_back(std::move(snow));
}

void addTower(Scene& scene, SceneAssets& assets) {
    std::vector<Primitive> parts(3);
    constexpr int kBands = 5;
    const auto radiusAt = [](double height) { return static_cast<float>(std::lerp(0.0042, 0.0025, height / 0.026)); };
    for (int band = 0; band < kBands; ++band) {
        const double low = 0.026 * band / kBands, high = 0.026 * (band + 1) / kBands;
        const std::array profile{glm::vec2(radiusAt(low), low), glm::vec2(radiusAt(high), high)};
        addTurned(parts[static_cast<std::size_t>(band % 2)], {}, profile);
    }
    const std::array gallery{glm::vec2(0.0026F, 0.0255F), glm::vec2(0.0037F, 0.0262F), glm::vec2(0.0037F, 0.0268F),
                             glm::vec2(0.0F, 0.0268F)};
    addTurned(parts[2], {}, gallery);
    const std::array cap{glm::vec2(0.0028F, 0.0300F), glm::vec2(0.0F, static_cast<float>(kTowerHeight))};
    addTurned(parts[1], {}, cap);
    const std::vector<Material> materials{plain("Red", {0.80F, 0.16F, 0.12F}, 0.5F),
                                          plain("White", {0.96F, 0.95F, 0.92F}, 0.5F),
                                          plain("Iron", {0.16F, 0.17F, 0.19F}, 0.5F)};
    addModel(scene, assets, kTower, "Lighthouse", modelOf("lighthouse", std::move(parts), materials), true).position =
        onLand(kGnomon, -0.0005);
    SceneItem lantern =
        demoItem(kLantern, "Lantern", ShapeItem{ShapeItem::Form::cylinder, {0.0042F, 0.0036F, 0.0042F}});
    lantern.position = onLand(kGnomon, 0.0283 - 0.0005);
    lantern.material = shining("Lantern", {1.0F, 0.86F, 0.55F}, 0.2F);
    scene.items.push_back(std::move(lantern));
}

/// Two shafts of light that turn with the lamp, and lose themselves in the haze.
void addBeam(Scene& scene, SceneAssets& assets) {
    Primitive shafts = strip(0.125F, 0.0011F, 0.0125F), back = shafts;
    for (glm::vec3& position : back.positions) position = {-position.x, position.y, -position.z};
    const auto first = static_cast<std::uint32_t>(shafts.positions.size());
    shafts.positions.insert(shafts.positions.end(), back.positions.begin(), back.positions.end());
    shafts.normals.insert(shafts.normals.end(), back.normals.begin(), back.normals.end());
    shafts.texcoords.insert(shafts.texcoords.end(), back.texcoords.begin(), back.texcoords.end());
    for (const auto& corners : back.triangles) shafts.triangles.push_back(corners + first);
    assets.images.emplace("ambient beam", glowPicture({256, 64}));
    SceneItem& beam = addModel(scene, assets, kBeam, "Beam", modelOf("beam", {shafts}));
    beam.position = onLand(kGnomon, 0.0278);
    beam.material = shining("Beam", {1.0F, 0.90F, 0.62F}, 0.0F);
    beam.material.colorTexture = overLand("ambient beam");
    beam.material.unlit = true;
    beam.visible = false;
}

constexpr glm::dvec2 kHouseAt{-0.0845, -0.0225};

void addHouse(Scene& scene, SceneAssets& assets) {
    Primitive walls, roof;
    const float w = 0.0056F, d = 0.0042F, h = 0.0052F, top = 0.0092F, over = 0.0008F;
    const std::array<glm::vec3, 4> base{glm::vec3(-w, 0, d), glm::vec3(w, 0, d), glm::vec3(w, 0, -d),
                                        glm::vec3(-w, 0, -d)};
    const glm::vec3 up(0.0F, h, 0.0F);
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::vec3 &a = base[k], &b = base[(k + 1) % 4];
        addFace(walls, std::array{a, b, b + up, a + up});
    }
    for (const float side : {-1.0F, 1.0F})
        addFace(walls, std::array{glm::vec3(side * w, h, side * d), glm::vec3(side * w, h, -side * d),
                                  glm::vec3(side * w, top, 0.0F)});
    const float x = w + over, z = d + over, low = h - 0.0007F;
    addFace(roof, std::array{glm::vec3(-x, low, z), glm::vec3(x, low, z), glm::vec3(x, top + 0.0004F, 0.0F),
                             glm::vec3(-x, top + 0.0004F, 0.0F)});
    addFace(roof, std::array{glm::vec3(x, low, -z), glm::vec3(-x, low, -z), glm::vec3(-x, top + 0.0004F, 0.0F),
                             glm::vec3(x, top + 0.0004F, 0.0F)});
    SceneItem& house = addModel(scene, assets, kHouse, "House", modelOf("house", {walls}));
    house.position = onLand(kHouseAt, -0.0006);
    house.material = plain("Plaster", {0.95F, 0.91F, 0.82F});
    SceneItem& tiles = addModel(scene, assets, kRoof, "Roof", modelOf("roof", {roof}));
    tiles.position = onLand(kHouseAt, -0.0006);
    tiles.material = plain("Tiles", {0.62F, 0.26F, 0.18F});
    SceneItem window = demoItem(kWindow, "Window", ShapeItem{ShapeItem::Form::box, {0.0022F, 0.0022F, 0.0004F}});
    window.position = onLand(kHouseAt, 0.0022) + glm::vec3(0.0018F, 0.0F, d);
    window.material = shining("Window", {1.0F, 0.74F, 0.34F}, 0.1F);
    scene.items.push_back(std::move(window));
}

constexpr std::array<glm::dvec3, 13> kTrees{{// x, z and height
                                             {-0.0960, -0.0640, 0.0150},
                                             {-0.0880, -0.0685, 0.0125},
                                             {-0.0975, -0.0520, 0.0130},
                                             {-0.0800, -0.0665, 0.0140},
                                             {-0.0890, -0.0570, 0.0170},
                                             {-0.0770, -0.0715, 0.0110},
                                             {-0.1000, -0.0410, 0.0105},
                                             {-0.0800, -0.0560, 0.0120},
                                             {-0.0985, 0.0050, 0.0110},
                                             {-0.0915, 0.0110, 0.0135},
                                             {-0.0995, 0.0165, 0.0095},
                                             {-0.0730, -0.0600, 0.0090},
                                             {-0.0965, -0.0300, 0.0090}}};

void addTrees(Scene& scene, SceneAssets& assets) {
    Primitive trunks, crowns;
    for (const glm::dvec3& tree : kTrees) {
        const glm::vec3 foot = onLand({tree.x, tree.y}, -0.0005);
        const auto h = static_cast<float>(tree.z);
        addTurned(trunks, foot, std::array{glm::vec2(0.07F * h, 0.0F), glm::vec2(0.05F * h, 0.4F * h)}, 8);
        // Three skirts, one over the other.
        for (int tier = 0; tier < 3; ++tier) {
            const float low = h * (0.22F + 0.22F * static_cast<float>(tier));
            const float wide = h * (0.27F - 0.06F * static_cast<float>(tier));
            addTurned(crowns, foot,
                      std::array{glm::vec2(0.0F, low), glm::vec2(wide, low), glm::vec2(0.0F, low + 0.38F * h)}, 12);
        }
    }
    addModel(scene, assets, kTrunks, "Trunks", modelOf("trunks", {trunks})).material =
        plain("Bark", {0.33F, 0.23F, 0.16F});
    addModel(scene, assets, kCrowns, "Trees", modelOf("crowns", {crowns})).material =
        plain("Needles", {0.15F, 0.33F, 0.18F});
}

void addStones(Scene& scene) {
    for (int hour = 0; hour < kStones; ++hour) {
        const float side = hour == 12 ? 0.0042F : hour % 6 == 0 ? 0.0034F : 0.0026F;
        SceneItem stone = demoItem(kFirstStone + hour, "Hour " + std::to_string(hour),
                                   ShapeItem{ShapeItem::Form::cylinder, {side, 0.0012F, side}});
        stone.material = plain("Hour", glm::vec3(0.8F), 0.45F);
        scene.items.push_back(std::move(stone));
    }
}

/// Blue where it freezes, white at ten degrees, and red in heat.
glm::vec3 colorOfTemperature(double celsius) {
    const glm::vec3 cold(0.16F, 0.38F, 0.95F), mild(0.95F, 0.92F, 0.80F), hot(0.98F, 0.28F, 0.10F);
    return celsius < 10.0 ? glm::mix(cold, mild, static_cast<float>(rise(-8.0, 10.0, celsius)))
                          : glm::mix(mild, hot, static_cast<float>(rise(10.0, 36.0, celsius)));
}

void showStones(Scene& scene, const View& view) {
    const double hour = localHour(view.place, view.utc);
    const double night = nightOf(view);
    for (int k = 0; k < kStones; ++k) {
        SceneItem& stone = itemOf(scene, kFirstStone + k);
        const auto at = static_cast<std::size_t>(k);
        stone.position = onLand(stonePlace(view.place, view.dayHours[at]), 0.0004);
        stone.material.color = colorOfTemperature(view.dayTemperatures[at]);
        // The hour that runs glows; at night it is the only hand there is.
        const double near = std::abs(std::remainder(hour - k, 24.0));
        const double now = std::max(0.0, 1.0 - near);
        stone.material.emission = stone.material.color;
        stone.material.emissionStrength = static_cast<float>(now * (0.25 + 0.9 * night) + 0.10 * night);
    }
}

} // namespace

double landHeight(const glm::dvec2& place) noexcept {
    const glm::dvec2 from = (place - glm::dvec2(-0.052, -0.022)) / glm::dvec2(0.078, 0.060);
    const double wobble =
        0.12 * std::sin(3.0 * std::atan2(from.y, from.x) + 0.7) + 0.18 * (noiseAt(55.0 * place, 21U) - 0.5);
    const double far = glm::length(from) * (1.0 + wobble);
    const double slope = rise(0.52, 1.30, far);
    const auto hill = [&](double x, double z, double wide, double high) {
        const double square = (place.x - x) * (place.x - x) + (place.y - z) * (place.y - z);
        return high * std::exp(-0.5 * square / (wide * wide));
    };
    double height = std::lerp(kPlateau, kBed, slope);
    const double rough = rise(0.028, 0.036, glm::distance(place, kGnomon));
    height += rough * (hill(-0.092, -0.062, 0.017, 0.016) + hill(-0.060, -0.080, 0.014, 0.009) +
                       hill(-0.102, 0.010, 0.016, 0.006));
    height += rough * 0.0022 * (noiseAt(140.0 * place, 31U) - 0.5);
    return static_cast<double>(kSheet) + height;
}

void addShore(Scene& scene, SceneAssets& assets) {
    addLand(scene, assets);
    addTower(scene, assets);
    addBeam(scene, assets);
    addHouse(scene, assets);
    addTrees(scene, assets);
    addStones(scene);
}

void showShore(Scene& scene, const View& view) {
    const double snow = rise(0.0, 6.0, view.snowLying);
    const auto white = static_cast<float>(0.85 * snow);
    const glm::vec3 snowy(0.95F, 0.96F, 1.0F);
    SceneItem& cover = itemOf(scene, kLandSnow);
    cover.visible = snow > 0.01;
    cover.material.holeThreshold = static_cast<float>(1.0 - 0.97 * snow);
    for (const int id : {int{kRoof}, int{kCrowns}}) {
        Material& material = itemOf(scene, id).material;
        material.color = glm::mix(material.color, snowy, white);
    }
    const double night = nightOf(view);
    const double dim = std::max(night, 1.0 - rise(400.0, 4000.0, view.weather.visibility));
    itemOf(scene, kLantern).material.emissionStrength = static_cast<float>(0.3 + 2.2 * dim);
    itemOf(scene, kWindow).material.emissionStrength = static_cast<float>(0.05 + 1.2 * night);
    SceneItem& beam = itemOf(scene, kBeam);
    beam.visible = dim > 0.05;
    beam.opacity = static_cast<float>(0.62 * dim);
    constexpr double kBeamTurn = 9.0; // seconds
    const double turn = 2.0 * std::numbers::pi * std::fmod(view.seconds / kBeamTurn, 1.0);
    beam.rotation = glm::angleAxis(static_cast<float>(turn), glm::vec3(0.0F, 1.0F, 0.0F));
    showStones(scene, view);
}

} // namespace lumorph::ambient

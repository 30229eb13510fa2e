#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "app/applications/ambient/forms.h"
#include "app/applications/ambient/parts.h"
#include "app/applications/demo_items.h"

namespace lumorph::ambient {
namespace {

constexpr double kCloudHeight = 0.065;         ///< metres
constexpr glm::dvec2 kCloudRoom{0.235, 0.060}; ///< metres in x and z; who leaves it comes back on the other side
constexpr double kCloudsBefore = 0.046;        ///< metres that it lies nearer: no cloud hides the hours to come
/// Fog lies in the sea's hollow and rises from there over the land; its sides fade within the device's outline.
constexpr glm::vec2 kFogSides{0.206F, 0.130F};
constexpr float kFogBefore = 0.008F;                                           ///< metres that it lies nearer, likewise
constexpr double kFogFloor = 0.026, kThinFogTop = 0.042, kThickFogTop = 0.058; ///< heights, metres
constexpr double kFallRoom = 0.028; ///< metres through which rain and snow fall: below the reach of the tablet's flaps
constexpr float kRainLean = 0.30F;  ///< tangent by which streaks lean
constexpr double kRainSpeed = 0.17, kFlakeSpeed = 0.016; ///< metres a second

/// Cover that each of the clouds stands for, one after another.
double shareOfCloud(double cover, int k) { return std::clamp(cover * (kClouds + 0.6) - k, 0.0, 1.0); }

Primitive cloud(std::uint32_t seed) {
    Primitive puffs;
    constexpr int kPuffs = 7;
    for (int k = 0; k < kPuffs; ++k) {
        const auto chance = [&](std::uint32_t more) {
            return static_cast<float>(noiseAt({static_cast<double>(k), 0.0}, seed + more)) - 0.5F;
        };
        const float middle = 1.0F - std::abs(static_cast<float>(k) - 3.0F) / 4.0F;
        const glm::vec3 centre(0.0075F * (static_cast<float>(k) - 3.0F), 0.004F * middle + 0.002F * chance(1U),
                               0.012F * chance(2U));
        const float radius = 0.0055F + 0.0050F * middle + 0.003F * chance(3U);
        addBall(puffs, centre, {1.15F * radius, 0.72F * radius, radius}, 16);
    }
    return puffs;
}

void addClouds(Scene& scene, SceneAssets& assets) {
    for (int k = 0; k < kClouds; ++k) {
        SceneItem& item = addModel(scene, assets, kFirstCloud + k, "Cloud " + std::to_string(k + 1),
                                   modelOf("cloud", {cloud(40U + 7U * static_cast<std::uint32_t>(k))}));
        item.material = plain("Cloud", glm::vec3(0.95F), 1.0F);
        item.visible = false;
    }
}

/// From -0.5 to 0.5, around again.
double wrapped(double share) { return share - std::floor(share + 0.5); }

void showClouds(Scene& scene, const View& view) {
    const double dark = std::max(rise(0.3, 5.0, view.weather.rain), view.weather.thunder);
    const auto color =
        glm::mix(glm::vec3(0.96F, 0.97F, 1.0F), glm::vec3(0.36F, 0.38F, 0.43F), static_cast<float>(dark));
    for (int k = 0; k < kClouds; ++k) {
        SceneItem& item = itemOf(scene, kFirstCloud + k);
        const double share = shareOfCloud(view.weather.cloudCover, k);
        const glm::dvec2 at(wrapped(view.drifted.x / kCloudRoom.x + 0.618 * k),
                            wrapped(view.drifted.y / kCloudRoom.y + 0.395 * k));
        const double rim = std::max(std::abs(at.x), std::abs(at.y));
        const double seen = share * (1.0 - rise(0.36, 0.49, rim));
        item.visible = seen > 0.03;
        const glm::dvec2 place = at * kCloudRoom;
        item.position = {glm::dvec3(place.x, kCloudHeight + 0.003 * (k % 3), place.y + kCloudsBefore)};
        item.scale = glm::vec3(static_cast<float>(0.42 + 0.26 * share) * (k % 2 == 0 ? 1.0F : 0.80F));
        item.opacity = static_cast<float>(seen * 0.96);
        item.material.color = color;
        // Lit from inside by lightning.
        item.material.emission = {0.75F, 0.80F, 1.0F};
        item.material.emissionStrength = static_cast<float>(0.6 * view.lightning);
    }
}

void showFog(Scene& scene, const View& view) {
    const double thick = 1.0 - rise(250.0, 5500.0, view.weather.visibility);
    const glm::vec3 tone =
        glm::mix(glm::vec3(0.90F, 0.92F, 0.95F), glm::vec3(0.16F, 0.19F, 0.27F), static_cast<float>(nightOf(view)));
    for (int k = 0; k < kFogs; ++k) {
        const View::FogBank& bank = view.fog[static_cast<std::size_t>(k)];
        SceneItem& item = itemOf(scene, kFirstFog + k);
        auto& fog = std::get<FogItem>(item.kind);
        item.visible = thick > 0.01;
        item.opacity = static_cast<float>(thick * bank.share);
        fog.color = tone;
        fog.drift = glm::vec2(bank.drift);
        const double top = std::lerp(kThinFogTop, kThickFogTop, thick * bank.share);
        fog.size.y = static_cast<float>(top - kFogFloor);
        item.position.y = static_cast<float>(0.5 * (top + kFogFloor));
    }
}

void addFog(Scene& scene) {
    for (int k = 0; k < kFogs; ++k) {
        SceneItem item = demoItem(kFirstFog + k, "Fog",
                                  FogItem{{kFogSides.x, 0.02F, kFogSides.y}, 80.0, glm::vec3(0.9F), 0.050, {}});
        item.position.z = kFogBefore;
        item.visible = false;
        scene.items.push_back(std::move(item));
    }
}

/// What falls, scattered through its room; every layer another.
Primitive scattered(std::uint32_t seed, int count, const std::function<void(Primitive&, const glm::vec3&)>& add) {
    Primitive all;
    for (int k = 0; k < count; ++k) {
        const auto chance = [&](std::uint32_t more) {
            return static_cast<float>(noiseAt({3.0 * k, 0.0}, seed + more)) - 0.5F;
        };
        add(all, {0.205F * chance(1U), static_cast<float>(kFallRoom) * chance(2U), 0.145F * chance(3U)});
    }
    return all;
}

void addFalling(Scene& scene, SceneAssets& assets) {
    const auto streak = [](Primitive& to, const glm::vec3& at) {
        const glm::vec3 up(-0.006F * kRainLean, 0.006F, 0.0F);
        for (const glm::vec3& across : {glm::vec3(0.0002F, 0.0F, 0.0F), glm::vec3(0.0F, 0.0F, 0.0002F)}) {
            addFace(to, std::array{at - across, at + across, at + across + up, at - across + up});
            addFace(to, std::array{at + across, at - across, at - across + up, at + across + up});
        }
    };
    const auto flake = [](Primitive& to, const glm::vec3& at) { addBall(to, at, glm::vec3(0.00075F), 6); };
    for (int k = 0; k < kRainLayers; ++k) {
        SceneItem& rain = addModel(scene, assets, kFirstRain + k, "Rain " + std::to_string(k + 1),
                                   modelOf("rain", {scattered(100U + 5U * static_cast<std::uint32_t>(k), 46, streak)}));
        rain.material = shining("Rain", {0.72F, 0.84F, 0.95F}, 0.12F);
        rain.visible = false;
    }
    for (int k = 0; k < kFlakeLayers; ++k) {
        SceneItem& flakes =
            addModel(scene, assets, kFirstFlakes + k, "Snowflakes " + std::to_string(k + 1),
                     modelOf("flakes", {scattered(200U + 5U * static_cast<std::uint32_t>(k), 44, flake)}));
        flakes.material = shining("Flakes", glm::vec3(1.0F), 0.22F);
        flakes.visible = false;
    }
}

/// One of `layers` that fall one after another without end: it fades in above and out below.
void showLayer(SceneItem& item, const View& view, int k, int layers, double speed, double amount) {
    item.visible = amount > 0.02;
    if (!item.visible) return;
    const double life = view.seconds * speed / kFallRoom + static_cast<double>(k) / layers;
    const double fallen = life - std::floor(life);
    // The wind takes it along: streaks lean with it, slow snow goes far.
    const double lean = std::min(0.06 * view.weather.windSpeed, 1.0);
    const glm::dvec2 aside = view.sea.towards * (lean * kFallRoom * (fallen - 0.5));
    item.position = {glm::dvec3(aside.x, 0.052 - kFallRoom * (fallen - 0.5), aside.y)};
    const double bearing = std::atan2(view.sea.towards.y, view.sea.towards.x);
    item.rotation = glm::angleAxis(static_cast<float>(-bearing), glm::vec3(0.0F, 1.0F, 0.0F));
    item.opacity = static_cast<float>(amount * std::sin(3.14159 * fallen));
}

void addBolt(Scene& scene, SceneAssets& assets) {
    Primitive bolt;
    glm::vec3 from(0.0F, 0.050F, 0.0F);
    for (int k = 1; k <= 7; ++k) {
        const auto side = [&](std::uint32_t seed) { return static_cast<float>(noiseAt({5.0 * k, 0.0}, seed)) - 0.5F; };
        const glm::vec3 to(0.022F * side(61U), 0.050F - 0.00715F * static_cast<float>(k), 0.016F * side(62U));
        const float wide = 0.0009F - 0.0001F * static_cast<float>(k);
        for (const glm::vec3& across : {glm::vec3(wide, 0.0F, 0.0F), glm::vec3(0.0F, 0.0F, wide)}) {
            addFace(bolt, std::array{from - across, to - across, to + across, from + across});
            addFace(bolt, std::array{from + across, to + across, to - across, from - across});
        }
        from = to;
    }
    SceneItem& item = addModel(scene, assets, kBolt, "Bolt", modelOf("bolt", {bolt}));
    item.material = shining("Bolt", {0.85F, 0.90F, 1.0F}, 2.0F);
    item.material.unlit = true;
    item.visible = false;
}

} // namespace

void addAir(Scene& scene, SceneAssets& assets) {
    addClouds(scene, assets);
    addFog(scene);
    addFalling(scene, assets);
    addBolt(scene, assets);
}

void showAir(Scene& scene, const View& view) {
    showClouds(scene, view);
    showFog(scene, view);
    const double rain = std::sqrt(rise(0.0, 6.0, view.weather.rain)),
                 snow = std::sqrt(rise(0.0, 2.0, view.weather.snow));
    for (int k = 0; k < kRainLayers; ++k)
        showLayer(itemOf(scene, kFirstRain + k), view, k, kRainLayers, kRainSpeed, 0.55 * rain);
    for (int k = 0; k < kFlakeLayers; ++k)
        showLayer(itemOf(scene, kFirstFlakes + k), view, k, kFlakeLayers, kFlakeSpeed, 0.95 * snow);
    SceneItem& bolt = itemOf(scene, kBolt);
    bolt.visible = view.lightning > 0.35;
    bolt.position = {glm::dvec3(view.struck.x, 0.030, view.struck.y)};
}

} // namespace lumorph::ambient

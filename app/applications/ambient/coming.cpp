#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "app/applications/ambient/forms.h"
#include "app/applications/ambient/parts.h"
#include "app/applications/demo_items.h"

namespace lumorph::ambient {
namespace {

constexpr double kRowZ = -0.071, kRowY = 0.052; ///< metres: over the far rim
constexpr double kRowLeft = -0.050, kRowRight = 0.108;
constexpr double kMostFall = 0.020; ///< length of what falls, metres

int idOf(int hour, int part) { return kFirstComing + 3 * hour + part; }

Primitive smallCloud() {
    Primitive puffs;
    addBall(puffs, {-0.55F, 0.0F, 0.0F}, {0.55F, 0.38F, 0.40F}, 12);
    addBall(puffs, {0.05F, 0.16F, 0.0F}, {0.62F, 0.52F, 0.48F}, 12);
    addBall(puffs, {0.62F, -0.02F, 0.0F}, {0.50F, 0.34F, 0.38F}, 12);
    return puffs;
}

void showLightOf(SceneItem& light, const View::Coming& hour, const glm::vec3& place, double seen) {
    const glm::vec3 sun(1.0F, 0.66F, 0.12F), moon(0.62F, 0.70F, 0.95F);
    const double clear = 1.0 - 0.9 * rise(0.2, 1.0, hour.weather.cloudCover);
    const double fog = rise(300.0, 4000.0, hour.weather.visibility);
    light.position = place;
    light.scale = glm::vec3(static_cast<float>((hour.day ? 1.0 : 0.7) * (0.55 + 0.45 * clear)));
    light.material.color = light.material.emission = hour.day ? sun : moon;
    light.material.emissionStrength = static_cast<float>((0.4 + 0.9 * clear) * (0.3 + 0.7 * fog));
    light.opacity = static_cast<float>(0.49 * seen); // so that it throws no shadow on the sea
}

void showCloudOf(SceneItem& cloud, const View& view, const View::Coming& hour, const glm::vec3& place, double seen) {
    const double wet = rise(0.1, 5.0, hour.weather.rain + hour.weather.snow);
    const double cover = std::max(rise(0.12, 0.9, hour.weather.cloudCover), 0.6 * wet);
    cloud.visible = cover > 0.05;
    cloud.position = place + glm::vec3(0.0F, -0.0022F, 0.0045F);
    cloud.scale = glm::vec3(static_cast<float>(0.0025 + 0.0052 * cover));
    cloud.material.color =
        glm::mix(glm::vec3(0.93F, 0.95F, 0.98F), glm::vec3(0.34F, 0.36F, 0.42F), static_cast<float>(wet));
    // A thunderstorm to come flickers.
    const double flicker =
        std::max(0.0, std::sin(9.0 * view.seconds + 5.0 * hour.ahead) * std::sin(2.3 * view.seconds));
    cloud.material.emission = {0.55F, 0.40F, 1.0F};
    cloud.material.emissionStrength = static_cast<float>(0.06 + hour.weather.thunder * (0.2 + 1.4 * flicker));
    cloud.opacity = static_cast<float>(seen);
}

void showFallOf(SceneItem& fall, const View& view, const View::Coming& hour, const glm::vec3& place, double seen) {
    const bool snows = hour.weather.snow > hour.weather.rain;
    const double amount = std::sqrt(rise(0.0, snows ? 2.5 : 7.0, snows ? hour.weather.snow : hour.weather.rain));
    fall.visible = amount > 0.05;
    const double length = std::max(0.002, kMostFall * amount);
    // It slants with the wind of its hour, as seen from the front.
    const double blows = onDevice(view.place, hour.weather.windFrom + 3.14159).x * hour.weather.windSpeed;
    const double lean = std::clamp(0.05 * blows, -0.8, 0.8);
    fall.rotation = glm::angleAxis(static_cast<float>(lean), glm::vec3(0.0F, 0.0F, 1.0F));
    fall.position =
        place + glm::vec3(glm::dvec3(0.5 * length * std::sin(lean), -0.004 - 0.5 * length * std::cos(lean), 0.0045));
    fall.scale = {1.0F, static_cast<float>(length), 1.0F};
    fall.material.color = fall.material.emission =
        snows ? glm::vec3(0.97F, 0.98F, 1.0F) : glm::vec3(0.20F, 0.50F, 0.95F);
    fall.opacity = static_cast<float>(0.8 * seen);
}

} // namespace

void addComing(Scene& scene, SceneAssets& assets) {
    assets.models.emplace("ambient small cloud", modelOf("small cloud", {smallCloud()}));
    for (int k = 0; k < kComingHours; ++k) {
        SceneItem light = demoItem(idOf(k, 0), "Hour to come", ShapeItem{ShapeItem::Form::sphere, glm::vec3(0.0088F)});
        light.material = shining("Sky", {1.0F, 0.8F, 0.3F}, 1.0F);
        scene.items.push_back(std::move(light));
        SceneItem cloud =
            demoItem(idOf(k, 1), "Its clouds", MeshItem{.model = "ambient small cloud", .ownMaterials = false});
        cloud.material = plain("Cloud to come", glm::vec3(0.9F), 1.0F);
        scene.items.push_back(std::move(cloud));
        SceneItem fall = demoItem(idOf(k, 2), "Its rain", ShapeItem{ShapeItem::Form::box, {0.0030F, 1.0F, 0.0008F}});
        fall.material = shining("Fall", {0.2F, 0.5F, 0.95F}, 0.35F);
        scene.items.push_back(std::move(fall));
    }
}

void showComing(Scene& scene, const View& view) {
    for (int k = 0; k < kComingHours; ++k) {
        const View::Coming& hour = view.coming[static_cast<std::size_t>(k)];
        const double share = hour.ahead / kComingHours;
        const glm::vec3 place(glm::dvec3(std::lerp(kRowLeft, kRowRight, share), kRowY, kRowZ));
        // The nearest goes up in the present, the farthest comes out of the haze.
        const double seen =
            rise(0.0, 0.6, hour.ahead) * (1.0 - rise(kComingHours - 0.7, kComingHours + 0.0, hour.ahead));
        for (int part = 0; part < 3; ++part) itemOf(scene, idOf(k, part)).visible = true;
        showLightOf(itemOf(scene, idOf(k, 0)), hour, place, seen);
        showCloudOf(itemOf(scene, idOf(k, 1)), view, hour, place, seen);
        showFallOf(itemOf(scene, idOf(k, 2)), view, hour, place, seen);
    }
}

} // namespace lumorph::ambient

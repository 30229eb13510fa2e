#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/ambient/parts.h"
#include "app/applications/demo_items.h"

namespace lumorph::ambient {
namespace {

/// How a clear sky lights at an elevation of the sun.
struct SkyLight {
    double degrees;
    glm::vec3 sun;     ///< sRGB
    double sunshine;   ///< LightItem::intensity
    glm::vec3 ambient; ///< Scene::sky
};
constexpr std::array<SkyLight, 8> kClearSky{{
    {-18.0, {0.55F, 0.66F, 1.00F}, 0.00, {0.016F, 0.026F, 0.062F}},
    {-9.0, {1.00F, 0.45F, 0.25F}, 0.00, {0.030F, 0.042F, 0.100F}},
    {-4.0, {1.00F, 0.40F, 0.20F}, 0.00, {0.130F, 0.095F, 0.160F}},
    {-0.8, {1.00F, 0.42F, 0.18F}, 0.25, {0.300F, 0.185F, 0.185F}},
    {4.0, {1.00F, 0.56F, 0.26F}, 1.05, {0.320F, 0.230F, 0.210F}},
    {12.0, {1.00F, 0.78F, 0.52F}, 1.15, {0.280F, 0.260F, 0.270F}},
    {30.0, {1.00F, 0.95F, 0.84F}, 1.15, {0.260F, 0.300F, 0.350F}},
    {60.0, {1.00F, 0.98F, 0.93F}, 1.10, {0.270F, 0.320F, 0.380F}},
}};
constexpr double kLowest = 0.06;    ///< radians: lower lights are shown from there, so that shadows stay on the device
constexpr double kMoonshine = 0.22; ///< of a full moon, as LightItem::intensity
constexpr double kSeldomDark = 0.004; ///< a light is never quite out, so that it needs no other shader

SkyLight skyLightAt(double elevation) {
    const double degrees = Angle::radians(elevation).inDegrees();
    std::size_t k = 1;
    while (k + 1 < kClearSky.size() && kClearSky[k].degrees < degrees) ++k;
    const SkyLight &a = kClearSky[k - 1], &b = kClearSky[k];
    const double share = std::clamp((degrees - a.degrees) / (b.degrees - a.degrees), 0.0, 1.0);
    const auto f = static_cast<float>(share);
    return {degrees, glm::mix(a.sun, b.sun, f), std::lerp(a.sunshine, b.sunshine, share),
            glm::mix(a.ambient, b.ambient, f)};
}

glm::vec3 lightPlace(const View& view, SkyPosition position) {
    position.elevation = std::max(position.elevation, kLowest);
    return glm::vec3(towards(view.place, position));
}

/// How much of the sun comes through clouds and fog.
double clearness(const View& view) {
    const double fog = 1.0 - rise(200.0, 6000.0, view.weather.visibility);
    return (1.0 - 0.86 * rise(0.25, 1.0, view.weather.cloudCover)) * (1.0 - 0.65 * fog);
}

/// The sun gives way to the moon while neither shines.
void showKeyLight(Scene& scene, const View& view, const SkyLight& sky) {
    SceneItem& item = itemOf(scene, kKeyLight);
    auto& light = std::get<LightItem>(item.kind);
    const bool day = view.sun.elevation > kHorizon;
    item.position = lightPlace(view, day ? view.sun : view.moon.position);
    if (day) {
        light.color = sky.sun;
        light.intensity = sky.sunshine * clearness(view);
    } else {
        light.color = {0.62F, 0.74F, 1.0F};
        const double up = rise(-0.02, 0.15, view.moon.position.elevation);
        const double dark = 1.0 - rise(Angle::degrees(-10.0).inRadians(), kHorizon, view.sun.elevation);
        light.intensity = kMoonshine * view.moon.lit * up * dark * clearness(view);
    }
    light.intensity = std::max(light.intensity, kSeldomDark);
    light.softness = 0.03 + 0.25 * view.weather.cloudCover;
}

} // namespace

void addDaylight(Scene& scene) {
    scene.items.push_back(demoItem(kKeyLight, "Sun and moon", LightItem{.softness = 0.04}));
    SceneItem lamp = demoItem(kLampLight, "Light of the lighthouse",
                              LightItem{LightItem::Kind::lamp, {1.0F, 0.78F, 0.42F}, 0.01, 0.1, false});
    lamp.position = {glm::dvec3(kGnomon.x, landHeight(kGnomon) + 0.034, kGnomon.y)};
    scene.items.push_back(lamp);
    SceneItem flash =
        demoItem(kFlashLight, "Lightning", LightItem{LightItem::Kind::sun, {0.80F, 0.86F, 1.0F}, 0.01, 0.1, false});
    flash.position = {-0.3F, 1.0F, -0.5F};
    scene.items.push_back(flash);
}

void showDaylight(Scene& scene, const View& view) {
    const SkyLight sky = skyLightAt(view.sun.elevation);
    showKeyLight(scene, view, sky);
    // Clouds take the blue out of the light, and by day some of it.
    const auto grey = static_cast<float>(rise(0.3, 1.0, view.weather.cloudCover));
    const glm::vec3 overcast = glm::vec3(0.86F * glm::dot(sky.ambient, glm::vec3(0.333F)));
    scene.sky = glm::mix(sky.ambient, overcast * glm::vec3(0.94F, 1.0F, 1.08F), 0.75F * grey);
    scene.sky += static_cast<float>(0.5 * view.lightning) * glm::vec3(0.55F, 0.62F, 0.85F);
    const double night = nightOf(view);
    scene.exposure = 1.0 + 0.55 * night;
    std::get<LightItem>(itemOf(scene, kLampLight).kind).intensity =
        std::max(kSeldomDark, 0.0055 * std::max(night, 0.6 * rise(0.7, 1.0, view.weather.thunder)));
    std::get<LightItem>(itemOf(scene, kFlashLight).kind).intensity = std::max(kSeldomDark, 2.4 * view.lightning);
}

} // namespace lumorph::ambient

#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/applications/ambient/place.h"
#include "app/applications/ambient/sea.h"
#include "app/applications/ambient/sun.h"
#include "app/applications/ambient/weather.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph::ambient {

inline constexpr int kComingHours = 12, kCards = 5, kCardHours = 3;

/// What is to be seen at a moment: all that the landscape depends on.
struct View {
    double seconds = 0.0; ///< of the program: waves, rain and clouds move by it
    double utc = 0.0;     ///< of the world: sun, moon and hours
    Place place;
    WeatherHour weather;
    double snowLying = 0.0; ///< cm
    SkyPosition sun;
    Moon moon;
    SeaState sea;            ///< as light shows it
    std::vector<Wave> waves; ///< of it, and how it leans, over the sea's level
    glm::dvec2 drifted{0.0}; ///< way of what the wind has carried, metres in x and z
    double lightning = 0.0;  ///< 0 to 1
    glm::dvec2 struck{0.0};  ///< where, x and z of the device
    /// Two banks of fog take turns; each keeps the wind it began with while it is seen.
    struct FogBank {
        double share = 0.0;    ///< of the fog
        glm::dvec2 drift{0.0}; ///< metres a second in x and z
    };
    std::array<FogBank, 2> fog{};
    /// Where the sun stands at the whole hours of the day, from local midnight on.
    std::array<SkyPosition, 24> dayHours{};
    std::array<double, 24> dayTemperatures{};
    struct Coming {
        WeatherHour weather;
        bool day = true;
        double ahead = 0.0; ///< hours from now
    };
    std::array<Coming, kComingHours> coming{}; ///< the next whole hours
    /// A time to come that a card tells of: every third hour of the clock.
    struct Card {
        WeatherHour weather; ///< then; what falls is the most of the three hours about it
        bool day = true;
        double ahead = 0.0; ///< hours from now
        int slot = 0;       ///< the same as long as it is to come, below kCards
    };
    std::array<Card, kCards> cards{};  ///< the nearest first
    glm::dvec3 eye{0.0, 0.5, 0.5};     ///< of who looks, device metres
    std::optional<glm::dvec2> touched; ///< where a visitor points, x and z of the device
};

/// Items of the scene.
enum SceneryItem : int {
    kKeyLight = 1, ///< sun by day, moon by night
    kLampLight,
    kFlashLight,
    kLand,
    kLandSnow,
    kSea,
    kFoam,
    kTower,
    kLantern,
    kBeam,
    kHouse,
    kRoof,
    kWindow,
    kTrunks,
    kCrowns,
    kBoat,
    kBolt,
    kFirstFog = 30,
    kFirstCloud = 35,
    kFirstStone = 50,
    kFirstRing = 80,
    kFirstRain = 110,
    kFirstFlakes = 120,
    kFirstCard = 130,
};
inline constexpr int kFogs = 2, kClouds = 7, kStones = 24, kRings = 22, kRainLayers = 4, kFlakeLayers = 5;

/// Heights over the device's ground plane, metres.
inline constexpr double kSeaLevel = 0.032;
/// The land at a place, x and z of the device; below the sea it goes on as its bed.
[[nodiscard]] double landHeight(const glm::dvec2& place) noexcept;
/// Where the lighthouse stands, whose shadow falls on the stone of the hour.
inline constexpr glm::dvec2 kGnomon{-0.046, -0.022};
inline constexpr double kDialRadius = 0.0235; ///< of the ring of stones, metres
/// The stone of an hour at which the sun stands there: where the shadow falls, or would at night.
[[nodiscard]] glm::dvec2 stonePlace(const Place& place, const SkyPosition& sun) noexcept;

class Coming;

/// The landscape as light shows it: what stands still is made once, and `show` puts in what moves.
class Scenery {
public:
    Scenery();
    ~Scenery();

    [[nodiscard]] const std::shared_ptr<const SceneAssets>& assets() const noexcept { return assets_; }
    [[nodiscard]] std::shared_ptr<const Scene> show(const View& view);

private:
    Scene still_;
    std::unique_ptr<Coming> coming_;
    std::shared_ptr<const SceneAssets> assets_;
};

} // namespace lumorph::ambient

#pragma once

#include <map>
#include <memory>
#include <span>

#include "app/applications/ice/fish.h"
#include "app/applications/ice/floe_field.h"
#include "app/applications/ice/ice_cover.h"
#include "app/applications/ice/ice_picture.h"
#include "app/applications/ice/meltwater.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph::ice {

/// Items of the scene.
enum PondItem : int {
    kSunItem = 1,
    kWarmthItem, ///< the light of the first warmth
    kBedItem,
    kWaterItem,
    kMeltwaterItem,
    kFirstFish,
    kFirstRing = kFirstFish + 16,
    kFirstFloe = kFirstFish + 32 ///< and up: one more for each new floe
};

/// The pond as a visitor sees it: what stands still is made once; a floe's shape anew when it changes, its place in
/// each frame. All that lies beneath the ice lies beneath the device's sheet, and light alone reveals it.
class Pond {
public:
    static constexpr std::size_t kMostFish = 16;

    /// `fish` at most `kMostFish`.
    Pond(const Polygon& shore, std::size_t fish, std::uint64_t seed);

    /// After so many seconds.
    [[nodiscard]] std::shared_ptr<const Scene> show(const IceCover& ice, const School& school,
                                                    const MeltingWeather& weather, double seconds,
                                                    const glm::dvec2& waterSlope = {});
    /// Of the scene shown last.
    [[nodiscard]] const std::shared_ptr<const SceneAssets>& assets() const noexcept { return assets_; }
    [[nodiscard]] const Meltwater& meltwater() const noexcept { return meltwater_; }

private:
    struct Shape {
        std::uint64_t version = 0;
        glm::dvec2 middle{0.0}; ///< home coordinates of its origin
        std::string model;      ///< asset
        bool grows = false;     ///< while frost does
        double age = 0.0;       ///< seconds since its model was made
        FloeField field;
        FloeField painted;   ///< as the picture shows it, while that is behind
        bool paints = false; ///< the picture is behind
    };
    void updateShapes(const IceCover& ice, double seconds);
    void updateWater(const IceCover& ice, Scene& scene, const glm::dvec2& waterSlope);
    [[nodiscard]] glm::dvec2 underFixedIce(const IceCover& ice, const glm::dvec2& slope, double seconds);
    SceneAssets& changing();
    [[nodiscard]] SceneItem floeItem(const Floe& floe) const;

    Scene still_;
    std::map<int, Shape> shapes_; ///< by the floes' numbers
    IcePicture picture_;
    Meltwater meltwater_;
    glm::dvec2 slope_{0.0}; ///< of the water, as it shows
    double held_ = 1.0;     ///< by the bank, 0 to 1
    bool wet_ = false;      ///< whether meltwater was shown
    std::shared_ptr<const SceneAssets> assets_;
    std::shared_ptr<SceneAssets> changed_; ///< of this frame
};

} // namespace lumorph::ice

#pragma once

#include <map>
#include <memory>
#include <span>

#include "app/applications/ice/fish.h"
#include "app/applications/ice/ice_cover.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph::ice {

/// Items of the scene.
enum PondItem : int {
    kSunItem = 1,
    kWarmthItem, ///< the light of the first warmth
    kBedItem,
    kWaterItem,
    kFirstFish,
    kFirstFloe = kFirstFish + 32 ///< and up: one more for each new floe
};

/// The pond as a visitor sees it: what stands still is made once; a floe's shape anew when it changes, its place in
/// each frame. All that lies beneath the ice lies beneath the device's sheet, and light alone reveals it.
class Pond {
public:
    Pond(const Polygon& shore, std::size_t fish);

    [[nodiscard]] std::shared_ptr<const Scene> show(const IceCover& ice, const School& school,
                                                    std::span<const Warmth> warmths, const glm::dvec2& waterSlope = {});
    /// Of the scene shown last.
    [[nodiscard]] const std::shared_ptr<const SceneAssets>& assets() const noexcept { return assets_; }

private:
    struct Shape {
        std::uint64_t version = 0;
        glm::dvec2 middle{0.0}; ///< home coordinates of its origin
        std::string model;      ///< asset
        bool grows = false;     ///< while frost does
    };
    void updateShapes(const IceCover& ice);
    [[nodiscard]] SceneItem floeItem(const Floe& floe) const;

    Scene still_;
    std::map<int, Shape> shapes_; ///< by the floes' numbers
    std::shared_ptr<const SceneAssets> assets_;
};

} // namespace lumorph::ice

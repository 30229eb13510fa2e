#pragma once

#include <memory>

#include <glm/vec3.hpp>

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/map_view.h"
#include "app/applications/navigation/view_ground.h"
#include "core/base/image.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph::navigation {

inline constexpr int kInsetItem = 60; ///< id of the small map; those of its frame's four sides follow

/// A small map of all the land in the device's far left corner, and on it a frame around what is seen. Shown where less
/// than most of the land is.
class Inset {
public:
    static constexpr double kSide = 0.032; ///< of the longer side with its margin, device metres

    explicit Inset(const Map& map);

    void addTo(SceneAssets& assets) const;
    /// Adds its items as an eye sees them before all that stands (device metres).
    void show(Scene& scene, const ViewGround& ground, const glm::dvec3& eye) const;
    /// 0 to 1, by the width of a view.
    [[nodiscard]] double opacity(const MapView& view) const noexcept;
    /// Where a place is on it, in x and z of the device, for an eye before or behind the device.
    [[nodiscard]] glm::dvec2 pointAt(const glm::dvec2& place, const glm::dvec3& eye) const noexcept;

private:
    glm::dvec2 mapSize_, half_; ///< metres of the map; half the sheet in device metres
    std::shared_ptr<const Image> picture_;
    std::shared_ptr<const SceneModel> sheet_;
};

} // namespace lumorph::navigation

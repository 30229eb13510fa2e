#pragma once

#include <vector>

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/map_view.h"
#include "core/voxels/height_grid.h"

namespace lumorph::navigation {

/// The ground of a view on the device's grid, and how heights become metres on it.
class ViewGround {
public:
    static constexpr int kColumns = 106, kRows = 76; ///< samples, 2 mm apart
    static constexpr double kLowest =
        0.0130; ///< y of the lowest place, device metres: below the sheet at rest, so that servos
                ///< spend their range on what differs, and not on lifting it all
    static constexpr double kReach = 0.030; ///< metres from there to the highest place, at most
    static constexpr double kMostExaggeration = 2.2;

    /// Samples the map. Heights come to their new extent by and by, `seconds` after the ground before; at once without.
    ViewGround(const Map& map, const MapView& view, const ViewGround* before = nullptr, double seconds = 0.0);

    [[nodiscard]] const MapView& view() const noexcept { return view_; }
    /// Metres over the sea of a sample, in rows along x.
    [[nodiscard]] float height(int column, int row) const noexcept {
        return heights_[static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column)];
    }
    /// Metres on the device for a metre of height, of a view whose heights span so many metres.
    [[nodiscard]] static double perMetreOf(double relief, const MapView& view) noexcept;
    /// y on the device of a height over the sea.
    [[nodiscard]] double lift(double height) const noexcept { return kLowest + (height - low_) * perMetre_; }
    /// Metres on the device for a metre of height.
    [[nodiscard]] double perMetre() const noexcept { return perMetre_; }
    /// How much steeper all is than it is on the ground.
    [[nodiscard]] double exaggeration() const noexcept { return perMetre_ * view_.scale(); }
    /// y of the surface that is drawn, over a point of the device.
    [[nodiscard]] double surfaceAt(const glm::dvec2& point) const noexcept;
    [[nodiscard]] static glm::dvec2 pointAt(int column, int row) noexcept;
    /// Whether heights have come to their extent.
    [[nodiscard]] bool settled() const noexcept { return settled_; }

    /// For the servos, device metres.
    [[nodiscard]] HeightGrid grid() const;

private:
    MapView view_;
    std::vector<float> heights_;
    double low_ = 0.0, perMetre_ = 1.0;
    bool settled_ = true;
};

} // namespace lumorph::navigation

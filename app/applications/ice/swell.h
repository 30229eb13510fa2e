#pragma once

#include <span>

#include "app/applications/ice/ice_cover.h"
#include "core/voxels/height_grid.h"

namespace lumorph::ice {

/// What servos lift of the ice: under each floe that is free the water stands up as one broad mound, the higher the
/// more the device can rise there, so that whole floes are felt and none of their rims, which are for light.
class Swell {
public:
    static constexpr double kMost = 0.0090; ///< over the sheet, metres

    Swell();

    /// Mounds follow the floes.
    void advance(const IceCover& ice, const Bending& device, double seconds);
    /// Device metres.
    [[nodiscard]] const HeightGrid& heights() const noexcept { return heights_; }
    /// Over rest.
    [[nodiscard]] WaterLevel at(const glm::dvec2& place) const noexcept;

private:
    void addFloe(const IceCover& ice, const Floe& floe, double lift);
    void addCell(const Polygon& outline, double lift);
    void smooth();

    HeightGrid heights_;
    std::vector<float> wanted_, across_;
};

} // namespace lumorph::ice

#pragma once

#include <memory>
#include <vector>

#include "core/render/viewport/viewport_scene.h"
#include "core/rig/rig.h"

namespace lumorph::studio {

/// How far an actuator's full stroke alone takes each place of the surface, in bands of colour over the device.
class InfluenceMap {
public:
    static constexpr int kBands = 8;
    InfluenceMap(const Rig& rig, std::size_t actuator);

    /// The bands where the vertices are now, from the colour of what hardly moves to that of what goes farthest.
    [[nodiscard]] std::vector<ViewportSurface> surfaces(std::shared_ptr<const std::vector<glm::vec3>> positions,
                                                        const glm::vec3& low, const glm::vec3& high) const;
    /// Which band each triangle of the rest mesh is in; -1: it stays where it is.
    [[nodiscard]] const std::vector<int>& bands() const noexcept { return bands_; }

private:
    std::vector<int> bands_;
    std::vector<std::shared_ptr<const SurfaceShading>> shadings_; ///< one a band; null: it is empty
};

} // namespace lumorph::studio

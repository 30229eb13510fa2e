#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <glm/mat4x4.hpp>

#include "core/render/gl/program.h"
#include "core/render/gl/shadow_maps.h"
#include "core/render/viewport/viewport_frame.h"

namespace lumorph {

/// What shadows depend on: version and place of each caster, and the box the maps are fitted to.
struct ShadowCasters {
    std::vector<std::pair<std::uint64_t, glm::mat4>> casters;
    Box bounds;
};

/// The light of a viewport: one small shadow map in motion; a finer one and the sky's maps when it stands still. Maps
/// are drawn again only when their casters have changed.
class ViewportLight {
public:
    /// Brings the maps of this quality up to date. `drawCasters` draws with the depth program it is given;
    /// `pieceDone` is asked after each map and gives up by false, which is returned.
    bool update(ViewportQuality quality, const ShadowCasters& casters, const std::function<void(Program&)>& drawCasters,
                const std::function<bool()>& pieceDone);

    /// Sets and binds what studio_light.glsl or moving_light.glsl needs, in texture units 0 and 1.
    void apply(Program& program, const ViewportFrame& frame) const;

    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Maps {
        ShadowMaps maps;
        ShadowCasters drawn{}; // empty bounds: not drawn
    };
    static bool redraw(Maps& maps, std::span<const glm::vec3> directions, const ShadowCasters& casters,
                       const std::function<void(Program&)>& drawCasters, const std::function<bool()>& pieceDone);

    Maps moving_{ShadowMaps(512, 1)};
    Maps still_{ShadowMaps(1024, 1)};
    Maps sky_{ShadowMaps(112, kSkyCount)};
    std::array<glm::vec3, kSkyCount> skyDirections_ = skyDirections();
};

} // namespace lumorph

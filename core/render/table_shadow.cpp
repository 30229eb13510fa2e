#include "core/render/table_shadow.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

constexpr float kSharpest = 0.012F;   // metres, at least, that a shadow's edge may reach: pixels of its map, and bias
constexpr float kLowestLight = 0.02F; // lower lights throw shadows without end

bool includeShadow(Box& onTable, std::span<const glm::vec3> casters, const glm::mat4& worldFromCasters,
                   const PosedLight& light) {
    for (const glm::vec3& caster : casters) {
        const glm::vec3 from(worldFromCasters * glm::vec4(caster, 1.0F));
        const glm::vec3 way = light.parallel ? light.position : light.position - from;
        const float length = glm::length(way);
        if (!(way.y > kLowestLight * length) || !std::isfinite(from.x + from.y + from.z)) return false;
        const float height = std::max(from.y, 0.0F);
        const glm::vec3 at = from - way * (height / way.y);
        // Half the light's width over the way to the table, which it meets at a slant.
        const float stretched = length / way.y;
        const float blur = kSharpest + 0.5F * light.softness * height * stretched * stretched;
        onTable.include(at - blur);
        onTable.include(at + blur);
    }
    return true;
}

} // namespace

std::optional<TableArea> shadowsOnTable(const ShowFrame& frame, const PosedLight& light) {
    Box shadows;
    if (frame.scene->device.show == DeviceSkin::Show::material && frame.devicePositions &&
        !includeShadow(shadows, *frame.devicePositions, frame.worldFromDevice, light))
        return std::nullopt;
    for (const PosedSurface& surface : frame.posed.surfaces)
        if (surface.shown() && surface.castsShadow &&
            !includeShadow(shadows, cornersOf(boundingBox(*surface.positions)), surface.worldFromSurface, light))
            return std::nullopt;
    if (shadows.empty()) return TableArea{};
    return TableArea{{shadows.min.x, shadows.min.z}, {shadows.max.x, shadows.max.z}};
}

} // namespace lumorph

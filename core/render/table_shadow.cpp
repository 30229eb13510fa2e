#include "core/render/table_shadow.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

constexpr float kPenumbra = 0.03F;    // metres, at least, that a shadow's edge may be wide
constexpr float kLowestLight = 0.02F; // lower lights throw shadows without end

} // namespace

bool includeShadow(Box& onTable, const Box& caster, const PosedLight& light) {
    for (unsigned i = 0; i < 8; ++i) {
        const glm::vec3 corner((i & 1U) != 0 ? caster.max.x : caster.min.x, (i & 2U) != 0 ? caster.max.y : caster.min.y,
                               (i & 4U) != 0 ? caster.max.z : caster.min.z);
        const glm::vec3 way = light.parallel ? light.position : light.position - corner;
        if (!(way.y > kLowestLight * glm::length(way))) return false;
        const float height = std::max(corner.y, 0.0F);
        const glm::vec3 at = corner - way * (height / way.y);
        const float blur = kPenumbra + 2.0F * light.softness * height * glm::length(way) / way.y;
        onTable.include(at - blur);
        onTable.include(at + blur);
    }
    return true;
}

} // namespace lumorph

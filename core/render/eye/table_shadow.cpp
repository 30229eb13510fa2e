#include "core/render/eye/table_shadow.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "core/render/eye/device_surface.h"

namespace lumorph {
namespace {

constexpr float kSharpest = 0.004F;     // metres that the sharpest edge may reach: bias
constexpr float kMapPixels = 0.01F;     // and of the casters' radius: some pixels of the map
constexpr float kLowestLight = 0.02F;   // lower lights throw shadows without end
constexpr float kFarthestCaster = 1.5F; // metres from the device's middle

// What throws shadows.
struct Casters {
    Box box;               ///< in the world
    float distance = 0.0F; ///< of a lamp from the farthest of them
};

Casters castersOf(const ShowFrame& frame, const PosedLight& light) {
    Casters casters{casterBounds(frame)};
    for (const glm::vec3& corner : cornersOf(casters.box))
        casters.distance = std::max(casters.distance, glm::distance(corner, light.position));
    return casters;
}

bool includeShadow(Box& onTable, std::span<const glm::vec3> points, const glm::mat4& worldFromPoints,
                   const PosedLight& light, const Casters& casters) {
    const float sharpest = kSharpest + kMapPixels * 0.5F * glm::length(casters.box.size());
    for (const glm::vec3& point : points) {
        const glm::vec3 from(worldFromPoints * glm::vec4(point, 1.0F));
        const glm::vec3 way = light.parallel ? light.position : light.position - from;
        const float length = glm::length(way);
        if (!(way.y > kLowestLight * length) || !std::isfinite(from.x + from.y + from.z)) return false;
        const float height = std::max(from.y, 0.0F);
        const glm::vec3 at = from - way * (height / way.y);
        // Half the light's width over the way to the table, which it meets at a slant; a lamp's is as wide as its
        // softness at the casters' distance.
        const float stretched = length / way.y;
        const float nearness = light.parallel ? 1.0F : std::max(casters.distance / length, 1.0F);
        const float blur = stretched * (sharpest + 0.5F * light.softness * nearness * height * stretched);
        onTable.include(at - blur);
        onTable.include(at + blur);
    }
    return true;
}

} // namespace

Box casterBounds(const ShowFrame& frame) {
    Box box;
    glm::vec3 middle(frame.worldFromDevice[3]);
    if (frame.rig) {
        box = deviceBounds(frame);
        middle = box.centre();
    }
    for (const PosedSurface& surface : frame.posed.surfaces)
        if (const auto corners = seenCorners(surface)) box.include(boundingBox(*corners));
    if (box.empty()) box.include(middle);
    box.min = glm::max(box.min, middle - kFarthestCaster);
    box.max = glm::min(box.max, middle + kFarthestCaster);
    return box;
}

std::optional<TableArea> shadowsOnTable(const ShowFrame& frame, const PosedLight& light) {
    Box shadows;
    const Casters casters = castersOf(frame, light);
    if (frame.scene->device.show == DeviceSkin::Show::material && frame.devicePositions &&
        !includeShadow(shadows, *frame.devicePositions, frame.worldFromDevice, light, casters))
        return std::nullopt;
    for (const PosedSurface& surface : frame.posed.surfaces) {
        const auto corners = seenCorners(surface);
        if (surface.castsShadow && corners && !includeShadow(shadows, *corners, glm::mat4(1.0F), light, casters))
            return std::nullopt;
    }
    if (shadows.empty()) return TableArea{};
    return TableArea{{shadows.min.x, shadows.min.z}, {shadows.max.x, shadows.max.z}};
}

} // namespace lumorph

#include "core/render/eye/eye_skin.h"

#include <algorithm>
#include <vector>

#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/render/eye/eye_programs.h"

namespace lumorph {
namespace {

constexpr float kEverywhere = 1e9F;
constexpr float kWall = 0.0015F; // metres: what is thinner is the skin itself

// Of the device as it appears: x and z from and to.
glm::vec4 outlineOf(const DeviceSkin& skin, const Box& rest) {
    const float share = 1.0F - static_cast<float>(std::clamp(skin.shrink, 0.0, 1.0));
    const glm::vec3 centre = rest.centre();
    const glm::vec3 half = 0.5F * share * rest.size();
    return {centre.x - half.x, centre.z - half.z, centre.x + half.x, centre.z + half.z};
}

} // namespace

std::uint32_t skinFeatures(const DeviceSkin& skin) {
    using namespace eye_feature;
    std::uint32_t bits = eye_feature::skin;
    if (skin.shrink > 0.0) bits |= holes;
    const auto count = std::min(static_cast<std::uint32_t>(skin.holes.size()), kMostRoundHoles);
    if (count > 0) bits |= holes | count << holeShift;
    return bits;
}

void applySkin(Program& program, const DeviceSkin& skin, const Box& rest, const glm::mat4& worldFromDevice) {
    program.set("deviceFromWorld", glm::inverse(worldFromDevice));
    const glm::vec4 everywhere(-kEverywhere, -kEverywhere, kEverywhere, kEverywhere);
    program.set("shrunkOutline", skin.shrink > 0.0 ? outlineOf(skin, rest) : everywhere);
    program.set("insideOutline",
                glm::vec4(rest.min.x + kWall, rest.min.z + kWall, rest.max.x - kWall, rest.max.z - kWall));
    program.set("insideTop", glm::vec2(rest.max.y, rest.max.y - kWall));
    std::vector<glm::vec3> holes;
    for (const DeviceSkin::Hole& hole : skin.holes) {
        if (holes.size() == kMostRoundHoles) break;
        const auto radius = static_cast<float>(hole.radius);
        holes.emplace_back(hole.centre, radius * radius);
    }
    if (!holes.empty()) program.set("holes", std::span<const glm::vec3>(holes));
}

void applyHolesAbove(Program& program, const DeviceSkin& skin, const Box& rest, const glm::mat4& worldFromDevice) {
    program.set("worldFromDevice", worldFromDevice);
    program.set("deviceFromWorld", glm::inverse(worldFromDevice));
    program.set("deviceOutline", outlineOf(skin, rest));
    program.set("deviceTop", rest.max.y);
}

} // namespace lumorph

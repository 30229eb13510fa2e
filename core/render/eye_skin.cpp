#include "core/render/eye_skin.h"

#include <algorithm>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/render/eye_programs.h"

namespace lumorph {
namespace {

constexpr std::size_t kMostHoles = 32; // as in eye_holes.glsl
constexpr float kEverywhere = 1e9F;

} // namespace

std::uint32_t skinFeatures(const DeviceSkin& skin) {
    using namespace eye_feature;
    std::uint32_t bits = eye_feature::skin;
    if (skin.shrink > 0.0) bits |= holes;
    if (!skin.holes.empty()) bits |= holes | holeList;
    return bits;
}

void applySkin(Program& program, const DeviceSkin& skin, const Box& rest) {
    glm::vec4 outline(-kEverywhere, -kEverywhere, kEverywhere, kEverywhere);
    if (skin.shrink > 0.0) {
        const float share = 1.0F - static_cast<float>(std::min(skin.shrink, 1.0));
        const glm::vec3 centre = rest.centre();
        const glm::vec3 half = 0.5F * share * rest.size();
        outline = {centre.x - half.x, centre.z - half.z, centre.x + half.x, centre.z + half.z};
    }
    program.set("shrunkOutline", outline);
    std::vector<glm::vec3> holes;
    for (const DeviceSkin::Hole& hole : skin.holes) {
        if (holes.size() == kMostHoles) break;
        const auto radius = static_cast<float>(hole.radius);
        holes.emplace_back(hole.centre, radius * radius);
    }
    program.set("holeCount", static_cast<int>(holes.size()));
    if (!holes.empty()) program.set("holes", std::span<const glm::vec3>(holes));
}

} // namespace lumorph

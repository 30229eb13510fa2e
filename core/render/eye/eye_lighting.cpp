#include "core/render/eye/eye_lighting.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/render/eye/eye_programs.h"

namespace lumorph {
namespace {

constexpr float kShoulder = 0.7F;
constexpr float kClip = 1.0F;
constexpr float kBounceShare = 0.3F; // things stand in their own shadow
constexpr float kDarkestSky = 0.2F;  // of it that reaches what looks down
constexpr float kLampSquare = 0.25F; // of the 0.5 m at which a lamp has its intensity

bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool shines(const PosedLight& light) {
    return finite(light.position) && finite(light.radiance) &&
           (!light.parallel || glm::length(light.position) > 0.0F) && light.radiance != glm::vec3(0.0F);
}

} // namespace

EyeLighting::EyeLighting(const Scene& scene, std::span<const PosedLight> lights)
    : sky_(scene.sky), exposure_(static_cast<float>(scene.exposure)), shoulder_(scene.toneMapping ? kShoulder : kClip) {
    std::vector<PosedLight> shining;
    std::copy_if(lights.begin(), lights.end(), std::back_inserter(shining), shines);
    const auto first = std::find_if(shining.begin(), shining.end(), [](const auto& light) { return light.shadows; });
    if (first != shining.end()) {
        std::rotate(shining.begin(), first, first + 1);
        shadowed_ = shining.front();
        features_ = eye_feature::shadow | (shadowed_->parallel ? 0U : eye_feature::lamp);
    }
    shining.resize(std::min(shining.size(), std::size_t{kMostEyeLights}));
    for (const PosedLight& light : shining) {
        places_.push_back(light.parallel ? glm::vec4(glm::normalize(light.position), 0.0F)
                                         : glm::vec4(light.position, 1.0F));
        radiances_.push_back(light.radiance);
    }
    features_ |= static_cast<std::uint32_t>(shining.size()) << eye_feature::lightShift;
}

void EyeLighting::dropShadow() {
    shadowed_.reset();
    features_ &= ~(eye_feature::shadow | eye_feature::lamp);
}

void EyeLighting::apply(Program& program) const {
    program.set("skyLight", sky_);
    program.set("bounceLight", kBounceShare * bounce_ + kDarkestSky * sky_);
    program.set("exposure", exposure_);
    program.set("shoulder", shoulder_);
    if (places_.empty()) return;
    program.set("lightPlaces", std::span<const glm::vec4>(places_));
    program.set("lightRadiances", std::span<const glm::vec3>(radiances_));
}

glm::vec3 EyeLighting::onTable(const glm::vec3& at) const {
    glm::vec3 light = sky_;
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const glm::vec3 towards = glm::vec3(places_[i]) - places_[i].w * at;
        const float square = std::max(glm::dot(towards, towards), 1e-4F);
        const float fall = places_[i].w > 0.5F ? kLampSquare / square : 1.0F;
        light += radiances_[i] * (fall * std::max(towards.y / std::sqrt(square), 0.0F));
    }
    return light;
}

} // namespace lumorph

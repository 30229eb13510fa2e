#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/render/gl/program.h"
#include "core/scene/posed_scene.h"
#include "core/scene/scene.h"

namespace lumorph {

/// The lights of a frame in the order in which shaders know them: the one with the shadow map first.
class EyeLighting {
public:
    EyeLighting() = default;
    EyeLighting(const Scene& scene, std::span<const PosedLight> lights);

    /// The light that gets the shadow map.
    [[nodiscard]] const std::optional<PosedLight>& shadowed() const noexcept { return shadowed_; }
    void dropShadow();
    /// Bits of eye_feature.
    [[nodiscard]] std::uint32_t features() const noexcept { return features_; }
    void apply(Program& program) const;
    /// Light that the table throws back upwards, linear.
    void setBounce(const glm::vec3& light) { bounce_ = light; }
    /// That falls on the open table at a place, linear, of a white diffuse surface.
    [[nodiscard]] glm::vec3 onTable(const glm::vec3& at) const;

private:
    glm::vec3 sky_{0.0F};
    glm::vec3 bounce_{0.0F};
    std::optional<PosedLight> shadowed_;
    std::vector<glm::vec4> places_;
    std::vector<glm::vec3> radiances_;
    std::uint32_t features_ = 0;
    float exposure_ = 1.0F;
    float shoulder_ = 1.0F;
};

} // namespace lumorph

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/scene/posed_scene.h"

namespace lumorph {

/// Fog in boxes, marched through in the eye pass's fragment shader.
class EyeFog {
public:
    /// Takes what a frame has; `light` is what falls on the fog, linear. More than two are left out.
    void update(std::span<const PosedFog> fogs, const glm::vec3& light);
    /// Bits of eye_feature; none where there is no fog to see.
    [[nodiscard]] std::uint32_t features() const noexcept;
    void apply(Program& program) const;
    [[nodiscard]] std::size_t objectCount() const noexcept { return grain_ ? 1 : 0; }

private:
    void makeGrain();

    std::vector<PosedFog> fogs_;
    glm::vec3 light_{1.0F};
    std::optional<gl::Texture> grain_;
};

} // namespace lumorph

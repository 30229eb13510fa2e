#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/render/gl_objects.h"
#include "core/render/program.h"
#include "core/scene/posed_scene.h"

namespace lumorph {

/// Fog in boxes, marched through in the eye pass's fragment shader.
class EyeFog {
public:
    /// Takes what a frame has; `light` is what falls on the fog, linear. More than two are left out.
    void update(std::span<const PosedFog> fogs, const glm::vec3& light);
    /// Whether there is any fog to see.
    [[nodiscard]] bool any() const noexcept { return !fogs_.empty(); }
    void apply(Program& program) const;
    [[nodiscard]] std::size_t objectCount() const noexcept { return grain_ ? 1 : 0; }

private:
    void makeGrain();

    std::vector<PosedFog> fogs_;
    glm::vec3 light_{1.0F};
    std::optional<gl::Texture> grain_;
};

} // namespace lumorph

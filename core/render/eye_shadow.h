#pragma once

#include <array>
#include <functional>

#include <glm/mat4x4.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/render/gl_objects.h"
#include "core/render/program.h"
#include "core/scene/posed_scene.h"

namespace lumorph {

/// The shadow map of the scene's first light with shadows, parallel or a lamp.
class EyeShadow {
public:
    EyeShadow();

    /// Looks from the light at a box that holds all casters. While the box moves a little the map's pixels stay where
    /// they are in the world, so that edges do not swim. Returns whether the map is to be drawn anew.
    bool aim(const PosedLight& light, const Box& casters);
    /// Clears the map and calls `drawCasters` with the light's clip space, depth alone bound.
    void draw(const std::function<void(const glm::mat4& clipFromWorld)>& drawCasters);
    /// Sets what eye_surface.vert and eye_shadow.glsl need in the current program.
    void apply(Program& program) const;

    /// In clip depth, near the middle of the casters.
    [[nodiscard]] float depthOf(float metres) const noexcept { return 2.0F * metres / depthRange_; }
    [[nodiscard]] bool parallel() const noexcept { return light_.parallel; }
    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    void drawTiles();
    [[nodiscard]] glm::vec2 reach() const;
    [[nodiscard]] float spread() const;
    void aimParallel(const glm::vec3& centre, float radius);
    void aimLamp(const glm::vec3& centre, float radius);

    gl::Texture depth_;
    std::array<gl::Texture, 2> tiles_;
    gl::Framebuffer framebuffer_, tileFramebuffer_;
    gl::VertexArray frame_;
    Program gather_, spread_;
    gl::Sampler compared_, plain_;
    PosedLight light_;
    glm::mat4 clipFromWorld_{1.0F};
    float texel_ = 0.0F;  ///< metres; of a lamp at a distance of 1 m
    float perMetre_ = 0.0F; ///< map units a metre; of a lamp at the middle of the casters
    float depthRange_ = 1.0F; ///< metres a unit of depth, there
    float distance_ = 1.0F; ///< of a lamp to the middle of the casters
};

} // namespace lumorph

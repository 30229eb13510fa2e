#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <glm/mat4x4.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/render/eye/eye_materials.h"
#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/scene/posed_scene.h"
#include "core/scene/scene.h"

namespace lumorph {

/// What of a thing its shadow depends on, to be compared from frame to frame.
struct CasterState {
    std::uint64_t shape = 0; ///< another number for another shape
    glm::mat4 world{1.0F};
    float share = 1.0F; ///< of the light that it holds back
    std::uint32_t features = 0;
    const void* picture = nullptr; ///< that cuts holes
    PicturePlacement placement;
    float threshold = 0.0F;
    bool operator==(const CasterState&) const = default;
};

/// The shadow map of the scene's first light with shadows, parallel or a lamp.
class EyeShadow {
public:
    EyeShadow();

    /// Looks from the light at a box that holds all casters. While the box moves a little the map's pixels stay where
    /// they are in the world, so that edges do not swim.
    void aim(const PosedLight& light, const Box& casters);
    /// Whether the map is to be drawn anew: it looks another way, or something casts another shadow than at the last
    /// call.
    [[nodiscard]] bool changed(std::vector<CasterState> casters, const DeviceSkin& skin);
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
    PosedLight light_;
    glm::mat4 drawnClip_{0.0F};
    float drawnSoftness_ = -1.0F;
    std::vector<CasterState> drawn_;
    std::vector<DeviceSkin::Hole> drawnHoles_;
    double drawnShrink_ = 0.0;
    glm::mat4 clipFromWorld_{1.0F};
    float texel_ = 0.0F;      ///< metres; of a lamp at a distance of 1 m
    float perMetre_ = 0.0F;   ///< map units a metre; of a lamp at the middle of the casters
    float depthRange_ = 1.0F; ///< metres a unit of depth, there
    float distance_ = 1.0F;   ///< of a lamp to the middle of the casters
};

} // namespace lumorph

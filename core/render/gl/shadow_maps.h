#pragma once

#include <functional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"

namespace lumorph {

/// Depth maps of a scene seen along parallel light from one or more directions, as the layers of one
/// depth texture to be sampled with sampler2DArrayShadow (1 is lit).
class ShadowMaps {
public:
    /// `side` pixels a map.
    ShadowMaps(int side, int layers);

    /// Draws all maps. `directions` lead towards the light, one a layer; what `drawCasters` draws must
    /// lie in `scene`; it is called once a map with the depth program, whose `worldFromMesh` it sets. Leaves its own
    /// framebuffer bound.
    void draw(std::span<const glm::vec3> directions, const Box& scene,
              const std::function<void(Program&)>& drawCasters);

    /// For each layer: world position to map coordinates and depth, all 0 to 1.
    [[nodiscard]] std::span<const glm::mat4> mapFromWorld() const noexcept { return mapFromWorld_; }
    /// Side of a map's pixel on the scene, metres.
    [[nodiscard]] float texel() const noexcept { return texel_; }
    [[nodiscard]] int side() const noexcept { return side_; }
    void bind(int textureUnit) const;
    /// OpenGL objects held now.
    [[nodiscard]] std::size_t objectCount() const noexcept { return 2 + program_.objectCount(); }

private:
    int side_;
    gl::Texture depth_;
    gl::Framebuffer framebuffer_;
    Program program_;
    std::vector<glm::mat4> mapFromWorld_;
    float texel_ = 0.0F;
};

} // namespace lumorph

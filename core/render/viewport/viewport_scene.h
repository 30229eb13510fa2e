#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/geometry/surface_shading.h"
#include "core/geometry/triangle_mesh.h"
#include "core/render/viewport/theme.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// A surface in a viewport. Shading and positions are shared and immutable: the renderer uploads again
/// only what is another object than last time.
struct ViewportSurface {
    std::uint32_t id = 0; ///< what picking returns; 0 is not pickable
    std::shared_ptr<const SurfaceShading> shading;
    std::shared_ptr<const std::vector<glm::vec3>> positions; ///< one a mesh vertex, metres, in the surface's own frame
    glm::mat4 worldFromSurface{1.0F};
    glm::vec3 color{0.8F}; ///< sRGB
    /// Over that, one a mesh vertex: sRGB, and 0 to 255 how much of it. Null: none.
    std::shared_ptr<const std::vector<glm::u8vec4>> vertexColors;
    float opacity = 1.0F;         ///< below 1 it is drawn after the opaque ones and casts no shadow
    float paper = 0.0F;           ///< 0 smooth, 1 the fine fibre of paper
    bool tinted = false;          ///< coloured by the scene's tint,
    std::uint8_t tintedBy = 0xFF; ///< but only by these of its classes, one a bit
    bool outlined = false;        ///< selected: drawn with an outline in the accent colour
};

/// Classes of voxels that tint surfaces where they pass through them; class 0 leaves the colour as it is.
struct ViewportTint {
    VoxelFrame frame;
    std::shared_ptr<const std::vector<std::uint8_t>> classes; ///< x fastest, then y, then z
    std::array<glm::vec4, 4> colors{};                        ///< sRGB and strength, one a class
};

/// One coloured voxel.
struct ViewportVoxel {
    std::uint16_t x = 0, y = 0, z = 0, reserved = 0;
    std::array<std::uint8_t, 4> color{}; ///< sRGB, alpha unused
    bool operator==(const ViewportVoxel&) const = default;
};

/// A cloud of voxels drawn as cubes.
struct ViewportVoxels {
    std::uint32_t id = 0;
    VoxelFrame frame;
    std::shared_ptr<const std::vector<ViewportVoxel>> voxels;
    float opacity = 1.0F;
    float side = 0.92F; ///< of a cube, in voxels
};

/// A straight line of constant width on the screen.
struct ViewportLine {
    glm::vec3 from{0.0F};
    glm::vec3 to{0.0F};
    glm::vec3 color{1.0F}; ///< sRGB
    float width = 1.5F;    ///< pixels at 100 % scaling
    bool onTop = false;    ///< not hidden by surfaces
};

/// Everything a viewport shows, as plain data: made by any thread, drawn by another.
struct ViewportScene {
    std::vector<ViewportSurface> surfaces;
    std::vector<ViewportVoxels> voxels;
    std::vector<ViewportLine> lines;
    std::optional<ViewportTint> tint;
    Box bounds;                ///< what stands in the scene; shadows and planes are fitted to it
    float groundHeight = 0.0F; ///< world y of the ground, metres
    bool grid = true;
    Theme theme = Theme::dark;
    glm::vec3 accent{0.16F, 0.72F, 0.80F};
};

} // namespace lumorph

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/triangle_mesh.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph {

/// What of a surface does not change while it moves.
struct SurfaceTopology {
    std::vector<glm::uvec3> triangles;
    std::vector<glm::vec2> coordinates; ///< one a vertex: metres of the rest shape, or texture coordinates
};

/// A surface of the virtual scene at one moment.
struct PosedSurface {
    int item = 0;
    std::shared_ptr<const SurfaceTopology> topology;
    std::shared_ptr<const std::vector<glm::vec3>> positions; ///< the same object while it does not deform
    std::shared_ptr<const std::vector<glm::vec3>> normals;   ///< one a vertex, length 1
    glm::mat4 worldFromSurface{1.0F};
    Material material;
    float opacity = 1.0F; ///< of the item, on top of the material's
    bool castsShadow = true;
};

struct PosedLight {
    int item = 0;
    bool parallel = true;
    glm::vec3 position{0.0F}; ///< parallel: towards the light, length 1; else where it stands. World
    glm::vec3 radiance{1.0F}; ///< linear, of a white diffuse surface it meets head on (a lamp: at 0.5 m)
    float softness = 0.1F;
    bool shadows = true;
};

struct PosedFog {
    int item = 0;
    glm::mat4 worldFromBox{1.0F}; ///< of the cube [-0.5, 0.5]^3
    glm::vec3 color{0.9F};        ///< linear
    float density = 12.0F;
    float grain = 0.06F;
    glm::vec2 offset{0.0F}; ///< of the grain, by its drift so far
};

/// The virtual scene at one moment, without device and table.
struct PosedScene {
    double seconds = 0.0;
    std::vector<PosedSurface> surfaces;
    std::vector<PosedLight> lights; ///< the first with shadows gets the shadow map
    std::vector<PosedFog> fogs;
};

/// What the scene takes from the frame around it.
struct PoseInput {
    double seconds = 0.0;
    glm::mat4 worldFromDevice{1.0F};
    /// The project's match target, for a TargetItem: its triangles, and where the loop has it.
    std::shared_ptr<const TriangleMesh> targetMesh;
    std::shared_ptr<const std::vector<glm::vec3>> targetPositions;
    glm::mat4 deviceFromTarget{1.0F};
};

/// Poses a scene again and again; keeps topologies and what stands still. One thread at a time.
class ScenePoser {
public:
    ScenePoser();
    ~ScenePoser();
    ScenePoser(ScenePoser&&) noexcept;
    ScenePoser& operator=(ScenePoser&&) noexcept;
    /// `showing` physical leaves out everything but lights. Broken assets are shown as a marked box of their size.
    [[nodiscard]] PosedScene pose(const Scene& scene, const SceneAssets& assets, const PoseInput& input);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Heights of a height field on a grid, for servos and light alike: out[k] is that at points[k] (x and z in the item's
/// frame, metres), 0 outside its rectangle.
void sampleHeights(const HeightItem& item, const Image* image, double seconds, std::span<const glm::vec2> points,
                   std::span<float> out);

/// `anchorFromItem` of an item with its groups and its motion at a time.
[[nodiscard]] glm::mat4 anchorFromItem(const Scene& scene, const SceneItem& item, double seconds);

} // namespace lumorph

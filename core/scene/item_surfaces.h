#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/geometry/model.h"
#include "core/geometry/surface_shading.h"
#include "core/scene/posed_scene.h"

/// The surfaces of items, each in its item's frame. Private to core/scene.
namespace lumorph {

/// An item with its motion in the frame of its group, or of its anchor.
[[nodiscard]] glm::mat4 parentFromItem(const SceneItem& item, double seconds);

struct ItemSurface {
    std::shared_ptr<const SurfaceTopology> topology;
    std::shared_ptr<const std::vector<glm::vec3>> positions;
    std::shared_ptr<const std::vector<glm::vec3>> normals;
};

/// The normals of triangles that have none, or that deform: smooth but at creases. Vertices are split there, so it has
/// a topology of its own.
class ShadedSurface {
public:
    /// `coordinates` is empty or has one a vertex of the mesh.
    ShadedSurface(const TriangleMesh& mesh, std::span<const glm::vec2> coordinates);
    /// The surface at these positions of the mesh's vertices.
    [[nodiscard]] ItemSurface at(std::span<const glm::vec3> positions) const;

private:
    std::shared_ptr<const SurfaceShading> shading_;
    std::shared_ptr<const SurfaceTopology> topology_;
};

/// A solid around the origin; a plane lies in x and z and faces up. Coordinates are metres along its faces.
[[nodiscard]] ItemSurface shapeSurface(const ShapeItem& shape);

/// A height field as a grid with walls down to its floor. What does not change with time is made once.
class HeightSurface {
public:
    HeightSurface(const HeightItem& item, std::shared_ptr<const Image> image);
    [[nodiscard]] ItemSurface at(double seconds) const;
    /// Other waves over the same grid: costs no new one, so that a program may change them each frame.
    void setWaves(const std::vector<Wave>& waves);
    [[nodiscard]] const HeightItem& item() const noexcept { return item_; }
    [[nodiscard]] const std::shared_ptr<const Image>& image() const noexcept { return image_; }
    /// Whether no time changes it.
    [[nodiscard]] bool still() const noexcept { return still_; }

private:
    [[nodiscard]] std::size_t index(int column, int row) const noexcept {
        return static_cast<std::size_t>(row) * xs_.size() + static_cast<std::size_t>(column);
    }
    void addTop(SurfaceTopology& topology) const;
    void addWalls(SurfaceTopology& topology);
    void computeHeights(double seconds, std::vector<float>& heights) const;

    HeightItem item_;
    std::shared_ptr<const Image> image_;
    bool still_ = true;
    glm::ivec2 quads_{1};
    std::vector<float> xs_, zs_;  ///< of the grid's columns and rows
    std::vector<float> calm_;     ///< one a grid point; empty without a calm edge
    std::vector<float> pictured_; ///< one a grid point; empty without a picture
    /// A vertex of a wall: below which grid point it stands, and whether at its foot.
    struct WallVertex {
        std::uint32_t point = 0;
        bool foot = false;
        glm::vec3 normal{0.0F};
    };
    std::vector<WallVertex> walls_;
    std::shared_ptr<const SurfaceTopology> topology_;
};

/// A surface of a model and where it is.
struct ModelSurface {
    ItemSurface surface;
    glm::mat4 itemFromSurface{1.0F};
    int material = -1; ///< of the model
};

/// A glTF in motion. What does not deform keeps its surface and only moves.
class ModelSurfaces {
public:
    /// `animation` is -1 or one of the model's.
    ModelSurfaces(std::shared_ptr<const SceneModel> model, int animation);
    /// The surfaces at a time of the animation, which repeats without end.
    [[nodiscard]] const std::vector<ModelSurface>& at(double seconds);
    [[nodiscard]] const std::shared_ptr<const SceneModel>& model() const noexcept { return model_; }
    [[nodiscard]] int animation() const noexcept { return animation_; }

private:
    /// A primitive of a shown node.
    struct Part {
        std::size_t node = 0;
        std::size_t first = 0; ///< of its vertices among those of the flattened model
        std::size_t count = 0;
        bool follows = false; ///< its node's transform moves it
        bool deforms = false;
        std::optional<ShadedSurface> shaded;
    };
    void addPart(std::size_t node, const Model::Primitive& primitive, const TriangleMesh& rest, std::size_t first,
                 std::size_t firstTriangle);
    [[nodiscard]] const Model::Animation* motion() const noexcept;
    void deform(const TriangleMesh& posed);

    std::shared_ptr<const SceneModel> model_;
    int animation_ = -1;
    bool anyDeforms_ = false;
    std::vector<Part> parts_;
    std::vector<ModelSurface> surfaces_; ///< one a part
};

} // namespace lumorph

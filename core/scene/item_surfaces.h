#pragma once

#include <memory>
#include <vector>

#include "core/render/image.h"
#include "core/scene/posed_scene.h"

/// Surfaces made from numbers. Private to core/scene.
namespace lumorph {

/// A surface in its item's frame.
struct ItemSurface {
    std::shared_ptr<const SurfaceTopology> topology;
    std::shared_ptr<const std::vector<glm::vec3>> positions;
    std::shared_ptr<const std::vector<glm::vec3>> normals;
};

/// A solid around the origin; a plane lies in x and z and faces up. Coordinates are metres along its faces.
[[nodiscard]] ItemSurface shapeSurface(const ShapeItem& shape);

/// A height field as a grid with walls down to its floor. What does not change with time is made once.
class HeightSurface {
public:
    HeightSurface(const HeightItem& item, std::shared_ptr<const Image> image);
    [[nodiscard]] ItemSurface at(double seconds) const;
    [[nodiscard]] const HeightItem& item() const noexcept { return item_; }
    [[nodiscard]] const std::shared_ptr<const Image>& image() const noexcept { return image_; }
    /// Whether no time changes it.
    [[nodiscard]] bool still() const noexcept { return still_; }

private:
    [[nodiscard]] std::size_t index(int column, int row) const noexcept {
        return static_cast<std::size_t>(row * (quads_.x + 1) + column);
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

} // namespace lumorph

#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/image.h"
#include "core/base/units.h"
#include "core/geometry/triangle_mesh.h"
#include "core/render/figure/camera.h"
#include "core/render/figure/studio_pass.h"

namespace lumorph {

/// sRGB colours, 0 to 1: the device's paper, and the accent for what it should become.
inline constexpr glm::vec3 kPaperColor{0.93F, 0.915F, 0.88F};
inline constexpr glm::vec3 kAccentColor{0.16F, 0.72F, 0.80F};

struct FigureItem {
    TriangleMesh mesh; ///< world metres; an empty mesh is left out
    glm::vec3 color = kPaperColor;
    float opacity = 1.0F; ///< below 1 it is drawn over the opaque items and casts no shadow
    Angle crease = Angle::degrees(35.0);
};

struct FigurePanel {
    std::string caption; ///< one line, UTF-8
    std::vector<FigureItem> items;
};

/// Panels side by side, seen by one camera from the front, right and above, that frames the union of
/// all meshes: sizes and places can be compared across panels.
struct Figure {
    std::vector<FigurePanel> panels;
    std::string footer; ///< one line, UTF-8
    Theme theme = Theme::dark;
    Lighting lighting;
};

/// A rectangle in pixels from the top left corner.
struct FigureRect {
    glm::ivec2 origin{0};
    glm::ivec2 size{0};
};

/// Where things are in a figure.
struct FigureLayout {
    std::vector<FigureRect> views;    ///< what the camera frames, one a panel
    std::vector<FigureRect> captions; ///< strips below the views, one a panel
    FigureRect footer;                ///< strip along the lower edge
    float em = 0.0F;                  ///< size of the captions, pixels
};

/// Throws InvalidInput unless there are panels and each has room for at least 16 pixels each way.
[[nodiscard]] FigureLayout layoutOf(const Figure& figure, glm::ivec2 size);
/// The camera of every panel. Throws InvalidInput when no panel has a mesh with an extent.
[[nodiscard]] Camera cameraOf(const Figure& figure, const FigureLayout& layout);

/// Draws figures in the current OpenGL context; keeps programs, shadow maps and the font between
/// figures.
class FigureRenderer {
public:
    FigureRenderer();
    ~FigureRenderer();
    FigureRenderer(FigureRenderer&&) noexcept;
    FigureRenderer& operator=(FigureRenderer&&) noexcept;

    /// Opaque, `size` pixels, 4x anti-aliased. Leaves no framebuffer and no program bound, and depth
    /// test, blending and culling off. Throws InvalidInput for a figure without panels or
    /// meshes, an opacity outside [0, 1] and a size that is too small or too large; DeviceError when
    /// the driver has no memory for it.
    [[nodiscard]] Image render(const Figure& figure, glm::ivec2 size);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// One figure by a renderer of its own; use FigureRenderer for several.
[[nodiscard]] Image renderFigure(const Figure& figure, glm::ivec2 size);

} // namespace lumorph

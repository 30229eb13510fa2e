#pragma once

#include <array>

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/render/viewport/viewport_frame.h"
#include "core/render/viewport/viewport_light.h"
#include "core/render/viewport/viewport_surfaces.h"
#include "core/render/viewport/viewport_tint.h"

namespace lumorph {

/// Draws the surfaces of a viewport with their material, light and tint.
class ViewportShading {
public:
    ViewportShading();

    /// Uploads what is new in the scene.
    void update(const ViewportScene& scene, ViewportQuality quality);
    [[nodiscard]] const ViewportSurfaces& surfaces() const noexcept { return surfaces_; }

    /// Draws one surface of the scene, in motion in a coarser form; a translucent one with blending on, back faces
    /// first, then the nearest front faces.
    void draw(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light, std::size_t surface);

    /// Draws all opaque surfaces with a depth program; in motion a coarser form of them.
    void drawCasters(Program& depth, const ViewportFrame& frame) const;

    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    Program& begin(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light, bool tinted);
    void drawOpaque(std::size_t surface) const;
    void drawTranslucent(const ViewportFrame& frame, Program& program, std::size_t surface);

    ViewportSurfaces surfaces_;
    ViewportTintVolume tint_;
    gl::Texture fibre_;
    // Plain and tinted.
    std::array<Program, 2> moving_;
    std::array<Program, 2> still_;
    Program depth_;
};

} // namespace lumorph

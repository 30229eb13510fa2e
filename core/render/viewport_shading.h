#pragma once

#include <functional>

#include "core/render/gl_objects.h"
#include "core/render/program.h"
#include "core/render/viewport_frame.h"
#include "core/render/viewport_light.h"
#include "core/render/viewport_surfaces.h"
#include "core/render/viewport_tint.h"

namespace lumorph {

/// Draws the surfaces of a viewport with their material, light and tint.
class ViewportShading {
public:
    ViewportShading();

    /// Uploads what is new in the scene.
    void update(const ViewportScene& scene);
    [[nodiscard]] const ViewportSurfaces& surfaces() const noexcept { return surfaces_; }

    /// Sets what all surfaces of a piece share and makes the program current.
    void begin(const ViewportFrame& frame, const FramePiece& piece, const ViewportLight& light);
    void drawOpaque(const ViewportFrame& frame, std::size_t surface);
    /// Blending is on. Back faces first, then the nearest front faces.
    void drawTranslucent(const ViewportFrame& frame, std::size_t surface);

    /// Draws all opaque surfaces with a depth program.
    void drawCasters(Program& depth, const ViewportScene& scene) const;

    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    void setMaterial(const ViewportFrame& frame, std::size_t surface);

    ViewportSurfaces surfaces_;
    ViewportTintVolume tint_;
    gl::Texture fibre_;
    Program moving_;
    Program still_;
    Program* current_ = nullptr;
};

} // namespace lumorph

#pragma once

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/render/viewport/viewport_frame.h"

namespace lumorph {

/// The outline of the selected surfaces in the accent colour.
class ViewportOutline {
public:
    /// Blends it into the bound framebuffer around what an alpha of 0 marks in `picture`, within a piece of the frame,
    /// and makes the frame opaque.
    void draw(GLuint picture, const FramePiece& piece, const ViewportFrame& frame);

    [[nodiscard]] std::size_t objectCount() const noexcept { return 1 + still_.objectCount() + moving_.objectCount(); }

private:
    Program still_{shaderFiles({"full_frame.vert"}, {"outline.frag"})};
    Program moving_{shaderFiles({"full_frame.vert"}, {"moving_outline.frag"})};
    gl::VertexArray empty_;
};

} // namespace lumorph

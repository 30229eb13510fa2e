#pragma once

#include <vector>

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/render/viewport/viewport_frame.h"

namespace lumorph {

/// The lines of a viewport: quads of constant width on the screen, with smooth edges and round ends.
class ViewportLineSet {
public:
    ViewportLineSet();

    void update(const std::vector<ViewportLine>& lines, float scale);
    /// Blends them over what is drawn; lines on top shine faintly through what hides them.
    void draw(const ViewportFrame& frame);

    [[nodiscard]] std::size_t objectCount() const noexcept { return 2 + program_.objectCount(); }

private:
    Program program_{shaderFiles({"line.vert"}, {"line.frag"})};
    gl::VertexArray array_;
    gl::Buffer vertices_;
    GLsizei hidden_ = 0; // vertices of lines that surfaces hide; those on top follow
    GLsizei count_ = 0;
};

} // namespace lumorph

#pragma once

#include <string>

#include "core/render/gl/color_target.h"
#include "core/render/gl/program.h"

namespace lumorph {

/// Shows a picture of linear light: sRGB, clipped at white.
class PictureOutput {
public:
    PictureOutput();

    /// Into a framebuffer of the picture's size, encoded by it or, if it does not encode, by this.
    void draw(GLuint framebuffer, const ColorTarget& picture);

    /// Empty, or why the driver only copies, with file and line.
    [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    void encode(const ColorTarget& picture, bool encoding);

    gl::VertexArray noAttributes_;
    Program out_, encodedOut_;
    std::string problem_;
};

} // namespace lumorph

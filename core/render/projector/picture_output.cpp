#include "core/render/projector/picture_output.h"

#include <utility>

#include "core/base/error.h"
#include "core/render/gl/draw_state.h"

namespace lumorph {
namespace {

ShaderFiles outFiles(std::vector<std::string> defines) {
    ShaderFiles files = shaderFiles({"full_frame.vert"}, {"version.glsl", "picture_output.frag"});
    files.defines = std::move(defines);
    return files;
}

bool encodes(GLuint framebuffer) {
    GLint encoding = GL_LINEAR;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, framebuffer == 0 ? GL_BACK_LEFT : GL_COLOR_ATTACHMENT0,
                                          GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING, &encoding);
    return encoding == GL_SRGB;
}

// What is left without a program.
void copy(GLuint framebuffer, const ColorTarget& picture) {
    const glm::ivec2 size = picture.size();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer());
    glBlitFramebuffer(0, 0, size.x, size.y, 0, 0, size.x, size.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

} // namespace

PictureOutput::PictureOutput() : out_(outFiles({})), encodedOut_(outFiles({"ENCODE"})) {}

void PictureOutput::draw(GLuint framebuffer, const ColorTarget& picture) {
    const bool encoding = encodes(framebuffer);
    beginSurfaces(framebuffer, picture.size());
    glDisable(GL_DEPTH_TEST);
    if (encoding) glEnable(GL_FRAMEBUFFER_SRGB);
    try {
        if (problem_.empty()) encode(picture, encoding);
    } catch (const DataError& error) {
        problem_ = error.subject() + ": " + error.why() + "; pictures are copied, and may be too dark";
    }
    if (!problem_.empty()) copy(framebuffer, picture);
    glDisable(GL_FRAMEBUFFER_SRGB);
}

void PictureOutput::encode(const ColorTarget& picture, bool encoding) {
    Program& out = encoding ? out_ : encodedOut_;
    out.use();
    bindTexture(0, picture.texture());
    out.set("picture", 0);
    glBindVertexArray(noAttributes_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

std::size_t PictureOutput::objectCount() const noexcept { return 1 + out_.objectCount() + encodedOut_.objectCount(); }

} // namespace lumorph

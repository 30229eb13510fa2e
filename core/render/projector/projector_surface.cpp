#include "core/render/projector/projector_surface.h"

#include <array>

#include <glm/common.hpp>

#include "core/base/error.h"
#include "core/render/gl/draw_state.h"

namespace lumorph {

void ProjectorSurface::fit(glm::ivec2 size) {
    const glm::ivec2 needed = glm::max(size, size_);
    if (needed == size_) return;
    size_ = glm::ivec2(0); // until it is whole
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    const auto attach = [&](GLenum to, const gl::Texture& texture, GLint format) {
        bindTexture(0, texture.name());
        glTexImage2D(GL_TEXTURE_2D, 0, format, needed.x, needed.y, 0, GL_RGBA, GL_FLOAT, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glFramebufferTexture2D(GL_FRAMEBUFFER, to, GL_TEXTURE_2D, texture.name(), 0);
    };
    attach(GL_COLOR_ATTACHMENT0, place_, GL_RGBA32F);
    attach(GL_COLOR_ATTACHMENT1, along_, GL_RGBA16F);
    attach(GL_COLOR_ATTACHMENT2, picture_, GL_SRGB8_ALPHA8);
    bindTexture(0, 0);
    constexpr std::array<GLenum, 2> kAll{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(static_cast<GLsizei>(kAll.size()), kAll.data());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, 0, 0);
    const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (!complete) throw DeviceError("OpenGL", "the driver cannot hold a picture of this size", "use a smaller size");
    size_ = needed;
}

void ProjectorSurface::bind(GLuint depth) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
}

void ProjectorSurface::keepPicture(const PixelRectangle& part) const {
    bindTexture(0, picture_.name());
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, part.low.x, part.low.y, part.low.x, part.low.y, part.high.x - part.low.x,
                        part.high.y - part.low.y);
}

void ProjectorSurface::setPicture(Program& program, int unit) const {
    bindTexture(unit, picture_.name());
    program.set("before", unit);
}

void ProjectorSurface::set(Program& program, int unit) const {
    bindTexture(unit, place_.name());
    program.set("surfacePlace", unit);
    bindTexture(unit + 1, along_.name());
    program.set("surfaceAlong", unit + 1);
}

} // namespace lumorph

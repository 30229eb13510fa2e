#include "core/render/projector/blend_maps.h"

#include "core/base/error.h"

namespace lumorph {
namespace {

void store(const gl::Texture& texture, GLenum format, glm::ivec2 size, GLint filter) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), size.x, size.y, 0, GL_RG, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D, 0);
}

/// Of the framebuffer that is bound, which it lets go.
void checkComplete() {
    const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (!complete) throw DeviceError("OpenGL", "the driver cannot hold a projector's weights", "use a smaller size");
}

void attach(const gl::Framebuffer& framebuffer, GLuint color, GLuint depth) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
    if (depth != 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    checkComplete();
}

void attachBlacks(const gl::Framebuffer& framebuffer, const gl::Texture& blacks) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, blacks.name(), 0);
    constexpr GLenum kBoth[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, kBoth);
    checkComplete();
}

} // namespace

BlendMaps::BlendMaps(glm::ivec2 size, GLuint depth, bool withBlacks) : distanceSize_((size + kBlock - 1) / kBlock) {
    for (std::size_t i = 0; i < 2; ++i) {
        store(distances_[i], GL_R8, distanceSize_, GL_LINEAR);
        attach(framebuffers_[i], distances_[i].name(), 0);
    }
    store(weights_, GL_RG32F, size, GL_NEAREST);
    attach(framebuffers_[2], weights_.name(), depth);
    if (!withBlacks) return;
    store(blacks_.emplace(), GL_RGBA16F, size, GL_NEAREST);
    attachBlacks(framebuffers_[2], *blacks_);
}

} // namespace lumorph

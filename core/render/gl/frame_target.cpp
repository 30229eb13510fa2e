#include "core/render/gl/frame_target.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/render/gl/pixel_reading.h"

namespace lumorph {
namespace {

void store(const gl::Renderbuffer& buffer, GLenum format, glm::ivec2 size, int samples) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer.name());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, size.x, size.y);
    glBindRenderbuffer(GL_RENDERBUFFER, 0);
}

void requireComplete() {
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
    throw DeviceError("OpenGL", "the driver cannot hold a frame of this size", "use a smaller size");
}

glm::ivec2 checked(glm::ivec2 size) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    largest = std::min(largest, kMaxImageSide);
    if (size.x >= 1 && size.y >= 1 && size.x <= largest && size.y <= largest) return size;
    throw InvalidInput("frame size " + std::to_string(size.x) + "x" + std::to_string(size.y),
                       "the driver cannot hold it", "use 1 to " + std::to_string(largest) + " pixels a side");
}

} // namespace

FrameTarget::FrameTarget(glm::ivec2 size, int samples) : size_(checked(size)) {
    store(color_, GL_RGBA8, size, samples);
    store(depth_, GL_DEPTH_COMPONENT24, size, samples);
    store(resolvedColor_, GL_RGBA8, size, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, resolvedColor_.name());
    requireComplete();
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_.name());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
    requireComplete();
}

Image FrameTarget::read() const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.name());
    glBlitFramebuffer(0, 0, size_.x, size_.y, 0, 0, size_.x, size_.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    Image image = readPixels(resolved_.name(), size_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    return image;
}

} // namespace lumorph

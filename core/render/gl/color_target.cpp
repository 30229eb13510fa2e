#include "core/render/gl/color_target.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/render/gl/pixel_reading.h"

namespace lumorph {

glm::ivec2 checkedTextureSize(glm::ivec2 size) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    largest = std::min(largest, kMaxImageSide);
    if (size.x >= 1 && size.y >= 1 && size.x <= largest && size.y <= largest) return size;
    throw InvalidInput("picture size " + std::to_string(size.x) + "x" + std::to_string(size.y),
                       "the driver cannot hold it", "use 1 to " + std::to_string(largest) + " pixels a side");
}

ColorTarget::ColorTarget(glm::ivec2 size, GLenum format) : depth_(size) {
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, color_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), size.x, size.y, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.name(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.texture(), 0);
    const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (!complete) throw DeviceError("OpenGL", "the driver cannot hold a picture of this size", "use a smaller size");
}

Image ColorTarget::read() const { return readPixels(framebuffer_.name(), depth_.size()); }

} // namespace lumorph

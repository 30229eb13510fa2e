#include "core/render/color_target.h"

#include <algorithm>
#include <string>

#include "core/base/error.h"

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

Image ColorTarget::read() const {
    const glm::ivec2 size = depth_.size();
    Image image(size);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels().data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    // OpenGL's row 0 is the lowest.
    for (int y = 0; y < size.y / 2; ++y)
        std::swap_ranges(&image.at(0, y), &image.at(0, y) + size.x, &image.at(0, size.y - 1 - y));
    return image;
}

} // namespace lumorph

#include "core/render/gl/pixel_reading.h"

#include <algorithm>

namespace lumorph {

Image readPixels(GLuint framebuffer, glm::ivec2 size) {
    Image image(size);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels().data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    // OpenGL's row 0 is the lowest.
    for (int y = 0; y < size.y / 2; ++y)
        std::swap_ranges(&image.at(0, y), &image.at(0, y) + size.x, &image.at(0, size.y - 1 - y));
    return image;
}

} // namespace lumorph

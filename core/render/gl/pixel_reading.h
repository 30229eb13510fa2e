#pragma once

#include <glm/vec2.hpp>

#include "core/base/image.h"
#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// The first colour of a framebuffer as it is stored, row 0 at the top. Leaves no framebuffer bound for reading.
[[nodiscard]] Image readPixels(GLuint framebuffer, glm::ivec2 size);

} // namespace lumorph

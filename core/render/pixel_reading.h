#pragma once

#include <glm/vec2.hpp>

#include "core/render/gl_objects.h"
#include "core/render/image.h"

namespace lumorph {

/// The first colour of a framebuffer as it is stored, row 0 at the top. Leaves no framebuffer bound for reading.
[[nodiscard]] Image readPixels(GLuint framebuffer, glm::ivec2 size);

} // namespace lumorph

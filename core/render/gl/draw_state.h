#pragma once

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include "core/render/gl/camera_uniforms.h"
#include "core/render/gl/gl_objects.h"
#include "core/render/gl/pixel_region.h"

namespace lumorph {

/// Binds a framebuffer for opaque surfaces: its whole viewport, depth tested and written, both faces, no blending.
inline void beginSurfaces(GLuint framebuffer, glm::ivec2 size) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, size.x, size.y);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClearDepth(1.0);
}

inline void scissor(const PixelRectangle& area) {
    glScissor(area.low.x, area.low.y, area.high.x - area.low.x, area.high.y - area.low.y);
}

/// Culling takes the faces that look away even where a placement turns a mesh inside out.
inline void setFrontFace(const glm::mat4& world) {
    glFrontFace(glm::determinant(glm::mat3(world)) < 0.0F ? GL_CW : GL_CCW);
}

inline void bindTexture(int unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture);
}

/// Change of depth (0 to 1) with distance, times the square of the distance, metres.
inline double depthSlope(const DepthRange& range) { return range.near * range.far / (range.far - range.near); }

} // namespace lumorph

#include "core/render/viewport/viewport_outline.h"

namespace lumorph {
namespace {

constexpr float kWidth = 2.9F; // pixels at 100 % scaling

} // namespace

void ViewportOutline::draw(GLuint picture, const FramePiece& piece, const ViewportFrame& frame) {
    // All marks lie in the piece.
    glEnable(GL_SCISSOR_TEST);
    glScissor(piece.origin.x, piece.origin.y, piece.size.x, piece.size.y);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
    glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, picture);
    Program& program = frame.quality == ViewportQuality::still ? still_ : moving_;
    program.use();
    program.set("frame", 0);
    program.set("accent", frame.scene.accent);
    program.set("width", kWidth * frame.scale);
    glBindVertexArray(empty_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

} // namespace lumorph

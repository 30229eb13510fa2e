#include "core/render/viewport/viewport_lines.h"

#include <cstddef>

namespace lumorph {
namespace {

constexpr float kHiddenOpacity = 0.35F; // of lines on top, behind a surface
constexpr int kVerticesEach = 6;

struct LineVertex {
    glm::vec3 from, to;
    glm::vec4 tone; // sRGB and width in pixels
};

void lineAttribute(GLuint index, GLint size, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, sizeof(LineVertex), reinterpret_cast<const void*>(offset));
}

} // namespace

ViewportLineSet::ViewportLineSet() {
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    lineAttribute(0, 3, offsetof(LineVertex, from));
    lineAttribute(1, 3, offsetof(LineVertex, to));
    lineAttribute(2, 4, offsetof(LineVertex, tone));
    glBindVertexArray(0);
}

void ViewportLineSet::update(const std::vector<ViewportLine>& lines, float scale) {
    std::vector<LineVertex> vertices;
    for (const bool onTop : {false, true}) {
        for (const ViewportLine& line : lines)
            if (line.onTop == onTop)
                vertices.insert(vertices.end(), kVerticesEach,
                                {line.from, line.to, glm::vec4(line.color, scale * line.width)});
        if (!onTop) hidden_ = static_cast<GLsizei>(vertices.size());
    }
    count_ = static_cast<GLsizei>(vertices.size());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(LineVertex)), vertices.data(),
                 GL_STREAM_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void ViewportLineSet::draw(const ViewportFrame& frame) {
    if (count_ == 0) return;
    program_.use();
    program_.set("clipFromWorld", frame.clipFromWorld);
    program_.set("frameSize", glm::vec2(frame.size));
    glBindVertexArray(array_.name());
    glDepthMask(GL_FALSE);
    // A line that lies on a surface is seen.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1.0F, -8.0F);
    if (count_ > hidden_) {
        program_.set("opacity", kHiddenOpacity);
        glDepthFunc(GL_GREATER);
        glDrawArrays(GL_TRIANGLES, hidden_, count_ - hidden_);
        glDepthFunc(GL_LEQUAL);
    }
    program_.set("opacity", 1.0F);
    glDrawArrays(GL_TRIANGLES, 0, count_);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDepthMask(GL_TRUE);
    glBindVertexArray(0);
}

} // namespace lumorph

#include "core/render/eye/device_surface.h"

#include <string>

#include "core/base/error.h"
#include "core/geometry/mesh_check.h"
#include "core/render/eye/eye_surfaces.h"

namespace lumorph {

void DeviceSurface::update(const ShowFrame& frame) {
    const TriangleMesh& rest = frame.rig->restMesh();
    if (frame.devicePositions->size() != rest.positions.size())
        throw InvalidInput("device",
                           std::to_string(frame.devicePositions->size()) + " positions for a rig of " +
                               std::to_string(rest.positions.size()) + " vertices",
                           "deform the same rig that is shown");
    worldFromDevice_ = frame.worldFromDevice;
    glBindVertexArray(array_.name());
    if (rig_ != frame.rig) {
        rig_ = frame.rig;
        positions_ = nullptr;
        count_ = static_cast<GLsizei>(3 * rest.triangles.size());
        const MeshReport report = checkMesh(rest, IntersectionTest::skip);
        closed_ = report.closed() && report.manifold() && report.inwardComponents == 0;
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(rest.triangles.size() * sizeof(glm::uvec3)),
                     rest.triangles.data(), GL_STATIC_DRAW);
    }
    if (positions_ != frame.devicePositions) {
        positions_ = frame.devicePositions;
        glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(positions_->size() * sizeof(glm::vec3)),
                     positions_->data(), GL_STREAM_DRAW);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
    }
    glBindVertexArray(0);
}

void DeviceSurface::draw(Program& program) const {
    program.set("worldFromMesh", worldFromDevice_);
    // Nobody sees the inside of a solid.
    if (closed_) glEnable(GL_CULL_FACE);
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
    glDisable(GL_CULL_FACE);
}

Box deviceBounds(const ShowFrame& frame) { return movedBox(frame.rig->reach(), frame.worldFromDevice); }

Box physicalBounds(const ShowFrame& frame) {
    const glm::vec2 half = 0.5F * frame.installation->tableSize;
    Box box = deviceBounds(frame);
    box.include(Box{glm::vec3(-half.x, 0.0F, -half.y), glm::vec3(half.x, 0.0F, half.y)});
    return box;
}

} // namespace lumorph

#include "core/render/figure/gpu_mesh.h"

#include <cstddef>

namespace lumorph {
namespace {

using Vertex = ShadedMesh::Vertex;

template <class Value> void upload(GLenum target, const std::vector<Value>& values) {
    glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(Value)), values.data(), GL_STATIC_DRAW);
}

void attribute(GLuint index, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<const void*>(offset));
}

} // namespace

GpuMesh::GpuMesh(const ShadedMesh& mesh) : count_(static_cast<GLsizei>(3 * mesh.triangles.size())) {
    glBindVertexArray(array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    upload(GL_ARRAY_BUFFER, mesh.vertices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    upload(GL_ELEMENT_ARRAY_BUFFER, mesh.triangles);
    attribute(0, offsetof(Vertex, position));
    attribute(1, offsetof(Vertex, normal));
    glBindVertexArray(0);
}

void GpuMesh::draw() const {
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

} // namespace lumorph

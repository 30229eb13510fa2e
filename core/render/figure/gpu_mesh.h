#pragma once

#include "core/geometry/shaded_mesh.h"
#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// A mesh in the memory of the current context: attribute 0 the position, 1 the normal.
class GpuMesh {
public:
    explicit GpuMesh(const ShadedMesh& mesh);
    void draw() const;

private:
    gl::VertexArray array_;
    gl::Buffer vertices_;
    gl::Buffer indices_;
    GLsizei count_ = 0;
};

} // namespace lumorph

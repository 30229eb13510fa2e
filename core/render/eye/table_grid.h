#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "core/geometry/calibrated_camera.h"
#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// The table as triangles for one camera: of what the camera sees of it, as few as its lens allows.
class TableGrid {
public:
    /// Builds it anew where the camera or the table is another one than before. `size`: metres in x and z.
    void fit(const CalibratedCamera& camera, glm::vec2 size);
    void draw() const;
    [[nodiscard]] std::size_t triangleCount() const noexcept { return static_cast<std::size_t>(count_) / 3; }
    static constexpr std::size_t kObjects = 3;

private:
    gl::VertexArray array_;
    gl::Buffer vertices_;
    gl::Buffer indices_;
    GLsizei count_ = 0;
    std::optional<CalibratedCamera> camera_;
    glm::vec2 size_{0.0F};
};

} // namespace lumorph

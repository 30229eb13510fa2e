#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/scene/show_frame.h"

namespace lumorph {

/// The device as it physically is, in the memory of the current context: attribute 0 the position, device metres.
class DeviceSurface {
public:
    /// Uploads what changed. Throws InvalidInput when the positions do not fit the rig.
    void update(const ShowFrame& frame);
    /// Sets `worldFromMesh` of the current program and draws.
    void draw(Program& program) const;
    static constexpr std::size_t kObjects = 3;

private:
    gl::VertexArray array_;
    gl::Buffer vertices_;
    gl::Buffer indices_;
    std::shared_ptr<const Rig> rig_;
    std::shared_ptr<const std::vector<glm::vec3>> positions_;
    glm::mat4 worldFromDevice_{1.0F};
    GLsizei count_ = 0;
    bool closed_ = false;
};

/// Box of the device in the world over all its states.
[[nodiscard]] Box deviceBounds(const ShowFrame& frame);
/// The same with the table.
[[nodiscard]] Box physicalBounds(const ShowFrame& frame);

} // namespace lumorph

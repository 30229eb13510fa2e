#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/render/gl_objects.h"
#include "core/render/program.h"
#include "core/render/viewport_frame.h"

namespace lumorph {

/// The class volume of a viewport's tint as a texture of the current context.
class ViewportTintVolume {
public:
    /// Uploads classes that are another object than last time; drops them when there is no tint. A tint whose
    /// number of classes does not fit its frame, or that the driver cannot hold, counts as none.
    void update(const std::optional<ViewportTint>& tint);

    /// Sets and binds what tint.glsl needs; call setTinted for each surface after it.
    void apply(Program& program, const ViewportFrame& frame, int textureUnit) const;
    void setTinted(Program& program, const ViewportFrame& frame, bool tinted) const;

    [[nodiscard]] std::size_t objectCount() const noexcept { return 1; }

private:
    std::shared_ptr<const std::vector<std::uint8_t>> classes_;
    glm::ivec3 dimensions_{0};
    gl::Texture texture_;
};

} // namespace lumorph

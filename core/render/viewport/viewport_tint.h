#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/render/viewport/viewport_frame.h"

namespace lumorph {

/// The class volume of a viewport's tint as a texture of the current context.
class ViewportTintVolume {
public:
    /// Uploads classes that are another object than last time; drops them when there is no tint. A tint whose
    /// number of classes does not fit its frame, or that the driver cannot hold, counts as none.
    void update(const std::optional<ViewportTint>& tint);

    [[nodiscard]] bool there() const noexcept { return volume_ != nullptr; }
    /// Sets and binds what tint.glsl needs; only the given classes (one a bit) tint. There must be a tint.
    void apply(Program& program, const ViewportFrame& frame, std::uint8_t classes, int textureUnit) const;

    [[nodiscard]] std::size_t objectCount() const noexcept { return volume_ ? 1 : 0; }

private:
    struct Volume {
        gl::Texture texture;
        std::shared_ptr<const std::vector<std::uint8_t>> classes;
        glm::ivec3 dimensions{0};
    };
    std::unique_ptr<Volume> volume_;
};

} // namespace lumorph

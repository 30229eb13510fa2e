#pragma once

#include <optional>
#include <string>

#include "core/render/gl/gl_objects.h"
#include "core/render/gl/program.h"
#include "core/scene/installation.h"

namespace lumorph {

/// A projector's measured response as a texture for projector_response.glsl: in one row the values that make light, in
/// the other the light of values.
class ResponseTable {
public:
    /// Entries of a row: each 8-bit value meets one, and between two values lie three more.
    static constexpr int kSteps = 4 * 255 + 1;
    static constexpr std::size_t kObjects = 1;

    ResponseTable();

    /// Uploads the response unless it is there already.
    void update(const InstalledProjector& projector);
    /// Sets the uniforms of projector_response.glsl in the current program; binds the table to a texture unit.
    void set(Program& program, int unit) const;

private:
    gl::Texture texture_;
    std::optional<InstalledProjector> shown_; ///< whose response it holds
};

} // namespace lumorph

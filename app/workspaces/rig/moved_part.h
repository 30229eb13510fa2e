#pragma once

#include <memory>
#include <vector>

#include "core/render/viewport/viewport_scene.h"
#include "core/rig/rig.h"

namespace lumorph::studio {

/// The border of what an actuator moves, as edges of the rig's mesh; of a part that is all its own, every outer edge
/// whose triangles stand at an angle.
class MovedPart {
public:
    MovedPart(const Rig& rig, std::size_t actuator);

    /// The border where the vertices are now.
    [[nodiscard]] std::vector<ViewportLine> lines(const std::vector<glm::vec3>& positions,
                                                  const glm::vec3& color) const;

private:
    std::vector<glm::uvec2> edges_;
};

/// How far an actuator has gone, 0 to 1 and back twice, `seconds` after it began to wiggle; negative when it is over.
[[nodiscard]] double wiggleStroke(double seconds);

} // namespace lumorph::studio

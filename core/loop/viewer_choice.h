#pragma once

#include <optional>
#include <span>
#include <string>

#include <glm/vec3.hpp>

#include "core/loop/pose_stream.h"
#include "core/scene/scene.h"

namespace lumorph {

/// A head that is tracked now.
struct TrackedHead {
    std::string name;
    glm::dvec3 eye{0.0}; ///< world metres
};

/// Whom the show follows, frame after frame: keeps the viewer it has while he is there, hands over smoothly (the eye
/// glides within 0.4 s), and nobody is followed when nobody is there.
class ViewerDirector {
public:
    struct View {
        std::string name;
        glm::dvec3 eye{0.0};
        bool handingOver = false;
    };
    /// `automatic`: the nearest to `centre`, changed only for one who is clearly nearer (20 %) for half a second.
    [[nodiscard]] std::optional<View> step(std::span<const TrackedHead> heads, const glm::dvec3& centre,
                                           ViewerChoice choice, double sinceLast);

private:
    std::string followed_;
    std::string rival_;
    double rivalSeconds_ = 0.0;
    std::optional<glm::dvec3> from_;
    std::optional<View> last_;
    double glide_ = 1.0;
};

} // namespace lumorph

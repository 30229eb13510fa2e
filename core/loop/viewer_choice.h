#pragma once

#include <optional>
#include <span>
#include <string>

#include <glm/vec3.hpp>

#include "core/loop/pose_stream.h"
#include "core/scene/installation.h"

namespace lumorph {

/// A head that is tracked now.
struct TrackedHead {
    std::string name;
    glm::dvec3 eye{0.0}; ///< world metres
};

/// Whom the show follows, frame after frame: keeps the viewer it has while he is there, hands over smoothly (the eye
/// glides within 0.4 s), and nobody is followed when nobody is there. Heads whose position is not finite are not there.
class ViewerDirector {
public:
    struct View {
        std::string name;
        glm::dvec3 eye{0.0};
        bool handingOver = false;
    };
    /// `automatic`: the nearest to `centre`, changed only for one who is clearly nearer (20 %) for half a second.
    /// `nearest`: always the nearest. `first`: the first of the list. `none`: nobody.
    [[nodiscard]] std::optional<View> step(std::span<const TrackedHead> heads, const glm::dvec3& centre,
                                           ViewerChoice choice, double sinceLast);

private:
    const TrackedHead& chosen(std::span<const TrackedHead> heads, const glm::dvec3& centre, ViewerChoice choice,
                              double seconds);
    View glided(const TrackedHead& head, double seconds);

    std::string followed_;
    std::string rival_; ///< who has been clearly nearer lately
    double rivalSeconds_ = 0.0;
    std::optional<glm::dvec3> from_; ///< where the eye glides from
    std::optional<View> last_;
    double glide_ = 1.0; ///< share of the way that is done
};

} // namespace lumorph

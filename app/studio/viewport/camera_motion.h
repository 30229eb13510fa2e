#pragma once

#include <chrono>
#include <optional>

#include <glm/vec2.hpp>

#include "core/render/viewport/view_camera.h"

namespace lumorph::studio {

/// The camera of a view while it glides to another or zooms smoothly. Time is given.
class CameraMotion {
public:
    using Time = std::chrono::steady_clock::time_point;
    static constexpr std::chrono::milliseconds kGlide{250};

    [[nodiscard]] const ViewCamera& camera() const noexcept { return camera_; }
    /// Where it will have come when it rests.
    [[nodiscard]] ViewCamera destination() const;
    [[nodiscard]] bool moves() const noexcept { return glide_ || zoom_; }

    /// At once; ends a glide.
    void set(const ViewCamera& camera);
    void glideTo(const ViewCamera& target, Time now);
    /// Comes nearer by `factor` in a few frames; several add up. `size` and `pixel` as for `zoomed`.
    void zoomBy(double factor, glm::vec2 pixel, glm::vec2 size, Time now);
    void advance(Time now);

private:
    struct Glide {
        ViewCamera from, to;
        Time begun;
    };
    struct Zoom {
        double remaining = 0.0; ///< logarithm of the factor that is still to come
        glm::vec2 pixel{0.0F};
        glm::vec2 size{1.0F};
        Time last;
    };
    ViewCamera camera_;
    std::optional<Glide> glide_;
    std::optional<Zoom> zoom_;
};

} // namespace lumorph::studio

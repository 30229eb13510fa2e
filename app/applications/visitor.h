#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "core/loop/show_inputs.h"
#include "core/loop/show_program.h"

namespace lumorph {

/// Who stands before an application, as all of them understand it: whether somebody plays, where he points, how far he
/// leans the device, and which of the keys that all share he pressed.
///
/// `key.left`, `key.right`, `key.up`, `key.down` (1 held, 0 let go); `pointer.x`, `pointer.y` and `pad.x`, `pad.y` from
/// -1 (left, away from the player) to 1 (right, towards the player); `pointer.held` while a button or finger is down;
/// `key.restart`, `key.next` and `key.attract` act when pressed. The device itself counts where it is tracked.
class Visitor {
public:
    static constexpr double kSilence = 45.0;  ///< seconds without anything done until he is taken to have gone
    static constexpr double kMostLean = 0.26; ///< radians, 15 degrees

    /// Takes what has come since the frame before.
    void take(const ShowMoment& moment);

    /// Somebody plays. Until then, and after, an application shows by itself what can be done.
    [[nodiscard]] bool there() const noexcept { return there_; }
    [[nodiscard]] bool came() const noexcept { return came_; }       ///< in this frame
    [[nodiscard]] bool left() const noexcept { return left_; }       ///< in this frame: silence, or `key.attract`
    [[nodiscard]] bool active() const noexcept { return active_; }   ///< did something in this frame
    [[nodiscard]] bool restart() const noexcept { return restart_; } ///< pressed in this frame
    [[nodiscard]] bool next() const noexcept { return next_; }       ///< pressed in this frame

    /// By keys, pointer, stick or device together, radians, at most `kMostLean` long. Positive x: the right side down;
    /// positive y: the side towards him down.
    [[nodiscard]] glm::dvec2 lean() const noexcept;
    /// The same where a pointer that lies still asks for nothing: it counts while it is moved or held, and a moment on.
    [[nodiscard]] glm::dvec2 lively() const noexcept;
    /// The tracked device's part of it; 0 without one.
    [[nodiscard]] const glm::dvec2& leanOfDevice() const noexcept { return device_; }
    /// Keys and stick alone, at most 1 each way.
    [[nodiscard]] glm::dvec2 push() const noexcept;
    /// Where the pointer stands over the view, -1 to 1 from its middle; nothing while it is elsewhere.
    [[nodiscard]] const std::optional<glm::dvec2>& pointer() const noexcept { return pointer_; }

private:
    void take(const ShowInput& input);
    void point(double value, double glm::dvec2::*axis);
    void decide(double step);

    glm::dvec2 negative_{0.0}, positive_{0.0}; ///< keys
    std::optional<glm::dvec2> pointer_;
    glm::dvec2 pad_{0.0};
    glm::dvec2 device_{0.0};                    ///< lean of the tracked device, radians; 0 without one
    double silence_ = 0.0, pointerRests_ = 0.0; ///< seconds
    bool holds_ = false;                        ///< a button or a finger
    bool there_ = false, came_ = false, left_ = false;
    bool active_ = false, restart_ = false, next_ = false, attract_ = false;
};

/// By how much a pose of the device leans against gravity, radians; at most Visitor::kMostLean long.
[[nodiscard]] glm::dvec2 leanOf(const glm::mat4& worldFromDevice) noexcept;

} // namespace lumorph

#pragma once

#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "core/loop/show_inputs.h"
#include "core/loop/show_program.h"

namespace lumorph::labyrinth {

/// How a player leans the labyrinth: by keys, a pointer or a stick as named inputs, or by the tracked device itself.
///
/// `key.left`, `key.right`, `key.up`, `key.down` (1 held, 0 let go); `pointer.x`, `pointer.y` and `pad.x`, `pad.y` from
/// -1 (left, away from the player) to 1 (right, towards the player); `key.restart` and `key.next` act when pressed.
class Controls {
public:
    /// Takes what has come since the frame before.
    void take(const ShowMoment& moment);

    [[nodiscard]] glm::dvec2 lean() const noexcept;                  ///< radians: as Game::advance takes it
    [[nodiscard]] bool active() const noexcept { return active_; }   ///< somebody did something in this frame
    [[nodiscard]] bool restart() const noexcept { return restart_; } ///< was pressed in this frame
    [[nodiscard]] bool next() const noexcept { return next_; }       ///< was pressed in this frame

private:
    void take(const ShowInput& input);
    void follow(const ShowMoment& moment);

    glm::dvec2 negative_{0.0}, positive_{0.0}; ///< keys
    glm::dvec2 pointer_{0.0}, pad_{0.0};
    glm::dvec2 device_{0.0}; ///< lean of the tracked device, radians; 0 without one
    bool active_ = false, restart_ = false, next_ = false;
};

/// By how much a pose of the device leans against gravity, radians; limited to what Game takes.
[[nodiscard]] glm::dvec2 leanOf(const glm::mat4& worldFromDevice) noexcept;

} // namespace lumorph::labyrinth

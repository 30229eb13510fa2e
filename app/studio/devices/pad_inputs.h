#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "core/loop/show_inputs.h"

namespace lumorph::studio {

/// What a game controller is read as, or all of them together.
struct PadReading {
    glm::dvec2 stick{0.0}; ///< or its cross; -1 (left, away from the player) to 1
    bool restart = false;  ///< the south button, or start
    bool next = false;     ///< the east button
    bool attract = false;  ///< back
    bool operator==(const PadReading&) const = default;
};

/// What readings change, as inputs of an application: `pad.x`, `pad.y`, and `key.restart`, `key.next` and
/// `key.attract`. A stick that rests, or trembles, says nothing.
class PadInputs {
public:
    static constexpr double kRests = 0.15; ///< of the whole way around the middle
    static constexpr double kWhole = 0.95; ///< from there on a stick is quite aside

    /// The inputs since the reading before; none where nothing has changed.
    [[nodiscard]] std::vector<ShowInput> take(const PadReading& reading);

private:
    PadReading before_; ///< with the stick as it was told
};

} // namespace lumorph::studio

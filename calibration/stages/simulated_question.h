#pragma once

#include <string>
#include <vector>

#include "core/scene/installation.h"

namespace lumorph {

/// Asks once before a result of the virtual lab goes into a room that holds something measured or entered.
class SimulatedQuestion {
public:
    /// Whether the user must be asked first. The next call about the same parts of the room is the user's yes, which
    /// holds for them from then on.
    [[nodiscard]] bool asks(const Installation& room);
    /// What the room holds, while it is asked; else empty.
    [[nodiscard]] const std::vector<std::string>& asked() const noexcept { return asked_; }
    void withdraw() { asked_.clear(); }

private:
    std::vector<std::string> asked_, answered_;
};

} // namespace lumorph

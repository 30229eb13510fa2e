#pragma once

#include <cstdint>
#include <vector>

#include "core/base/units.h"

namespace lumorph {

/// `count` quasi-random joint states: a Sobol sequence over the actuators (Joe and Kuo's direction
/// numbers), shifted digitally by `seed`. The same on every machine.
/// Throws InvalidInput for more actuators than the sequence has dimensions (3667).
[[nodiscard]] std::vector<State> quasiRandomStates(std::size_t actuators, int levels, std::size_t count,
                                                   std::uint64_t seed);

/// Every joint state, levels^actuators of them, the first actuator fastest.
[[nodiscard]] std::vector<State> allStates(std::size_t actuators, int levels);

/// levels^actuators, or `limit` when that is more.
[[nodiscard]] std::uint64_t jointStateCount(std::size_t actuators, int levels, std::uint64_t limit) noexcept;

} // namespace lumorph

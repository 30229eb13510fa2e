#pragma once

#include <cstdint>
#include <vector>

namespace lumorph {

/// Short sessions with each of the simulated boards, as servo_trace_fuzz reads them.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> servoTraceSeeds();

} // namespace lumorph

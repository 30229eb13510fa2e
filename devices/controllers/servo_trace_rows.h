#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "devices/controllers/servo_input.h"
#include "devices/controllers/servo_trace.h"

/// How the inputs of a ServoEngine lie in a trace. Numbers are little endian; counts, and times between ticks, are
/// LEB128, signed ones in zigzag.
namespace lumorph::servo_trace {

/// Kinds of rows, besides those of inputs.
inline constexpr std::string_view kMachine = "machine"; ///< one is made: its version, and its profile as JSON
inline constexpr std::string_view kSent = "sent";       ///< messages that came out of one input, joined
inline constexpr std::string_view kMissing = "missing"; ///< what was before was not kept

/// All kinds of rows. A packed history names them by their place here, which may not change.
inline constexpr std::array<std::string_view, 19> kKinds = {
    kMachine, kSent,  kMissing,  "connect", "disconnect", "confirm",  "arm",  "disarm", "stop",    "command",
    "wiggle", "slow", "profile", "quit",    "opened",     "received", "lost", "ticks",  "released"};

struct TimedInput {
    Microseconds time{0};
    ServoInput input;
};
struct TimedTick {
    Microseconds time{0};
    std::uint64_t unsent = 0;
};

[[nodiscard]] ServoTraceRow machineRow(const DeviceProfile& profile, Microseconds time);
/// Of anything but a tick.
[[nodiscard]] ServoTraceRow inputRow(const ServoInput& input, Microseconds time);
/// Many ticks are one row; there is at least one.
[[nodiscard]] ServoTraceRow ticksRow(std::span<const TimedTick> ticks);

/// The way back. Throw DataError that names the row by its number and kind.
[[nodiscard]] DeviceProfile machineProfile(const ServoTraceRow& row, std::size_t number);
[[nodiscard]] std::vector<TimedInput> inputsOf(const ServoTraceRow& row, std::size_t number);

} // namespace lumorph::servo_trace

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/clock.h"

namespace lumorph {

/// What went into the machine behind a device's servos (ServoEngine), or came out of it, in order. The same inputs at
/// the same times make the same bytes, so a session can be proved afterwards. The first row, of kind "machine", holds
/// the profile; another later means that a device was put in its place.
struct ServoTraceRow {
    Microseconds time{0}; ///< by the steady clock of the link
    std::string kind;     ///< an input's name; "sent" for bytes that came out
    std::vector<std::uint8_t> bytes;
    bool operator==(const ServoTraceRow&) const = default;
};

/// What running a trace again has shown.
struct TraceCheck {
    struct Difference {
        std::size_t row = 0; ///< of the trace, from 0
        Microseconds time{0};
        std::string text; ///< what was expected and what came
    };
    std::uint64_t inputs = 0;             ///< that were run again, ticks too
    std::uint64_t bytesSent = 0;          ///< of the trace, that were compared
    std::optional<Difference> difference; ///< the first, where it ends; none: every byte is equal
};

/// Runs the inputs of a trace through the same machine again, with the trace's own times, and compares what comes out
/// bit for bit. Times may be shifted as a whole. What the last input made may be missing: a trace can end anywhere.
/// Throws DataError, which names the row, for a trace that does not begin with its machine, is of another version of
/// it, or is damaged.
[[nodiscard]] TraceCheck checkTrace(std::span<const ServoTraceRow> trace);

/// The strokes of a row of kind "command". `number` is for the DataError of a damaged one.
[[nodiscard]] std::vector<double> tracedStrokes(const ServoTraceRow& row, std::size_t number);

} // namespace lumorph

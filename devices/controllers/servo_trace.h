#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/clock.h"

namespace lumorph {

/// What went into the machine behind a device's servos, or came out of it, in order. The same inputs at the same times
/// make the same bytes, so a session can be proved afterwards.
struct ServoTraceRow {
    Microseconds time{0}; ///< by the steady clock of the link
    std::string kind;     ///< an input's name; "sent" for bytes that came out
    std::vector<std::uint8_t> bytes;
    bool operator==(const ServoTraceRow&) const = default;
};

/// What running a trace again has shown.
struct TraceCheck {
    struct Difference {
        std::size_t row = 0; ///< of the trace
        Microseconds time{0};
        std::string text; ///< what was expected and what came
    };
    std::uint64_t inputs = 0;
    std::uint64_t bytesSent = 0;          ///< recorded
    std::optional<Difference> difference; ///< the first; none: every byte is equal
};

/// Runs the inputs of a trace through the same machine again, with the trace's own times, and compares what comes out
/// bit for bit. Times may be shifted as a whole. Throws DataError for a trace that does not begin with its profile.
[[nodiscard]] TraceCheck checkTrace(std::span<const ServoTraceRow> trace);

} // namespace lumorph

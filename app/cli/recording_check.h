#pragma once

#include <cstdint>
#include <string>

#include "app/recording/recording.h"
#include "devices/controllers/servo_trace.h"

namespace lumorph::cli {

/// What running a recorded session again has shown.
struct RecordingCheck {
    TraceCheck servos;
    std::uint64_t commands = 0; ///< to the servos, while there were frames
    std::uint64_t framed = 0;   ///< of these, whose strokes are a frame's estimated state, bit for bit
    std::string firstOther;     ///< about the first that is none; empty: all are

    [[nodiscard]] bool equal() const { return !servos.difference && framed == commands; }
};

/// Runs the servos' inputs again (checkTrace), and looks for each command in the frames of the ten seconds before it,
/// in their order. Throws DataError for a recording without servo rows, and as checkTrace.
[[nodiscard]] RecordingCheck checkRecording(const Recording& recording);

} // namespace lumorph::cli

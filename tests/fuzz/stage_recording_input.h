#pragma once

#include <cstddef>

/// How an input of stage_recording_fuzz holds a recording whose files may be changed without a checksum that then is
/// wrong: "2", then stage, method, and name and bytes of each file, each ended by this byte.
inline constexpr char kPartEnd = '\x1e';
/// Of the room and the device that it is read for.
inline constexpr std::size_t kFuzzActuators = 2, kFuzzProjectors = 2;

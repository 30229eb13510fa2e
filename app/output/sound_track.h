#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace lumorph {

/// Writes the pictures of a video file as they are, and beside them sound (as AAC), into another MP4. `samples`: left
/// and right by turns, `rate` a second. Throws DeviceError where one of them cannot be read, written or encoded.
void addSoundTrack(const std::string& video, std::span<const std::int16_t> samples, int rate, const std::string& into);

} // namespace lumorph

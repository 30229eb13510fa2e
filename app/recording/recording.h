#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/recording/session_rows.h"

namespace lumorph {

/// A recorded session, read whole.
struct Recording {
    std::map<std::string, std::string> facts;
    std::vector<FrameRow> frames; ///< each list by time
    std::vector<PoseRow> poses;
    std::vector<EventRow> events;
    std::vector<ServoRow> servo;
};

/// Throws DataError that names file, table and row: no recording, a newer version's, damaged.
[[nodiscard]] Recording readRecording(const std::filesystem::path& file);

/// Writes `frames.csv`, `poses.csv`, `events.csv` and `servo.csv` into a folder, for a study: a header line, commas,
/// decimal points, seconds, metres; each column once, the servos' as wanted_0, estimated_0, ... Throws DeviceError.
void exportCsv(const Recording& recording, const std::filesystem::path& folder);

/// The frame to be shown `seconds` after the begin: the newest not after it; the first before all.
[[nodiscard]] const FrameRow* frameAt(const Recording& recording, double seconds);

} // namespace lumorph

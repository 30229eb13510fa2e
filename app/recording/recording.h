#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/recording/session_rows.h"
#include "core/base/progress.h"

namespace lumorph {

/// A recorded session, read whole.
struct Recording {
    std::map<std::string, std::string> facts;
    std::vector<FrameRow> frames; ///< this and the next two by time
    std::vector<PoseRow> poses;
    std::vector<EventRow> events;
    std::vector<InputRow> inputs;      ///< by time; empty in what an older version recorded
    std::vector<ServoRow> servo;       ///< as it went in and came out
    bool closed = true;                ///< its recorder ended it
    std::vector<std::string> warnings; ///< where it did not: what that means, in plain sentences
};

/// One that was not closed is read as far as it reached the disk, with a warning; nothing is written, neither into the
/// file nor beside it. Throws DataError that names file, table and row: no recording, a newer version's, damaged;
/// Cancelled.
[[nodiscard]] Recording readRecording(const std::filesystem::path& file, const Progress& progress = {});

/// The files that the session's project needs. Throws as readRecording, also for a name that leaves their folder.
[[nodiscard]] std::vector<FileRow> readFiles(const std::filesystem::path& file);

/// Seconds from the recording's begin to the last that it shows or tells.
[[nodiscard]] double secondsOf(const Recording& recording);

/// Writes `frames.csv`, `poses.csv`, `events.csv`, `inputs.csv` and `servo.csv` into a folder, for a study: a header
/// line, commas, decimal points, seconds, metres; each column once, the servos' as wanted_0, estimated_0, ... Throws
/// DeviceError, Cancelled.
void exportCsv(const Recording& recording, const std::filesystem::path& folder, const Progress& progress = {});

/// The frame to be shown `seconds` after the begin: the newest not after it; the first before all.
[[nodiscard]] const FrameRow* frameAt(const Recording& recording, double seconds);

} // namespace lumorph

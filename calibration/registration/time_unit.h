#pragma once

#include <optional>
#include <string>

#include "calibration/registration/pose_track.h"
#include "core/base/progress.h"

/// Recordings whose times are no seconds.
namespace lumorph {

struct TimeUnit {
    double seconds = 1.0;
    const char* name = "seconds"; ///< of many
};

/// Seconds, or milli-, micro- or nanoseconds where the recording's usual step, taken for seconds, is longer than any
/// gap over which a motion can be followed. Of fewer than 20 poses seconds: nothing can be told of them.
[[nodiscard]] TimeUnit likelyTimeUnit(const PoseTrack& track);

/// Whole numbers that are one, two or three apart: frames, or pictures of which some were left out.
[[nodiscard]] bool countsFrames(const PoseTrack& track);

/// The recording in seconds, with a warning `time_unit` where it was in another unit; what counts frames is unchanged.
[[nodiscard]] PoseTrack inSeconds(PoseTrack track, const std::string& name);

/// The same for who knows no other recording: throws CaptureRefused, `time_unit`, for one that counts frames.
[[nodiscard]] PoseTrack inKnownSeconds(PoseTrack track, const std::string& name);

/// A recording that counts frames, in seconds by the frame rate at which it turns as `other` does; nothing where no
/// rate explains it. Both have to be of about the same time: one no longer than three times the other. Throws
/// Cancelled.
[[nodiscard]] std::optional<PoseTrack> inSecondsBy(const PoseTrack& other, PoseTrack frames, const std::string& name,
                                                   const Progress& progress = {});

} // namespace lumorph

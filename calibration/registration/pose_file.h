#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "calibration/registration/pose_track.h"

namespace lumorph {

/// Reads rows `time,x,y,z,qx,qy,qz,qw` (seconds, metres), with commas, semicolons, tabs or blanks between; beside
/// semicolons numbers may have a decimal comma. `#` begins a comment. A head row is passed over; where it names all
/// columns, with or without `#` (TUM, EuRoC, rostopic), they are taken by their names and units (`qw` before `qx`,
/// `[ns]`, `time_ms`), and others are passed over. Times since 1970 in milli-, micro- or nanoseconds become seconds,
/// with a warning `time_unit`; other units solveHandEye finds out.
///
/// Rows out of order are sorted, those with the time of another left out, as by inTimeOrder. Throws DataError with the
/// line for a row that is no pose (not eight finite numbers, a quaternion whose length is not 1 within 2 %),
/// CaptureRefused for a clock that goes back, for fewer than two poses and for places farther than 200 m, which are
/// millimetres or centimetres. `name` is the file's, for messages.
[[nodiscard]] PoseTrack parsePoseTrack(std::string_view text, const std::string& name);

/// Points `name,x,y,z`, metres.
struct NamedPoint {
    std::string name;
    glm::dvec3 place{0.0};
};
/// Reads such rows, `#` begins a comment. Throws DataError with the line; also for two points of one name.
[[nodiscard]] std::vector<NamedPoint> parseNamedPoints(std::string_view text, const std::string& name);

/// A body that stood still.
struct Station {
    std::string name; ///< "3" where the file has none
    Pose pose;        ///< worldFromBody, metres
};
/// Reads rows `x,y,z,qx,qy,qz,qw`, or with a name or number before them, as parsePoseTrack reads its own. Throws
/// DataError with the line; also for two stations of one name.
[[nodiscard]] std::vector<Station> parseStations(std::string_view text, const std::string& name);

} // namespace lumorph

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calibration/registration/hand_eye.h"
#include "calibration/registration/hand_eye_closed.h"
#include "calibration/registration/hand_eye_fit.h"

/// One way of reading two recordings, solved; and the search for another where it fits badly. Private to hand_eye.h.
namespace lumorph::hand_eye {

struct Recordings {
    const PoseTrack& a;
    const PoseTrack& b;
    ClockOffset clocks;
    bool areStations = false; ///< whose times are numbers of stations, and whose clocks are known
    Names names;
    bool isReread = false; ///< as another reading has it: none is looked for again
};

struct Attempt {
    Unknowns solved;
    Place place = Place::body;
    std::vector<Deviation> deviations;
    double medianTurn = 0.0, medianShift = 0.0; ///< radians, metres
    bool aInPlace = false, bInPlace = false;
};

/// In closed form, then refined. Throws CaptureRefused as closedForm does, and `too_few_points`; Cancelled.
[[nodiscard]] Attempt attemptOf(const Recordings& recordings, const Progress& progress);

/// How the recordings have to be read, where that is not as they are.
struct OtherReading {
    PoseReading a, b;
};

/// What makes one of `attemptOf`: its result, or the reading by which another fits well while this does not. Throws
/// what attemptOf does; `inverted` where one of the two has the world in the body's frame, for nothing tells which;
/// `quaternion_order` where several readings fit.
struct Read {
    std::optional<Attempt> attempt;
    std::optional<OtherReading> other;
};
[[nodiscard]] Read readRecordings(const Recordings& recordings, const Progress& progress);

/// What a reading other than the usual is warned of.
[[nodiscard]] std::vector<Finding> warningsOf(const OtherReading& other, const Names& names);
/// That a body turned in place, and that both recordings may be inverted.
[[nodiscard]] std::vector<Finding> warningsOf(const Attempt& attempt, const Names& names);

/// What both kinds of recording tell.
[[nodiscard]] HandEye resultOf(const Attempt& attempt);

} // namespace lumorph::hand_eye

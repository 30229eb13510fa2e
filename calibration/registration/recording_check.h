#pragma once

#include <span>
#include <string>
#include <utility>

#include "calibration/registration/pose_track.h"

namespace lumorph {

/// In the order of times, and each time once: rows that came late, up to 0.2 s, or by more where it is seen that they
/// fit in, are sorted, and those of a second clock that is behind left out, with a warning `rows_out_of_order`; of rows
/// of one time the first is kept, with a warning `doubled_rows`. Throws CaptureRefused, `clock_jumps`, where the clock
/// went back instead. `places` names rows for messages; where it is empty, they count from 1.
[[nodiscard]] PoseTrack inTimeOrder(const PoseTrack& track, const std::string& name,
                                    std::span<const std::string> places = {});

/// The recording as it may be used: in the order of its times (inTimeOrder); rows with the time of the row before, and
/// one or two poses of somewhere else, left out with a warning each. Throws CaptureRefused: `not_a_number`,
/// `clock_jumps` (back, or ahead at once), `tracker_lost` (nothing for longer than a third of a second), `body_swapped`
/// (from one pose to the next it is somewhere else), `wrong_units` (farther than any tracker sees), `too_few_points`
/// (none). `name` is the body's, for messages.
[[nodiscard]] PoseTrack soundTrack(const PoseTrack& track, const std::string& name);

/// A fault that all poses of a capture share, and how it is undone.
struct CaptureFault {
    Cause cause = Cause::mirrored;
    const char* why = "";
    const char* remedy = "";
    Pose (*pose)(const Pose&) = nullptr;              ///< as it were without the fault
    glm::dvec3 (*point)(const glm::dvec3&) = nullptr; ///< likewise a point in a body's frame
    bool exchanged = false;                           ///< the pointer is the body, and the body the pointer
};
/// Left-handed worlds, centimetres and millimetres, two bodies taken for one another all the time.
[[nodiscard]] std::span<const CaptureFault> captureFaults();

[[nodiscard]] PoseTrack withoutFault(PoseTrack track, const CaptureFault& fault);

/// `solve(nullptr)`; where that is refused and `solve(&fault)`, which undoes a fault in what it is made of, is not,
/// that fault is what is refused: a residual tells only that something is wrong, this tells what.
template <typename Solve> [[nodiscard]] auto orNamed(const std::string& what, const Solve& solve) {
    try {
        return solve(nullptr);
    } catch (const CaptureRefused&) {
        for (const CaptureFault& fault : captureFaults()) {
            try {
                (void)solve(&fault);
            } catch (const CaptureRefused&) {
                continue; // not this one
            }
            throw CaptureRefused({fault.cause, what, {}, fault.why, fault.remedy});
        }
        throw;
    }
}

} // namespace lumorph

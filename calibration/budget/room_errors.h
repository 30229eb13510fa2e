#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "calibration/lab/true_room.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// Of what a show is made, each with its own error. `prediction` is what is left of a hand's motion when the delay is
/// known: noise of the tracker, turns that nobody can foresee, and what lies farther ahead than is predicted. `pointer`
/// is what the pointer's tip puts into tracker, device and eye, where they were measured with it; it is their common
/// cause, so that it is added up once.
enum class BudgetPart { projector, tracker, device, eye, servos, delay, prediction, pointer };
inline constexpr std::size_t kBudgetParts = 8;
inline constexpr std::array<BudgetPart, kBudgetParts> kAllBudgetParts{
    BudgetPart::projector, BudgetPart::tracker, BudgetPart::device,     BudgetPart::eye,
    BudgetPart::servos,    BudgetPart::delay,   BudgetPart::prediction, BudgetPart::pointer};
/// "projector", "tracker", ...: of keys in JSON and names of widgets.
[[nodiscard]] const char* keyOf(BudgetPart part) noexcept;

/// How the error of a part is known.
enum class ErrorSource {
    told,      ///< its measurement said so
    measured,  ///< it was measured, but not said how well: as such measurements come out
    simulated, ///< the virtual lab measured it: as large as it is there, which says nothing of this room
    assumed,   ///< it was not measured: as large as it usually is
    worked     ///< worked out from the others: the prediction
};

/// Standard deviations of a pose along each of three axes.
struct PoseError {
    double metres = 0.0, radians = 0.0;
};

/// Where a projector's light falls.
struct BeamError {
    double metres = 0.0; ///< across the beam, both directions together
    ErrorSource source = ErrorSource::assumed;
};

/// What the tip's error makes of tracker, device and eye: metres along each axis. A tip that is believed too far off by
/// some way shifts the tracker's world against it, and a device and an eye along with it. That is so where a pointer is
/// held about alike for all of them, as hands do.
struct TipErrors {
    double tracker = 0.0, device = 0.0, eye = 0.0;
};

/// How far a room's figures may be from the truth, as standard deviations. Tracker, device and eye are without the part
/// that is in `tip`; all of them together are independent of one another.
struct RoomErrors {
    std::vector<BeamError> lights; ///< one a projector of the room; zero for one that is off
    PoseError tracker;             ///< of its world in the room's, about the middle of the table
    PoseError device;              ///< on its body, about the device's origin
    double eye = 0.0;              ///< metres along each axis, from its body
    TipErrors tip;
    std::vector<double> strokes; ///< one an actuator
    double delay = 0.0;          ///< seconds, from a motion to its light, besides what is compensated by prediction
    PoseError noise;             ///< of each pose that a tracker tells
    double ahead = 0.0;          ///< seconds by which poses are to be predicted, however far that is
    /// False: nobody has said where the tracker's world lies, so that no number tells how far a tracked thing's light
    /// falls beside.
    bool isTrackerPlaced = true;
    std::array<ErrorSource, kBudgetParts> sources{};

    [[nodiscard]] ErrorSource sourceOf(BudgetPart part) const { return sources[static_cast<std::size_t>(part)]; }
};

/// Those of a room: what its measurements said of themselves (`sigmaOf` their origins); of what was not measured the
/// usual sizes, those of the lab, with the servos' strokes at `commanded`, one an actuator. Figures entered by hand
/// count as not measured. A part of which some was not measured (a projector, a servo) counts as not measured. Without
/// prediction the whole delay is an error.
[[nodiscard]] RoomErrors errorsOf(const Installation& room, const Rig& rig, const std::vector<double>& commanded,
                                  const LabErrors& usual = {});

/// The same after a part has been measured as such measurements come out; one that was measured already is half as
/// large then. The prediction stays. A pointer that is measured again helps as soon as tracker, device and eye are.
[[nodiscard]] RoomErrors measuredAgain(RoomErrors errors, const Rig& rig, BudgetPart part);

} // namespace lumorph

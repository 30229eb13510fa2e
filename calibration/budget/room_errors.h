#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "calibration/lab/true_room.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// Of what a show is made, each with its own error. `prediction` is what is left of a hand's motion when the delay is
/// known: noise of the tracker, and turns that nobody can foresee.
enum class BudgetPart { projector, tracker, device, eye, servos, delay, prediction };
inline constexpr std::size_t kBudgetParts = 7;
inline constexpr std::array<BudgetPart, kBudgetParts> kAllBudgetParts{
    BudgetPart::projector, BudgetPart::tracker, BudgetPart::device,    BudgetPart::eye,
    BudgetPart::servos,    BudgetPart::delay,   BudgetPart::prediction};
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

/// How far a room's figures may be from the truth, as standard deviations.
struct RoomErrors {
    double light = 0.0;          ///< metres across the beam, both directions together: where a projector's light falls
    PoseError tracker;           ///< of its world in the room's, about the middle of the table
    PoseError device;            ///< on its body, about the device's origin
    double eye = 0.0;            ///< metres along each axis, from its body
    std::vector<double> strokes; ///< one an actuator
    double delay = 0.0;          ///< seconds, from a motion to its light, besides what is believed
    PoseError noise;             ///< of each pose that a tracker tells
    double ahead = 0.0;          ///< seconds by which poses are predicted
    /// False: nobody has said where the tracker's world lies, so that no number tells how far a tracked thing's light
    /// falls beside.
    bool isTrackerPlaced = true;
    std::array<ErrorSource, kBudgetParts> sources{};

    [[nodiscard]] ErrorSource sourceOf(BudgetPart part) const { return sources[static_cast<std::size_t>(part)]; }
};

/// Those of a room: what its measurements said of themselves (`sigmaOf` their origins); of what was not measured the
/// usual sizes, those of the lab, with the servos' strokes at `commanded`, one an actuator. Figures entered by hand
/// count as not measured.
[[nodiscard]] RoomErrors errorsOf(const Installation& room, const Rig& rig, const std::vector<double>& commanded,
                                  const LabErrors& usual = {});

/// The same after a part has been measured as such measurements come out; one that was measured already is half as
/// large then. The prediction stays.
[[nodiscard]] RoomErrors measuredAgain(RoomErrors errors, const Rig& rig, BudgetPart part);

} // namespace lumorph

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// How far the lab's true room is from what one believes of it before anything is measured, as standard deviations, and
/// how much its instruments tremble.
struct LabErrors {
    bool unknownTracker = true;           ///< its world stands and is turned anyhow, up to a metre and a half turn away
    double deviceMillimetres = 15;        ///< of the device on its body
    double deviceDegrees = 6;             ///< likewise
    double tipMillimetres = 160;          ///< of the pointer's tip from its body, along one side
    double eyeMillimetres = 25;           ///< of the eye from the tracked head's body
    double servoBend = 0.04;              ///< of a stroke: how far a servo's curve bends away from the straight line
    double backlashDegrees = 2.0;         ///< between the way up and the way down; exact, not a deviation
    double servoLagSeconds = 0.1;         ///< of servos, in the mean
    double trackerSeconds = 0.012;        ///< age of poses on arrival, in the mean
    double lightSeconds = 0.07;           ///< from a picture's frame to its light, in the mean
    double gain = 0.12;                   ///< of the channels of a projector
    double black = 0.004;                 ///< light of a projector's black
    double color = 0.04;                  ///< of the bare device and table, sRGB: they are darker than believed
    double trackerNoiseMillimetres = 1.0; ///< of each pose
    double trackerNoiseDegrees = 0.2;     ///< of each pose
};

/// The virtual lab's truth beside a room as it is believed to be: what stands in the lab, with errors of these sizes in
/// all that comes after projector and camera (tracker, device on its body, pointer, eye, servos of this rig, delays,
/// light, bare colours). Projectors and cameras keep their lenses and poses. Equal seeds give equal rooms. Every
/// actuator gets a `MeasuredServo` with its true curve, which rises strictly.
[[nodiscard]] Installation trueRoom(const Installation& believed, std::span<const Actuator> actuators,
                                    std::uint32_t seed, const LabErrors& errors = {});

/// The lab's camera and one projector of the room as they truly are: as somebody has put them up, near where rooms have
/// their first projector, or for another number to the side of it, and with another zoom.
[[nodiscard]] Installation labTruth(const Installation& room, std::size_t projector = 0);

/// The whole room as it truly is in the lab: projectors that were calibrated stand where they are believed to, all
/// others, and a camera where none was calibrated, as somebody has put them up.
[[nodiscard]] Installation labRoomTruth(Installation room);

/// Root mean square distance, metres, by which light of `believed` lands beside where `truth` puts it, over a square of
/// `side` metres on the table around the world's origin; empty where neither lights it.
[[nodiscard]] std::optional<double> lightError(const CalibratedCamera& believed, const CalibratedCamera& truth,
                                               double side);

/// Ground truth of the virtual lab for this seed, which measurements do not read: the
/// same for the same seed and actuators, whatever was measured meanwhile. Projectors and cameras stand where they are
/// believed to; where the lab's own sequence measured a projector, where that truly has it (labTruth).
[[nodiscard]] Installation unpackedLab(const Installation& believed, std::span<const Actuator> actuators,
                                       std::uint32_t seed);

/// Degrees of a whole stroke; empty for an actuator that does not turn.
[[nodiscard]] std::optional<double> degreesOf(const Actuator& actuator);

} // namespace lumorph

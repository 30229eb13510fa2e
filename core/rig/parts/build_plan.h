#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/rig/parts/layered_solid.h"
#include "core/rig/parts/lever.h"
#include "core/rig/parts/servo_body.h"
#include "core/rig/rig.h"

namespace lumorph {

/// How parts are made; millimetres.
struct PartOptions {
    ServoBody servo = servoBodies().front();
    double tolerance = 0.2; ///< between a printed part and what goes into it, on every side: 0 to 1
    double bed = 220.0;     ///< sides of the printer's bed: 50 to 2000
};

/// A part to print, as often as `count`.
struct PrintPart {
    std::string name; ///< fit for a file
    std::string use;
    std::string material;
    int count = 1;
    LayeredSolid solid; ///< lies on z = 0 with its lower left corner at the origin
};

/// A part to buy.
struct BoughtPart {
    std::string name;
    std::string use;
    int count = 1;
};

/// How one actuator is wired.
struct WiringRow {
    std::string actuator;
    int channel = -1;         ///< of the rig's file; -1 when it tells none
    int pin = -1;             ///< of the board; -1 where one board does not have enough
    double pulseMin = 1000.0; ///< microseconds, least and greatest that may be sent
    double pulseMax = 2000.0;
    PulseCurve curve{};    ///< of its lever, from rest to where the lever has lifted the flap
    bool reversed = false; ///< rest at pulseMax
    std::string seat;      ///< what holds its servo
    std::optional<Lever> lever;
};

/// A step of the assembly. The picture is inline SVG, or empty.
struct BuildStep {
    std::string title;
    std::string text;
    std::string picture;
};

/// All that a maker needs to build a device.
struct BuildPlan {
    std::string device;
    std::string servo; ///< its kind, as in PartOptions
    std::vector<PrintPart> parts;
    std::vector<BoughtPart> bought;
    std::vector<WiringRow> wiring;
    std::vector<BuildStep> steps;
    std::vector<std::string> notes;  ///< what the maker should know before printing, a sentence each
    std::vector<PlanePolygon> sheet; ///< borders of the flexible sheet, for cutting it instead; even-odd
};

/// Most servos that the sketch for the board drives.
inline constexpr std::size_t kBoardServos = 12;

/// What is to be printed, bought, wired and done for this rig. A sheet on a housing gives housing, lid, sheet, seats
/// and levers; pins that slide give pins, guide, base and banks of seats; any other rig gives seats, and a note why it
/// has no housing. Every part is closed and manifold and lies within the bed, in pieces with dovetails where it must.
/// Throws InvalidInput naming the option, the part or the actuator that stands in the way; Cancelled.
[[nodiscard]] BuildPlan buildPlanOf(const Rig& rig, const PartOptions& options = {}, const Progress& progress = {});

/// The rig as the levers of its plan move it: a bend ends where its lever has lifted the flap, pulses are those of the
/// wiring with the lever's curve. No stroke is faster than before or than the servo can turn. Actuators without a lever
/// stay as they are.
[[nodiscard]] RigParts withLevers(const Rig& rig, const BuildPlan& plan);

} // namespace lumorph

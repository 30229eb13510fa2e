#pragma once

#include <vector>

#include "calibration/servos/servo_calibration.h"

/// Private to servo_calibration.
namespace lumorph::servos {

/// A servo's real strokes at one level.
struct LevelSeen {
    double commanded = 0.0;
    double real = 0.0, sigma = 0.0;
};
/// On the way up and on the way down, each by rising command.
struct BothWays {
    std::vector<LevelSeen> up, down;
};

/// Which actuator's part moved when this servo was told to go to half its range, by how much, in strokes with a sign.
struct Mover {
    std::size_t part = 0;
    double by = 0.0;
    bool isOwnSeen = true; ///< its own part was seen then: if nothing moved, it does not move
};

/// The curve through what was seen, with its play.
void drawCurve(const BothWays& seen, ServoFinding& servo);
/// The command from which on it moves no more though it should; empty where it gets to its end.
[[nodiscard]] std::optional<double> stopOf(const BothWays& seen);
/// Names who is dead, swapped, reversed, or hidden, so that nobody can tell; true where none is.
[[nodiscard]] bool judgeWiring(const Rig& rig, const std::vector<Mover>& movers, const StrokeEstimate& rest,
                               std::vector<Finding>& findings);
[[nodiscard]] Finding jammedFinding(const Rig& rig, std::size_t actuator, double commanded, double real,
                                    double degrees);

} // namespace lumorph::servos

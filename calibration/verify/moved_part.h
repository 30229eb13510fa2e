#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "calibration/verify/room_motion.h"
#include "core/base/progress.h"

namespace lumorph {

/// Light that was seen while the device stood still.
struct LitShot {
    std::vector<double> strokes; ///< where the actuators are believed to stand
    std::vector<LitPoint> points;
};

/// What stands elsewhere, and how far.
struct PartMotion {
    RoomPart part;
    /// Metres, root mean square over what was seen: how far a projector's light lies beside, what the camera is taken
    /// to see, how far the device or a servo's flap stands off.
    double beside = 0.0;
    double sigma = 0.0; ///< standard deviation of `beside`, metres
};

/// The motion that explains best what a camera saw.
struct MovedParts {
    std::vector<PartMotion> parts;     ///< the farthest first; empty where nothing moved
    std::vector<RoomPart> couldAlsoBe; ///< in place of the one in `parts`: what was seen does not tell them apart
    Eigen::VectorXd motion;            ///< of all parts, as RoomParts counts
    double noise = 0.0;                ///< of a coordinate of the light, projector pixels
    double unexplained = 0.0;          ///< median of what is left along the surface, metres
    std::size_t compared = 0;          ///< points with which causes were compared
    std::size_t points = 0;            ///< of them, that lie on what is believed to be there
};

struct MovedPartOptions {
    std::size_t camera = 0;
    double least = 0.8e-3;         ///< metres: parts that moved less count as where they were
    double leastNoise = 0.15;      ///< pixels of a projector
    std::size_t mostPoints = 1200; ///< with which causes are compared
    std::size_t mostParts = 6;
};

/// Finds what moved: parts are freed one after another as long as each explains much more than chance would, and those
/// that turn out to stand still are held again. Robust against a third of the light being strays. What the light does
/// not tell stays where it was believed. `shots` name projectors of the room; throws InvalidInput where they do not, or
/// the room has no such camera; Cancelled.
[[nodiscard]] MovedParts movedParts(const Rig& rig, const Installation& believed, std::span<const LitShot> shots,
                                    const MovedPartOptions& options = {}, const Progress& progress = {});

} // namespace lumorph

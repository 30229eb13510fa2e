#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "calibration/servos/surface_points.h"
#include "core/rig/rig.h"

namespace lumorph {

/// Where the device is known to lie: a small turn and shift of its frame (radians and metres, in that frame) away from
/// where it was believed to be, and how sure that is.
struct DeviceNudge {
    glm::dvec3 turn{0.0}, shift{0.0};
    double turnSigma = 0.02;   ///< radians, of each
    double shiftSigma = 0.005; ///< metres, of each
};

/// How the device stands in one pass of structured light.
struct StrokeEstimate {
    std::vector<double> strokes; ///< one an actuator, in [0, 1]
    std::vector<double> sigma;   ///< standard deviations; large where the points tell nothing
    DeviceNudge place;           ///< with the standard deviations that were given
    double rms = 0.0;            ///< of the points that count, metres off the surface
    double share = 0.0;          ///< of the device's points that lie on the surface
    int points = 0;              ///< on the device
};

/// Finds the strokes at which a rig's surface passes through measured points: non-linear least squares of their
/// distances along the surface's normal (Chen and Medioni 1992), Gauss-Newton on the deformed mesh, with the points
/// that lie far off left out. A point on a part that several actuators move counts less. Points on the table and beside
/// the device are left out by themselves. Keeps its buffers; one thread at a time.
class StrokeSolver {
public:
    /// `worldFromDevice` is a rotation and a translation. Throws InvalidInput for a rig without actuators.
    StrokeSolver(const Rig& rig, const glm::dmat4& worldFromDevice);
    ~StrokeSolver();
    StrokeSolver(StrokeSolver&&) noexcept;
    StrokeSolver& operator=(StrokeSolver&&) noexcept;

    /// Begins at the guess that fits best, and where none fits looks at all strokes of one actuator after the other.
    /// `thoroughly`: it does that in any case, which tells a servo that stands elsewhere than anybody thinks. Empty
    /// where fewer than `kFewest` points lie on the device. Throws InvalidInput where a guess has not one stroke an
    /// actuator; points that are no numbers are left out.
    [[nodiscard]] std::optional<StrokeEstimate> solve(std::span<const MeasuredPoint> points,
                                                      std::span<const std::vector<double>> guesses,
                                                      const DeviceNudge& place, bool thoroughly = false);

    static constexpr int kFewest = 50;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph

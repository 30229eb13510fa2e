#pragma once

#include <string>
#include <vector>

#include "calibration/decode/refusal.h"

namespace lumorph {

/// How far a point is from where a registration has it, metres.
struct PointError {
    std::string name;
    double metres = 0.0;
};
[[nodiscard]] double rmsOf(const std::vector<PointError>& errors);

/// Check points, which a fit never saw, against it. Residuals flatter: a fit bends towards its own points, wrong ones
/// too.
struct FreshCheck {
    std::vector<PointError> points;
    double rms = 0.0, worst = 0.0; ///< metres
    double allowed = 0.0;          ///< metres of RMS
    [[nodiscard]] bool good() const { return points.size() >= kFewest && rms <= allowed && worst <= 2.5 * allowed; }
    static constexpr std::size_t kFewest = 3;
};

/// Throws CaptureRefused: `too_few_points` for fewer than three, without which nothing is called good, and
/// `fresh_points_far` where they lie farther off than `allowed` metres (RMS; one alone 2.5 times that).
[[nodiscard]] FreshCheck checkFresh(std::vector<PointError> points, double allowed);

} // namespace lumorph

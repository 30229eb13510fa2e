#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration/decode/refusal.h"

namespace lumorph {

/// A delay as it was measured.
struct MeasuredDelay {
    double seconds = 0.0;
    double sigma = 0.0;    ///< standard deviation, seconds, by leaving parts of the recording out
    double residual = 0.0; ///< root mean square of what the delay leaves unexplained, in the unit of what was seen
    /// Seconds by which both halves of the recording disagree; empty where one of them alone tells nothing.
    std::optional<double> halvesDiffer;
    int events = 0; ///< flashes, steps or pictures that it was made of
    std::vector<Finding> warnings;
};

inline constexpr double kLongestDelay = 0.5;   ///< seconds that any of them is looked for
inline constexpr double kSlowestCamera = 0.07; ///< seconds between two pictures of a camera that times motion
/// Of one that times flashes, each of which it sees in a picture at least.
inline constexpr double kSlowestForFlashes = 0.11;

/// Private to calibration/delays.
namespace delays {

[[noreturn]] inline void refuse(Cause cause, const std::string& what, std::string why, std::string remedy) {
    throw CaptureRefused({cause, what, {}, std::move(why), std::move(remedy)});
}

/// Refuses `camera_slow`, `clock_jumps` and `not_a_number` for the times at which a camera's pictures were exposed.
void checkPictures(const std::vector<double>& seconds, const std::string& what, double slowest = kSlowestCamera);

/// The value at which a function is smallest between two others, to `exact`: golden section.
[[nodiscard]] double smallestBetween(double low, double high, double exact, const std::function<double(double)>& cost);

/// Standard deviation of a whole's value by those with one part left out (jackknife).
[[nodiscard]] double jackknife(const std::vector<double>& without);

} // namespace delays
} // namespace lumorph

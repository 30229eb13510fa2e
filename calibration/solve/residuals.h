#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/refusal.h"

namespace lumorph {

/// Standard deviation of one coordinate of errors, pixels: what they leave when `freedom` of the coordinates were used
/// up by what was solved for. Strays count as if they were twelve of it off.
[[nodiscard]] double sigmaOf(const std::vector<cv::Point2d>& errors, double freedom);

/// Root mean square length; 0 of none.
[[nodiscard]] double rmsOf(const std::vector<cv::Point2d>& errors);

/// Errors that have no place among the others. The robust losses bear what is nearer than 20 standard deviations.
struct Outliers {
    std::vector<bool> isOut; ///< one an error
    std::size_t count = 0;
    double worst = 0.0; ///< pixels

    /// Takes them out of a list with one entry an error.
    template <typename Value> void eraseFrom(std::vector<Value>& values) const {
        std::size_t at = 0;
        std::erase_if(values, [&](const Value&) { return isOut[at++]; });
    }
};

/// Of errors whose standard deviation is `sigma` pixels. None where more than a twentieth would be: so many have a
/// cause that is to be found.
[[nodiscard]] Outliers outliersOf(const std::vector<cv::Point2d>& errors, double sigma);

/// The warning about outliers of `what` ("decoded points") that were removed from a view.
[[nodiscard]] Finding findingOf(const Outliers& outliers, const std::string& what, const std::string& view);

} // namespace lumorph

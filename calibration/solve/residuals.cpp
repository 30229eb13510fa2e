#include "calibration/solve/residuals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace lumorph {

double sigmaOf(const std::vector<cv::Point2d>& errors, double freedom) {
    constexpr double kFarthest = 12.0; // standard deviations
    std::vector<double> squares;
    squares.reserve(errors.size());
    for (const cv::Point2d& error : errors) squares.push_back(error.dot(error));
    if (squares.empty()) return 0.0;
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::ranges::nth_element(squares, middle);
    const double most = kFarthest * kFarthest * *middle / (2.0 * std::numbers::ln2); // of normal noise, from the median
    double sum = 0.0;
    for (const double square : squares) sum += std::min(square, most);
    return std::sqrt(sum / std::max(1.0, 2.0 * static_cast<double>(squares.size()) - freedom));
}

double rmsOf(const std::vector<cv::Point2d>& errors) {
    double sum = 0.0;
    for (const cv::Point2d& error : errors) sum += error.dot(error);
    return errors.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(errors.size()));
}

Outliers outliersOf(const std::vector<cv::Point2d>& errors, double sigma) {
    constexpr double kOutlier = 20.0; // standard deviations
    constexpr double kFew = 0.05;     // of the errors
    Outliers outliers;
    for (const cv::Point2d& error : errors) {
        const double size = cv::norm(error);
        outliers.isOut.push_back(!(size <= kOutlier * sigma));
        if (!outliers.isOut.back()) continue;
        ++outliers.count;
        outliers.worst = std::max(outliers.worst, size);
    }
    if (static_cast<double>(outliers.count) <= kFew * static_cast<double>(errors.size())) return outliers;
    return {std::vector<bool>(errors.size(), false), 0, 0.0};
}

Finding findingOf(const Outliers& outliers, const std::string& what, const std::string& view) {
    std::ostringstream why;
    why.precision(2);
    why << std::fixed << outliers.count << " of " << outliers.isOut.size() << " " << what << " lie up to "
        << outliers.worst << " pixels from where the others have them";
    return {Cause::pointSuspicious, view, "", why.str(),
            "nothing: they were left out; a reflection or something before the board makes such points"};
}

} // namespace lumorph

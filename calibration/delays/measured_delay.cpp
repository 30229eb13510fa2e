#include "calibration/delays/measured_delay.h"

#include "core/base/statistics.h"

namespace lumorph::delays {

void checkPictures(const std::vector<double>& seconds, const std::string& what, double slowest) {
    std::vector<double> steps;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        if (!std::isfinite(seconds[i]))
            refuse(Cause::notANumber, what, "the time of a picture is no number", "record it again");
        if (i == 0) continue;
        if (seconds[i] <= seconds[i - 1])
            refuse(Cause::clockJumps, what, "a picture is as old as the one before, or older",
                   "record it again with times by one clock");
        steps.push_back(seconds[i] - seconds[i - 1]);
    }
    const double step = median(steps);
    if (steps.size() < 30 || step > slowest)
        refuse(Cause::cameraSlow, what,
               steps.size() < 30 ? "there are " + std::to_string(seconds.size()) + " pictures of the camera"
                                 : "the camera gives " + std::to_string(std::lround(1.0 / step)) + " pictures a second",
               "use one that gives " + std::to_string(std::lround(std::ceil(1.0 / slowest))) +
                   " or more for the whole time: more light or a smaller picture often helps");
}

double smallestBetween(double low, double high, double exact, const std::function<double(double)>& cost) {
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double atA = cost(a), atB = cost(b);
    while (high - low > exact) {
        if (atA < atB) {
            high = b;
            b = a;
            atB = atA;
            a = high - golden * (high - low);
            atA = cost(a);
        } else {
            low = a;
            a = b;
            atA = atB;
            b = low + golden * (high - low);
            atB = cost(b);
        }
    }
    return 0.5 * (low + high);
}

double jackknife(const std::vector<double>& without) {
    if (without.size() < 2) return 0.0;
    const auto n = static_cast<double>(without.size());
    double mean = 0.0, square = 0.0;
    for (const double value : without) mean += value / n;
    for (const double value : without) square += (value - mean) * (value - mean);
    return std::sqrt((n - 1.0) / n * square);
}

} // namespace lumorph::delays

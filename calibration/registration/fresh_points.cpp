#include "calibration/registration/fresh_points.h"

#include <algorithm>
#include <cmath>

#include "calibration/registration/refusing.h"

namespace lumorph {

double rmsOf(const std::vector<PointError>& errors) {
    double squares = 0.0;
    for (const PointError& at : errors) squares += at.metres * at.metres;
    return errors.empty() ? 0.0 : std::sqrt(squares / double(errors.size()));
}

FreshCheck checkFresh(std::vector<PointError> points, double allowed) {
    using registration::number;
    constexpr const char* kFresh = "check points";
    FreshCheck check{std::move(points), 0.0, 0.0, allowed};
    if (check.points.size() < FreshCheck::kFewest)
        registration::refuse(Cause::tooFewPoints, kFresh,
                             std::to_string(check.points.size()) +
                                 " check points that the fit never saw do not tell its worth",
                             "touch three more, at other places than before");
    const auto worst = std::ranges::max_element(check.points, {}, &PointError::metres);
    check.rms = rmsOf(check.points);
    check.worst = worst->metres;
    if (!check.good())
        registration::refuse(Cause::freshPointsFar, kFresh,
                             "check points that the fit never saw lie " + number(1000.0 * check.rms, 1) + " mm off, " +
                                 worst->name + " " + number(1000.0 * check.worst, 1) + " mm, where " +
                                 number(1000.0 * allowed, 1) + " mm are allowed",
                             "see that nothing was moved meanwhile, and measure again");
    return check;
}

} // namespace lumorph

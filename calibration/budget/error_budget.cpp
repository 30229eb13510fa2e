#include "calibration/budget/error_budget.h"

#include <algorithm>
#include <cmath>

#include "core/loop/pose_stream.h"

namespace lumorph {
namespace {

using Squares = std::array<double, kBudgetParts>; // metres^2, by parts

constexpr double kWorthIt = 0.05; // of the sum, by which advice must help

double square(double value) { return value * value; }

/// One error of the tip shifts the tracker one way, device and eye the other: its parts are added up as slips, with
/// their signs, before they are squared.
double ofTip(const SlipModel& model, const TipErrors& tip) {
    const double squares = model.trackerShift.trace() * square(tip.tracker) +
                           model.deviceShift.trace() * square(tip.device) + model.eye.trace() * square(tip.eye);
    const double products = model.deviceWithEye * tip.device * tip.eye -
                            model.trackerWithDevice * tip.tracker * tip.device -
                            model.trackerWithEye * tip.tracker * tip.eye;
    return std::max(0.0, squares + 2.0 * products); // rounding, where they cancel
}

/// How long a pose is known already when a frame asks for one, in the mean.
double ageOf(const CarryingHand& hand) { return 0.5 / hand.samplesASecond; }

/// All but the prediction, which does not depend on what is measured.
Squares squaresOf(const SlipModel& model, const RoomErrors& errors, double speed) {
    Squares squares{};
    const auto at = [&squares](BudgetPart part) -> double& { return squares[static_cast<std::size_t>(part)]; };
    const auto pose = [](const Eigen::Matrix3d& shift, const Eigen::Matrix3d& turn, const PoseError& error) {
        return shift.trace() * square(error.metres) + turn.trace() * square(error.radians);
    };
    for (std::size_t i = 0; i < std::min(model.lights.size(), errors.lights.size()); ++i)
        at(BudgetPart::projector) += model.lights[i] * square(errors.lights[i].metres);
    at(BudgetPart::tracker) = pose(model.trackerShift, model.trackerTurn, errors.tracker);
    at(BudgetPart::device) = pose(model.deviceShift, model.deviceTurn, errors.device);
    at(BudgetPart::eye) = model.eye.trace() * square(errors.eye);
    at(BudgetPart::pointer) = ofTip(model, errors.tip);
    for (std::size_t i = 0; i < std::min(model.strokes.size(), errors.strokes.size()); ++i)
        at(BudgetPart::servos) += model.strokes[i] * square(errors.strokes[i]);
    // A hand goes in all directions over the table.
    const double level = 0.5 * (model.deviceShift(0, 0) + model.deviceShift(2, 2));
    at(BudgetPart::delay) = level * square(speed * errors.delay);
    return squares;
}

double sumOf(const Squares& squares) {
    double sum = 0.0;
    for (const double one : squares) sum += one;
    return sum;
}

} // namespace

ErrorBudget budgetOf(const Rig& rig, const SlipModel& model, const RoomErrors& errors, const CarryingHand& hand) {
    const PoseMoments left = predictionLeaves(hand, errors.noise, errors.ahead);
    const double prediction =
        model.deviceShift.cwiseProduct(left.place).sum() + model.deviceTurn.cwiseProduct(left.turn).sum();
    const auto all = [&](const RoomErrors& with) {
        Squares squares = squaresOf(model, with, hand.speed);
        squares[static_cast<std::size_t>(BudgetPart::prediction)] = prediction;
        return squares;
    };
    const Squares squares = all(errors);
    const double sum = sumOf(squares);
    ErrorBudget budget;
    budget.total = std::sqrt(sum);
    budget.isTrackerPlaced = errors.isTrackerPlaced;
    budget.places = model.points.size();
    if (errors.ahead > 0.0) {
        budget.cutSeconds = std::max(0.0, errors.ahead + ageOf(hand) - PoseStream::kFarthestAhead);
        budget.cutMetres = hand.speed * budget.cutSeconds;
    }
    budget.isSimulated = std::ranges::find(errors.sources, ErrorSource::simulated) != errors.sources.end();
    for (const BudgetPart part : kAllBudgetParts) {
        const double own = squares[static_cast<std::size_t>(part)];
        budget.items[static_cast<std::size_t>(part)] = {part, errors.sourceOf(part), std::sqrt(own),
                                                        sum > 0.0 ? own / sum : 0.0};
        if (part == BudgetPart::prediction) continue;
        const double after = std::sqrt(sumOf(all(measuredAgain(errors, rig, part))));
        const ErrorSource source = errors.sourceOf(part);
        const bool isFirst = source == ErrorSource::assumed || source == ErrorSource::simulated;
        const bool isUrgent = part == BudgetPart::tracker && !errors.isTrackerPlaced;
        if (isUrgent || after < (1.0 - kWorthIt) * budget.total)
            budget.advice.push_back({part, isFirst, budget.total, after});
    }
    std::ranges::stable_sort(budget.advice, {}, [&](const BudgetAdvice& advice) {
        const bool isUrgent = advice.part == BudgetPart::tracker && !errors.isTrackerPlaced;
        return isUrgent ? 0.0 : advice.after;
    });
    return budget;
}

} // namespace lumorph

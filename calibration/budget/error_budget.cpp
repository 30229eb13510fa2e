#include "calibration/budget/error_budget.h"

#include <algorithm>
#include <cmath>

namespace lumorph {
namespace {

using Squares = std::array<double, kBudgetParts>; // metres^2, by parts

constexpr double kWorthIt = 0.05; // of the sum, by which advice must help

double square(double value) { return value * value; }

/// All but the prediction, which does not depend on what is measured.
Squares squaresOf(const SlipModel& model, const RoomErrors& errors, double speed) {
    Squares squares{};
    const auto at = [&squares](BudgetPart part) -> double& { return squares[static_cast<std::size_t>(part)]; };
    const auto pose = [](const Eigen::Matrix3d& shift, const Eigen::Matrix3d& turn, const PoseError& error) {
        return shift.trace() * square(error.metres) + turn.trace() * square(error.radians);
    };
    at(BudgetPart::projector) = model.light * square(errors.light);
    at(BudgetPart::tracker) = pose(model.trackerShift, model.trackerTurn, errors.tracker);
    at(BudgetPart::device) = pose(model.deviceShift, model.deviceTurn, errors.device);
    at(BudgetPart::eye) = model.eye.trace() * square(errors.eye);
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

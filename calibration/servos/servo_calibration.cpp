#include "calibration/servos/servo_calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "calibration/lab/true_room.h"
#include "calibration/registration/refusing.h"
#include "calibration/servos/servo_judge.h"
#include "core/base/error.h"
#include "core/scene/measured_servos.h"
#include "core/scene/measured_sigma.h"

namespace lumorph {

namespace {

using servos::BothWays;
using servos::LevelSeen;
using servos::Mover;
using Kind = ServoStep::Kind;
using Estimates = std::vector<std::optional<StrokeEstimate>>;

constexpr double kKnownTurn = 0.001;   // radians: how still the device lies between two passes
constexpr double kKnownShift = 0.0003; // metres
constexpr double kBumped = 0.003;      // metres, or as many radians a tenth of a metre: somebody pushed it
constexpr double kSureEnough = 0.05;   // strokes: of a part that has been seen
constexpr double kFreshMost = 2.0;     // degrees: of the median fresh error that curves are believed with

/// How many steps a plan has before its levels: after them it is known who moves what.
std::size_t wiringSteps(const ServoPlan& plan) {
    const auto later = std::ranges::find_if(
        plan.steps, [](const ServoStep& step) { return step.kind == Kind::level || step.kind == Kind::fresh; });
    return static_cast<std::size_t>(later - plan.steps.begin());
}

[[noreturn]] void refuseUnseen() {
    throw CaptureRefused({Cause::boardUnlit, "servos", "",
                          "camera and projector see too little of the device to tell how it stands",
                          "place the device where both see it, and check the calibration of projector and camera"});
}

void requireSeen(const Estimates& estimates) {
    const auto seen = std::ranges::count_if(estimates, [](const auto& one) { return one.has_value(); });
    if (!estimates.front() || 2 * static_cast<std::size_t>(seen) <= estimates.size()) refuseUnseen();
}

/// How many passes found the device elsewhere on the table than the first did.
std::size_t elsewhere(const Estimates& estimates) {
    const DeviceNudge& first = estimates.front()->place;
    const auto moved = std::ranges::count_if(estimates, [&](const auto& one) {
        if (!one) return false;
        const double shift = glm::length(one->place.shift - first.shift);
        return shift + 0.1 * glm::length(one->place.turn - first.turn) > kBumped;
    });
    return static_cast<std::size_t>(moved);
}

/// While each servo moves alone, before the long stepping. A flat device does not tell where along the table it lies:
/// one that is believed to lie elsewhere seems to slide away as its parts rise.
void requireBelievedPlace(const Estimates& estimates) {
    if (2 * elsewhere(estimates) < estimates.size()) return;
    throw CaptureRefused({Cause::modelDoesNotFit, "servos", "",
                          "the device is found where the room has it only while its servos are at rest",
                          "let the tracker see it, its corners touched before, or enter in Scene where it lies"});
}

void requireStill(const Estimates& estimates) {
    if (5 * elsewhere(estimates) < estimates.size()) return;
    throw CaptureRefused({Cause::rigMoved, "servos", "", "the device moved on the table while it was measured",
                          "fix it, keep your hands off, and measure again"});
}

/// Who moved in the pass in which this servo alone was told to; itself by nothing where nobody did.
Mover moverOf(const StrokeEstimate& rest, const StrokeEstimate& now, std::size_t servo) {
    Mover mover{servo, 0.0, now.sigma[servo] < kSureEnough};
    for (std::size_t i = 0; i < now.strokes.size(); ++i) {
        const double by = now.strokes[i] - rest.strokes[i];
        if (now.sigma[i] < kSureEnough && std::abs(by) > std::abs(mover.by)) {
            mover.part = i;
            mover.by = by;
        }
    }
    return mover;
}

std::vector<Mover> moversOf(const ServoPlan& plan, const Estimates& estimates, std::size_t count) {
    std::vector<Mover> movers(count);
    for (std::size_t i = 0; i < count; ++i) movers[i] = {i, 0.0, false};
    for (std::size_t k = 0; k < estimates.size(); ++k) {
        if (plan.steps[k].kind != Kind::find || !estimates[k]) continue;
        const std::size_t servo = plan.steps[k].servos.front();
        movers[servo] = moverOf(*estimates.front(), *estimates[k], servo);
    }
    return movers;
}

/// The levels of one servo: those of its group, up to the highest and down again.
BothWays levelsOf(const ServoPlan& plan, const Estimates& estimates, std::size_t servo, std::size_t part) {
    BothWays ways;
    double before = -1.0;
    for (std::size_t k = 0; k < plan.steps.size(); ++k) {
        const ServoStep& step = plan.steps[k];
        if (step.kind != Kind::level || std::ranges::find(step.servos, servo) == step.servos.end()) continue;
        const double commanded = step.commanded[servo];
        const bool rises = commanded > before;
        before = commanded;
        if (!estimates[k]) continue;
        const LevelSeen seen{commanded, estimates[k]->strokes[part], estimates[k]->sigma[part]};
        (rises ? ways.up : ways.down).push_back(seen);
        // Each end belongs to both ways.
        if (rises && commanded >= 1.0) ways.down.push_back(seen);
    }
    std::ranges::sort(ways.down, {}, &LevelSeen::commanded);
    return ways;
}

/// What curves say of fresh states, against what was seen of them. Unseen states confirm no curve.
void judgeFresh(const Rig& rig, const ServoPlan& plan, ServoCalibration& result) {
    std::vector<double> errors;
    const std::size_t count = rig.actuatorCount();
    std::vector<double> real(count, 0.0);
    for (std::size_t k = 0; k < plan.steps.size(); ++k)
        for (std::size_t i = 0; i < count; ++i) {
            const ServoFinding& servo = result.servos[i];
            real[i] = realStroke(servo.curve, plan.steps[k].commanded[i], real[i]);
            const auto& seen = result.estimates[k];
            if (plan.steps[k].kind != Kind::fresh || !seen || seen->sigma[i] > kSureEnough) continue;
            errors.push_back(servo.degrees * std::abs(seen->strokes[i] - real[i]));
        }
    if (errors.empty()) {
        if (std::ranges::find(plan.steps, Kind::fresh, &ServoStep::kind) == plan.steps.end())
            return; // none were wanted
        result.usable = false;
        result.findings.push_back({Cause::tooFewPoints, "servos", "", "none of the fresh states was seen",
                                   "keep hands and things out of the light, then measure again"});
        return;
    }
    std::ranges::sort(errors);
    result.freshDegrees = errors[errors.size() / 2];
    result.freshWorst = errors.back();
    if (result.freshDegrees <= kFreshMost) return;
    result.usable = false;
    result.findings.push_back(
        {Cause::modelDoesNotFit, "servos", "",
         "fresh states are " + registration::number(result.freshDegrees, 1) + " degrees from where the curves put them",
         "look for loose parts, then measure again"});
}

double medianRms(const Estimates& estimates) {
    std::vector<double> all;
    for (const auto& one : estimates)
        if (one) all.push_back(one->rms);
    std::ranges::nth_element(all, all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2));
    return all[all.size() / 2];
}

/// Curves of all servos, and who stops too early.
void drawCurves(const Rig& rig, const ServoPlan& plan, ServoCalibration& result) {
    for (std::size_t i = 0; i < result.servos.size(); ++i) {
        ServoFinding& servo = result.servos[i];
        const BothWays ways = levelsOf(plan, result.estimates, i, i);
        servo.stopsAt = servos::stopOf(ways);
        drawCurve(ways, servo);
        if (servo.curve.points.empty()) {
            result.findings.push_back({Cause::tooFewPoints, servo.curve.actuator, "",
                                       "too little of the part of servo \"" + servo.curve.actuator + "\" was seen",
                                       "move camera or projector so that both see it while it moves"});
            result.usable = false;
        } else if (servo.stopsAt) {
            result.findings.push_back(
                servos::jammedFinding(rig, i, *servo.stopsAt, servo.curve.points.back().rising, servo.degrees));
        }
    }
}

} // namespace

struct ServoSolver::Data {
    Rig rig;
    ServoPlan plan;
    StrokeSolver solver;
    Estimates estimates;
    DeviceNudge place;
    std::vector<Mover> movers;
    std::vector<Finding> wiring;
    bool isWiringClear = true; ///< as far as it was looked at

    Data(const Rig& r, const glm::dmat4& worldFromDevice, const ServoPlan& p)
        : rig(r), plan(p), solver(r, worldFromDevice) {}

    [[nodiscard]] ServoCalibration begun() const;
};

ServoSolver::ServoSolver(const Rig& rig, const glm::dmat4& worldFromDevice, const ServoPlan& plan) {
    const auto fits = [&](const ServoStep& step) { return step.commanded.size() == rig.actuatorCount(); };
    if (plan.steps.empty() || !std::ranges::all_of(plan.steps, fits))
        throw InvalidInput("plan of servos", "it has no steps, or is another rig's", "plan anew for this rig");
    data_ = std::make_unique<Data>(rig, worldFromDevice, plan);
}

ServoSolver::~ServoSolver() = default;
ServoSolver::ServoSolver(ServoSolver&&) noexcept = default;
ServoSolver& ServoSolver::operator=(ServoSolver&&) noexcept = default;

/// Each pass begins where the one before was, or where it was told to go.
void ServoSolver::take(const ServoPass& pass) {
    Data& d = *data_;
    if (ended()) throw InvalidInput("measurement of servos", "it has ended", "begin anew with another plan");
    const ServoStep& step = d.plan.steps[d.estimates.size()];
    std::vector<std::vector<double>> guesses{step.commanded};
    if (!d.estimates.empty() && d.estimates.back()) guesses.push_back(d.estimates.back()->strokes);
    const bool thoroughly = step.kind == Kind::rest || step.kind == Kind::find;
    d.estimates.push_back(d.solver.solve(pass, guesses, d.place, thoroughly));
    if (!d.estimates.front()) refuseUnseen();
    if (d.estimates.size() == 1) {
        d.place = d.estimates.front()->place;
        d.place.turnSigma = kKnownTurn;
        d.place.shiftSigma = kKnownShift;
    }
    if (d.estimates.size() != wiringSteps(d.plan)) return;
    requireBelievedPlace(d.estimates);
    d.movers = moversOf(d.plan, d.estimates, d.rig.actuatorCount());
    d.isWiringClear = servos::judgeWiring(d.rig, d.movers, *d.estimates.front(), d.wiring);
}

bool ServoSolver::ended() const noexcept {
    return !data_->isWiringClear || data_->estimates.size() == data_->plan.steps.size();
}

ServoCalibration ServoSolver::Data::begun() const {
    ServoCalibration result;
    result.estimates = estimates;
    result.findings = wiring;
    result.rms = medianRms(estimates);
    for (std::size_t i = 0; i < rig.actuatorCount(); ++i) {
        const Actuator& actuator = rig.actuators()[i];
        ServoFinding& servo = result.servos.emplace_back();
        servo.curve.actuator = actuator.name;
        servo.degrees = degreesOf(actuator).value_or(kDegreesOfUnturned);
        servo.moves = i < movers.size() ? movers[i].part : i;
    }
    return result;
}

ServoCalibration ServoSolver::result() const {
    const Data& d = *data_;
    if (!ended())
        throw InvalidInput("measurement of servos",
                           std::to_string(d.estimates.size()) + " passes for " + std::to_string(d.plan.steps.size()) +
                               " steps of the plan",
                           "take one pass for each step");
    requireSeen(d.estimates);
    requireStill(d.estimates);
    ServoCalibration result = d.begun();
    if (!d.isWiringClear) return result;
    result.usable = true;
    drawCurves(d.rig, d.plan, result);
    judgeFresh(d.rig, d.plan, result);
    return result;
}

ServoCalibration solveServos(const Rig& rig, const glm::dmat4& worldFromDevice, const ServoPlan& plan,
                             const std::vector<ServoPass>& passes, const Progress& progress) {
    ServoSolver solver(rig, worldFromDevice, plan);
    for (std::size_t k = 0; k < passes.size() && !solver.ended(); ++k) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(k) / static_cast<double>(passes.size()), "working out the servos");
        solver.take(passes[k]);
    }
    return solver.result();
}

Installation withServos(const Installation& room, const ServoCalibration& measured, const std::string& method) {
    if (!measured.usable) return room;
    Installation edited = room;
    edited.servos.clear();
    for (const ServoFinding& servo : measured.servos) {
        MeasuredServo curve = servo.curve;
        const auto before = std::ranges::find(room.servos, curve.actuator, &MeasuredServo::actuator);
        if (before != room.servos.end()) curve.lagSeconds = before->lagSeconds; // another measurement's figure
        edited.servos.push_back(std::move(curve));
    }
    // The median of what the curves say of states that they were not made of, as a standard deviation.
    constexpr double kSigmaOfMedian = 1.4826, kDegree = std::numbers::pi / 180.0;
    const MeasuredSigma sigma{0.0, kSigmaOfMedian * kDegree * measured.freshDegrees, 0.0};
    markOrigins(room, edited, {Origin::Way::measured, withSigma(method, sigma), utcDate()});
    return edited;
}

} // namespace lumorph

#include "calibration/budget/room_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/loop/viewer_stage.h"
#include "core/scene/measured_sigma.h"

namespace lumorph {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kUsualDegrees = 60.0; // a whole stroke of something that does not turn, as the lab has it

/// How well measurements come out in the lab, for those that did not say it. Along each axis.
namespace usually {
constexpr double kLight = 0.0005; // metres
constexpr PoseError kTracker{0.0005, 0.1 * kDegree}, kDevice{0.0005, 0.15 * kDegree};
constexpr double kEye = 0.002;           // metres
constexpr double kServo = 0.3 * kDegree; // of its horn
constexpr double kDelay = 0.002;         // seconds
} // namespace usually

/// A projector that was aimed by eye.
constexpr double kAimedLight = 0.005; // metres
/// A tracker's world that was typed in, as one measures with a ruler.
constexpr PoseError kEnteredTracker{0.01, 2.0 * kDegree};

double degreesOfStroke(const Actuator& actuator) { return degreesOf(actuator).value_or(kUsualDegrees); }

PoseError alongAxes(const MeasuredSigma& sigma) {
    return {sigma.metres / std::numbers::sqrt3, sigma.radians / std::numbers::sqrt3};
}

ErrorSource sourceOf(const Origin& origin, bool isTold) {
    return !origin.isCalibrated()                 ? ErrorSource::assumed
           : origin.way == Origin::Way::simulated ? ErrorSource::simulated
           : isTold                               ? ErrorSource::told
                                                  : ErrorSource::measured;
}

/// Writes what is known of one part, and how.
class Writer {
public:
    explicit Writer(RoomErrors& errors) : errors_(errors) {}

    void pose(BudgetPart part, const Origin& origin, PoseError& error, const PoseError& assumed,
              const PoseError& measured) {
        const PoseError said = alongAxes(sigmaOf(origin));
        error = choose(part, origin, said.metres > 0.0 && said.radians > 0.0, said, measured, assumed);
    }
    /// What the tip puts into a part leaves the part's own error.
    void share(BudgetPart part, const Origin& origin, const Origin& pointer, double& error, double& tip) {
        // One that was measured before the tip was measured again has an error of the tip of its own.
        if (!origin.isCalibrated() || origin.date < pointer.date) return;
        tip = std::min(sigmaOf(origin).tipMetres / std::numbers::sqrt3, error);
        error = std::sqrt(error * error - tip * tip);
        if (!(tip > 0.0)) return;
        ErrorSource& all = errors_.sources[static_cast<std::size_t>(BudgetPart::pointer)];
        const ErrorSource source = errors_.sourceOf(part);
        all = all == ErrorSource::worked ? source : std::max(all, source);
    }
    void number(BudgetPart part, const Origin& origin, double& error, double said, double measured, double assumed) {
        error = choose(part, origin, said > 0.0, said, measured, assumed);
    }

private:
    template <typename Value>
    Value choose(BudgetPart part, const Origin& origin, bool isTold, const Value& said, const Value& measured,
                 const Value& assumed) {
        const ErrorSource source = sourceOf(origin, isTold);
        // The sources are in the order of how much they are worth: what is worst of a part is said of it.
        ErrorSource& all = errors_.sources[static_cast<std::size_t>(part)];
        all = std::max(all, source);
        return source == ErrorSource::assumed ? assumed : isTold ? said : measured;
    }

    RoomErrors& errors_;
};

/// Of where its light falls: a place that the lab made is not measured, whatever its lens is.
Origin lightOrigin(const InstalledProjector& projector) {
    Origin origin = projector.lens;
    if (origin.way == Origin::Way::measured && projector.pose.way == Origin::Way::simulated)
        origin.way = Origin::Way::simulated;
    return origin;
}

/// Root mean square of a servo's curve and half its play beside the straight line, strokes. As `trueRoom` draws them.
double usualStroke(const Actuator& actuator, double at, const LabErrors& usual) {
    const double bow = usual.servoBend * std::sin(std::numbers::pi * at);
    const double wave = 0.5 * usual.servoBend * std::sin(2.0 * std::numbers::pi * at);
    const double play = 0.5 * usual.backlashDegrees / degreesOfStroke(actuator);
    return std::sqrt(bow * bow + wave * wave + play * play);
}

/// Second moment of a delay around what is compensated: uniform within a share of its mean. Without prediction nothing
/// is, not even the age of poses.
double usualDelay(const Installation& room, const LabErrors& usual) {
    const auto variance = [](double mean, double share) { return std::pow(mean * share, 2) / 3.0; };
    // Of an age that was measured no more than the measurement's error is open.
    const bool isAgeKnown = room.origins.delays.isCalibrated() && room.trackerSeconds > 0.0;
    const double age = isAgeKnown ? room.trackerSeconds : usual.trackerSeconds;
    const double off = usual.lightSeconds + age - lookAhead(room, 0.0);
    return std::sqrt(off * off + variance(usual.lightSeconds, 0.3) +
                     (isAgeKnown ? std::pow(sigmaOf(room.origins.delays).seconds, 2) : variance(age, 0.4)));
}

} // namespace

const char* keyOf(BudgetPart part) noexcept {
    static constexpr std::array<const char*, kBudgetParts> kKeys{"projector", "tracker", "device",     "eye",
                                                                 "servos",    "delay",   "prediction", "pointer"};
    return kKeys[static_cast<std::size_t>(part)];
}

RoomErrors errorsOf(const Installation& room, const Rig& rig, const std::vector<double>& commanded,
                    const LabErrors& usual) {
    RoomErrors errors;
    Writer write(errors);
    const Installation::Origins& origins = room.origins;
    errors.sources[static_cast<std::size_t>(BudgetPart::pointer)] = ErrorSource::worked; // until it is in anything
    for (const InstalledProjector& projector : room.projectors) {
        BeamError& light = errors.lights.emplace_back();
        if (!projector.enabled) continue;
        const Origin origin = lightOrigin(projector);
        const double said = sigmaOf(origin).metres;
        light.source = sourceOf(origin, said > 0.0);
        write.number(BudgetPart::projector, origin, light.metres, said, usually::kLight, kAimedLight);
    }
    if (std::ranges::none_of(room.projectors, &InstalledProjector::enabled))
        errors.sources[static_cast<std::size_t>(BudgetPart::projector)] = ErrorSource::assumed;
    write.pose(BudgetPart::tracker, origins.tracker, errors.tracker, kEnteredTracker, usually::kTracker);
    errors.isTrackerPlaced = origins.tracker.way != Origin::Way::assumed;
    write.pose(BudgetPart::device, origins.deviceBody, errors.device,
               {1e-3 * usual.deviceMillimetres, usual.deviceDegrees * kDegree}, usually::kDevice);
    write.number(BudgetPart::eye, origins.eyeOffset, errors.eye,
                 sigmaOf(origins.eyeOffset).metres / std::numbers::sqrt3, usually::kEye, 1e-3 * usual.eyeMillimetres);
    write.share(BudgetPart::tracker, origins.tracker, origins.pointer, errors.tracker.metres, errors.tip.tracker);
    write.share(BudgetPart::device, origins.deviceBody, origins.pointer, errors.device.metres, errors.tip.device);
    write.share(BudgetPart::eye, origins.eyeOffset, origins.pointer, errors.eye, errors.tip.eye);
    for (std::size_t i = 0; i < rig.actuatorCount(); ++i) {
        const Actuator& actuator = rig.actuators()[i];
        const auto servo = std::ranges::find(room.servos, actuator.name, &MeasuredServo::actuator);
        const bool isMeasured = servo != room.servos.end() && !servo->points.empty(); // else only its lag was
        const double whole = degreesOfStroke(actuator) * kDegree;
        const double at = i < commanded.size() ? commanded[i] : 0.5;
        // A servo that a measurement left out is as it was before.
        const Origin origin = isMeasured ? origins.servos : Origin{};
        write.number(BudgetPart::servos, origin, errors.strokes.emplace_back(), sigmaOf(origin).radians / whole,
                     usually::kServo / whole, usualStroke(actuator, at, usual));
    }
    // Without prediction the whole delay is an error.
    const Origin delays = room.predictionSeconds > 0.0 ? origins.delays : Origin{};
    write.number(BudgetPart::delay, delays, errors.delay, sigmaOf(delays).seconds, usually::kDelay,
                 usualDelay(room, usual));
    errors.noise = {1e-3 * usual.trackerNoiseMillimetres, usual.trackerNoiseDegrees * kDegree};
    errors.ahead = lookAhead(room, 0.0);
    errors.sources[static_cast<std::size_t>(BudgetPart::prediction)] = ErrorSource::worked;
    return errors;
}

RoomErrors measuredAgain(RoomErrors errors, const Rig& rig, BudgetPart part) {
    const bool isNew = errors.sourceOf(part) == ErrorSource::assumed;
    const auto number = [isNew](double& error, double measured) { error = isNew ? measured : 0.5 * error; };
    const auto pose = [&number](PoseError& error, const PoseError& measured) {
        number(error.metres, measured.metres);
        number(error.radians, measured.radians);
    };
    switch (part) {
    case BudgetPart::projector:
        for (BeamError& light : errors.lights) {
            // Where some were not measured, it is they that are measured.
            if (!(light.metres > 0.0) || (isNew && light.source != ErrorSource::assumed)) continue;
            number(light.metres, usually::kLight);
            if (isNew || light.source == ErrorSource::simulated) light.source = ErrorSource::measured;
        }
        break;
    case BudgetPart::tracker:
        pose(errors.tracker, usually::kTracker);
        errors.isTrackerPlaced = true;
        break;
    case BudgetPart::device:
        pose(errors.device, usually::kDevice);
        break;
    case BudgetPart::eye:
        number(errors.eye, usually::kEye);
        break;
    case BudgetPart::servos:
        for (std::size_t i = 0; i < errors.strokes.size(); ++i) {
            const double usual = usually::kServo / (degreesOfStroke(rig.actuators()[i]) * kDegree);
            number(errors.strokes[i], std::min(errors.strokes[i], usual));
        }
        break;
    case BudgetPart::delay:
        number(errors.delay, usually::kDelay);
        break;
    case BudgetPart::pointer:
        for (double* tip : {&errors.tip.tracker, &errors.tip.device, &errors.tip.eye}) *tip *= 0.5;
        break;
    case BudgetPart::prediction:
        return errors;
    }
    if (isNew || errors.sourceOf(part) == ErrorSource::simulated)
        errors.sources[static_cast<std::size_t>(part)] = ErrorSource::measured;
    return errors;
}

} // namespace lumorph

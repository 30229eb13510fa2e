#include "calibration/delays/delays_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/scene/measured_sigma.h"

namespace lumorph {

namespace {

constexpr double kContradicts = 0.004; ///< seconds by which the moved mark may differ, if it is no noise
constexpr double kMaxDelay = 0.3;      ///< seconds: no show can be had with a longer one

std::string milliseconds(double seconds, int digits = 1) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f ms", digits, 1e3 * seconds);
    return text;
}

/// The mark that followed a hand was measured by itself: what light and tracker come to has to be what it says.
void checkAgainstMark(MeasuredDelays& delays) {
    const double together = delays.light.seconds + delays.tracker.seconds;
    const double differs = delays.mark.seconds - together;
    const double sigma = std::hypot(delays.mark.sigma, std::hypot(delays.light.sigma, delays.tracker.sigma));
    if (std::abs(differs) <= std::max(kContradicts, 3.0 * sigma)) return;
    delays::refuse(Cause::freshPointsFar, "delays",
                   "a mark that follows a hand is " + milliseconds(delays.mark.seconds) +
                       " late, but flashes and tracker say " + milliseconds(together),
                   "close other programs that make the show uneven, then measure again");
}

std::string summaryOf(const MeasuredDelays& delays) {
    if (delays.isOfLightAlone()) return "Light comes " + milliseconds(delays.light.seconds) + " after its frame.";
    std::string text = "Light comes " + milliseconds(delays.light.seconds) + " after its frame, poses are " +
                       milliseconds(delays.tracker.seconds) + " old when they arrive";
    if (delays.servos.empty()) return text + ".";
    double low = HUGE_VAL, high = 0.0;
    for (const MeasuredDelays::Servo& servo : delays.servos) {
        low = std::min(low, servo.step.lag.seconds);
        high = std::max(high, servo.step.lag.seconds);
    }
    return text + ", servos move " + milliseconds(low, 0) + " to " + milliseconds(high, 0) + " after their commands.";
}

Installation withDelays(const Installation& believed, const MeasuredDelays& delays) {
    Installation room = believed;
    room.predictionSeconds = std::max(0.001, delays.light.seconds); // 0 would switch prediction off
    if (!delays.isOfLightAlone()) room.trackerSeconds = std::max(0.0, delays.tracker.seconds);
    for (const MeasuredDelays::Servo& measured : delays.servos) {
        const auto known = std::ranges::find(room.servos, measured.name, &MeasuredServo::actuator);
        if (known != room.servos.end())
            known->lagSeconds = measured.step.lag.seconds;
        else
            room.servos.push_back({measured.name, {}, measured.step.lag.seconds});
    }
    const MeasuredSigma sigma{0.0, 0.0, std::hypot(delays.light.sigma, delays.tracker.sigma)};
    room.origins.delays = {
        Origin::Way::measured,
        withSigma(std::to_string(delays.light.events) + " flashes, " +
                      (delays.isOfLightAlone() ? "of light alone"
                                               : std::to_string(delays.tracker.events) + " poses of a board"),
                  sigma),
        utcDate()};
    return room;
}

void solveAll(const Rig& rig, const DelaysCapture& capture, const Progress& progress, MeasuredDelays& delays) {
    const auto begin = [&](double share, const char* stage) {
        progress.throwIfCancelled();
        progress.report(share, stage);
    };
    begin(0.0, "working out when light came");
    delays.light = solveFlashDelay(capture.flashes, progress.part(0.0, 0.2));
    if (delays.light.seconds > kMaxDelay || delays.light.seconds < 0.0)
        delays::refuse(Cause::flashNotSeen, "flashes",
                       "light seems to come " + milliseconds(delays.light.seconds) + " after its frame",
                       "look whether the camera's times are those of this machine");
    if (capture.flashes.arrivalSigma > 0.0)
        delays.warnings.push_back({Cause::undetermined, "camera", "",
                                   "it does not say when it takes a picture, so what a picture needs to come counts as "
                                   "delay of the light",
                                   "time light with a camera that has a clock, such as a GenICam one, or take off in "
                                   "Scene what is known of it"});
    if (capture.mark.pictures.empty() && capture.tracked.poses.empty() && capture.steps.empty()) {
        delays.warnings.push_back({Cause::undetermined, "tracker and servos", "",
                                   "flashes alone were recorded, which tell of the projector's light",
                                   "how late poses and servos are stays as it was; enter it in Scene where it is "
                                   "known"});
        return;
    }
    begin(0.2, "working out how late a mark follows");
    delays.mark = solveMarkDelay(capture.mark, progress.part(0.2, 0.4));
    begin(0.4, "working out how old poses are");
    delays.tracker = solveTrackerDelay(capture.tracked, capture.seen, progress.part(0.4, 0.7));
    checkAgainstMark(delays);
    if (rig.actuatorCount() > kMostSteppedServos) {
        delays.warnings.push_back(
            {Cause::undetermined, "servos", "", "the device has more than 64 of them", "their lag stays as it was"});
        return;
    }
    for (std::size_t k = 0; k < capture.steps.size(); ++k) {
        begin(0.7 + 0.3 * double(k) / double(capture.steps.size()), "working out the servos' lag");
        delays.servos.push_back({capture.steps[k].servo, solveStepLag(capture.steps[k], progress.part(1.0, 1.0))});
    }
    for (const Actuator& actuator : rig.actuators())
        if (std::ranges::find(delays.servos, actuator.name, &MeasuredDelays::Servo::name) == delays.servos.end())
            delays.warnings.push_back({Cause::undetermined, actuator.name, "",
                                       "the camera does not see its part in all its range",
                                       "its lag stays as it was; another place of the camera may show it"});
}

} // namespace

MeasuredDelays solveDelays(const Rig& rig, const Installation& believed, const DelaysCapture& capture,
                           const Progress& progress) {
    MeasuredDelays delays;
    delays.installation = believed;
    delays.seconds = capture.seconds;
    try {
        solveAll(rig, capture, progress, delays);
    } catch (const CaptureRefused& refused) {
        delays.refusal = refused.finding();
        delays.summary = sentenceOf(refused.finding());
        return delays;
    }
    delays.installation = withDelays(believed, delays);
    delays.summary = summaryOf(delays);
    return delays;
}

void takeDelays(const Installation& measured, Installation& room) {
    room.predictionSeconds = measured.predictionSeconds;
    room.trackerSeconds = measured.trackerSeconds;
    for (const MeasuredServo& servo : measured.servos) {
        const auto known = std::ranges::find(room.servos, servo.actuator, &MeasuredServo::actuator);
        if (known != room.servos.end())
            known->lagSeconds = servo.lagSeconds;
        else
            room.servos.push_back({servo.actuator, {}, servo.lagSeconds});
    }
    room.origins.delays = measured.origins.delays;
}

} // namespace lumorph

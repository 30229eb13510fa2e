#include "devices/firmware/board_sequence.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "devices/firmware/pin_header.h"

namespace lumorph {
namespace {

constexpr double kFrameSeconds = 0.02;
constexpr int kLampPin = 13; // its lamp would pull it low
constexpr std::size_t kStepBytes = 10;

long framesOf(double seconds) { return std::lround(seconds / kFrameSeconds); }
/// So that what was slow enough stays so.
double wholeFrames(double seconds) { return kFrameSeconds * std::ceil(seconds / kFrameSeconds - 1e-9); }

std::string stepsText(const std::vector<std::size_t>& steps) {
    std::string text = steps.size() == 1 ? "step " : "steps ";
    for (std::size_t k = 0; k < steps.size(); ++k)
        text += (k == 0 ? "" : k + 1 == steps.size() ? " and " : ", ") + std::to_string(steps[k] + 1);
    return text;
}

void checkButton(const DeviceProfile& profile, int pin) {
    const std::vector<int> possible = buttonPins(profile);
    if (std::ranges::find(possible, pin) != possible.end()) return;
    std::string free;
    for (const int one : possible) free += (free.empty() ? "" : ", ") + std::to_string(one);
    throw InvalidInput("pin " + std::to_string(pin), "no button can be there", "take one of " + free);
}

std::vector<PoseLimits> limitsOf(const DeviceProfile& profile) {
    std::vector<PoseLimits> limits;
    for (const ServoSetup& servo : profile.servos) limits.push_back({servo.maxVelocity, servo.maxAcceleration});
    return limits;
}

/// Steps whose easing has no acceleration that a servo can have.
std::vector<std::size_t> soften(PoseSequence& sequence) {
    std::vector<std::size_t> softened;
    for (std::size_t k = 0; k < sequence.steps.size(); ++k)
        if (sequence.steps[k].easing == Easing::linear) {
            sequence.steps[k].easing = Easing::smooth;
            softened.push_back(k);
        }
    return softened;
}

/// A button may have stopped it anywhere between its poses.
PoseSequence withinLimitsFromAnywhere(const PoseSequence& sequence, const std::vector<double>& from,
                                      const std::vector<PoseLimits>& limits) {
    PoseSequence slow = withinLimits(sequence, from, limits);
    for (const NamedPose& pose : sequence.poses)
        slow.steps.front().travelSeconds = std::max(
            slow.steps.front().travelSeconds, withinLimits(sequence, pose.strokes, limits).steps[0].travelSeconds);
    return slow;
}

/// Poses that no step leads to need no room.
void dropUnused(PoseSequence& sequence) {
    std::erase_if(sequence.poses, [&](const NamedPose& pose) {
        return std::ranges::find(sequence.steps, pose.name, &PoseStep::pose) == sequence.steps.end();
    });
}

std::string pulsesRow(const DeviceProfile& profile, const std::vector<double>& strokes) {
    std::string row = "    {";
    for (std::size_t k = 0; k < strokes.size(); ++k)
        row += (k == 0 ? "" : ", ") + std::to_string(std::lround(pulseOf(profile.servos[k], strokes[k])));
    return row + "},";
}

std::string fastestRow(const DeviceProfile& profile) {
    std::string row;
    for (const ServoSetup& servo : profile.servos) {
        const double step = fastestPulse(servo) * kFrameSeconds;
        row += (row.empty() ? "" : ", ") + std::to_string(std::clamp(std::lround(std::ceil(step)), 1L, 2000L));
    }
    return row;
}

std::string stepRow(const PoseSequence& sequence, const PoseStep& step) {
    const auto pose = std::ranges::find(sequence.poses, step.pose, &NamedPose::name) - sequence.poses.begin();
    return "    {" + std::to_string(pose + 1) + ", " +
           (step.easing == Easing::minimumJerk ? "kNaturally" : "kSmoothly") + ", " +
           std::to_string(framesOf(step.travelSeconds)) + ", " + std::to_string(framesOf(step.holdSeconds)) + "},";
}

constexpr std::string_view kDeclarations = R"(#pragma once

#include <avr/pgmspace.h>
#include <stdint.h>

#include "channels.h"

enum PoseEasing : uint8_t { kSmoothly, kNaturally };
struct PoseStep {
    uint8_t pose; // row of kPosePulses
    PoseEasing easing;
    uint32_t travel, hold; // frames of 20 ms
};
)";

} // namespace

std::vector<int> buttonPins(const DeviceProfile& profile) {
    std::set<int> pins = {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 15, 16, 17, 18, 19};
    for (const ServoSetup& servo : profile.servos) pins.erase(servo.channel);
    return {pins.begin(), pins.end()};
}

BoardPlan planForBoard(const DeviceProfile& profile, const BoardSequence& asked) {
    (void)channelsHeader(profile); // what the board cannot be
    requirePlayable(asked.sequence, profile.servos.size());
    if (asked.button) checkButton(profile, *asked.button);
    BoardPlan plan;
    plan.sequence = asked.sequence;
    dropUnused(plan.sequence);
    if (!asked.button && !plan.sequence.loop) {
        plan.sequence.loop = true;
        plan.notes.emplace_back("Without a button it begins anew after its last pose.");
    }
    for (const ServoSetup& servo : profile.servos) plan.from.push_back(servo.exitStroke);
    if (const auto softened = soften(plan.sequence); !softened.empty())
        plan.notes.push_back("Even speed begins and ends with a jerk, so the board moves smoothly in " +
                             stepsText(softened) + ".");
    const PoseSequence before = plan.sequence;
    plan.sequence = withinLimitsFromAnywhere(plan.sequence, plan.from, limitsOf(profile));
    std::vector<std::size_t> slowed;
    for (std::size_t k = 0; k < plan.sequence.steps.size(); ++k) {
        PoseStep& step = plan.sequence.steps[k];
        if (step.travelSeconds > before.steps[k].travelSeconds) slowed.push_back(k);
        step.travelSeconds = wholeFrames(step.travelSeconds);
        step.holdSeconds = kFrameSeconds * static_cast<double>(framesOf(step.holdSeconds));
    }
    if (!slowed.empty())
        plan.notes.push_back("The servos may go no faster, so the way takes longer than it is set to in " +
                             stepsText(slowed) + ".");
    plan.bytes = 2 * profile.servos.size() * (plan.sequence.poses.size() + 2) + kStepBytes * plan.sequence.steps.size();
    return plan;
}

std::string posesHeader(const DeviceProfile& profile, const BoardSequence& asked) {
    const BoardPlan plan = planForBoard(profile, asked);
    const auto comment = [](const std::string& name) {
        std::string text;
        for (const char c : name) text += c >= ' ' && c <= '~' && c != '\\' && c != '"' && c != '?' ? c : '_';
        return "// " + text;
    };
    std::string text = "// Poses that the board shows without a computer. Lumorph makes this file; upload the sketch "
                       "again after a change.\n";
    text += kDeclarations;
    text += "\nconstexpr uint16_t kPoseSteps = " + std::to_string(plan.sequence.steps.size()) +
            "; // 0: none, the board waits for a computer\n";
    text += std::string("constexpr bool kPoseLoop = ") + (plan.sequence.loop ? "true" : "false") + ";\n";
    text += "constexpr uint8_t kPoseButton = " + std::to_string(asked.button.value_or(0)) +
            "; // pin of a button to ground; 0: it begins by itself at power on\n";
    const long stagger = std::clamp(framesOf(profile.staggerSeconds), 1L, 250L);
    text += "constexpr uint8_t kPoseStagger = " + std::to_string(stagger) +
            "; // frames between one servo's start and the next\n\n";
    text += "// Microseconds of each channel; first where it begins that the board does not know.\n";
    text += "const uint16_t kPosePulses[][kChannelCount] PROGMEM = {\n" + pulsesRow(profile, plan.from) + "\n";
    for (const NamedPose& pose : plan.sequence.poses)
        text += pulsesRow(profile, pose.strokes) + " " + comment(pose.name) + "\n";
    text += "};\n// Most microseconds from one frame to the next.\n";
    text += "const uint16_t kPoseFastest[kChannelCount] PROGMEM = {" + fastestRow(profile) + "};\n";
    text += "const PoseStep kPoseTable[] PROGMEM = {\n";
    for (const PoseStep& step : plan.sequence.steps) text += stepRow(plan.sequence, step) + "\n";
    return text + "};\n";
}

} // namespace lumorph

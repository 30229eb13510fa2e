#include "devices/controllers/servo_link_watch.h"

#include <cstdio>
#include <utility>

namespace lumorph {
namespace {

using Kind = LinkEvent::Kind;

// Volts of two lithium cells. In between nothing is said: the voltage sags with every move.
constexpr double kLow = 6.0;
constexpr double kEnough = 6.4;

// Broken frames in a window; in between nothing is said.
constexpr Microseconds kWindow{2'000'000};
constexpr std::uint64_t kNoisy = 3;

std::string voltsText(double volts) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.1f V", volts);
    return text;
}

} // namespace

void LinkWatch::opened(const ControllerState& state) {
    phase_ = ControllerPhase::handshake;
    errors_ = state.errors;
    noisy_ = false;
    words_.clear();
}

void LinkWatch::look(const ControllerState& state, Microseconds now) {
    lookAtPhase(state);
    lookAtBattery(state);
    lookAtNoise(state, now);
    lookAtWords(state);
}

void LinkWatch::lookAtPhase(const ControllerState& state) {
    if (std::exchange(phase_, state.phase) == state.phase) return;
    const std::string what = state.traits.name + (state.firmware.empty() ? "" : ", " + state.firmware);
    if (state.phase == ControllerPhase::ready)
        tell_(Kind::information, "The board is ready (" + what + ").", "");
    else if (state.phase == ControllerPhase::unidentified)
        tell_(Kind::warning, "Something answers (" + what + "), but it may be another device.",
              "Confirm that it is your servo controller before anything moves.");
    else if (state.phase == ControllerPhase::refused && state.trouble)
        tell_(Kind::failure, "The board cannot be used: " + state.trouble->why + ".", state.trouble->remedy);
}

void LinkWatch::lookAtBattery(const ControllerState& state) {
    if (!state.volts) return;
    if (!low_ && *state.volts < kLow) {
        low_ = true;
        tell_(Kind::warning, "The battery is low: " + voltsText(*state.volts) + ".",
              "Charge it or change it: servos lose their strength, and the board may restart.");
    } else if (low_ && *state.volts >= kEnough) {
        low_ = false;
        tell_(Kind::information, "The battery is well again: " + voltsText(*state.volts) + ".", "");
    }
}

void LinkWatch::lookAtNoise(const ControllerState& state, Microseconds now) {
    if (now >= window_ && now - window_ < kWindow) return;
    const std::uint64_t broken = state.errors - std::exchange(errors_, state.errors);
    window_ = now;
    if (!noisy_ && broken >= kNoisy)
        tell_(Kind::warning, "The link is noisy: " + std::to_string(broken) + " broken messages in two seconds.",
              "Check plugs and ground, keep servo cables away from the data line, or bring the radio nearer.");
    noisy_ = broken >= kNoisy || (noisy_ && broken > 0);
}

/// What the board itself says; the battery and a refusal have words of their own.
void LinkWatch::lookAtWords(const ControllerState& state) {
    if (!state.trouble || state.batteryTrouble || !state.answering || state.phase == ControllerPhase::refused) return;
    if (std::exchange(words_, state.trouble->why) == state.trouble->why) return;
    tell_(Kind::warning, "Trouble with the board: " + state.trouble->why + ".", state.trouble->remedy);
}

} // namespace lumorph

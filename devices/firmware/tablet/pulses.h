#pragma once

#include <stdint.h>

// Pulses of all servos by Timer1, 50 times a second. Channels are counted as in channels.h.

constexpr uint16_t kLeastPulse = 500; // microseconds; no pulse is ever shorter or longer, whatever is asked
constexpr uint16_t kGreatestPulse = 2500;
constexpr uint16_t kEdgeError = F_CPU > 8000000UL ? 1 : 2; // microseconds that a pulse may differ from what was asked
constexpr uint8_t kFrameMilliseconds = 20;

void pulsesBegin();
struct Limits {
    uint16_t least, greatest;
};
/// Rounded inwards, so that a pulse that is asked for at a limit does not pass it on the wire.
Limits safeLimits(uint16_t least, uint16_t greatest);
/// Width from the next frame on, microseconds; clamped to the channel's limits.
void setPulse(uint8_t channel, uint16_t microseconds);
/// Most microseconds by which a pulse may differ from the one a frame before, while the channel is on; 0: any. What a
/// radio held back and then delivers all at once must not throw a servo.
void setStep(uint8_t channel, uint16_t microseconds);
/// A channel that is on but was never given a width stays without pulse. Its first pulse is the one it was given.
void setOn(uint8_t channel, bool on);
bool isOn(uint8_t channel);
/// What it was given, though it may still be on its way there. 0: it was never given one.
uint16_t pulseOf(uint8_t channel);
/// All off, widths and steps forgotten.
void forgetPulses();
void allOff();
bool anyOn();

/// True once a frame, when the last pulse is over and the next frame must be planned.
bool pulsesFrameIsDue();
/// The same, and it stays so.
bool pulsesFrameWaits();
/// Lays the next frame out. A frame is taken over as a whole, between two frames: no pulse is ever cut short.
void pulsesPlan();
/// Makes the next frame's begin the processor's start, for one that hangs.
void restartAfterThisFrame();

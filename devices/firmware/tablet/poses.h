// Poses that the board shows without a computer: none. Lumorph makes this file; upload the sketch again after a change.
#pragma once

#include <avr/pgmspace.h>
#include <stdint.h>

#include "channels.h"

enum PoseEasing : uint8_t { kSmoothly, kNaturally };
struct PoseStep {
    uint8_t pose; // row of kPosePulses
    PoseEasing easing;
    uint32_t travel, hold; // frames of 20 ms
};

constexpr uint16_t kPoseSteps = 0; // 0: none, the board waits for a computer
constexpr bool kPoseLoop = false;
constexpr uint8_t kPoseButton = 0;  // pin of a button to ground; 0: it begins by itself at power on
constexpr uint8_t kPoseStagger = 1; // frames between one servo's start and the next

// Microseconds of each channel; first where it begins that the board does not know.
const uint16_t kPosePulses[][kChannelCount] PROGMEM = {{0}};
// Most microseconds from one frame to the next.
const uint16_t kPoseFastest[kChannelCount] PROGMEM = {0};
const PoseStep kPoseTable[] PROGMEM = {{0, kSmoothly, 0, 0}};

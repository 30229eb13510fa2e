// Servos of "Tablet". Lumorph makes this file from a device profile; upload the sketch again after a change.
#pragma once

#include <stdint.h>

struct ChannelSetup {
    uint8_t pin;              // 2 to 13, A1 to A5 as 15 to 19
    uint16_t least, greatest; // microseconds, 500 to 2500
};

constexpr ChannelSetup kChannels[] = {
    {3, 1000, 2000},  // servo 1
    {5, 1000, 2000},  // servo 2
    {6, 1000, 2000},  // servo 3
    {9, 1000, 2000},  // servo 4
    {10, 1000, 2000}, // servo 5
    {11, 1000, 2000}, // servo 6
};
constexpr uint8_t kChannelCount = sizeof(kChannels) / sizeof(kChannels[0]);

constexpr uint32_t kBaud = 57600;

// Battery on A0, which must stay below 1.1 V: 100 kOhm above it and 10 kOhm below measure up to 12.1 V.
constexpr uint32_t kBatteryTopOhms = 100000;
constexpr uint32_t kBatteryBottomOhms = 10000;
constexpr uint32_t kReferenceMillivolts = 1100; // 1000 to 1200 from chip to chip: correct it by a voltmeter

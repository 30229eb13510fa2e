#include "devices/firmware/pin_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "devices/transport/address.h"

namespace lumorph {

namespace {

constexpr std::size_t kMostServos = 12;
constexpr double kLeastPulse = 500.0; // microseconds
constexpr double kGreatestPulse = 2500.0;
constexpr int kBatteryPin = 14;
constexpr std::array kBauds = {9600, 19200, 38400, 57600, 115200};

constexpr std::string_view kBegin = R"(#pragma once

#include <stdint.h>

struct ChannelSetup {
    uint8_t pin;              // 2 to 13, A1 to A5 as 15 to 19
    uint16_t least, greatest; // microseconds, 500 to 2500
};

constexpr ChannelSetup kChannels[] = {
)";
constexpr std::string_view kMiddle = R"(};
constexpr uint8_t kChannelCount = sizeof(kChannels) / sizeof(kChannels[0]);

constexpr uint32_t kBaud = )";
constexpr std::string_view kEnd = R"(;

// Battery on A0, which must stay below 1.1 V: 100 kOhm above it and 10 kOhm below measure up to 12.1 V.
constexpr uint32_t kBatteryTopOhms = 100000;
constexpr uint32_t kBatteryBottomOhms = 10000;
constexpr uint32_t kReferenceMillivolts = 1100; // 1000 to 1200 from chip to chip: correct it by a voltmeter
)";

std::string servoName(std::size_t index) { return "servo " + std::to_string(index + 1); }

void checkPin(const std::string& servo, int pin) {
    if (pin == 0 || pin == 1)
        throw InvalidInput(servo, "pin " + std::to_string(pin) + " is the serial line", "use a pin from 2 to 13");
    if (pin == kBatteryPin) throw InvalidInput(servo, "pin 14 (A0) measures the battery", "use A1 to A5, 15 to 19");
    if (pin < 2 || pin > 19)
        throw InvalidInput(servo, "a Pro Mini has no pin " + std::to_string(pin),
                           "use pins from 2 to 13, or A1 to A5 as 15 to 19");
}

void checkLimits(const std::string& servo, const ServoSetup& setup) {
    // So written that what is not a number fails too.
    if (!(setup.pulseMin >= kLeastPulse && setup.pulseMax <= kGreatestPulse))
        throw InvalidInput(servo, "its pulses leave 500 to 2500 us", "set limits within");
    if (!(std::ceil(setup.pulseMin) <= std::floor(setup.pulseMax)))
        throw InvalidInput(servo, "its least pulse is longer than its greatest", "swap its limits");
}

int baudOf(const std::string& uri) {
    if (uri.empty()) return SerialAddress().baud;
    const DeviceAddress address = parseDeviceAddress(uri);
    if (std::holds_alternative<BluetoothAddress>(address)) return 9600;
    const auto* serial = std::get_if<SerialAddress>(&address);
    const int baud = serial != nullptr ? serial->baud : SerialAddress().baud;
    for (const int possible : kBauds)
        if (baud == possible) return baud;
    throw InvalidInput("address '" + uri + "'", "the sketch cannot have " + std::to_string(baud) + " baud",
                       "take 9600, 19200, 38400, 57600 or 115200");
}

/// A name comes from a file: only what cannot end the comment it stands in.
std::string commentText(const std::string& name) {
    std::string text;
    for (const char c : name) text += c >= ' ' && c <= '~' && c != '\\' && c != '"' && c != '?' ? c : '_';
    return text;
}

std::string row(const ServoSetup& setup) {
    const auto whole = [](double value) { return std::to_string(static_cast<int>(value)); };
    return "    {" + std::to_string(setup.channel) + ", " + whole(std::ceil(setup.pulseMin)) + ", " +
           whole(std::floor(setup.pulseMax)) + "},";
}

/// With the servos' numbers beneath each other.
std::string table(const std::vector<std::string>& rows) {
    std::size_t longest = 0;
    for (const std::string& row : rows) longest = std::max(longest, row.size());
    std::string text;
    for (std::size_t i = 0; i < rows.size(); ++i)
        text += rows[i] + std::string(longest - rows[i].size() + 1, ' ') + "// " + servoName(i) + "\n";
    return text;
}

} // namespace

std::string channelsHeader(const DeviceProfile& profile) {
    if (profile.servos.empty()) throw InvalidInput("profile", "it has no servo", "add one before making the sketch");
    if (profile.servos.size() > kMostServos)
        throw InvalidInput("profile", "the sketch drives 12 servos, not " + std::to_string(profile.servos.size()),
                           "spread them over two boards");
    std::set<int> pins;
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < profile.servos.size(); ++i) {
        const ServoSetup& setup = profile.servos[i];
        checkPin(servoName(i), setup.channel);
        checkLimits(servoName(i), setup);
        if (!pins.insert(setup.channel).second)
            throw InvalidInput(servoName(i), "pin " + std::to_string(setup.channel) + " has another servo already",
                               "give each servo a pin of its own");
        rows.push_back(row(setup));
    }
    std::string text = "// Servos of \"" + commentText(profile.name) +
                       "\". Lumorph makes this file from a device profile; upload the sketch again after a change.\n";
    text += kBegin;
    text += table(rows);
    text += kMiddle;
    text += std::to_string(baudOf(profile.address));
    text += kEnd;
    return text;
}

} // namespace lumorph

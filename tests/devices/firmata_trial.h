#pragma once

#include <string>
#include <vector>

#include "tests/devices/controller_harness.h"

/// What a Firmata board says, and a controller that has shaken hands with one.
namespace lumorph::test::firmata_board {

inline const Bytes kVersion = {0xF9, 0x02, 0x05};
inline const Bytes kStateQuestion = {0xF0, 0x6D};
inline const Bytes kVoltageQuestion = {0xF0, 0x02};
inline const Messages kQuestions = {kStateQuestion, kVoltageQuestion};

inline Bytes firmwareNamed(const std::string& name, std::uint8_t minor = 2) {
    Bytes bytes = {0xF0, 0x79, 0x01, minor};
    for (const char letter : name) bytes.insert(bytes.end(), {static_cast<std::uint8_t>(letter), 0x00});
    bytes.push_back(0xF7);
    return bytes;
}

/// Pins 0 and 1 are the serial port's, all others drive servos.
inline Bytes capabilities(int pins = 20) {
    Bytes bytes = {0xF0, 0x6C, 0x7F, 0x7F};
    for (int pin = 2; pin < pins; ++pin) bytes.insert(bytes.end(), {0x00, 0x01, 0x01, 0x01, 0x04, 0x0E, 0x7F});
    bytes.push_back(0xF7);
    return bytes;
}

inline Bytes stateOf(std::uint8_t pin, std::uint8_t mode, int value = 1500) {
    return {0xF0, 0x6E, pin, mode, static_cast<std::uint8_t>(value & 0x7F), static_cast<std::uint8_t>(value >> 7),
            0xF7};
}
/// What a pin is told to let its servo go; the first byte ends what was begun before.
inline Bytes detachOf(std::uint8_t pin) { return {0xF7, 0xF4, pin, 0x01}; }
inline const Bytes kReset = {0xF7, 0xFF};
inline Bytes voltage(int millivolts) {
    return {0xF0,
            0x02,
            static_cast<std::uint8_t>(millivolts & 0x7F),
            static_cast<std::uint8_t>(millivolts >> 7 & 0x7F),
            static_cast<std::uint8_t>(millivolts >> 14 & 0x7F),
            0xF7};
}

inline void shakeHands(ControllerTrial& trial, const std::string& firmware = "LumorphTablet") {
    trial.receive(kVersion);
    trial.receive(firmwareNamed(firmware));
    trial.receive(capabilities());
}

inline ControllerTrial readyTrial(const std::vector<int>& channels, const std::string& firmware = "LumorphTablet",
                                  const std::string& uri = "serial:///dev/ttyUSB0") {
    ControllerTrial trial(test::profileOn(ControllerKind::firmata, channels), uri);
    trial.open();
    shakeHands(trial, firmware);
    (void)trial.written();
    return trial;
}

} // namespace lumorph::test::firmata_board

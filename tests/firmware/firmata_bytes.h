#pragma once

#include <cstdint>

#include "tests/firmware/board.h"

namespace lumorph::firmware_test {

// Messages of Firmata, spelt out here: not taken from an encoder of ours.
inline Bytes attach(int pin) { return {0xF4, static_cast<std::uint8_t>(pin), 0x04}; }
inline Bytes detach(int pin) { return {0xF4, static_cast<std::uint8_t>(pin), 0x01}; }
inline std::uint8_t low(int value) { return static_cast<std::uint8_t>(value & 0x7F); }
inline std::uint8_t high(int value) { return static_cast<std::uint8_t>((value >> 7) & 0x7F); }
inline Bytes write(int pin, int value) {
    if (pin < 16) return {static_cast<std::uint8_t>(0xE0 + pin), low(value), high(value)};
    return {0xF0, 0x6F, static_cast<std::uint8_t>(pin), low(value), high(value), 0xF7};
}
inline Bytes limits(int pin, int least, int greatest) {
    return {0xF0, 0x70, static_cast<std::uint8_t>(pin), low(least), high(least), low(greatest), high(greatest), 0xF7};
}
inline Bytes step(int pin, int microseconds) {
    return {0xF0, 0x03, static_cast<std::uint8_t>(pin), low(microseconds), high(microseconds), 0xF7};
}

} // namespace lumorph::firmware_test

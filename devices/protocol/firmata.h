#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

/// Firmata 2.x (firmata/protocol 2.8; firmata/arduino speaks 2.5): what the studio says to an Arduino and what it
/// hears.
namespace lumorph::firmata {

using Bytes = std::vector<std::uint8_t>;

constexpr int kOutputMode = 1;
constexpr int kServoMode = 4;
/// A value below is taken for degrees, not for microseconds.
constexpr int kLeastMicroseconds = 544;
/// Ends an extended message. Before any other it does no harm, and gets a board out of one whose own end was lost:
/// stock firmware takes all for data until then.
constexpr std::uint8_t kEndOfMessage = 0xF7;

// Questions and commands. All throw InvalidInput for a pin beyond 0 to 127 or a value that their bytes cannot carry.
[[nodiscard]] Bytes askVersion();
[[nodiscard]] Bytes askFirmware();
[[nodiscard]] Bytes askCapabilities();
[[nodiscard]] Bytes askPinState(int pin);
/// Only firmware of ours answers it.
[[nodiscard]] Bytes askVoltage();
/// Microseconds, 0 to 16383. Stock firmware attaches the servo, too.
[[nodiscard]] Bytes configureServo(int pin, int pulseMin, int pulseMax);
/// Most microseconds from one frame of 20 ms to the next, 0 to 16383; 0: any. Only firmware of ours knows it,
/// since 1.2.
[[nodiscard]] Bytes limitStep(int pin, int microseconds);
[[nodiscard]] Bytes setPinMode(int pin, int mode);
[[nodiscard]] Bytes attachServo(int pin);
[[nodiscard]] Bytes detachServo(int pin);
/// The short form where it can carry pin and value, else the extended one.
[[nodiscard]] Bytes writeValue(int pin, int value);
[[nodiscard]] Bytes writeExtended(int pin, int value);
/// Detaches all servos.
[[nodiscard]] Bytes resetBoard();

struct Version {
    int major = 0, minor = 0;
    bool operator==(const Version&) const = default;
};
struct Firmware {
    int major = 0, minor = 0;
    std::string name; ///< may be empty
    bool operator==(const Firmware&) const = default;
};
struct PinMode {
    int mode = 0, resolution = 0;
    bool operator==(const PinMode&) const = default;
};
struct Capabilities {
    std::vector<std::vector<PinMode>> pins;
    bool operator==(const Capabilities&) const = default;
};
struct AnalogMapping {
    std::vector<int> channels; ///< by pin, -1: none
    bool operator==(const AnalogMapping&) const = default;
};
struct PinState {
    int pin = 0;
    int mode = 0; ///< -1: the board has no such pin
    std::uint32_t value = 0;
    bool operator==(const PinState&) const = default;
};
struct Text {
    std::string text;
    bool operator==(const Text&) const = default;
};
struct Voltage {
    double volts = 0.0;
    bool operator==(const Voltage&) const = default;
};
/// What a pin or a port reads, unasked.
struct Reading {
    bool isPort = false;
    int number = 0, value = 0;
    bool operator==(const Reading&) const = default;
};
using Message = std::variant<Version, Firmware, Capabilities, AnalogMapping, PinState, Text, Voltage, Reading>;

/// Takes bytes as they come and gives the messages that they complete. After something broken it goes on with the next
/// command byte. Extended messages that it does not know are skipped.
class Parser {
public:
    /// Bytes that an extended message may have; a board with 128 pins needs 4400 to tell what they can do.
    static constexpr std::size_t kLongest = 8192;

    [[nodiscard]] std::vector<Message> feed(std::span<const std::uint8_t> bytes);
    /// Forgets what was begun. What is counted stays.
    void clear();
    /// Messages that were broken off, too long or nonsense, and runs of bytes that belong to none.
    [[nodiscard]] std::uint64_t broken() const noexcept { return broken_; }

private:
    enum class Place { outside, garbage, shortMessage, extended, overlong };
    void begin(std::uint8_t command);
    void data(std::uint8_t byte, std::vector<Message>& messages);
    void finishExtended(std::vector<Message>& messages);

    Place place_ = Place::outside;
    std::uint8_t command_ = 0;
    Bytes body_;
    std::uint64_t broken_ = 0;
};

} // namespace lumorph::firmata

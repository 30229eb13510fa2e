#include "devices/protocol/firmata.h"

#include <optional>

#include "core/base/error.h"

namespace lumorph::firmata {

namespace {

constexpr std::uint8_t kStart = 0xF0;
constexpr std::uint8_t kEnd = kEndOfMessage;
constexpr std::uint8_t kVersion = 0xF9;
constexpr std::uint8_t kSetMode = 0xF4;
constexpr std::uint8_t kReset = 0xFF;
constexpr std::uint8_t kAnalog = 0xE0;
constexpr std::uint8_t kDigital = 0x90;
// Of extended messages:
constexpr std::uint8_t kVoltage = 0x02;
constexpr std::uint8_t kStep = 0x03;
constexpr std::uint8_t kMapping = 0x6A;
constexpr std::uint8_t kCapabilityQuery = 0x6B, kCapability = 0x6C;
constexpr std::uint8_t kPinStateQuery = 0x6D, kPinState = 0x6E;
constexpr std::uint8_t kExtendedAnalog = 0x6F;
constexpr std::uint8_t kServoConfig = 0x70;
constexpr std::uint8_t kText = 0x71;
constexpr std::uint8_t kFirmware = 0x79;

std::uint8_t inRange(const char* what, int value, int greatest) {
    if (value < 0 || value > greatest)
        throw InvalidInput(std::string("Firmata ") + what + " " + std::to_string(value), "it cannot be told to a board",
                           "use 0 to " + std::to_string(greatest));
    return static_cast<std::uint8_t>(value & 0x7F);
}
std::uint8_t pinByte(int pin) { return inRange("pin", pin, 127); }
std::uint8_t low(int value) { return inRange("value", value, 0x3FFF); }
std::uint8_t high(int value) { return static_cast<std::uint8_t>((value >> 7) & 0x7F); }

using View = std::span<const std::uint8_t>;

std::optional<Message> firmwareOf(View body) {
    if (body.size() < 2 || body.size() % 2 != 0) return std::nullopt;
    Firmware firmware{body[0], body[1], {}};
    for (std::size_t i = 2; i < body.size(); i += 2)
        firmware.name.push_back(static_cast<char>(body[i] | (body[i + 1] & 1) << 7));
    return firmware;
}

std::optional<Message> textOf(View body) {
    if (body.size() % 2 != 0) return std::nullopt;
    Text text;
    for (std::size_t i = 0; i < body.size(); i += 2)
        text.text.push_back(static_cast<char>(body[i] | (body[i + 1] & 1) << 7));
    return text;
}

/// Per pin pairs of mode and resolution, then 7F.
std::optional<Message> capabilitiesOf(View body) {
    Capabilities capabilities;
    std::vector<PinMode> pin;
    std::size_t i = 0;
    while (i < body.size()) {
        if (body[i] == 0x7F) {
            capabilities.pins.push_back(std::move(pin));
            pin.clear();
            ++i;
            continue;
        }
        if (i + 1 >= body.size()) return std::nullopt;
        pin.push_back({body[i], body[i + 1]});
        i += 2;
    }
    if (!pin.empty() || capabilities.pins.size() > 128) return std::nullopt;
    return capabilities;
}

std::optional<Message> mappingOf(View body) {
    if (body.size() > 128) return std::nullopt;
    AnalogMapping mapping;
    for (const std::uint8_t channel : body) mapping.channels.push_back(channel == 0x7F ? -1 : channel);
    return mapping;
}

std::optional<Message> pinStateOf(View body) {
    if (body.size() == 1) return PinState{body[0], -1, 0};
    if (body.size() < 3 || body.size() > 6) return std::nullopt;
    PinState state{body[0], body[1], 0};
    for (std::size_t i = 2; i < body.size(); ++i) state.value |= static_cast<std::uint32_t>(body[i]) << 7 * (i - 2);
    return state;
}

std::optional<Message> voltageOf(View body) {
    if (body.size() != 3) return std::nullopt;
    return Voltage{0.001 * (body[0] | body[1] << 7 | body[2] << 14)};
}

} // namespace

Bytes askVersion() { return {kVersion}; }
Bytes askFirmware() { return {kStart, kFirmware, kEnd}; }
Bytes askCapabilities() { return {kStart, kCapabilityQuery, kEnd}; }
Bytes askPinState(int pin) { return {kStart, kPinStateQuery, pinByte(pin), kEnd}; }
Bytes askVoltage() { return {kStart, kVoltage, kEnd}; }

Bytes configureServo(int pin, int pulseMin, int pulseMax) {
    return {kStart, kServoConfig, pinByte(pin), low(pulseMin), high(pulseMin), low(pulseMax), high(pulseMax), kEnd};
}

Bytes limitStep(int pin, int microseconds) {
    return {kStart, kStep, pinByte(pin), low(microseconds), high(microseconds), kEnd};
}

Bytes setPinMode(int pin, int mode) { return {kSetMode, pinByte(pin), inRange("pin mode", mode, 127)}; }
Bytes attachServo(int pin) { return setPinMode(pin, kServoMode); }
Bytes detachServo(int pin) { return setPinMode(pin, kOutputMode); }

Bytes writeValue(int pin, int value) {
    if (pinByte(pin) > 15 || value > 0x3FFF) return writeExtended(pin, value);
    return {static_cast<std::uint8_t>(kAnalog + pin), low(value), high(value)};
}

Bytes writeExtended(int pin, int value) {
    (void)inRange("value", value, 0x0FFFFFFF);
    Bytes bytes{kStart, kExtendedAnalog, pinByte(pin)};
    const std::size_t least = bytes.size() + 2;
    for (; value > 0 || bytes.size() < least; value >>= 7) bytes.push_back(static_cast<std::uint8_t>(value & 0x7F));
    bytes.push_back(kEnd);
    return bytes;
}

Bytes resetBoard() { return {kReset}; }

std::vector<Message> Parser::feed(std::span<const std::uint8_t> bytes) {
    std::vector<Message> messages;
    for (const std::uint8_t byte : bytes) {
        if (byte < 0x80)
            data(byte, messages);
        else if (byte == kEnd && place_ == Place::extended)
            finishExtended(messages);
        else
            begin(byte);
    }
    return messages;
}

void Parser::clear() {
    place_ = Place::outside;
    body_.clear();
}

/// A command byte ends whatever was begun.
void Parser::begin(std::uint8_t command) {
    if (place_ == Place::extended || place_ == Place::shortMessage) ++broken_;
    const bool closesOverlong = place_ == Place::overlong && command == kEnd; // was counted when it grew too long
    clear();
    command_ = command;
    const int kind = command & 0xF0;
    if (command == kStart)
        place_ = Place::extended;
    else if (command == kVersion || kind == kAnalog || kind == kDigital)
        place_ = Place::shortMessage;
    else if (!closesOverlong) {
        ++broken_;
        place_ = Place::garbage;
    }
}

void Parser::data(std::uint8_t byte, std::vector<Message>& messages) {
    if (place_ == Place::outside) {
        ++broken_;
        place_ = Place::garbage;
    }
    if (place_ == Place::garbage || place_ == Place::overlong) return;
    body_.push_back(byte);
    if (place_ == Place::extended && body_.size() > kLongest) {
        clear();
        ++broken_;
        place_ = Place::overlong;
    }
    if (place_ != Place::shortMessage || body_.size() < 2) return;
    if (command_ == kVersion)
        messages.emplace_back(Version{body_[0], body_[1]});
    else
        messages.emplace_back(Reading{(command_ & 0xF0) == kDigital, command_ & 0x0F, body_[0] | body_[1] << 7});
    clear();
}

void Parser::finishExtended(std::vector<Message>& messages) {
    const View body = View(body_).subspan(body_.empty() ? 0 : 1);
    std::optional<Message> message;
    bool known = true;
    switch (body_.empty() ? -1 : body_[0]) {
    case kFirmware:
        message = firmwareOf(body);
        break;
    case kText:
        message = textOf(body);
        break;
    case kCapability:
        message = capabilitiesOf(body);
        break;
    case kMapping:
        message = mappingOf(body);
        break;
    case kPinState:
        message = pinStateOf(body);
        break;
    case kVoltage:
        message = voltageOf(body);
        break;
    default:
        known = body_.empty();
        break; // an empty one is broken, others are somebody else's
    }
    if (message)
        messages.push_back(std::move(*message));
    else if (known)
        ++broken_;
    clear();
}

} // namespace lumorph::firmata

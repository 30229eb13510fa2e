#include "devices/protocol/lewansoul.h"

#include <string>

#include "core/base/error.h"

namespace lumorph::lewansoul {

namespace {

constexpr std::uint8_t kHeader = 0x55;
constexpr std::uint8_t kMove = 0x03;
constexpr std::uint8_t kVoltage = 0x0F;
constexpr std::uint8_t kUnload = 0x14;
constexpr std::uint8_t kPositions = 0x15;
constexpr std::size_t kMostServos = 83; // 3N + 5 fits a byte

[[noreturn]] void refuse(const std::string& what, const std::string& remedy) {
    throw InvalidInput("LewanSoul " + what, "it does not fit a frame", remedy);
}

void pushWord(Bytes& bytes, int value) {
    bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
}

void checkCount(std::size_t count) {
    if (count == 0 || count > kMostServos) refuse(std::to_string(count) + " servos", "name 1 to 83 at once");
}

std::uint8_t servoByte(int servo) {
    if (servo < 0 || servo > 254) refuse("servo " + std::to_string(servo), "use 0 to 254");
    return static_cast<std::uint8_t>(servo);
}

Bytes begin(std::size_t length, std::uint8_t command) {
    return {kHeader, kHeader, static_cast<std::uint8_t>(length), command};
}

Bytes listOf(std::uint8_t command, std::span<const int> servos) {
    checkCount(servos.size());
    Bytes bytes = begin(servos.size() + 3, command);
    bytes.push_back(static_cast<std::uint8_t>(servos.size()));
    for (const int servo : servos) bytes.push_back(servoByte(servo));
    return bytes;
}

int word(const Bytes& frame, std::size_t at) { return frame[at] | frame[at + 1] << 8; }

/// Whether a frame of these first four bytes can be.
bool canBe(std::size_t length, std::uint8_t command) {
    if (command == kVoltage) return length == 4;
    if (command == kPositions) return length >= 6 && length % 3 == 0;
    // Were the length 55, the frame would rather begin one byte later. Others that a device sends are short.
    return length >= 2 && length < kHeader;
}

std::optional<Message> messageOf(const Bytes& frame) {
    if (frame[3] == kVoltage) return Voltage{0.001 * word(frame, 4)};
    if (frame[3] != kPositions) return Other{frame[3]};
    if (frame[2] != 3 * frame[4] + 3) return std::nullopt;
    Positions positions;
    for (std::size_t at = 5; at + 2 < frame.size(); at += 3)
        positions.places.push_back({frame[at], static_cast<std::int16_t>(word(frame, at + 1))});
    return positions;
}

} // namespace

Bytes move(std::span<const Place> places, int milliseconds) {
    checkCount(places.size());
    if (milliseconds < 0 || milliseconds > 0xFFFF) refuse("time of a move", "use 0 to 65535 ms");
    Bytes bytes = begin(3 * places.size() + 5, kMove);
    bytes.push_back(static_cast<std::uint8_t>(places.size()));
    pushWord(bytes, milliseconds);
    for (const Place& place : places) {
        bytes.push_back(servoByte(place.servo));
        if (place.position < 0 || place.position > 0xFFFF)
            refuse("position " + std::to_string(place.position), "use 0 to 65535");
        pushWord(bytes, place.position);
    }
    return bytes;
}

Bytes askVoltage() { return begin(2, kVoltage); }
Bytes unload(std::span<const int> servos) { return listOf(kUnload, servos); }
Bytes askPositions(std::span<const int> servos) { return listOf(kPositions, servos); }

std::vector<Message> Parser::feed(std::span<const std::uint8_t> bytes) {
    std::vector<Message> messages;
    for (const std::uint8_t byte : bytes) {
        frame_.push_back(byte);
        scan(messages);
    }
    return messages;
}

std::vector<Message> Parser::report(std::span<const std::uint8_t> bytes) {
    clear();
    std::vector<Message> messages = feed(bytes);
    if (waiting()) ++broken_;
    clear();
    return messages;
}

void Parser::clear() {
    frame_.clear();
    garbage_ = false;
}

void Parser::dropFirst(std::size_t count) {
    frame_.erase(frame_.begin(), frame_.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Takes away what cannot be the beginning of a frame, and a frame that is complete.
void Parser::scan(std::vector<Message>& messages) {
    while (!frame_.empty()) {
        const std::size_t size = frame_.size();
        if (frame_[0] == 0 && !garbage_) {
            dropFirst(1);
            continue;
        }
        const bool sound =
            frame_[0] == kHeader && (size < 2 || frame_[1] == kHeader) && (size < 4 || canBe(frame_[2], frame_[3]));
        if (!sound) {
            if (!garbage_) ++broken_;
            garbage_ = frame_[0] != 0;
            dropFirst(1);
            continue;
        }
        if (size < 4 || size < frame_[2] + std::size_t{2}) return;
        if (std::optional<Message> message = messageOf(frame_)) {
            messages.push_back(std::move(*message));
            garbage_ = false;
            frame_.clear();
            return;
        }
        if (!garbage_) ++broken_;
        garbage_ = true;
        dropFirst(1);
    }
}

} // namespace lumorph::lewansoul

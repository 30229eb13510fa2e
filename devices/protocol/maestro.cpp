#include "devices/protocol/maestro.h"

#include <array>

#include "core/base/error.h"

namespace lumorph::maestro {

namespace {

constexpr std::uint8_t kTarget = 0x84;
constexpr std::uint8_t kSpeed = 0x87;
constexpr std::uint8_t kPosition = 0x90;
constexpr std::uint8_t kErrors = 0xA1;
constexpr std::uint8_t kHome = 0xA2;
constexpr std::uint8_t kAddressed = 0xAA;
constexpr std::array<const char*, 9> kErrorWords = {"signal error",       "overrun",           "receive buffer full",
                                                    "checksum error",     "protocol error",    "serial timeout",
                                                    "script stack error", "script call error", "script counter error"};

int inRange(const char* what, int value, int greatest) {
    if (value < 0 || value > greatest)
        throw InvalidInput(std::string("Maestro ") + what + " " + std::to_string(value), "it cannot be told to a board",
                           "use 0 to " + std::to_string(greatest));
    return value;
}

Bytes dressed(const Form& form, std::uint8_t command, std::span<const std::uint8_t> data) {
    Bytes bytes;
    if (form.addressed)
        bytes = {kAddressed, static_cast<std::uint8_t>(inRange("device number", form.device, 127)),
                 static_cast<std::uint8_t>(command & 0x7F)};
    else
        bytes = {command};
    bytes.insert(bytes.end(), data.begin(), data.end());
    if (form.checksum) bytes.push_back(checksum(bytes));
    return bytes;
}

Bytes ofChannel(const Form& form, std::uint8_t command, int channel, int value) {
    inRange("value", value, 0x3FFF);
    const std::array data = {static_cast<std::uint8_t>(inRange("channel", channel, 127)),
                             static_cast<std::uint8_t>(value & 0x7F), static_cast<std::uint8_t>(value >> 7)};
    return dressed(form, command, data);
}

} // namespace

std::uint8_t checksum(std::span<const std::uint8_t> bytes) {
    std::uint8_t sum = 0;
    for (const std::uint8_t byte : bytes) {
        sum = static_cast<std::uint8_t>(sum ^ byte);
        for (int bit = 0; bit < 8; ++bit) {
            if (sum & 1) sum = static_cast<std::uint8_t>(sum ^ 0x91);
            sum = static_cast<std::uint8_t>(sum >> 1);
        }
    }
    return sum;
}

Bytes setTarget(const Form& form, int channel, int quarters) { return ofChannel(form, kTarget, channel, quarters); }
Bytes setSpeed(const Form& form, int channel, int speed) { return ofChannel(form, kSpeed, channel, speed); }
Bytes goHome(const Form& form) { return dressed(form, kHome, {}); }
Bytes askPosition(const Form& form, int channel) {
    const std::array data = {static_cast<std::uint8_t>(inRange("channel", channel, 127))};
    return dressed(form, kPosition, data);
}
Bytes askErrors(const Form& form) { return dressed(form, kErrors, {}); }

std::string errorWords(int bits) {
    std::string words;
    for (std::size_t i = 0; i < kErrorWords.size(); ++i) {
        if (!(bits >> i & 1)) continue;
        if (!words.empty()) words += ", ";
        words += kErrorWords[i];
    }
    return words;
}

void Replies::expect(Question question) {
    if (open_.size() == kMostOpen) {
        open_.pop_front();
        first_ = -1;
        ++broken_;
    }
    open_.push_back(question);
}
void Replies::expectPosition(int channel) { expect({Question::Kind::position, channel}); }
void Replies::expectErrors() { expect({Question::Kind::errors, 0}); }

void Replies::clear() {
    open_.clear();
    first_ = -1;
}

std::vector<Message> Replies::feed(std::span<const std::uint8_t> bytes) {
    std::vector<Message> messages;
    for (const std::uint8_t byte : bytes) {
        if (open_.empty()) {
            ++broken_;
        } else if (first_ < 0) {
            first_ = byte;
        } else {
            const int value = first_ | byte << 8;
            first_ = -1;
            answer(value, messages);
        }
    }
    return messages;
}

void Replies::answer(int value, std::vector<Message>& messages) {
    const Question question = open_.front();
    open_.pop_front();
    using Kind = Question::Kind;
    const int greatest = question.kind == Kind::position ? 0x3FFF : 0x1FF;
    if (value > greatest) {
        ++broken_;
        clear();
    } else if (question.kind == Kind::position) {
        messages.emplace_back(Position{question.channel, value});
    } else {
        messages.emplace_back(Errors{value});
    }
}

} // namespace lumorph::maestro

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "devices/simulator/board_program.h"

namespace lumorph {

namespace {

constexpr std::size_t kChannels = 12;
constexpr std::uint8_t kDevice = 12;
constexpr std::uint8_t kPololu = 0xAA;
constexpr Microseconds kTick{10'000}; // the unit of its speeds
constexpr double kTicksOfAcceleration = 8.0;
constexpr unsigned kChecksumError = 1U << 3;
constexpr unsigned kProtocolError = 1U << 4;

using Bytes = std::vector<std::uint8_t>;

std::uint8_t checksum(std::span<const std::uint8_t> message) {
    unsigned rest = 0;
    for (const std::uint8_t byte : message) {
        rest ^= byte;
        for (int bit = 0; bit < 8; ++bit) rest = (rest & 1U ? rest ^ 0x91U : rest) >> 1U;
    }
    return static_cast<std::uint8_t>(rest);
}

/// Data bytes after a command; of an unknown one none.
std::size_t dataOf(std::uint8_t command) {
    if (command == 0x84 || command == 0x87 || command == 0x89) return 3;
    return command == 0x90 ? 1 : 0;
}

/// All in quarters of a microsecond and ticks.
struct Channel {
    double target = 0.0; ///< 0: off
    double pulse = 0.0;
    double velocity = 0.0;
    double speed = 0.0;        ///< 0: no limit
    double acceleration = 0.0; ///< 0: no limit

    void aim(double quarters) {
        target = quarters;
        const bool unlimited = speed <= 0.0 && acceleration <= 0.0;
        if (target > 0.0 && pulse > 0.0 && target != pulse && !unlimited) return;
        pulse = target; // out of nothing it knows no way
        velocity = 0.0;
    }

    void step() {
        const double way = target - pulse;
        double fastest = speed > 0.0 ? std::min(speed, std::abs(way)) : std::abs(way);
        if (acceleration > 0.0) {
            const double change = acceleration / kTicksOfAcceleration;
            // That it can stop there, slower by `change` with each tick.
            fastest = std::min(fastest, change * (std::sqrt(0.25 + 2.0 * std::abs(way) / change) - 0.5));
            velocity += std::clamp(std::copysign(fastest, way) - velocity, -change, change);
        } else {
            velocity = std::copysign(fastest, way);
        }
        if (velocity * way > 0.0 && std::abs(velocity) >= std::abs(way)) {
            pulse = target;
            velocity = 0.0;
        } else {
            pulse += velocity;
        }
    }

    [[nodiscard]] bool moves() const { return pulse != target; }
};

class Maestro final : public BoardProgram {
public:
    explicit Maestro(BoardHardware& hardware) : hardware_(hardware) {}

    void receive(std::span<const std::uint8_t> bytes, Microseconds now) override {
        now_ = now;
        for (const std::uint8_t byte : bytes) receiveByte(byte);
        finish();
    }

    [[nodiscard]] std::optional<Microseconds> alarm() const override { return nextTick_; }

    void wake(Microseconds now) override {
        now_ = now;
        for (std::size_t i = 0; i < kChannels; ++i) {
            if (!channels_[i].moves()) continue;
            channels_[i].step();
            drive(i);
        }
        nextTick_.reset();
        keepTicking();
    }

private:
    void receiveByte(std::uint8_t byte) {
        if (byte >= 0x80) {
            finish(); // without a checksum
            if (message_.size() > 1) errors_ |= kProtocolError;
            message_ = {byte};
            late_.reset();
        } else if (message_.empty()) {
            if (late_ != byte) errors_ |= kProtocolError;
            late_.reset();
        } else if (isComplete()) {
            if (byte == checksum(message_))
                execute();
            else
                errors_ |= kChecksumError;
            message_.clear();
        } else {
            message_.push_back(byte);
        }
    }

    /// A checksum may follow or not: without one, a complete message holds as soon as nothing follows it.
    void finish() {
        if (!isComplete()) return;
        late_ = checksum(message_);
        execute();
        message_.clear();
    }

    [[nodiscard]] bool isComplete() const {
        if (message_.empty()) return false;
        if (message_[0] != kPololu) return message_.size() == 1 + dataOf(message_[0]);
        return message_.size() >= 3 && message_.size() == 3 + dataOf(message_[2] | 0x80);
    }

    void execute() {
        const bool isPololu = message_[0] == kPololu;
        if (isPololu && message_[1] != kDevice) return; // for another one on the same line
        const auto command = static_cast<std::uint8_t>(isPololu ? message_[2] | 0x80 : message_[0]);
        const std::span<const std::uint8_t> data = std::span(message_).subspan(isPololu ? 3 : 1);
        if (!data.empty() && data[0] >= kChannels)
            errors_ |= kProtocolError;
        else if (data.size() == 3)
            set(command, data[0], data[1] | data[2] << 7);
        else
            answer(command, data);
    }

    void set(std::uint8_t command, std::size_t channel, int value) {
        if (command == 0x87) channels_[channel].speed = value;
        if (command == 0x89) channels_[channel].acceleration = value;
        if (command != 0x84) return;
        drive(channel); // the way to the new target begins here and now
        channels_[channel].aim(value);
        drive(channel);
        keepTicking();
    }

    void answer(std::uint8_t command, std::span<const std::uint8_t> data) {
        if (command == 0x90)
            sayTwo(static_cast<unsigned>(std::lround(channels_[data[0]].pulse)));
        else if (command == 0x93)
            hardware_.said.push_back({static_cast<std::uint8_t>(anyMoves() ? 1 : 0)});
        else if (command == 0xA1)
            sayTwo(std::exchange(errors_, 0U));
        else if (command == 0xA2)
            goHome();
        else
            errors_ |= kProtocolError;
    }

    void goHome() { // "off" on a new board
        for (Channel& channel : channels_) channel.aim(0.0);
        hardware_.servos.allLimp();
    }

    void drive(std::size_t channel) { hardware_.servos.setPulse(channel, channels_[channel].pulse / 4.0); }

    [[nodiscard]] bool anyMoves() const {
        return std::ranges::any_of(channels_, [](const Channel& channel) { return channel.moves(); });
    }

    void keepTicking() {
        if (!nextTick_ && anyMoves()) nextTick_ = now_ + kTick;
    }

    void sayTwo(unsigned value) {
        hardware_.said.push_back({static_cast<std::uint8_t>(value & 0xFF), static_cast<std::uint8_t>(value >> 8)});
    }

    BoardHardware& hardware_;
    Microseconds now_{0};
    std::array<Channel, kChannels> channels_;
    std::optional<Microseconds> nextTick_;
    unsigned errors_ = 0;
    Bytes message_;
    std::optional<std::uint8_t> late_; ///< checksum of the message before, in case that it comes after all
};

} // namespace

std::unique_ptr<BoardProgram> makeMaestroProgram(BoardHardware& hardware) {
    return std::make_unique<Maestro>(hardware);
}

} // namespace lumorph

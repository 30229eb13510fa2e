#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <variant>
#include <vector>

/// Pololu Maestro servo controllers over serial (Pololu, "Maestro Servo Controller User's Guide", section 5).
namespace lumorph::maestro {

using Bytes = std::vector<std::uint8_t>;

/// How commands are dressed.
struct Form {
    bool addressed = false; ///< Pololu protocol: AA, device number, command without its top bit
    int device = 12;        ///< 0 to 127
    bool checksum = false;  ///< CRC-7 at the end
    bool operator==(const Form&) const = default;
};

/// CRC-7 of the bytes, polynomial 91, least significant bit first.
[[nodiscard]] std::uint8_t checksum(std::span<const std::uint8_t> bytes);

// All throw InvalidInput for a channel or device number beyond 0 to 127 or a value beyond 0 to 16383.
/// Quarters of a microsecond; 0 is no pulse.
[[nodiscard]] Bytes setTarget(const Form& form, int channel, int quarters);
[[nodiscard]] Bytes setSpeed(const Form& form, int channel, int speed);
[[nodiscard]] Bytes goHome(const Form& form);
[[nodiscard]] Bytes askPosition(const Form& form, int channel);
[[nodiscard]] Bytes askErrors(const Form& form);

/// What the board sends to the channel now, not where the servo is; 0: no pulse.
struct Position {
    int channel = 0, quarters = 0;
    bool operator==(const Position&) const = default;
};
struct Errors {
    int bits = 0;
    bool operator==(const Errors&) const = default;
};
using Message = std::variant<Position, Errors>;

constexpr int kTimeoutError = 1 << 5;
/// "checksum error, serial timeout"; empty for none.
[[nodiscard]] std::string errorWords(int bits);

/// Answers have no frame: they are told apart by what was asked, in order.
class Replies {
public:
    /// Questions that may be open at once; beyond that the oldest is given up.
    static constexpr std::size_t kMostOpen = 32;

    void expectPosition(int channel);
    void expectErrors();
    /// A byte that nobody asked for is broken; so is an answer that cannot be, and then all that is open is given up,
    /// since nobody knows whose bytes come next.
    [[nodiscard]] std::vector<Message> feed(std::span<const std::uint8_t> bytes);
    /// Gives up all open questions.
    void clear();
    [[nodiscard]] std::size_t open() const noexcept { return open_.size(); }
    [[nodiscard]] std::uint64_t broken() const noexcept { return broken_; }

private:
    struct Question {
        enum class Kind { position, errors } kind;
        int channel;
    };
    void expect(Question question);
    void answer(int value, std::vector<Message>& messages);

    std::deque<Question> open_;
    int first_ = -1; ///< low byte of the answer that is coming
    std::uint64_t broken_ = 0;
};

} // namespace lumorph::maestro

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

/// Frames `55 55 LEN CMD params` of LewanSoul (Hiwonder) servo controllers, over USB-HID or serial. No checksum.
namespace lumorph::lewansoul {

using Bytes = std::vector<std::uint8_t>;

/// Servos that a frame may name so that its question and its answer fit a HID report of 64 bytes.
constexpr std::size_t kServosPerReport = 16;
constexpr std::size_t kReportBytes = 64;

struct Place {
    int servo = 0;
    int position = 0; ///< 0 to 1000 is 240 degrees on bus servos; microseconds on LSC boards
    bool operator==(const Place&) const = default;
};

// All throw InvalidInput where a servo is not 0 to 254, a value does not fit 16 bits, or there are none or more than
// 83 servos.
[[nodiscard]] Bytes move(std::span<const Place> places, int milliseconds);
[[nodiscard]] Bytes askVoltage();
[[nodiscard]] Bytes unload(std::span<const int> servos);
[[nodiscard]] Bytes askPositions(std::span<const int> servos);

struct Voltage {
    double volts = 0.0;
    bool operator==(const Voltage&) const = default;
};
struct Positions {
    std::vector<Place> places; ///< slightly beyond 0 to 1000 is possible, below 0 too
    bool operator==(const Positions&) const = default;
};
/// A frame with a command that is none of these, such as the end of an action group.
struct Other {
    int command = 0;
    bool operator==(const Other&) const = default;
};
using Message = std::variant<Voltage, Positions, Other>;

/// Takes bytes as they come and gives the messages that they complete. Zeros between frames are filling.
class Parser {
public:
    [[nodiscard]] std::vector<Message> feed(std::span<const std::uint8_t> bytes);
    /// One HID report: frames do not go on in the next.
    [[nodiscard]] std::vector<Message> report(std::span<const std::uint8_t> bytes);
    /// Forgets what was begun. What is counted stays.
    void clear();
    /// A frame was begun and is not complete.
    [[nodiscard]] bool waiting() const noexcept { return !frame_.empty(); }
    /// Frames that cannot be, and runs of bytes that belong to none.
    [[nodiscard]] std::uint64_t broken() const noexcept { return broken_; }

private:
    void scan(std::vector<Message>& messages);
    void dropFirst(std::size_t count);

    Bytes frame_;          ///< at most one frame
    bool garbage_ = false; ///< the run was counted
    std::uint64_t broken_ = 0;
};

} // namespace lumorph::lewansoul

#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lumorph::firmware_test {

using Bytes = std::vector<std::uint8_t>;

/// One pulse on a pin, as it was on the wire.
struct Pulse {
    int pin = 0;
    double start = 0.0; ///< milliseconds since power was switched on
    double width = 0.0; ///< microseconds
};

/// An ATmega328P with the sketch in it. Its time is that of its own clock.
class Board {
public:
    /// `sketch` as in "six" or `variantOf`.
    Board(const std::string& sketch, int megahertz);
    ~Board();

    void run(double milliseconds);
    /// Bytes on its receiving line, one after the other as fast as the line goes, while it runs.
    void send(std::span<const std::uint8_t> bytes);
    void send(std::initializer_list<int> bytes);
    /// Until all bytes are sent, and a little longer.
    void runUntilSent();
    [[nodiscard]] bool isSending() const;
    [[nodiscard]] double now() const; ///< milliseconds

    /// What it said and the pulses that ended since it was last asked.
    [[nodiscard]] Bytes takeSaid();
    [[nodiscard]] std::vector<Pulse> takePulses();
    [[nodiscard]] bool isHigh(int pin) const;
    /// A button between a pin and ground; let go, the pin is pulled up.
    void setButton(int pin, bool down);
    [[nodiscard]] std::size_t flashBytes() const; ///< of the sketch

    void setPinMillivolts(int millivolts); ///< on A0
    /// The processor goes round in one instruction for ever; the interrupts of the pulses' timer go on or end too.
    void hang(bool timerRuns);
    /// Called with each byte as it is said.
    void onSaid(std::function<void(std::uint8_t)> say);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::firmware_test

#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/simulator/pty.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph {

/// A simulated board at the far end of a pseudo-terminal, for programs that know nothing of it. What its servos do is
/// the board's own word.
class BoardAtPort {
public:
    using Clock = std::chrono::steady_clock;

    /// A board of the bench: "tablet", "uno", "maestro", or "xarm", which then is a LewanSoul board with a serial port.
    explicit BoardAtPort(const std::string& name);

    [[nodiscard]] std::string address() const { return "serial://" + port_.path() + "?baud=57600"; }
    /// How many of its servos get a pulse now.
    [[nodiscard]] std::size_t driven() const;
    /// When one got a pulse last.
    [[nodiscard]] Clock::time_point lastDriven() const { return lastDriven_; }
    [[nodiscard]] std::shared_ptr<SimulatedBoard> board() const { return board_; }

private:
    void pass();
    void takeFrames();

    Pty port_;
    SimulatedBench bench_;
    std::shared_ptr<SimulatedBoard> board_;
    std::vector<std::uint8_t> waiting_; ///< of a board that wants whole frames
    std::atomic<Clock::time_point> lastDriven_{Clock::time_point{}};
    std::jthread pump_;
};

} // namespace lumorph

#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/simulator/simulated_bench.h"

namespace lumorph {

/// A test's hand on the wire of one simulated board, in a time that it turns itself.
class SimulatedWire {
public:
    using Bytes = std::vector<std::uint8_t>;

    explicit SimulatedWire(const std::string& name) : board(bench_.board(name)) { board->plugged(clock_->now()); }

    void send(const Bytes& bytes) { board->take(bytes, clock_->now()); }
    [[nodiscard]] Bytes receive() { return board->give(clock_->now()); }
    [[nodiscard]] Bytes ask(const Bytes& question) {
        send(question);
        return receive();
    }
    void wait(Microseconds time) { clock_->advance(time); }
    [[nodiscard]] Microseconds now() const { return clock_->now(); }
    [[nodiscard]] SimulatedServo servo(std::size_t index) const { return board->servos().at(index); }

    template <typename Change> void fault(Change change) {
        BoardFaults faults = board->faults();
        change(faults);
        board->setFaults(faults);
    }

private:
    std::shared_ptr<ManualClock> clock_ = std::make_shared<ManualClock>();
    SimulatedBench bench_{clock_};

public:
    std::shared_ptr<SimulatedBoard> board;
};

} // namespace lumorph

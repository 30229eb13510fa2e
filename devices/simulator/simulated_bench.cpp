#include "devices/simulator/simulated_bench.h"

#include <utility>

#include "devices/simulator/wired_board.h"

namespace lumorph {

namespace {

// An ordinary servo takes 0.17 s for 60 degrees; its 180 degrees are 2000 us. A bus servo's 240 degrees are as many.
constexpr double kServoSpeed = 60.0 / 0.17 * 2000.0 / 180.0;
constexpr double kBusServoSpeed = 60.0 / 0.17 * 2000.0 / 240.0;

constexpr Microseconds kBootloader{2'500'000}; // an Arduino's, until its program runs
constexpr Microseconds kQuickStart{300'000};

} // namespace

struct SimulatedBench::Data {
    std::shared_ptr<const Clock> clock;
    std::vector<std::shared_ptr<SimulatedBoard>> boards;

    void add(BoardKind kind) { boards.push_back(makeBoard(std::move(kind), boards.size() + 1, clock)); }
};

SimulatedBench::SimulatedBench(std::shared_ptr<const Clock> clock) : data_(std::make_unique<Data>()) {
    data_->clock = std::move(clock);
    data_->add({"tablet", "LumorphTablet", false, 12, kServoSpeed, kBootloader, makeTabletProgram});
    data_->add({"uno", "Arduino Uno", false, 12, kServoSpeed, kBootloader, makeStandardFirmataProgram});
    data_->add({"xarm", "LOBOT xArm", true, 6, kBusServoSpeed, kQuickStart, makeLewansoulProgram});
    data_->add({"maestro", "Pololu Mini Maestro 12", false, 12, kServoSpeed, kQuickStart, makeMaestroProgram});
}

SimulatedBench::~SimulatedBench() = default;

std::vector<std::string> SimulatedBench::names() const {
    std::vector<std::string> names;
    for (const auto& board : data_->boards) names.push_back(board->name());
    return names;
}

std::shared_ptr<SimulatedBoard> SimulatedBench::board(const std::string& name) const {
    for (const auto& board : data_->boards)
        if (board->name() == name) return board;
    return nullptr;
}

Microseconds SimulatedBench::now() const { return data_->clock->now(); }

} // namespace lumorph

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "core/base/clock.h"
#include "devices/simulator/board_program.h"
#include "devices/simulator/simulated_bench.h"

namespace lumorph {

/// What makes a board.
struct BoardKind {
    std::string name;
    std::string product;
    bool isHid = false;
    std::size_t servos = 0;
    double hornSpeed = 0.0;   ///< microseconds of pulse a second
    Microseconds startsIn{0}; ///< after a reboot
    std::unique_ptr<BoardProgram> (*makeProgram)(BoardHardware& hardware) = nullptr;
};

/// A running board at the end of a wire. The seed makes its faults.
[[nodiscard]] std::shared_ptr<SimulatedBoard> makeBoard(BoardKind kind, std::uint64_t seed,
                                                        std::shared_ptr<const Clock> clock);

} // namespace lumorph

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/base/clock.h"
#include "devices/transport/transport.h"

namespace lumorph {

class SimulatedBoard;
struct BoardFaults;

/// The wire to a simulated board. Its faults are the board's (BoardFaults), and those of the address where they are
/// worse: `jitter` in milliseconds, `drop` and `noise` as shares of bytes. The same traffic suffers the same faults
/// every time. `now` is the clock of the board's bench. Throws InvalidInput for an option that is unknown or no number.
[[nodiscard]] std::unique_ptr<Transport> makeSimulatedTransport(std::shared_ptr<SimulatedBoard> board,
                                                                const SimulatedAddress& address,
                                                                Transport::Events events,
                                                                std::function<Microseconds()> now);

/// Why a board cannot be opened with such faults; empty where it can.
[[nodiscard]] std::optional<LinkTrouble> simulatedTrouble(const std::string& board, const BoardFaults& faults);

} // namespace lumorph

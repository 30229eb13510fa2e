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

/// The wire to a simulated board. It can be unplugged, busy, forbidden and stalled as the board's faults say; what the
/// board itself does to bytes (noise, drop, jitter, silence) is done already. The address may add faults of the wire:
/// `jitter` in milliseconds, `drop` and `noise` as shares of bytes. The same traffic suffers them the same way. `now`
/// is the clock of the board's bench. Throws InvalidInput for an option that is unknown or no number.
[[nodiscard]] std::unique_ptr<Transport> makeSimulatedTransport(std::shared_ptr<SimulatedBoard> board,
                                                                const SimulatedAddress& address,
                                                                Transport::Events events,
                                                                std::function<Microseconds()> now);

/// Why a board cannot be opened with such faults; empty where it can.
[[nodiscard]] std::optional<LinkTrouble> simulatedTrouble(const std::string& board, const BoardFaults& faults);

} // namespace lumorph

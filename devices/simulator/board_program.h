#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/clock.h"
#include "devices/simulator/servo_bank.h"

namespace lumorph {

/// What a board's program has its hands on.
struct BoardHardware {
    ServoBank servos;
    double volts = 0.0;
    std::vector<std::vector<std::uint8_t>> said; ///< messages for the studio, oldest first
};

/// The program of a simulated board: its end of the protocol, written from the protocol's documents alone, so that it
/// can be the judge of the studio's end. It is made when the board has started, and gone when the power fails.
class BoardProgram {
public:
    virtual ~BoardProgram() = default;
    /// It has started anew while the link was open.
    virtual void greet() {}
    /// Bytes of any cut and any content; of a HID device one report.
    virtual void receive(std::span<const std::uint8_t> bytes, Microseconds now) = 0;
    /// When it wants to be woken; after wake() that is later.
    [[nodiscard]] virtual std::optional<Microseconds> alarm() const = 0;
    virtual void wake(Microseconds now) = 0;
};

/// Our firmware, Firmata 2.5: pins 2 to 13 are servos. A pulse that is set before its servo is attached is used then;
/// half a second of silence detaches all; it tells its battery's voltage. Outlived by `hardware`, as all of these.
[[nodiscard]] std::unique_ptr<BoardProgram> makeTabletProgram(BoardHardware& hardware);
/// StandardFirmata 2.5: servos jump to the middle on attach, and nothing watches over them.
[[nodiscard]] std::unique_ptr<BoardProgram> makeStandardFirmataProgram(BoardHardware& hardware);
/// LewanSoul xArm with bus servos 1 to 6, whose 0 to 1000 are told as pulses of 500 to 2500 us.
[[nodiscard]] std::unique_ptr<BoardProgram> makeLewansoulProgram(BoardHardware& hardware);
/// Pololu Maestro with device number 12.
[[nodiscard]] std::unique_ptr<BoardProgram> makeMaestroProgram(BoardHardware& hardware);

} // namespace lumorph

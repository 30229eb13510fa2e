#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/clock.h"

namespace lumorph {

/// What a user of the simulator's panel can do to a board.
struct BoardFaults {
    bool unplugged = false;
    bool silent = false;    ///< it is there but does not answer
    bool busy = false;      ///< another program has it
    bool forbidden = false; ///< this user may not open it
    bool nameless = false;  ///< its USB adapter does not say what it is; heeded when the link is opened
    bool stalled = false;   ///< the link takes bytes but passes nothing on
    double noise = 0.0;     ///< share of bytes that arrive broken, both ways
    double drop = 0.0;      ///< share of bytes that are lost, both ways
    double jitterMilliseconds = 0.0;
    double volts = 7.4;                ///< of its battery
    std::optional<std::size_t> held{}; ///< a hand holds the horn of this servo, in the order of `servos`
    bool operator==(const BoardFaults&) const = default;
};

/// One servo on a simulated board, with the truth about it.
struct SimulatedServo {
    double pulse = 0.0;       ///< microseconds that it gets now; 0: none
    double position = 1500.0; ///< where its horn is, microseconds of pulse that would hold it there
    double fastest = 0.0;     ///< microseconds a second: greatest speed of the pulse's changes while attached
    double largestJump = 0.0; ///< microseconds between the position and the first pulse on attach
};

/// A servo controller that speaks its protocol byte by byte and moves servos that have mass. Any thread.
class SimulatedBoard {
public:
    virtual ~SimulatedBoard() = default;
    [[nodiscard]] virtual std::string name() const = 0;    ///< as in `sim://NAME`
    [[nodiscard]] virtual std::string product() const = 0; ///< what it calls itself
    [[nodiscard]] virtual BoardFaults faults() const = 0;
    virtual void setFaults(const BoardFaults& faults) = 0;
    /// False while a board whose USB is its own starts anew: the system does not see it then.
    [[nodiscard]] virtual bool present() const { return true; }
    /// Brown-out: servos go limp, all state is lost, and it starts anew (Firmata says so unasked).
    virtual void reboot() = 0;
    /// In the order of the board's numbers: pins from 2 (`tablet`, `uno`), ids from 1 (`xarm`), channels from 0
    /// (`maestro`).
    [[nodiscard]] virtual std::vector<SimulatedServo> servos() const = 0;

    // For the transport: the far end of the wire. Times are of the bench's clock.
    virtual void plugged(Microseconds now) = 0;                                   ///< a link was opened
    virtual void take(std::span<const std::uint8_t> bytes, Microseconds now) = 0; ///< bytes from the studio
    [[nodiscard]] virtual std::vector<std::uint8_t> give(Microseconds now) = 0;   ///< bytes for the studio that are due
    [[nodiscard]] virtual bool isHid() const = 0; ///< `give` gives one 64-byte report at a time
};

/// All simulated boards. Outlives every link to them.
class SimulatedBench {
public:
    /// Holds the boards `tablet` (our firmware's Firmata, six servos or more), `uno` (stock StandardFirmata, which
    /// jumps on attach), `xarm` (LewanSoul over HID, reads positions) and `maestro`.
    explicit SimulatedBench(std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>());
    ~SimulatedBench();

    [[nodiscard]] std::vector<std::string> names() const;
    /// Empty where there is none of that name.
    [[nodiscard]] std::shared_ptr<SimulatedBoard> board(const std::string& name) const;
    [[nodiscard]] Microseconds now() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph

#pragma once

#include <atomic>
#include <string>
#include <string_view>
#include <thread>

#include "app/table/table.h"
#include "devices/simulator/board_at_port.h"

namespace lumorph::table {

/// The table's servos: a simulated board at a pseudo-terminal, whose horns move the device by the true curves, with
/// play and lag. Looks 200 times a second.
class ServoPort {
public:
    /// `table` outlives it. Throws DeviceError where there is no pseudo-terminal.
    explicit ServoPort(Table& table);

    [[nodiscard]] std::string address() const { return board_.address(); }
    enum class Fault { none, jammed, reversed };
    /// Of the second servo.
    void setFault(Fault fault) { fault_ = fault; }
    /// Its power fails for a moment.
    void reboot() { board_.board()->reboot(); }

private:
    void follow(const std::stop_token& stop);

    Table& table_;
    BoardAtPort board_{"tablet"};
    std::atomic<Fault> fault_{Fault::none};
    std::jthread thread_;
};

} // namespace lumorph::table

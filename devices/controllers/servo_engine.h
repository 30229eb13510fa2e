#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/clock.h"
#include "devices/controllers/servo_input.h"
#include "devices/controllers/servo_link_status.h"

namespace lumorph {

/// What a ServoEngine wants done, in order.
namespace servo_output {
struct Write {
    std::vector<std::uint8_t> bytes; ///< a whole message
    bool moves = false;              ///< the last of those that tell servos something new
    bool urgent = false;             ///< what waits unsent is dropped before it
};
struct Reach { ///< the link leads elsewhere from now on; it is closed
    std::string address;
};
struct Open {
    std::string identity; ///< of the device that is meant; empty: whatever is there
};
struct Close {};
struct Drop { ///< the device does not answer: close the link and open it anew
    LinkTrouble why;
};
struct Tell {
    LinkEvent event;
};
} // namespace servo_output

using ServoOutput = std::variant<servo_output::Write, servo_output::Reach, servo_output::Open, servo_output::Close,
                                 servo_output::Drop, servo_output::Tell>;

/// A device with its servos as a machine: controller, guard, and all that is decided between a link and its user. It
/// does no I/O and knows no time but that of its inputs: the same inputs with the same times, or all of them shifted by
/// the same time, give the same outputs bit for bit. Times may run back.
class ServoEngine {
public:
    /// Another number where the same inputs may give other bytes: a trace is of one version.
    static constexpr std::uint8_t kVersion = 5;

    /// Throws as checkProfile, parseDeviceAddress and makeController.
    explicit ServoEngine(const DeviceProfile& profile);
    ~ServoEngine();

    /// Throws nothing where a new profile is sound.
    void take(const ServoInput& input, Microseconds now);
    /// What it wants done since it was asked last.
    [[nodiscard]] std::vector<ServoOutput> takeOutput();

    [[nodiscard]] LinkStatus status() const; ///< without what only the link can measure
    /// Servos are on their way, or start.
    [[nodiscard]] bool moves() const noexcept;
    [[nodiscard]] bool live() const noexcept;
    /// What lets the servos go, while one is under power or may be.
    [[nodiscard]] std::optional<ServoRelease> release() const;
    /// What the link and the profile allow between two commands.
    [[nodiscard]] Microseconds commandPeriod() const;
    /// A tick is wanted no later than so.
    [[nodiscard]] Microseconds pause() const;
    /// A tick would do nothing, and need not be told.
    [[nodiscard]] bool idle() const noexcept;
    /// After the order to quit: all is closed.
    [[nodiscard]] bool done() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph

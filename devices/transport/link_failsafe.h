#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "core/base/clock.h"
#include "devices/transport/transport.h"

namespace lumorph {

/// A process of its own (failsafe_program.cpp) that holds a copy of a link's descriptor, and lets the servos go where
/// this program cannot any more: when it has ended, whatever ended it, or when no beat came for a second. It writes
/// nothing else. Lives in the link's thread; nothing here waits, but for the destructor.
class LinkFailsafe {
public:
    /// Starts the process; `runs` says whether it could be.
    LinkFailsafe(const SharedLink& link, const std::filesystem::path& program);
    /// Ends it: at once where no servo is under power by the last `setRelease`, else it lets them go first. Waits, at
    /// most 0.2 s, until the process has closed the device.
    ~LinkFailsafe();
    LinkFailsafe(const LinkFailsafe&) = delete;
    LinkFailsafe& operator=(const LinkFailsafe&) = delete;

    /// False, too, once it has ended by itself.
    [[nodiscard]] bool runs() const noexcept;
    /// Messages that let all servos go, and the pause between two times that they are written. None: no servo is under
    /// power. To be told before the first pulse is written.
    void setRelease(const std::vector<std::vector<std::uint8_t>>& messages, Microseconds gap);
    /// The thread that drives the servos works, and would obey a STOP. Call it often; one in 0.1 s is passed on while a
    /// servo is under power.
    void beat(Microseconds now);
    /// Whether it has let the servos go, because no beat came, since this was asked last.
    [[nodiscard]] bool takeLetGo();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Beside the program that runs.
[[nodiscard]] std::filesystem::path failsafeProgram();

} // namespace lumorph

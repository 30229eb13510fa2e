#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "devices/controllers/servo_input.h"
#include "devices/controllers/servo_link.h"
#include "devices/controllers/servo_trace_log.h"

namespace lumorph {

/// What was asked for, and how many times STOP had been pressed before.
struct LinkRequest {
    ServoInput input;
    std::uint64_t stops = 0;
};

/// Everything that was asked for since the worker looked last.
struct LinkOrders {
    std::vector<LinkRequest> requests;
    std::optional<std::vector<double>> command;
    std::uint64_t commandStops = 0;         ///< as LinkRequest::stops
    Microseconds commandedAt{0};            ///< by the steady clock, of the first command that was not taken yet
    bool quit = false;                      ///< to rest, detach, close
    std::vector<ServoTraceLog::Sink> sinks; ///< of the trace, one after the other
};

/// The part of a ServoLink that lives in its thread, which runs a Qt event loop: it brings bytes and time to a
/// ServoEngine, and does what that wants done. Nothing in it waits.
class LinkWorker {
public:
    struct Events {
        std::function<void(LinkEvent)> tell;
        std::function<void(LinkStatus)> publish;
    };
    LinkWorker(const DeviceProfile& profile, const LinkOptions& options, Events events);
    ~LinkWorker();

    /// All servos are detached, before anything else.
    void stop();
    /// Does what was ordered and what is due. Call it when there are orders, and after `pause` at the latest.
    void work(LinkOrders orders);
    [[nodiscard]] Microseconds pause() const;
    /// After an order to quit: all is closed.
    [[nodiscard]] bool done() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "devices/controllers/servo_link.h"
#include "devices/transport/address.h"

namespace lumorph {

/// What ServoLink's user asks for, besides strokes and STOP, which have ways of their own.
namespace link_request {
struct Connect {};
struct Disconnect {};
struct Confirm {};
struct Arm {
    bool jumpAllowed = false;
};
struct Disarm {};
struct Wiggle {
    std::size_t servo = 0;
};
struct Slow {
    bool on = false;
};
struct Profile {
    DeviceProfile profile;
};
} // namespace link_request
using LinkRequest =
    std::variant<link_request::Connect, link_request::Disconnect, link_request::Confirm, link_request::Arm,
                 link_request::Disarm, link_request::Wiggle, link_request::Slow, link_request::Profile>;

/// Everything that was asked for since the worker looked last.
struct LinkOrders {
    bool stop = false; ///< comes before all else; what was asked before it, and moves, has been taken out
    std::vector<LinkRequest> requests;
    std::optional<std::vector<double>> command;
    Microseconds commandedAt{0}; ///< by the steady clock, of the first command that was not taken yet
    bool quit = false;           ///< to rest, detach, close
};

/// The part of a ServoLink that lives in its thread, which runs a Qt event loop: link, controller and guard. Nothing in
/// it waits.
class LinkWorker {
public:
    struct Events {
        std::function<void(LinkEvent)> tell;
        std::function<void(LinkStatus)> publish;
    };
    LinkWorker(const DeviceProfile& profile, const LinkOptions& options, Events events);
    ~LinkWorker();

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

#include "devices/transport/link_keeper.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "devices/transport/port_access.h"

namespace lumorph {

namespace {

constexpr Microseconds kFirstPause{200'000};
constexpr Microseconds kLongestPause{2'000'000};
constexpr Microseconds kReturnLook{100'000}; // between two looks for the device's return
constexpr Microseconds kSettle{100'000};     // a new node gets its permissions a moment after it appears

/// Pauses between attempts: 0.2 s, doubling, at most 2 s.
struct Backoff {
    Microseconds pause{0};

    Microseconds next() {
        pause = pause.count() == 0 ? kFirstPause : std::min(2 * pause, kLongestPause);
        return pause;
    }
    void reset() { pause = Microseconds{0}; }
};

} // namespace

struct LinkKeeper::Data {
    enum class State { stopped, waiting, opening, open };

    DeviceAddress address;
    Events events;
    LinkWorld world;
    State state = State::stopped;
    std::unique_ptr<Transport> transport;
    std::vector<std::unique_ptr<Transport>> retired; ///< one of them may have called us
    DeviceAddress at;                                ///< where `transport` leads
    PortMemory memory;
    std::string expected; ///< serial number of the device
    Backoff backoff;
    bool heard = false; ///< the device has said something since the link was opened
    std::optional<Microseconds> due;
    Microseconds looked{0};
    std::string seen;
    std::optional<LinkTrouble> trouble;

    void attempt(Microseconds now);
    std::optional<DeviceAddress> whereIsIt();
    void leadTo(const DeviceAddress& place);
    void letGo();
    void onOpened();
    void onReceived(std::span<const std::uint8_t> bytes);
    void lose(const LinkTrouble& why);
    void lookForReturn(Microseconds now);
};

void LinkKeeper::Data::attempt(Microseconds now) {
    looked = now;
    seen = world.sight(address);
    state = State::opening;
    due.reset();
    heard = false;
    try {
        if (const std::optional<DeviceAddress> place = whereIsIt()) {
            leadTo(*place);
            transport->open();
        } else {
            lose(notThere(std::get<SerialAddress>(address).path));
        }
    } catch (const Error& error) {
        lose({error.why(), error.remedy()});
    }
}

std::optional<DeviceAddress> LinkKeeper::Data::whereIsIt() {
    const auto* serial = std::get_if<SerialAddress>(&address);
    if (!serial) return address;
    if (memory.isEmpty()) {
        if (expected.empty()) return address;
        const std::string path = portOf(expected, world.serialPorts()).value_or(serial->path);
        return SerialAddress{path == realPath(serial->path) ? serial->path : path, serial->baud};
    }
    const std::optional<std::string> path = memory.find(serial->path, world.serialPorts());
    if (!path) return std::nullopt;
    return SerialAddress{*path, serial->baud};
}

void LinkKeeper::Data::leadTo(const DeviceAddress& place) {
    if (transport && at == place) return;
    letGo();
    transport = world.makeTransport(place, {[this] { onOpened(); }, [this](auto bytes) { onReceived(bytes); },
                                            [this](const LinkTrouble& why) { lose(why); }});
    at = place;
}

void LinkKeeper::Data::letGo() {
    if (!transport) return;
    transport->close();
    retired.push_back(std::move(transport));
}

void LinkKeeper::Data::onOpened() {
    state = State::open;
    trouble.reset();
    if (const auto* serial = std::get_if<SerialAddress>(&at)) memory.remember(serial->path, world.serialPorts());
    events.opened();
}

void LinkKeeper::Data::onReceived(std::span<const std::uint8_t> bytes) {
    // A port that opens but says nothing is no success: the pauses go on growing.
    if (!heard) backoff.reset();
    heard = true;
    events.received(bytes);
}

void LinkKeeper::Data::lose(const LinkTrouble& why) {
    const bool wasOpen = state == State::open;
    const bool isNew = wasOpen || trouble != why;
    // Nodes may have come and gone while nobody looked.
    if (wasOpen) seen = world.sight(address);
    state = State::waiting;
    due.reset();
    trouble = why;
    if (isNew) events.lost(why);
}

void LinkKeeper::Data::lookForReturn(Microseconds now) {
    if (now - looked < kReturnLook) return;
    looked = now;
    std::string sight = world.sight(address);
    if (sight == seen) return;
    seen = std::move(sight);
    backoff.reset();
    due = std::min(*due, now + kSettle);
}

LinkKeeper::LinkKeeper(DeviceAddress address, Events events, LinkWorld world) : data_(std::make_unique<Data>()) {
    data_->address = std::move(address);
    data_->events = std::move(events);
    data_->world = std::move(world);
}

LinkKeeper::~LinkKeeper() { stop(); }

void LinkKeeper::start(Microseconds now, std::string identity) {
    if (data_->state != Data::State::stopped) return;
    data_->expected = std::move(identity);
    // Its user may have put another device in its place.
    data_->letGo();
    data_->memory.forget();
    data_->backoff.reset();
    data_->trouble.reset();
    data_->attempt(now);
}

void LinkKeeper::stop() {
    data_->state = Data::State::stopped;
    data_->trouble.reset();
    if (data_->transport) data_->transport->close();
}

void LinkKeeper::tick(Microseconds now) {
    Data& data = *data_;
    data.retired.clear();
    if (data.state != Data::State::waiting) return;
    if (!data.due) {
        data.due = now + data.backoff.next();
        data.looked = now;
    }
    data.lookForReturn(now);
    if (now >= *data.due) data.attempt(now);
}

void LinkKeeper::drop(const LinkTrouble& why, Microseconds now) {
    if (data_->state == Data::State::stopped) return;
    if (data_->transport) data_->transport->close();
    data_->lose(why);
    if (data_->state == Data::State::waiting) data_->due = now + data_->backoff.next();
}

void LinkKeeper::write(std::span<const std::uint8_t> message) {
    if (isOpen()) data_->transport->write(message);
}

void LinkKeeper::dropUnsent() {
    if (isOpen()) data_->transport->dropUnsent();
}

bool LinkKeeper::isOpen() const { return data_->state == Data::State::open; }

std::size_t LinkKeeper::unsent() const { return isOpen() ? data_->transport->unsent() : 0; }

std::string LinkKeeper::identity() const { return data_->transport ? data_->transport->identity() : std::string{}; }

std::string LinkKeeper::product() const { return data_->transport ? data_->transport->product() : std::string{}; }

SharedLink LinkKeeper::shared() const { return isOpen() ? data_->transport->shared() : SharedLink{}; }

std::optional<LinkTrouble> LinkKeeper::trouble() const { return isOpen() ? std::nullopt : data_->trouble; }

} // namespace lumorph

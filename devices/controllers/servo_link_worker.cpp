#include "devices/controllers/servo_link_worker.h"

#include <algorithm>
#include <deque>
#include <limits>
#include <utility>

#include "devices/controllers/servo_engine.h"
#include "devices/controllers/servo_link_traffic.h"
#include "devices/simulator/simulated_bench.h"
#include "devices/transport/link_failsafe.h"
#include "devices/transport/link_keeper.h"

namespace lumorph {
namespace {

constexpr Microseconds kHandPause{50'000}; // also of a link that is off
constexpr std::size_t kRowsAtOnce = 2000;  // of the trace: a long history must not hold up a STOP
constexpr Microseconds kFailsafeAgain{2'000'000};
constexpr Microseconds kQuitAtLast{4'000'000}; // by the steady clock, whatever the engine's may do

Microseconds steadyNow() { return SteadyClock{}.now(); }

} // namespace

struct LinkWorker::Data {
    Data(const DeviceProfile& profile, const LinkOptions& theOptions, Events theEvents)
        : options(theOptions), events(std::move(theEvents)), engine(profile) {
        reach(profile.address);
        trace.made(profile, now());
    }

    LinkOptions options;
    Events events;
    DeviceAddress address;
    std::unique_ptr<LinkKeeper> keeper;
    std::unique_ptr<LinkFailsafe> failsafe; ///< while the link is open; goes before it
    std::optional<Microseconds> failsafeTried;
    ServoEngine engine;
    ServoTraceLog trace;
    LinkTraffic traffic;
    std::deque<ServoOutput> todo;
    bool doing = false;
    std::optional<Microseconds> quitBy;

    void reach(const std::string& uri);
    [[nodiscard]] Microseconds now() const;
    void take(const ServoInput& input);
    void command(std::vector<double> strokes, Microseconds at);
    void passTime();
    void startFailsafe();
    void listenToFailsafe();
    void keepFailsafe();
    void armFailsafe();
    void tellFailsafe();

    void perform(const servo_output::Write& write);
    void perform(const servo_output::Reach& place) { reach(place.address); }
    void perform(const servo_output::Open& open) { keeper->start(now(), open.identity); }
    void perform(const servo_output::Close&) {
        // All that could be done to let servos go was done.
        if (failsafe) failsafe->setRelease({}, {});
        failsafe.reset();
        keeper->stop();
    }
    void perform(const servo_output::Drop& drop) {
        failsafe.reset();
        keeper->drop(drop.why, now());
    }
    void perform(const servo_output::Tell& tell) { events.tell(tell.event); }

    [[nodiscard]] LinkStatus status();
};

void LinkWorker::Data::reach(const std::string& uri) {
    failsafe.reset();
    address = parseDeviceAddress(uri);
    LinkKeeper::Events told;
    told.opened = [this] {
        startFailsafe();
        take(servo_input::Opened{keeper->product(), keeper->identity()});
    };
    told.received = [this](std::span<const std::uint8_t> bytes) {
        if (options.onWire) options.onWire(bytes, false);
        take(servo_input::Received{{bytes.begin(), bytes.end()}});
    };
    told.lost = [this](const LinkTrouble& why) {
        failsafe.reset();
        take(servo_input::Lost{why});
    };
    keeper = std::make_unique<LinkKeeper>(address, std::move(told), options.bench);
}

void LinkWorker::Data::startFailsafe() {
    failsafeTried = steadyNow();
    failsafe.reset();
    const SharedLink shared = keeper->shared();
    if (shared.descriptor < 0) return;
    failsafe = std::make_unique<LinkFailsafe>(shared, options.failsafeProgram.empty() ? failsafeProgram()
                                                                                      : options.failsafeProgram);
    tellFailsafe();
}

/// Before anything else is written: what it let go is not driven on.
void LinkWorker::Data::listenToFailsafe() {
    if (failsafe && failsafe->takeLetGo()) take(servo_input::Released{});
}

/// One that has ended is started again.
void LinkWorker::Data::keepFailsafe() {
    if (!failsafe) return;
    failsafe->beat(steadyNow());
    if (!failsafe->runs() && steadyNow() - *failsafeTried >= kFailsafeAgain) startFailsafe();
}

/// Before a servo gets its first pulse.
void LinkWorker::Data::armFailsafe() {
    if (!failsafe) return;
    if (const std::optional<ServoRelease> release = engine.release())
        failsafe->setRelease(release->messages, release->gap);
}

/// When all was written: none may have a pulse any more.
void LinkWorker::Data::tellFailsafe() {
    armFailsafe();
    if (failsafe && !engine.release()) failsafe->setRelease({}, {});
}

/// A simulated board and the link to it live in the same time.
Microseconds LinkWorker::Data::now() const {
    if (options.bench && std::holds_alternative<SimulatedAddress>(address)) return options.bench->now();
    return steadyNow();
}

/// What it wants done is done in order, also where doing it makes the link tell something at once.
void LinkWorker::Data::take(const ServoInput& input) {
    const Microseconds time = now();
    trace.took(input, time);
    engine.take(input, time);
    std::vector<std::uint8_t> sent;
    for (ServoOutput& output : engine.takeOutput()) {
        if (const auto* write = std::get_if<servo_output::Write>(&output))
            sent.insert(sent.end(), write->bytes.begin(), write->bytes.end());
        todo.push_back(std::move(output));
    }
    if (!sent.empty()) trace.sent(std::move(sent), time);
    armFailsafe();
    if (std::exchange(doing, true)) return;
    try {
        while (!todo.empty()) {
            const ServoOutput next = std::move(todo.front());
            todo.pop_front();
            std::visit([this](const auto& output) { perform(output); }, next);
        }
    } catch (...) {
        todo.clear(); // a STOP must not wait behind what has failed
        doing = false;
        throw;
    }
    doing = false;
    tellFailsafe();
}

void LinkWorker::Data::perform(const servo_output::Write& write) {
    if (write.urgent) keeper->dropUnsent();
    keeper->write(write.bytes);
    if (options.onWire) options.onWire(write.bytes, true);
    if (write.moves) traffic.wrote(steadyNow(), engine.commandPeriod());
}

void LinkWorker::Data::command(std::vector<double> strokes, Microseconds at) {
    const bool moving = engine.moves();
    take(servo_input::Command{std::move(strokes)});
    // From a standstill it is the acceleration that takes its time, not the link.
    if (moving && engine.live()) traffic.commanded(at);
}

void LinkWorker::Data::passTime() {
    keeper->tick(now());
    if (!engine.idle()) take(servo_input::Tick{keeper->unsent()});
    if (!engine.moves()) traffic.settled();
}

LinkStatus LinkWorker::Data::status() {
    LinkStatus status = engine.status();
    status.commandsPerSecond = traffic.perSecond(steadyNow());
    status.latencyMilliseconds = traffic.medianMilliseconds();
    if (keeper->isOpen() && !std::holds_alternative<SimulatedAddress>(address))
        status.failsafe = !failsafe          ? LinkFailsafeState::notShared
                          : failsafe->runs() ? LinkFailsafeState::runs
                                             : LinkFailsafeState::missing;
    return status;
}

LinkWorker::LinkWorker(const DeviceProfile& profile, const LinkOptions& options, Events events)
    : data_(std::make_unique<Data>(profile, options, std::move(events))) {}

LinkWorker::~LinkWorker() = default;

void LinkWorker::stop() { data_->take(servo_input::Stop{}); }

void LinkWorker::work(LinkOrders orders) {
    Data& data = *data_;
    data.listenToFailsafe();
    for (ServoTraceLog::Sink& sink : orders.sinks) data.trace.setSink(std::move(sink));
    for (const LinkRequest& request : orders.requests) data.take(request.input);
    if (orders.command) data.command(std::move(*orders.command), orders.commandedAt);
    if (orders.quit) {
        data.quitBy = steadyNow() + kQuitAtLast;
        data.take(servo_input::Quit{});
    }
    data.passTime();
    data.keepFailsafe();
    data.trace.hand(done() ? std::numeric_limits<std::size_t>::max() : kRowsAtOnce);
    data.events.publish(data.status());
}

Microseconds LinkWorker::pause() const {
    const Microseconds pause = data_->engine.pause();
    return data_->trace.hasMore() ? std::min(pause, kHandPause) : pause;
}

bool LinkWorker::done() const { return data_->engine.done() || (data_->quitBy && steadyNow() >= *data_->quitBy); }

} // namespace lumorph

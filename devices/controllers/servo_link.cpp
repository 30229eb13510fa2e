#include "devices/controllers/servo_link.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <type_traits>
#include <utility>

#include <QObject>
#include <QThread>
#include <QTimer>

#include "core/base/error.h"
#include "devices/controllers/servo_link_worker.h"
#include "devices/transport/address.h"

namespace lumorph {
namespace {

constexpr std::size_t kMostEvents = 1000;
constexpr Microseconds kTellChange{33'000}; // a window need not know more often

void checkAll(const DeviceProfile& profile) {
    checkProfile(profile);
    (void)makeController(profile, parseDeviceAddress(profile.address));
}

/// STOP takes back what was asked before it and would move something.
bool movesSomething(const ServoInput& request) {
    return std::holds_alternative<servo_input::Arm>(request) || std::holds_alternative<servo_input::Wiggle>(request);
}

} // namespace

struct ServoLink::Data {
    explicit Data(DeviceProfile its, LinkOptions theOptions)
        : options(std::move(theOptions)), profile(std::move(its)) {}

    const LinkOptions options;

    std::mutex mutex; ///< held for moments only, never while anything waits
    DeviceProfile profile;
    LinkOrders orders;
    LinkStatus status;
    std::vector<LinkEvent> events;
    bool woken = false;

    QThread thread;
    QObject here; ///< lives in the thread

    // Of the thread alone.
    std::unique_ptr<LinkWorker> worker;
    std::unique_ptr<QTimer> timer;
    std::optional<LinkPhase> toldPhase;
    Microseconds toldAt{0};
    bool eventsToTell = false;

    void begin() {
        timer = std::make_unique<QTimer>();
        timer->setTimerType(Qt::PreciseTimer);
        timer->setSingleShot(true);
        timer->callOnTimeout([this] { work(); });
        worker = std::make_unique<LinkWorker>(profileNow(), options,
                                              LinkWorker::Events{[this](LinkEvent event) { keep(std::move(event)); },
                                                                 [this](LinkStatus now) { publish(std::move(now)); }});
        work();
    }
    void work() {
        if (!worker) return;
        try {
            worker->work(takeOrders());
        } catch (const std::exception& error) {
            keep({{},
                  LinkEvent::Kind::failure,
                  std::string("The link has failed: ") + error.what() + ".",
                  "Servos were stopped; connect the device again."});
            LinkOrders stop;
            stop.stop = true;
            worker->work(std::move(stop));
        }
        if (worker->done()) {
            worker.reset();
            timer.reset();
            thread.quit();
            return;
        }
        timer->start(std::chrono::duration_cast<std::chrono::milliseconds>(worker->pause()));
    }
    /// Whatever fails in the thread is told; servos are stopped then.
    template <typename Work> bool tried(Work work) {
        try {
            work();
            return true;
        } catch (const std::exception& error) {
            keep({SteadyClock{}.now(), LinkEvent::Kind::failure, std::string("The link has failed: ") + error.what(),
                  "Servos were stopped; connect the device again."});
            return false;
        }
    }
    [[nodiscard]] DeviceProfile profileNow() {
        const std::scoped_lock lock(mutex);
        return profile;
    }
    [[nodiscard]] LinkOrders takeOrders() {
        const std::scoped_lock lock(mutex);
        woken = false;
        return std::exchange(orders, {});
    }
    void keep(LinkEvent event) {
        const std::scoped_lock lock(mutex);
        if (events.size() >= kMostEvents) events.erase(events.begin());
        events.push_back(std::move(event));
        eventsToTell = true;
    }
    void publish(LinkStatus now) {
        const Microseconds time = SteadyClock{}.now();
        const bool isNews = eventsToTell || toldPhase != now.phase || time - toldAt >= kTellChange;
        toldPhase = now.phase;
        {
            const std::scoped_lock lock(mutex);
            status = std::move(now);
        }
        if (!isNews || !options.onChange) return;
        toldAt = time;
        eventsToTell = false;
        options.onChange();
    }

    /// Changes the orders and wakes the thread.
    template <typename Change> void order(Change change) {
        const std::scoped_lock lock(mutex);
        change(orders);
        if (std::exchange(woken, true)) return;
        QMetaObject::invokeMethod(
            &here, [this] { work(); }, Qt::QueuedConnection);
    }
    void request(ServoInput request) {
        order([&](LinkOrders& all) { all.requests.push_back(std::move(request)); });
    }
};

ServoLink::ServoLink(DeviceProfile profile, LinkOptions options) {
    checkAll(profile);
    data_ = std::make_unique<Data>(std::move(profile), std::move(options));
    Data& data = *data_;
    data.status.servos.resize(data.profile.servos.size());
    data.here.moveToThread(&data.thread);
    data.thread.start(QThread::TimeCriticalPriority);
    QMetaObject::invokeMethod(
        &data.here, [&data] { data.begin(); }, Qt::QueuedConnection);
}

ServoLink::~ServoLink() {
    data_->order([](LinkOrders& all) { all.quit = true; });
    data_->thread.wait();
}

void ServoLink::connect() { data_->request(servo_input::Connect{}); }
void ServoLink::disconnect() { data_->request(servo_input::Disconnect{}); }
void ServoLink::confirmIdentity() { data_->request(servo_input::Confirm{}); }

void ServoLink::setProfile(DeviceProfile profile) {
    checkAll(profile);
    data_->order([&](LinkOrders& all) {
        data_->profile = profile;
        // A slider gives many in a row, and only the last counts.
        if (!all.requests.empty() && std::holds_alternative<servo_input::Profile>(all.requests.back()))
            all.requests.pop_back();
        all.requests.emplace_back(servo_input::Profile{std::move(profile)});
    });
}

DeviceProfile ServoLink::profile() const { return data_->profileNow(); }

void ServoLink::arm(bool jumpAllowed) { data_->request(servo_input::Arm{jumpAllowed}); }
void ServoLink::disarm() { data_->request(servo_input::Disarm{}); }

void ServoLink::stop() {
    data_->order([](LinkOrders& all) {
        all.stop = true;
        std::erase_if(all.requests, movesSomething);
        all.command.reset();
    });
}

void ServoLink::command(std::span<const double> strokes) {
    const Microseconds now = SteadyClock{}.now();
    data_->order([&](LinkOrders& all) {
        if (!all.command) all.commandedAt = now;
        all.command.emplace(strokes.begin(), strokes.end());
    });
}

void ServoLink::wiggle(std::size_t servo) { data_->request(servo_input::Wiggle{servo}); }
void ServoLink::setSlow(bool slow) { data_->request(servo_input::Slow{slow}); }

void ServoLink::setTrace(std::function<void(const ServoTraceRow&)> sink) {
    data_->order([&](LinkOrders& all) { all.sinks.push_back(std::move(sink)); });
}

LinkStatus ServoLink::status() const {
    const std::scoped_lock lock(data_->mutex);
    return data_->status;
}

std::vector<LinkEvent> ServoLink::takeEvents() {
    const std::scoped_lock lock(data_->mutex);
    return std::exchange(data_->events, {});
}

} // namespace lumorph

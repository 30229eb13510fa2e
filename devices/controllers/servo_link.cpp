#include "devices/controllers/servo_link.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>

#include <QCoreApplication>
#include <QEvent>
#include <QObject>
#include <QThread>
#include <QTimer>

#include "core/base/error.h"
#include "core/base/thread_priority.h"
#include "devices/controllers/servo_link_worker.h"
#include "devices/transport/address.h"

namespace lumorph {
namespace {

constexpr QEvent::Type kWake = QEvent::User;
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

    /// How often STOP was pressed. It needs no lock, so that whoever floods the link with orders cannot hold it up;
    /// what was ordered before it, and moves, is told by its number.
    std::atomic<std::uint64_t> stops = 0;

    std::mutex mutex; ///< as the other, held for moments only, never while anything waits
    DeviceProfile profile;
    LinkOrders orders;
    bool woken = false;

    std::mutex toldMutex;
    LinkStatus status;
    std::vector<LinkEvent> events;

    QThread thread;

    /// What one thread hands to another by an event, or by its end, is in order: Qt locks. ThreadSanitizer does not see
    /// into Qt, so it is said here again.
    std::atomic<unsigned> handedOver = 0;
    void handOver() { handedOver.fetch_add(1, std::memory_order_release); }
    void takeOver() { (void)handedOver.load(std::memory_order_acquire); }

    /// Lives in the thread and hears what is posted to it.
    struct Ear : QObject {
        explicit Ear(Data& its) : data(its) {}
        bool event(QEvent* event) override {
            data.takeOver();
            if (event->type() != kWake) return QObject::event(event);
            data.work();
            return true;
        }
        Data& data;
    } ear{*this};

    // Of the thread alone.
    std::unique_ptr<LinkWorker> worker;
    bool begun = false;
    std::unique_ptr<QTimer> timer;
    std::optional<LinkPhase> toldPhase;
    Microseconds toldAt{0};
    std::uint64_t stopsTaken = 0;

    std::atomic<bool> eventsToTell = false;
    std::atomic<bool> isAlone = false; ///< the board is lost: no command can reach it

    void begin() {
        begun = true;
        // Boards let go of their servos when they hear nothing for half a second, however busy the machine is.
        runPromptly();
        timer = std::make_unique<QTimer>();
        timer->setTimerType(Qt::PreciseTimer);
        timer->setSingleShot(true);
        timer->callOnTimeout([this] { work(); });
        worker = std::make_unique<LinkWorker>(profileNow(), options,
                                              LinkWorker::Events{[this](LinkEvent event) { keep(std::move(event)); },
                                                                 [this](LinkStatus now) { publish(std::move(now)); }});
    }
    void work() {
        if (!begun) begin();
        if (!worker) return;
        try {
            takeStop();
            worker->work(takeOrders());
        } catch (const std::exception& error) {
            stopAfter(error);
        }
        if (worker->done()) {
            worker.reset();
            timer.reset();
            handOver();
            thread.quit();
            return;
        }
        timer->start(std::chrono::duration_cast<std::chrono::milliseconds>(worker->pause()));
    }
    /// What the link's own faults lead to; none of them may end the program, or be told better than it is.
    void stopAfter(const std::exception& error) {
        std::string remedy = "Servos were stopped; connect the device again.";
        try {
            worker->stop();
            worker->work({});
        } catch (const std::exception&) {
            remedy = "Servos may still have power: switch it off by hand, then connect the device again.";
        }
        keep({{}, LinkEvent::Kind::failure, std::string("The link has failed: ") + error.what() + ".", remedy});
    }
    [[nodiscard]] DeviceProfile profileNow() {
        const std::scoped_lock lock(mutex);
        return profile;
    }
    void takeStop() {
        if (const std::uint64_t now = stops; std::exchange(stopsTaken, now) != now) worker->stop();
    }
    /// Without those that a STOP has taken back. One that comes while the lock is held by others is taken at once.
    [[nodiscard]] LinkOrders takeOrders() {
        std::unique_lock lock(mutex, std::try_to_lock);
        while (!lock.owns_lock()) {
            takeStop();
            std::this_thread::sleep_for(std::chrono::microseconds(100)); // whoever holds it may need this processor
            (void)lock.try_lock();
        }
        woken = false;
        LinkOrders all = std::exchange(orders, {});
        lock.unlock();
        std::erase_if(all.requests, [this](const LinkRequest& request) {
            return request.stops < stopsTaken && movesSomething(request.input);
        });
        if (all.commandStops < stopsTaken) all.command.reset();
        return all;
    }
    void keep(LinkEvent event) {
        const std::scoped_lock lock(toldMutex);
        if (events.size() >= kMostEvents) events.erase(events.begin());
        events.push_back(std::move(event));
        eventsToTell = true;
    }
    void publish(LinkStatus now) {
        const Microseconds time = SteadyClock{}.now();
        isAlone = now.phase == LinkPhase::lost;
        const bool isNews = eventsToTell || toldPhase != now.phase || time - toldAt >= kTellChange;
        toldPhase = now.phase;
        {
            const std::scoped_lock lock(toldMutex);
            status = std::move(now);
        }
        if (!isNews || !options.onChange) return;
        toldAt = time;
        eventsToTell = false;
        options.onChange();
    }

    /// Changes the orders and wakes the thread, unless that has time until it looks by itself.
    template <typename Change> void order(Change change, bool hasTime = false) {
        const std::scoped_lock lock(mutex);
        change(orders);
        if (!hasTime && !std::exchange(woken, true)) wake();
    }
    void wake() {
        auto event = std::make_unique<QEvent>(kWake);
        handOver();
        QCoreApplication::postEvent(&ear, event.release());
    }
    void request(ServoInput input) {
        const std::uint64_t before = stops;
        order([&](LinkOrders& all) { all.requests.push_back({std::move(input), before}); });
    }
};

ServoLink::ServoLink(DeviceProfile profile, LinkOptions options) {
    checkAll(profile);
    data_ = std::make_unique<Data>(std::move(profile), std::move(options));
    Data& data = *data_;
    data.status.servos.resize(data.profile.servos.size());
    data.ear.moveToThread(&data.thread);
    data.thread.start();
    data.wake();
}

ServoLink::~ServoLink() { leave(); }

void ServoLink::leave() {
    data_->order([](LinkOrders& all) { all.quit = true; });
    data_->thread.wait();
    data_->takeOver();
}

void ServoLink::connect() { data_->request(servo_input::Connect{}); }
void ServoLink::disconnect() { data_->request(servo_input::Disconnect{}); }
void ServoLink::confirmIdentity() { data_->request(servo_input::Confirm{}); }

void ServoLink::setProfile(DeviceProfile profile) {
    checkAll(profile);
    data_->order([&](LinkOrders& all) {
        data_->profile = profile;
        // A slider gives many in a row, and only the last counts.
        if (!all.requests.empty() && std::holds_alternative<servo_input::Profile>(all.requests.back().input))
            all.requests.pop_back();
        all.requests.push_back({servo_input::Profile{std::move(profile)}, 0});
    });
}

DeviceProfile ServoLink::profile() const { return data_->profileNow(); }

void ServoLink::arm(bool jumpAllowed) { data_->request(servo_input::Arm{jumpAllowed}); }
void ServoLink::disarm() { data_->request(servo_input::Disarm{}); }

void ServoLink::stop() {
    ++data_->stops;
    data_->wake();
}

bool ServoLink::letGo(std::chrono::milliseconds atMost) {
    stop();
    const auto end = std::chrono::steady_clock::now() + atMost;
    for (;;) {
        const LinkStatus now = status();
        const bool driven = now.phase == LinkPhase::starting || now.phase == LinkPhase::live ||
                            std::ranges::any_of(now.servos, &ServoStatus::attached);
        if (!driven && !now.controller.detaching) return true;
        if (std::chrono::steady_clock::now() >= end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

void ServoLink::command(std::span<const double> strokes) {
    const Microseconds now = SteadyClock{}.now();
    const std::uint64_t before = data_->stops;
    data_->order(
        [&](LinkOrders& all) {
            if (!all.command) all.commandedAt = now;
            all.commandStops = before;
            all.command.emplace(strokes.begin(), strokes.end());
        },
        data_->isAlone);
}

void ServoLink::wiggle(std::size_t servo) { data_->request(servo_input::Wiggle{servo}); }
void ServoLink::setSlow(bool slow) { data_->request(servo_input::Slow{slow}); }

void ServoLink::setTrace(std::function<void(const ServoTraceRow&)> sink) {
    data_->order([&](LinkOrders& all) { all.sinks.push_back(std::move(sink)); });
}

LinkStatus ServoLink::status() const {
    const std::scoped_lock lock(data_->toldMutex);
    return data_->status;
}

std::vector<LinkEvent> ServoLink::takeEvents() {
    const std::scoped_lock lock(data_->toldMutex);
    return std::exchange(data_->events, {});
}

} // namespace lumorph

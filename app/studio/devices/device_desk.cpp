#include "app/studio/devices/device_desk_data.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr int kStatusMilliseconds = 50;
constexpr int kTestMilliseconds = 33;

bool drives(LinkPhase phase) { return phase == LinkPhase::live || phase == LinkPhase::starting; }

} // namespace

void DeviceDesk::Data::listen() {
    due.setSingleShot(true);
    due.setInterval(kStatusMilliseconds);
    poll.setInterval(kStatusMilliseconds);
    testTimer.setInterval(kTestMilliseconds);
    connect(&due, &QTimer::timeout, &desk, [this] { take(); });
    connect(&poll, &QTimer::timeout, &desk, [this] {
        if (!link) {
            if (sense()) emit desk.changed();
        } else if (!due.isActive()) {
            take();
        }
    });
    connect(&finder, &DeviceFinder::changed, &desk, &DeviceDesk::foundChanged);
    connect(&finder, &DeviceFinder::searchFailed, &desk, [this](const LinkTrouble& trouble) { tellSearch(trouble); });
    connect(&testTimer, &QTimer::timeout, &desk, [this] { tick(); });
    connect(&document, &StudioDocument::changed, &desk, [this](StateParts parts) {
        if (parts & StatePart::rig) takeRig();
    });
    // STOP is for the servos before it is for anything else.
    connect(&loop, &StudioLoop::stopOrdered, &desk, [this] {
        feed.stop();
        take();
    });
    connect(&loop, &StudioLoop::stoppedChanged, &desk, [this] { heedResume(); });
    tap = loop.addTap([this](const MatchFrame& frame) { follow(frame); });
    takeRig();
}

/// Another rig has other servos; the same one, edited, keeps its link.
void DeviceDesk::Data::takeRig() {
    const auto& now = document.state().rig.rig;
    if (now == rig) return;
    const bool same = now && rig && now->name() == rig->name() && now->actuatorCount() == profile.servos.size();
    rig = now;
    if (same) return;
    retire();
    use(rig ? freshProfile(*rig, ControllerKind::firmata) : DeviceProfile{});
    if (rig)
        if (const QString last = profiles.lastOf(*rig); !last.isEmpty()) desk.loadProfile(last);
    emit desk.profileChanged();
    take();
}

/// A hand that comes near makes servos slow before they are told where to go.
void DeviceDesk::Data::follow(const MatchFrame& frame) {
    handWatch.follow(frame);
    feed.setSlow(SlowCause::hand, handWatch.look(SteadyClock().now()));
    feed.follow(frame.estimatedStrokes);
}

void DeviceDesk::Data::use(DeviceProfile next) {
    profile = std::move(next);
    handWatch.setLimit(profile.handDistance);
}

bool DeviceDesk::Data::force(const DeviceProfile& next) {
    if (!rig) return false;
    try {
        checkProfile(next);
        if (link) link->setProfile(next);
    } catch (const Error& error) {
        notices.post("servo", noticeOf(error));
        emit desk.profileChanged(); // panels show what still holds
        return false;
    }
    notices.dismissAll("servo");
    use(next);
    emit desk.profileChanged();
    return true;
}

void DeviceDesk::Data::keep() {
    try {
        profiles.keep(profile, *rig);
    } catch (const Error& error) {
        notices.post("servo", noticeOf(error));
    }
}

/// Throws InvalidInput where the address is none.
void DeviceDesk::Data::makeLink() {
    LinkOptions options;
    options.bench = bench.get();
    options.onChange = [this] { hear(); };
    auto made = std::make_shared<ServoLink>(profile, options);
    retire();
    link = std::move(made);
    traceLink();
    feed.attach(link, profile.servos.size());
}

void DeviceDesk::Data::traceLink() {
    if (!link) return;
    if (!trace) return link->setTrace({}); // once it has handed over what it still holds
    tracing = std::make_shared<std::atomic<bool>>(true);
    link->setTrace([on = tracing, sink = trace](const ServoTraceRow& row) {
        if (*on) sink(row);
    });
}

void DeviceDesk::Data::retire() {
    feed.attach(nullptr, 0);
    std::erase_if(leaving,
                  [](const auto& one) { return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
    if (!link) return;
    takeEvents();
    if (tracing) *tracing = false; // the next one's rows may not come between
    link->setTrace({});
    leaving.push_back(std::async(std::launch::async, [old = std::exchange(link, nullptr)]() mutable {
        old->leave();
        old.reset();
    }));
    status = {};
}

void DeviceDesk::Data::leaveAll() {
    loop.removeTap(tap);
    retire();
    leaving.clear(); // waits: they call `hear`
}

void DeviceDesk::Data::hear() {
    feed.feel(SteadyClock().now());
    if (posted.exchange(true)) return;
    QMetaObject::invokeMethod(
        &desk,
        [this] {
            if (!due.isActive()) due.start();
        },
        Qt::QueuedConnection);
}

void DeviceDesk::Data::take() {
    posted = false;
    const bool wasDriven = drives(status.phase);
    takeEvents();
    const bool wasLive = status.phase == LinkPhase::live;
    status = link ? link->status() : LinkStatus{};
    if (status.phase == LinkPhase::live && !wasLive) liveSince = QDateTime::currentDateTime();
    if (drives(status.phase) && !wasDriven) {
        notices.dismissAll("device");
        knowBoard();
    }
    if (!drives(status.phase) && wasDriven) desk.endTest();
    sense();
    emit desk.changed();
}

/// Its pulses and limits are those of the board that was set up: next time another one at the same port is asked about,
/// and this one found at another port.
void DeviceDesk::Data::knowBoard() {
    if (!profile.identity.empty() || status.identity.empty()) return;
    DeviceProfile known = profile;
    known.identity = status.identity;
    desk.setProfile(known);
}

/// Whether something that is shown of hands is different.
bool DeviceDesk::Data::sense() {
    const Microseconds now = SteadyClock().now();
    feed.setSlow(SlowCause::hand, handWatch.look(now));
    const bool driven = drives(status.phase);
    const HandSense before = std::exchange(hands, HandSense{handWatch.distance(), handWatch.near(), feed.stuck(),
                                                            status.controller.traits.readsPosition && driven});
    if (driven) tellAll(handEvents(before, hands, now));
    return before != hands;
}

void DeviceDesk::Data::takeEvents() {
    if (link) tellAll(link->takeEvents());
}

void DeviceDesk::Data::tellAll(const std::vector<LinkEvent>& events) {
    for (const LinkEvent& event : events) {
        const DeviceLogLine line = lineOf(event);
        log.add(line);
        // The status line has the newest trouble, until something went well.
        if (event.kind == LinkEvent::Kind::information)
            notices.dismissAll("device");
        else
            notices.post("device", noticeOf(line, desk.name()));
    }
    if (!events.empty()) emit desk.logged(static_cast<int>(events.size()));
}

/// Servos that STOP has let go start softly, where they were live.
void DeviceDesk::Data::heedResume() {
    if (!link || loop.stopped() || !feed.takeStoppedLive()) return;
    link->arm(false);
    take();
}

void DeviceDesk::Data::tellSearch(const LinkTrouble& trouble) {
    Notice notice;
    notice.level = Notice::Level::warning;
    notice.subject = "Bluetooth";
    notice.why = QString::fromStdString(trouble.why);
    notice.remedy = QString::fromStdString(trouble.remedy);
    notices.post("devices", notice);
}

void DeviceDesk::Data::tick() {
    feed.advance(1e-3 * static_cast<double>(sinceTest.restart()));
    if (!feed.moving()) testTimer.stop();
}

DeviceDesk::DeviceDesk(Settings& settings, StudioDocument& document, StudioLoop& loop, Notices& notices)
    : data_(std::make_unique<Data>(*this, settings, document, loop, notices)) {
    data_->listen();
}

DeviceDesk::~DeviceDesk() { data_->leaveAll(); }

void DeviceDesk::leave() { data_->leaveAll(); }

SimulatedBench& DeviceDesk::bench() noexcept { return *data_->bench; }
const std::vector<FoundDevice>& DeviceDesk::found() const noexcept { return data_->finder.found(); }
bool DeviceDesk::searchingBluetooth() const noexcept { return data_->finder.searchingBluetooth(); }
const DeviceProfile& DeviceDesk::profile() const noexcept { return data_->profile; }
const LinkStatus& DeviceDesk::status() const noexcept { return data_->status; }
const std::deque<DeviceLogLine>& DeviceDesk::log() const noexcept { return data_->log.lines(); }
const QDateTime& DeviceDesk::liveSince() const noexcept { return data_->liveSince; }
const HandSense& DeviceDesk::hands() const noexcept { return data_->hands; }
bool DeviceDesk::slow() const noexcept { return data_->slow; }
QStringList DeviceDesk::profileNames() const { return data_->profiles.names(); }
std::optional<double> DeviceDesk::tested(std::size_t servo) const { return data_->feed.held(servo); }
bool DeviceDesk::testing() const { return data_->feed.testing(); }

} // namespace lumorph::studio

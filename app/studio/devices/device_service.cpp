#include "app/studio/devices/device_service_data.h"

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

void DeviceService::Data::listen() {
    due.setSingleShot(true);
    due.setInterval(kStatusMilliseconds);
    poll.setInterval(kStatusMilliseconds);
    testTimer.setInterval(kTestMilliseconds);
    connect(&due, &QTimer::timeout, &service, [this] { take(); });
    connect(&poll, &QTimer::timeout, &service, [this] {
        if (!link) {
            if (sense()) emit service.changed();
        } else if (!due.isActive()) {
            take();
        }
    });
    connect(&finder, &DeviceFinder::changed, &service, &DeviceService::foundChanged);
    connect(&finder, &DeviceFinder::searchFailed, &service,
            [this](const LinkTrouble& trouble) { tellSearch(trouble); });
    connect(&testTimer, &QTimer::timeout, &service, [this] { tick(); });
    connect(&document, &StudioDocument::changed, &service, [this](StateParts parts) {
        if (parts & (StatePart::rig | StatePart::rigEdited)) takeRig();
    });
    // STOP is for the servos before it is for anything else.
    connect(&loop, &StudioLoop::stopOrdered, &service, [this] {
        feed.stop();
        take();
    });
    connect(&loop, &StudioLoop::stoppedChanged, &service, [this] { onResumed(); });
    tap = loop.addTap([this](const MatchFrame& frame) { follow(frame); });
    takeRig();
}

/// Another rig has other servos; the same one, edited, keeps its link.
void DeviceService::Data::takeRig() {
    const auto& now = document.state().rig.rig;
    if (now == rig) return;
    const bool edited = origin && origin == document.state().rig.origin;
    const bool same =
        now && rig && (edited || now->name() == rig->name()) && now->actuatorCount() == profile.servos.size();
    rig = now;
    origin = document.state().rig.origin;
    if (same) return;
    retire();
    use(rig ? freshProfile(*rig, ControllerKind::firmata) : DeviceProfile{});
    if (rig)
        if (const QString last = profiles.lastOf(*rig); !last.isEmpty()) service.loadProfile(last);
    emit service.profileChanged();
    take();
}

/// A hand that comes near makes servos slow before they are told where to go.
void DeviceService::Data::follow(const MatchFrame& frame) {
    handWatch.follow(frame);
    feed.setSlow(SlowCause::hand, handWatch.look(SteadyClock().now()));
    feed.follow(frame.estimatedStrokes);
}

void DeviceService::Data::use(DeviceProfile next) {
    profile = std::move(next);
    handWatch.setLimit(profile.handDistance);
}

bool DeviceService::Data::force(const DeviceProfile& next) {
    if (!rig) return false;
    try {
        checkProfile(next);
        if (link) link->setProfile(next);
    } catch (const Error& error) {
        notices.post("servo", noticeOf(error));
        emit service.profileChanged(); // panels show what still holds
        return false;
    }
    notices.dismissAll("servo");
    use(next);
    emit service.profileChanged();
    return true;
}

void DeviceService::Data::keep() {
    try {
        profiles.keep(profile, *rig);
    } catch (const Error& error) {
        notices.post("servo", noticeOf(error));
    }
}

/// Throws InvalidInput where the address is none.
void DeviceService::Data::makeLink() {
    LinkOptions options;
    options.bench = bench.get();
    options.onChange = [this] { onLinkChanged(); };
    auto made = std::make_shared<ServoLink>(profile, options);
    retire();
    link = std::move(made);
    traceLink();
    feed.attach(link, profile.servos.size());
}

void DeviceService::Data::traceLink() {
    if (!link) return;
    if (!trace) return link->setTrace({}); // once it has handed over what it still holds
    tracing = std::make_shared<std::atomic<bool>>(true);
    link->setTrace([on = tracing, sink = trace](const ServoTraceRow& row) {
        if (*on) sink(row);
    });
}

void DeviceService::Data::retire() {
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

void DeviceService::Data::leaveAll() {
    loop.removeTap(tap);
    retire();
    leaving.clear(); // waits: they call `hear`
}

void DeviceService::Data::onLinkChanged() {
    feed.checkHands(SteadyClock().now());
    if (posted.exchange(true)) return;
    QMetaObject::invokeMethod(
        &service,
        [this] {
            if (!due.isActive()) due.start();
        },
        Qt::QueuedConnection);
}

void DeviceService::Data::take() {
    posted = false;
    const bool wasDriven = drives(status.phase);
    takeEvents();
    const bool wasLive = status.phase == LinkPhase::live;
    status = link ? link->status() : LinkStatus{};
    if (status.phase == LinkPhase::live && !wasLive) liveSince = QDateTime::currentDateTime();
    if (drives(status.phase) && !wasDriven) {
        notices.dismissAll("device");
        identifyBoard();
    }
    if (!drives(status.phase) && wasDriven) service.endTest();
    sense();
    emit service.changed();
}

/// Its pulses and limits are those of the board that was set up: next time another one at the same port is asked about,
/// and this one found at another port.
void DeviceService::Data::identifyBoard() {
    if (!profile.identity.empty() || status.identity.empty()) return;
    DeviceProfile known = profile;
    known.identity = status.identity;
    service.setProfile(known);
}

/// Whether something that is shown of hands is different.
bool DeviceService::Data::sense() {
    const Microseconds now = SteadyClock().now();
    feed.setSlow(SlowCause::hand, handWatch.look(now));
    const bool driven = drives(status.phase);
    const HandSense before = std::exchange(hands, HandSense{handWatch.distance(), handWatch.near(), feed.stuck(),
                                                            status.controller.traits.readsPosition && driven});
    if (driven) tellAll(handEvents(before, hands, now));
    return before != hands;
}

void DeviceService::Data::takeEvents() {
    if (link) tellAll(link->takeEvents());
}

void DeviceService::Data::tellAll(const std::vector<LinkEvent>& events) {
    for (const LinkEvent& event : events) {
        const DeviceLogLine line = lineOf(event);
        log.add(line);
        // The status line has the newest trouble, until something went well.
        if (event.kind == LinkEvent::Kind::information)
            notices.dismissAll("device");
        else
            notices.post("device", noticeOf(line, service.name()));
    }
    if (!events.empty()) emit service.logged(static_cast<int>(events.size()));
}

/// Servos that STOP has let go start softly, where they were live.
void DeviceService::Data::onResumed() {
    if (!link || loop.stopped() || !feed.takeStoppedLive()) return;
    link->arm(false);
    take();
}

void DeviceService::Data::tellSearch(const LinkTrouble& trouble) {
    Notice notice;
    notice.level = Notice::Level::warning;
    notice.subject = "Bluetooth";
    notice.why = QString::fromStdString(trouble.why);
    notice.remedy = QString::fromStdString(trouble.remedy);
    notices.post("devices", notice);
}

void DeviceService::Data::tick() {
    feed.advance(1e-3 * static_cast<double>(sinceTest.restart()));
    if (!feed.moving()) testTimer.stop();
}

DeviceService::DeviceService(Settings& settings, StudioDocument& document, StudioLoop& loop, Notices& notices)
    : data_(std::make_unique<Data>(*this, settings, document, loop, notices)) {
    data_->listen();
}

DeviceService::~DeviceService() { data_->leaveAll(); }

void DeviceService::leave() { data_->leaveAll(); }

SimulatedBench& DeviceService::bench() noexcept { return *data_->bench; }
const std::vector<FoundDevice>& DeviceService::found() const noexcept { return data_->finder.found(); }
bool DeviceService::searchingBluetooth() const noexcept { return data_->finder.searchingBluetooth(); }
const DeviceProfile& DeviceService::profile() const noexcept { return data_->profile; }
const LinkStatus& DeviceService::status() const noexcept { return data_->status; }
const std::deque<DeviceLogLine>& DeviceService::log() const noexcept { return data_->log.lines(); }
const QDateTime& DeviceService::liveSince() const noexcept { return data_->liveSince; }
const HandSense& DeviceService::hands() const noexcept { return data_->hands; }
bool DeviceService::slow() const noexcept { return data_->slow; }
QStringList DeviceService::profileNames() const { return data_->profiles.names(); }
std::optional<double> DeviceService::tested(std::size_t servo) const { return data_->feed.held(servo); }
bool DeviceService::testing() const { return data_->feed.testing(); }

} // namespace lumorph::studio

#include "app/studio/devices/device_desk.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <limits>
#include <utility>

#include <QElapsedTimer>
#include <QTimer>

#include "app/studio/devices/device_finder.h"
#include "app/studio/devices/rig_profiles.h"
#include "app/studio/devices/servo_feed.h"
#include "core/base/error.h"
#include "devices/controllers/controller_kinds.h"
#include "devices/simulator/simulated_bench.h"
#include "devices/transport/address.h"

namespace lumorph::studio {
namespace {

constexpr int kStatusMilliseconds = 50;
constexpr int kTestMilliseconds = 33;

bool drives(LinkPhase phase) { return phase == LinkPhase::live || phase == LinkPhase::starting; }

} // namespace

struct DeviceDesk::Data {
    Data(DeviceDesk& owner, Settings& hisSettings, StudioDocument& openDocument, StudioLoop& hisLoop,
         Notices& allNotices)
        : desk(owner), document(openDocument), loop(hisLoop), notices(allNotices), profiles(hisSettings) {}

    void listen();
    void follow(const MatchFrame& frame); ///< in the loop's thread
    void takeRig();
    void use(DeviceProfile next);
    bool force(const DeviceProfile& next);
    void keep();
    void makeLink();
    void traceLink();
    void retire();
    void hear(); ///< in the link's thread
    void take();
    void takeEvents();
    void tellAll(const std::vector<LinkEvent>& events);
    void heedStop();
    bool sense();
    void tellSearch(const LinkTrouble& trouble);
    void tick();

    DeviceDesk& desk;
    StudioDocument& document;
    StudioLoop& loop;
    Notices& notices;
    RigProfiles profiles;
    std::unique_ptr<SimulatedBench> bench = std::make_unique<SimulatedBench>();
    std::shared_ptr<const Rig> rig;
    DeviceProfile profile;
    HandWatch handWatch;
    HandSense hands;
    ServoFeed feed;
    int tap = 0;
    std::function<void(const ServoTraceRow&)> trace;
    std::shared_ptr<std::atomic<bool>> tracing; ///< false for a link that is no longer the present one
    std::unique_ptr<ServoLink> link;
    std::vector<std::future<void>> leaving; ///< links that go to rest; waiting for them would block the window
    LinkStatus status;
    DeviceFinder finder{*bench};
    DeviceLog log;
    std::atomic<bool> posted = false; ///< the window has been told of a change that it did not take yet
    QTimer due, poll, testTimer;
    QElapsedTimer sinceTest;
    QDateTime liveSince;
    bool slow = false;
};

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
    connect(&loop, &StudioLoop::stoppedChanged, &desk, [this] { heedStop(); });
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
    auto made = std::make_unique<ServoLink>(profile, options);
    retire();
    link = std::move(made);
    traceLink();
    feed.attach(link.get(), profile.servos.size());
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
    leaving.push_back(
        std::async(std::launch::async, [old = std::shared_ptr<ServoLink>(std::move(link))]() mutable { old.reset(); }));
    status = {};
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
    if (drives(status.phase) && !wasDriven) notices.dismissAll("device");
    if (!drives(status.phase) && wasDriven) desk.endTest();
    sense();
    emit desk.changed();
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

/// STOP is for the servos before it is for anything else; taken back, they start softly where they were live.
void DeviceDesk::Data::heedStop() {
    if (!link) return;
    if (loop.stopped()) {
        feed.stop();
    } else if (feed.takeStoppedLive()) {
        link->arm(false);
    }
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

DeviceDesk::~DeviceDesk() {
    data_->loop.removeTap(data_->tap);
    data_->feed.attach(nullptr, 0);
    data_->link.reset();
    data_->leaving.clear(); // waits: they call `hear`
}

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

void DeviceDesk::setShown(bool shown) {
    data_->finder.setLooking(shown);
    if (!shown) {
        data_->poll.stop();
        return;
    }
    data_->poll.start();
    data_->take();
}

void DeviceDesk::searchBluetooth() {
    data_->notices.dismiss("devices", "Bluetooth");
    data_->finder.searchBluetooth();
}

bool DeviceDesk::setProfile(const DeviceProfile& profile) {
    if (!data_->force(profile)) return false;
    data_->keep();
    return true;
}

bool DeviceDesk::previewProfile(const DeviceProfile& profile) {
    if (data_->link && beginsAnew(data_->link->profile(), profile)) return false;
    return data_->force(profile);
}

void DeviceDesk::loadProfile(const QString& name) {
    if (!data_->rig) return;
    try {
        DeviceProfile loaded = data_->profiles.load(name, *data_->rig);
        if (data_->status.phase == LinkPhase::off) {
            data_->retire();
        } else { // what is connected stays connected
            loaded.address = data_->profile.address;
            loaded.controller = data_->profile.controller;
            loaded.identity = data_->profile.identity;
        }
        setProfile(loaded);
    } catch (const Error& error) {
        data_->notices.post("servo", noticeOf(error));
        emit profileChanged();
    }
}

void DeviceDesk::saveProfileAs(const QString& name) {
    DeviceProfile named = data_->profile;
    named.name = fileNameOf(name).toStdString();
    setProfile(named);
}

void DeviceDesk::resetProfile() {
    if (!data_->rig) return;
    DeviceProfile fresh = data_->profile;
    fresh.servos = freshProfile(*data_->rig, fresh.controller).servos;
    setProfile(fresh);
}

void DeviceDesk::connectTo(const QString& address, std::optional<ControllerKind> controller) {
    if (!data_->rig) return;
    const std::string wanted = address.trimmed().toStdString();
    const DeviceProfile next =
        readdressed(data_->profile, *data_->rig, wanted, controller.value_or(likelyController(wanted)));
    const DeviceProfile before = std::exchange(data_->profile, next);
    try {
        static_cast<void>(parseDeviceAddress(wanted));
        const bool other = !data_->link || data_->link->profile().address != wanted ||
                           data_->link->profile().controller != next.controller;
        if (other) data_->makeLink();
        data_->link->connect();
        data_->notices.dismissAll("devices");
        data_->keep();
    } catch (const Error& error) {
        data_->profile = before;
        data_->notices.post("devices", noticeOf(error));
    }
    emit profileChanged();
    data_->take();
}

void DeviceDesk::disconnect() {
    if (!data_->link) return;
    data_->link->disconnect();
    data_->feed.drop();
    data_->notices.dismissAll("device");
    data_->take();
}

void DeviceDesk::confirm() {
    if (!data_->link) return;
    data_->link->confirmIdentity();
    if (const std::string& identity = data_->status.identity; !identity.empty()) {
        DeviceProfile known = data_->profile;
        known.identity = identity;
        setProfile(known);
    }
    data_->take();
}

void DeviceDesk::start(bool jumpAllowed) {
    if (!data_->link) return;
    static_cast<void>(data_->feed.takeStoppedLive()); // this start is the one to come
    data_->loop.resume();
    data_->link->arm(jumpAllowed);
    data_->take();
}

void DeviceDesk::stopNow() { data_->feed.stop(); }

void DeviceDesk::release() {
    if (!data_->link) return;
    data_->link->disarm();
    data_->feed.drop();
    data_->take();
}

void DeviceDesk::wiggle(std::size_t servo) {
    if (data_->link) data_->link->wiggle(servo);
}

void DeviceDesk::setSlow(bool slow) {
    data_->slow = slow;
    data_->feed.setSlow(SlowCause::user, slow);
    emit changed();
}

void DeviceDesk::test(std::size_t servo, double stroke) {
    if (data_->status.phase != LinkPhase::live) return;
    data_->feed.hold(servo, stroke);
    data_->sinceTest.start();
    data_->testTimer.start();
    emit changed();
}

void DeviceDesk::endTest() {
    if (!data_->feed.testing()) return;
    data_->feed.release();
    data_->sinceTest.start();
    data_->testTimer.start();
    emit changed();
}

void DeviceDesk::setPoses(std::shared_ptr<const PoseBoard> poses) { data_->handWatch.setPoses(std::move(poses)); }

QString DeviceDesk::name() const {
    const std::string& address = data_->profile.address;
    for (const FoundDevice& one : data_->finder.found())
        if (one.address == address) return QString::fromStdString(one.name);
    if (!data_->status.product.empty()) return QString::fromStdString(data_->status.product);
    return address.empty() ? QString("Device") : QString::fromStdString(address);
}

QString DeviceDesk::liveName() const {
    switch (data_->status.phase) {
    case LinkPhase::starting:
    case LinkPhase::live:
    case LinkPhase::stopped:
        return name();
    default:
        return {};
    }
}

void DeviceDesk::setTrace(std::function<void(const ServoTraceRow&)> sink) {
    data_->trace = std::move(sink);
    data_->traceLink();
}

void DeviceDesk::note(const QString& text) {
    data_->log.add({QDateTime::currentDateTime(), LinkEvent::Kind::information, text, {}, true});
    emit logged(1);
}

} // namespace lumorph::studio

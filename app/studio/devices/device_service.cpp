#include "app/studio/devices/device_service.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include <QDateTime>
#include <QElapsedTimer>
#include <QTimer>
#include <QUndoCommand>

#include "app/studio/devices/device_finder.h"
#include "app/studio/devices/rig_profiles.h"
#include "app/studio/devices/servo_feed.h"
#include "app/studio/devices/start_moves.h"
#include "core/base/error.h"
#include "devices/controllers/controller_kinds.h"
#include "devices/simulator/simulated_bench.h"
#include "devices/transport/address.h"

namespace lumorph::studio {
namespace {

constexpr int kDeviceStatusMilliseconds = 50;
constexpr int kTestMilliseconds = 33;

bool drives(LinkPhase phase) { return phase == LinkPhase::live || phase == LinkPhase::starting; }

/// What a frame tells the servos. A recording knows where the device was, not what it was told.
const std::vector<double>& commandsOf(const MatchFrame& frame) {
    return frame.commandedStrokes.empty() ? frame.estimatedStrokes : frame.commandedStrokes;
}

/// The set-up of one profile on the board of another.
DeviceProfile onBoardOf(DeviceProfile setup, const DeviceProfile& board) {
    setup.address = board.address;
    setup.controller = board.controller;
    setup.identity = board.identity;
    setup.confirmed = board.confirmed;
    return setup;
}

} // namespace

/// What a DeviceService holds.
struct DeviceService::Data {
    Data(DeviceService& owner, Settings& userSettings, StudioDocument& openDocument, StudioLoop& studioLoop,
         Notices& allNotices)
        : service(owner), document(openDocument), loop(studioLoop), notices(allNotices), profiles(userSettings) {}

    void listen();
    void follow(const MatchFrame& frame); ///< in the loop's thread
    void takeRig();
    void followEdits();
    void use(DeviceProfile next);
    bool force(const DeviceProfile& next);
    void keep();
    void makeLink();
    void traceLink();
    void retire();
    void leaveAll();
    void onLinkChanged(); ///< in the link's thread
    void take();
    void takeEvents();
    void tellAll(const std::vector<LinkEvent>& events);
    void onResumed();
    void identifyBoard();
    bool sense();
    void tellSearch(const LinkTrouble& trouble);
    void tick();
    void startTicking();

    DeviceService& service;
    StudioDocument& document;
    StudioLoop& loop;
    Notices& notices;
    RigProfiles profiles;
    std::unique_ptr<SimulatedBench> bench = std::make_unique<SimulatedBench>();
    std::shared_ptr<const Rig> rig;
    std::shared_ptr<const Rig> origin;   ///< of the rig, the same for its edits
    std::shared_ptr<const Rig> followed; ///< whose pulses the profile was last set beside
    DeviceProfile profile;
    HandWatch handWatch;
    HandSense hands;
    ServoFeed feed;
    int tap = 0;
    std::function<void(const ServoTraceRow&)> trace;
    std::shared_ptr<std::atomic<bool>> tracing; ///< false for a link that is no longer the present one
    std::shared_ptr<ServoLink> link;
    std::vector<std::future<void>> leaving; ///< links that go to rest; waiting for them would block the window
    LinkStatus status;
    DeviceFinder finder{*bench};
    DeviceLog log;
    std::atomic<bool> posted = false; ///< the window has been told of a change that it did not take yet
    QTimer due, poll, testTimer;
    QElapsedTimer sinceTest;
    QDateTime liveSince;
    QString stopKeysProblem; ///< why
    bool slow = false;
    QUndoStack undo;
    std::optional<DeviceProfile> beforePreview; ///< what a drag began with
    std::atomic<bool> followsRecordings = false;
    bool apart = false; ///< a recording was shown that servos did not follow; of the loop's thread
};

/// Before and after; it has happened already when it is pushed.
class DeviceService::ChangeSetup : public QUndoCommand {
public:
    ChangeSetup(DeviceService& service, const QString& what, DeviceProfile before, DeviceProfile after)
        : QUndoCommand(what), service_(service), before_(std::move(before)), after_(std::move(after)) {}
    void undo() override { use(before_); }
    void redo() override {
        if (std::exchange(pushed_, true)) use(after_);
    }

private:
    void use(const DeviceProfile& profile) { service_.setProfile(onBoardOf(profile, service_.profile())); }

    DeviceService& service_;
    DeviceProfile before_, after_;
    bool pushed_ = false;
};

void DeviceService::Data::listen() {
    due.setSingleShot(true);
    due.setInterval(kDeviceStatusMilliseconds);
    poll.setInterval(kDeviceStatusMilliseconds);
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
    connect(&document.undoStack(), &QUndoStack::indexChanged, &service, [this] { takeRig(); }); // a drag has ended
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
    if (now == rig) return followEdits();
    const bool edited = origin && origin == document.state().rig.origin;
    const bool same =
        now && rig && (edited || now->name() == rig->name()) && now->actuatorCount() == profile.servos.size();
    rig = now;
    origin = document.state().rig.origin;
    if (same) return followEdits();
    followed = rig;
    retire();
    undo.clear();
    beforePreview.reset();
    use(rig ? freshProfile(*rig, DeviceProfile{}.controller) : DeviceProfile{});
    if (rig)
        if (const QString last = profiles.lastOf(*rig); !last.isEmpty()) service.loadProfile(last);
    emit service.profileChanged();
    take();
}

/// What a drag passes on its way is not followed: wider pulses begin a link anew.
void DeviceService::Data::followEdits() {
    if (!rig || followed == rig || document.previewing()) return;
    const auto before = std::exchange(followed, rig);
    if (!before || before->actuatorCount() != rig->actuatorCount()) return;
    DeviceProfile next = profile;
    const bool all = followEdit(next, *before, *rig);
    if (next != profile && force(next) && profiles.lastOf(*rig) == QString::fromStdString(profile.name)) keep();
    if (all) return;
    notices.post("servo", {Notice::Level::warning,
                           "Pulses of the servos",
                           "the rig moves by other pulses now, and servos that were set up in Devices keep theirs: "
                           "light may miss the device",
                           "Set them up as the rig says, or measure anew where each servo stands",
                           {{"Set up as the rig says", [this] { service.resetProfile(); }}}});
}

/// A hand that comes near makes servos slow before they are told where to go.
void DeviceService::Data::follow(const MatchFrame& frame) {
    const bool drives = !frame.recorded || followsRecordings;
    if (drives) handWatch.follow(frame); // else the device is not where it is shown
    feed.setSlow(SlowCause::hand, handWatch.look(SteadyClock().now()));
    const bool anew = std::exchange(apart, !drives) && drives;
    if (!drives) return;
    feed.follow(commandsOf(frame), anew);
    if (anew)
        QMetaObject::invokeMethod(
            &service, [this] { startTicking(); }, Qt::QueuedConnection);
}

void DeviceService::Data::use(DeviceProfile next) {
    if (next.controller != profile.controller) undo.clear(); // its channels are others
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

/// Servos that STOP has let go start softly, where they were live and are read where they stand; else somebody may have
/// moved them since, and the user is asked as at any start.
void DeviceService::Data::onResumed() {
    if (!link || loop.stopped() || !feed.takeStoppedLive()) return;
    take();
    if (!startsFromReadPlaces(status)) return service.askStart();
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

void DeviceService::Data::startTicking() {
    sinceTest.start();
    testTimer.start();
    emit service.changed();
}

DeviceService::DeviceService(Settings& settings, StudioDocument& document, StudioLoop& loop, Notices& notices)
    : data_(std::make_unique<Data>(*this, settings, document, loop, notices)) {
    data_->listen();
}

DeviceService::~DeviceService() { data_->leaveAll(); }

void DeviceService::beginLeave() { data_->retire(); }

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
bool DeviceService::movesToTest() const { return data_->feed.moving(); }

// What the user orders at the service.

void DeviceService::setShown(bool shown) {
    data_->finder.setLooking(shown);
    if (!shown) {
        data_->poll.stop();
        return;
    }
    data_->poll.start();
    data_->take();
}

void DeviceService::searchBluetooth() {
    data_->notices.dismiss("devices", "Bluetooth");
    data_->finder.searchBluetooth();
}

bool DeviceService::setProfile(const DeviceProfile& profile, const QString& what) {
    const DeviceProfile before = std::exchange(data_->beforePreview, std::nullopt).value_or(data_->profile);
    if (!data_->force(profile)) return false;
    data_->keep();
    if (!what.isEmpty() && onBoardOf(before, profile) != profile)
        data_->undo.push(new ChangeSetup(*this, what, before, profile));
    return true;
}

QUndoStack& DeviceService::undoStack() noexcept { return data_->undo; }

bool DeviceService::previewProfile(const DeviceProfile& profile) {
    if (!data_->beforePreview) data_->beforePreview = data_->profile;
    if (data_->link && beginsAnew(data_->link->profile(), profile)) return false;
    return data_->force(profile);
}

void DeviceService::loadProfile(const QString& name) {
    if (!data_->rig) return;
    try {
        DeviceProfile loaded = data_->profiles.load(name, *data_->rig);
        if (data_->status.phase == LinkPhase::off) {
            data_->retire();
        } else { // what is connected stays connected
            loaded.address = data_->profile.address;
            loaded.controller = data_->profile.controller;
            loaded.identity = data_->profile.identity;
            loaded.confirmed = data_->profile.confirmed;
        }
        setProfile(loaded, "Load profile " + name);
    } catch (const Error& error) {
        data_->notices.post("servo", noticeOf(error));
        emit profileChanged();
    }
}

void DeviceService::saveProfileAs(const QString& name) {
    DeviceProfile named = data_->profile;
    named.name = fileNameOf(name).toStdString();
    setProfile(named, "Save profile as " + fileNameOf(name));
}

void DeviceService::resetProfile() {
    if (!data_->rig) return;
    DeviceProfile fresh = data_->profile;
    fresh.servos = freshProfile(*data_->rig, fresh.controller).servos;
    setProfile(fresh, "Set up as the rig's file says");
}

void DeviceService::connectTo(const QString& address, std::optional<ControllerKind> controller) {
    if (!data_->rig) return;
    const std::string wanted = address.trimmed().toStdString();
    const DeviceProfile next =
        readdressed(data_->profile, *data_->rig, wanted, controller.value_or(likelyController(wanted)));
    const DeviceProfile before = std::exchange(data_->profile, next);
    if (next.controller != before.controller) data_->undo.clear(); // its channels are others
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

void DeviceService::disconnect() {
    if (!data_->link) return;
    data_->link->disconnect();
    data_->feed.drop();
    data_->notices.dismissAll("device");
    data_->take();
}

void DeviceService::confirm() {
    if (!data_->link) return;
    data_->link->confirmIdentity();
    if (const std::string& identity = data_->status.identity; !identity.empty()) {
        DeviceProfile known = data_->profile;
        known.identity = identity;
        known.confirmed = true;
        setProfile(known);
    }
    data_->take();
}

void DeviceService::start(bool jumpAllowed) {
    if (!data_->link) return;
    static_cast<void>(data_->feed.takeStoppedLive()); // this start is the one to come
    data_->loop.resume();
    data_->link->arm(jumpAllowed);
    data_->take();
}

void DeviceService::askStart(StartBy by) { emit startAsked(by); }

std::vector<double> DeviceService::wanted() const {
    std::vector<double> shown = data_->feed.shown();
    const auto& frame = data_->loop.frame();
    return shown.empty() && frame && !frame->recorded ? commandsOf(*frame) : shown;
}

void DeviceService::setFollowsRecordings(bool follows) { data_->followsRecordings = follows; }

bool DeviceService::followsRecordings() const noexcept { return data_->followsRecordings; }

void DeviceService::stopNow() { data_->feed.stop(); }

bool DeviceService::letGo(std::chrono::milliseconds atMost) { return data_->feed.letGo(atMost); }

void DeviceService::setStopKeysProblem(const QString& why) {
    data_->stopKeysProblem = why;
    emit changed();
}

const QString& DeviceService::stopKeysProblem() const noexcept { return data_->stopKeysProblem; }

void DeviceService::release() {
    if (!data_->link) return;
    data_->link->disarm();
    data_->feed.drop();
    data_->take();
}

void DeviceService::wiggle(std::size_t servo) {
    if (data_->link) data_->link->wiggle(servo);
}

void DeviceService::setSlow(bool slow) {
    data_->slow = slow;
    data_->feed.setSlow(SlowCause::user, slow);
    emit changed();
}

void DeviceService::test(std::size_t servo, double stroke) {
    if (data_->status.phase != LinkPhase::live) return;
    data_->feed.hold(servo, stroke);
    data_->startTicking();
}

void DeviceService::endTest() {
    if (!data_->feed.testing()) return;
    data_->feed.release();
    data_->startTicking();
}

void DeviceService::setPoses(std::shared_ptr<const PoseBoard> poses) { data_->handWatch.setPoses(std::move(poses)); }

QString DeviceService::name() const {
    const std::string& address = data_->profile.address;
    for (const FoundDevice& one : data_->finder.found())
        if (one.address == address) return QString::fromStdString(one.name);
    if (!data_->status.product.empty()) return QString::fromStdString(data_->status.product);
    return address.empty() ? QString("Device") : QString::fromStdString(address);
}

QString DeviceService::liveName() const {
    switch (data_->status.phase) {
    case LinkPhase::starting:
    case LinkPhase::live:
    case LinkPhase::stopped:
        return name();
    default:
        return {};
    }
}

void DeviceService::setTrace(std::function<void(const ServoTraceRow&)> sink) {
    data_->trace = std::move(sink);
    data_->traceLink();
}

void DeviceService::note(const QString& text) {
    data_->log.add({QDateTime::currentDateTime(), LinkEvent::Kind::information, text, {}, true});
    emit logged(1);
}

} // namespace lumorph::studio

#include "app/studio/devices/device_desk.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <limits>
#include <thread>
#include <utility>

#include <QElapsedTimer>
#include <QTimer>

#include "app/studio/devices/device_shelf.h"
#include "app/studio/devices/servo_feed.h"
#include "core/base/error.h"
#include "devices/controllers/controller_kinds.h"
#include "devices/transport/address.h"

namespace lumorph::studio {
namespace {

constexpr int kStatusMilliseconds = 50;
constexpr int kLookMilliseconds = 2000;
constexpr int kTestMilliseconds = 33;
constexpr std::size_t kMostLines = 500;
constexpr auto kProfileKey = "device/profile/"; ///< and the rig's name: which profile it had last

bool drives(LinkPhase phase) { return phase == LinkPhase::live || phase == LinkPhase::starting; }

/// Remedies are worded as parts of a sentence; a log has lines.
QString asSentence(QString text) {
    if (text.isEmpty()) return text;
    text[0] = text[0].toUpper();
    return text.endsWith('.') ? text : text + '.';
}

/// Links tell the steady clock's time; people read the wall's.
QDateTime wallTime(Microseconds time) {
    const auto ago = std::chrono::duration_cast<std::chrono::milliseconds>(SteadyClock().now() - time);
    return QDateTime::currentDateTime().addMSecs(-std::clamp<std::int64_t>(ago.count(), 0, 60'000));
}

bool sameChannels(const DeviceProfile& a, const DeviceProfile& b) {
    return std::ranges::equal(a.servos, b.servos, {}, &ServoSetup::channel, &ServoSetup::channel);
}

/// Wider limits make the link begin anew, which a drag shall not do with every pixel.
bool widens(const DeviceProfile& before, const DeviceProfile& after) {
    return !std::ranges::equal(before.servos, after.servos, [](const ServoSetup& a, const ServoSetup& b) {
        return b.pulseMin >= a.pulseMin && b.pulseMax <= a.pulseMax;
    });
}

} // namespace

struct DeviceDesk::Data {
    Data(DeviceDesk& owner, Settings& hisSettings, StudioDocument& openDocument, StudioLoop& hisLoop,
         Notices& allNotices)
        : desk(owner), settings(hisSettings), document(openDocument), loop(hisLoop), notices(allNotices),
          shelf(hisSettings.folder() / "devices") {}

    void listen();
    void takeRig();
    bool force(const DeviceProfile& next);
    void keep();
    void makeLink();
    void traceLink();
    void retire();
    void hear(); ///< in the link's thread
    void take();
    void takeEvents();
    void add(DeviceLogLine line);
    void heedStop();
    void look();
    void takeFound(std::vector<FoundDevice> now);
    void tick();

    DeviceDesk& desk;
    Settings& settings;
    StudioDocument& document;
    StudioLoop& loop;
    Notices& notices;
    DeviceShelf shelf;
    std::unique_ptr<SimulatedBench> bench = std::make_unique<SimulatedBench>();
    std::shared_ptr<const Rig> rig;
    DeviceProfile profile;
    ServoFeed feed;
    int tap = 0;
    std::function<void(const ServoTraceRow&)> trace;
    std::shared_ptr<std::atomic<bool>> tracing; ///< false for a link that is no longer the present one
    std::unique_ptr<ServoLink> link;
    std::vector<std::future<void>> leaving; ///< links that go to rest; waiting for them would block the window
    LinkStatus status;
    std::vector<FoundDevice> found;
    std::vector<FoundDevice> ofBluetooth;
    std::unique_ptr<BluetoothSearch> search;
    std::deque<DeviceLogLine> log;
    std::atomic<bool> posted = false; ///< the window has been told of a change that it did not take yet
    std::jthread looker;
    QTimer due, poll, lookTimer, testTimer;
    QElapsedTimer sinceTest;
    QDateTime liveSince;
    bool shown = false;
    bool looking = false;
    bool slow = false;
};

void DeviceDesk::Data::listen() {
    due.setSingleShot(true);
    due.setInterval(kStatusMilliseconds);
    poll.setInterval(kStatusMilliseconds);
    lookTimer.setInterval(kLookMilliseconds);
    testTimer.setInterval(kTestMilliseconds);
    connect(&due, &QTimer::timeout, &desk, [this] { take(); });
    connect(&poll, &QTimer::timeout, &desk, [this] {
        if (link && !due.isActive()) take();
    });
    connect(&lookTimer, &QTimer::timeout, &desk, [this] { look(); });
    connect(&testTimer, &QTimer::timeout, &desk, [this] { tick(); });
    connect(&document, &StudioDocument::changed, &desk, [this](StateParts parts) {
        if (parts & StatePart::rig) takeRig();
    });
    connect(&loop, &StudioLoop::stoppedChanged, &desk, [this] { heedStop(); });
    tap = loop.addTap([this](const MatchFrame& frame) { feed.follow(frame.estimatedStrokes); });
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
    profile = DeviceProfile{};
    if (rig) {
        profile = profileFor(*rig);
        countChannelsFrom(profile, firstChannel(profile.controller));
        const QString usual = fileNameOf(QString::fromStdString(rig->name()));
        const QString name = settings.value(kProfileKey + usual, usual).toString();
        profile.name = usual.toStdString();
        if (shelf.has(name)) desk.loadProfile(name);
    }
    emit desk.profileChanged();
    take();
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
    profile = next;
    emit desk.profileChanged();
    return true;
}

void DeviceDesk::Data::keep() {
    try {
        shelf.save(profile);
        settings.setValue(kProfileKey + fileNameOf(QString::fromStdString(rig->name())),
                          QString::fromStdString(profile.name));
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
    link->setSlow(slow);
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
    emit desk.changed();
}

void DeviceDesk::Data::takeEvents() {
    if (!link) return;
    const std::vector<LinkEvent> events = link->takeEvents();
    for (const LinkEvent& event : events) {
        const DeviceLogLine line{wallTime(event.time), event.kind, QString::fromStdString(event.text),
                                 asSentence(QString::fromStdString(event.remedy))};
        add(line);
        if (event.kind == LinkEvent::Kind::information) continue;
        // For those who are in another workspace: the status line counts and lists it.
        Notice notice;
        notice.level = event.kind == LinkEvent::Kind::failure ? Notice::Level::error : Notice::Level::warning;
        notice.subject = desk.name();
        notice.why = line.text;
        notice.remedy = line.remedy;
        notices.post("device", notice);
    }
    if (!events.empty()) emit desk.logged(static_cast<int>(events.size()));
}

void DeviceDesk::Data::add(DeviceLogLine line) {
    log.push_front(std::move(line));
    if (log.size() > kMostLines) log.pop_back();
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

/// Looking at the system's ports may take its time on some machines.
void DeviceDesk::Data::look() {
    if (std::exchange(looking, true)) return;
    looker = std::jthread([this] {
        std::vector<FoundDevice> now;
        try {
            now = findDevices(bench.get());
        } catch (const std::exception&) {
            now.clear(); // a port that vanished meanwhile; the next look comes soon
        }
        QMetaObject::invokeMethod(
            &desk, [this, now]() mutable { takeFound(std::move(now)); }, Qt::QueuedConnection);
    });
}

void DeviceDesk::Data::takeFound(std::vector<FoundDevice> now) {
    looking = false;
    now.insert(now.end(), ofBluetooth.begin(), ofBluetooth.end());
    if (now == found) return;
    found = std::move(now);
    emit desk.foundChanged();
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
    data_->search.reset();
    data_->looker = {}; // waits
    data_->feed.attach(nullptr, 0);
    data_->link.reset();
    data_->leaving.clear(); // waits: they call `hear`
}

SimulatedBench& DeviceDesk::bench() noexcept { return *data_->bench; }
const std::vector<FoundDevice>& DeviceDesk::found() const noexcept { return data_->found; }
bool DeviceDesk::searchingBluetooth() const noexcept { return data_->search != nullptr; }
const DeviceProfile& DeviceDesk::profile() const noexcept { return data_->profile; }
const LinkStatus& DeviceDesk::status() const noexcept { return data_->status; }
const std::deque<DeviceLogLine>& DeviceDesk::log() const noexcept { return data_->log; }
const QDateTime& DeviceDesk::liveSince() const noexcept { return data_->liveSince; }
bool DeviceDesk::slow() const noexcept { return data_->slow; }
QStringList DeviceDesk::profileNames() const { return data_->shelf.names(); }
std::optional<double> DeviceDesk::tested(std::size_t servo) const { return data_->feed.held(servo); }
bool DeviceDesk::testing() const { return data_->feed.testing(); }

void DeviceDesk::setShown(bool shown) {
    data_->shown = shown;
    if (!shown) {
        data_->poll.stop();
        data_->lookTimer.stop();
        return;
    }
    data_->poll.start();
    data_->lookTimer.start();
    data_->look();
    data_->take();
}

void DeviceDesk::searchBluetooth() {
    if (data_->search) return;
    data_->ofBluetooth.clear();
    BluetoothSearch::Events events;
    events.found = [this](const FoundDevice& one) {
        data_->ofBluetooth.push_back(one);
        data_->found.push_back(one);
        emit foundChanged();
    };
    events.ended = [this](const LinkTrouble& trouble) {
        // The search must not be destroyed inside its own call.
        QMetaObject::invokeMethod(
            this,
            [this, trouble] {
                data_->search.reset();
                if (!trouble.why.empty()) {
                    Notice notice;
                    notice.level = Notice::Level::warning;
                    notice.subject = "Bluetooth";
                    notice.why = QString::fromStdString(trouble.why);
                    notice.remedy = QString::fromStdString(trouble.remedy);
                    data_->notices.post("devices", notice);
                }
                emit foundChanged();
            },
            Qt::QueuedConnection);
    };
    data_->notices.dismiss("devices", "Bluetooth");
    data_->search = std::make_unique<BluetoothSearch>(std::move(events));
    emit foundChanged();
}

bool DeviceDesk::setProfile(const DeviceProfile& profile) {
    if (!data_->force(profile)) return false;
    data_->keep();
    return true;
}

bool DeviceDesk::previewProfile(const DeviceProfile& profile) {
    if (data_->link && widens(data_->link->profile(), profile)) return false;
    return data_->force(profile);
}

void DeviceDesk::loadProfile(const QString& name) {
    if (!data_->rig) return;
    try {
        DeviceProfile loaded = data_->shelf.load(name);
        if (loaded.servos.size() != data_->rig->actuatorCount())
            throw DataError("profile " + name.toStdString(),
                            "it is for " + std::to_string(loaded.servos.size()) + " servos, the open rig has " +
                                std::to_string(data_->rig->actuatorCount()),
                            "choose another, or open the rig that it was made for");
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
    fresh.servos = profileFor(*data_->rig).servos;
    countChannelsFrom(fresh, firstChannel(fresh.controller));
    setProfile(fresh);
}

void DeviceDesk::connectTo(const QString& address, std::optional<ControllerKind> controller) {
    if (!data_->rig) return;
    const std::string wanted = address.trimmed().toStdString();
    DeviceProfile next = data_->profile;
    if (next.address != wanted) next.identity.clear(); // it was another board's
    next.address = wanted;
    next.controller = controller.value_or(likelyController(wanted));
    if (next.controller != data_->profile.controller) {
        // Who has not chosen channels has them counted as this kind counts.
        DeviceProfile counted = data_->profile;
        counted.servos = profileFor(*data_->rig).servos;
        countChannelsFrom(counted, firstChannel(data_->profile.controller));
        if (sameChannels(counted, data_->profile)) countChannelsFrom(next, firstChannel(next.controller));
    }
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
    if (data_->link) data_->link->setSlow(slow);
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

QString DeviceDesk::name() const {
    const std::string& address = data_->profile.address;
    for (const FoundDevice& one : data_->found)
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
    data_->add({QDateTime::currentDateTime(), LinkEvent::Kind::information, text, {}});
    emit logged(1);
}

} // namespace lumorph::studio

#include "app/studio/devices/tracker_service.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include <QThreadPool>
#include <QTime>
#include <QTimer>
#include <QVariantMap>

#include "app/tracking/any_tracker.h"
#include "calibration/tracking/camera_source.h"

namespace lumorph::studio {
namespace {

constexpr int kTrackerStatusMilliseconds = 100;
constexpr std::size_t kHistory = 101; ///< ten seconds of it
constexpr qsizetype kMostAddresses = 8;
constexpr std::size_t kMostBodies = 200; ///< names come from outside, and may be new ones for ever
constexpr std::string_view kSimulated = "sim://";
constexpr auto kAddressesKey = "trackers/addresses";
constexpr auto kRolesKey = "trackers/roles";
constexpr const char* kExamples[] = {"sim://head",
                                     "sim://device",
                                     "sim://pointer",
                                     "natnet://192.168.0.2?mode=multicast",
                                     "opentrack://127.0.0.1:4242",
                                     "osc://127.0.0.1:9000"};
constexpr std::pair<PoseRole, const char*> kRoleWords[] = {
    {PoseRole::head, "head"}, {PoseRole::device, "device"}, {PoseRole::pointer, "pointer"}};

QString wordOf(std::optional<PoseRole> role) {
    for (const auto& [one, word] : kRoleWords)
        if (role == one) return word;
    return "none";
}

std::optional<PoseRole> roleOf(const QString& word) {
    for (const auto& [one, known] : kRoleWords)
        if (word == known) return one;
    return std::nullopt;
}

void keepTenSeconds(std::deque<double>& history, double value) {
    history.push_back(value);
    if (history.size() > kHistory) history.pop_front();
}

} // namespace

std::optional<PoseRole> likelyRole(std::string_view body) {
    std::string name(body);
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto tells = [&](const char* word) { return name.find(word) != std::string::npos; };
    if (tells("head") || tells("eye") || tells("glasses") || tells("hat")) return PoseRole::head;
    if (tells("device") || tells("tablet") || tells("board")) return PoseRole::device;
    if (tells("hand") || tells("pointer") || tells("finger") || tells("glove")) return PoseRole::pointer;
    return std::nullopt;
}

struct TrackerService::Data {
    Data(TrackerService& owner, Settings& userSettings, StudioLoop& studioLoop, Notices& allNotices)
        : service(owner), settings(userSettings), loop(studioLoop), notices(allNotices) {
        // One after the other, so that a port is free again before it is opened again.
        worker.setMaxThreadCount(1);
        worker.setExpiryTimeout(-1);
        for (const auto& [body, word] : settings.value(kRolesKey).toMap().asKeyValueRange())
            said[body.toStdString()] = roleOf(word.toString());
        timer.setInterval(kTrackerStatusMilliseconds);
        connect(&timer, &QTimer::timeout, &service, [this] { sample(); });
    }

    void opened(const QString& address);
    void failed(const QString& address, const Notice& notice);
    void take();
    void sample();
    void meet(const TrackerStatus& status);
    void noteEvent(OpenTracker& tracker, std::uint64_t before);
    [[nodiscard]] std::unique_ptr<Tracker> openOne(const std::string& uri, TrackerOptions options);
    [[nodiscard]] std::shared_ptr<SimulatedSteering> steeringOf(const std::string& uri);
    void tellRoles();
    void keepRoles();

    TrackerService& service;
    Settings& settings;
    StudioLoop& loop;
    Notices& notices;
    std::shared_ptr<PoseBoard> board = std::make_shared<PoseBoard>();
    std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>();
    std::mutex steeringMutex; ///< trackers are opened in the worker
    std::map<std::string, std::shared_ptr<SimulatedSteering>> steering;
    std::shared_ptr<const Installation> simulatedRoom; ///< likewise
    TrackerHub hub{board, clock,
                   [this](const std::string& uri, TrackerOptions options) { return openOne(uri, std::move(options)); }};
    std::map<std::string, std::optional<PoseRole>> said; ///< by the user
    std::map<std::string, std::optional<PoseRole>> met;  ///< by name, since the start
    std::vector<OpenTracker> trackers;
    std::map<std::pair<std::string, std::string>, Microseconds> lastSeen; ///< by address and body
    std::set<QString> opening;
    QString trouble;       ///< what the newest notice is about
    bool followed = false; ///< the loop has the board
    QTimer timer;
    QThreadPool worker;
};

void TrackerService::Data::opened(const QString& address) {
    opening.erase(address);
    notices.dismiss("devices", trouble);
    QStringList kept = settings.value(kAddressesKey).toStringList();
    kept.removeAll(address);
    kept.prepend(address);
    settings.setValue(kAddressesKey, QStringList(kept.mid(0, kMostAddresses)));
    emit service.addressesChanged();
    take();
    emit service.changed();
}

void TrackerService::Data::failed(const QString& address, const Notice& notice) {
    opening.erase(address);
    if (trouble != notice.subject) notices.dismiss("devices", trouble);
    trouble = notice.subject;
    notices.post("devices", notice);
    emit service.changed();
}

/// What is open now, each with the history that it had.
void TrackerService::Data::take() {
    std::vector<OpenTracker> now;
    for (TrackerStatus& status : hub.status()) {
        meet(status);
        OpenTracker& one = now.emplace_back();
        const auto before = std::ranges::find(trackers, status.address,
                                              [](const OpenTracker& tracker) { return tracker.status.address; });
        if (before != trackers.end()) one = std::move(*before);
        const std::uint64_t events = one.status.events;
        one.status = std::move(status);
        one.steering = steeringOf(one.status.address);
        noteEvent(one, events);
    }
    trackers = std::move(now);
    const bool any = !trackers.empty();
    if (std::exchange(followed, any) != any) loop.setPoses(any ? board : nullptr);
    if (!any)
        timer.stop();
    else if (!timer.isActive())
        timer.start();
}

void TrackerService::Data::sample() {
    take();
    for (OpenTracker& one : trackers) {
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        keepTenSeconds(one.rate, one.status.framesPerSecond);
        keepTenSeconds(one.latency, one.status.receiving ? one.status.latencyMilliseconds.value_or(kNone) : kNone);
    }
    emit service.changed();
}

void TrackerService::Data::noteEvent(OpenTracker& tracker, std::uint64_t before) {
    if (tracker.status.events == before) return;
    tracker.event = QTime::currentTime().toString("HH:mm:ss") + ' ' + QString::fromStdString(tracker.status.event);
}

/// In the worker.
std::unique_ptr<Tracker> TrackerService::Data::openOne(const std::string& uri, TrackerOptions options) {
    auto made = std::make_shared<SimulatedSteering>();
    {
        const std::scoped_lock lock(steeringMutex);
        made->setRoom(simulatedRoom); // before its first frame
    }
    std::unique_ptr<Tracker> tracker = openAnyTracker(uri, std::move(options), made);
    const std::scoped_lock lock(steeringMutex);
    made->setRoom(simulatedRoom);
    steering[uri] = uri.starts_with(kSimulated) ? std::move(made) : nullptr;
    return tracker;
}

std::shared_ptr<SimulatedSteering> TrackerService::Data::steeringOf(const std::string& uri) {
    const std::scoped_lock lock(steeringMutex);
    const auto found = steering.find(uri);
    return found == steering.end() ? nullptr : found->second;
}

/// Bodies that are new get the role that they had last time, or the one that their name tells.
void TrackerService::Data::meet(const TrackerStatus& status) {
    bool any = false;
    for (const TrackedBody& body : status.bodies) {
        if (met.size() >= kMostBodies || met.contains(body.name)) continue;
        const auto known = said.find(body.name);
        met[body.name] = known == said.end() ? likelyRole(body.name) : known->second;
        any = true;
    }
    if (any) tellRoles();
}

void TrackerService::Data::tellRoles() {
    RoleMap roles;
    for (const auto& [body, role] : met)
        if (role) roles[body] = *role;
    hub.setRoles(std::move(roles));
}

void TrackerService::Data::keepRoles() {
    QVariantMap kept;
    for (const auto& [body, role] : said) kept[QString::fromStdString(body)] = wordOf(role);
    settings.setValue(kRolesKey, kept);
}

TrackerService::TrackerService(Settings& settings, StudioLoop& loop, Notices& notices)
    : data_(std::make_unique<Data>(*this, settings, loop, notices)) {}

TrackerService::~TrackerService() {
    data_->worker.waitForDone();
    if (data_->followed) data_->loop.setPoses({});
}

QStringList TrackerService::addresses() const {
    QStringList all = data_->settings.value(kAddressesKey).toStringList().mid(0, kMostAddresses);
    for (const char* example : kExamples)
        if (!all.contains(example)) all << example;
    std::vector<CameraInfo> cameras = listCameras();
    if (cameras.empty()) cameras.push_back({"/dev/video0", {}});
    for (const CameraInfo& camera : cameras) {
        const QString address = "board://" + QString::fromStdString(camera.path) + "?squares=5x7&size=30&marker=22";
        if (!all.contains(address)) all << address;
    }
    return all;
}

void TrackerService::open(const QString& address, bool openToNetwork) {
    const QString wanted = address.trimmed();
    if (wanted.isEmpty() || !data_->opening.insert(wanted).second) return;
    data_->worker.start([this, wanted, openToNetwork] {
        try {
            data_->hub.open(wanted.toStdString(), openToNetwork);
            QMetaObject::invokeMethod(
                this, [this, wanted] { data_->opened(wanted); }, Qt::QueuedConnection);
        } catch (const std::exception& error) {
            QMetaObject::invokeMethod(
                this, [this, wanted, notice = noticeOf(error)] { data_->failed(wanted, notice); },
                Qt::QueuedConnection);
        }
    });
    emit changed();
}

void TrackerService::close(const QString& address) {
    data_->worker.start([this, address] {
        data_->hub.close(address.toStdString());
        QMetaObject::invokeMethod(
            this,
            [this] {
                data_->take();
                emit changed();
            },
            Qt::QueuedConnection);
    });
}

std::shared_ptr<const PoseBoard> TrackerService::poses() const noexcept { return data_->board; }
bool TrackerService::opening() const noexcept { return !data_->opening.empty(); }
const std::vector<OpenTracker>& TrackerService::trackers() const noexcept { return data_->trackers; }

std::vector<SeenBody> TrackerService::bodies() const {
    std::vector<SeenBody> all;
    if (data_->trackers.empty()) return all;
    const Microseconds now = data_->clock->now();
    for (const TrackerStatus& status : data_->hub.status())
        for (const TrackedBody& body : status.bodies) {
            if (all.size() >= kMostBodies) return all;
            const std::pair key{status.address, body.name};
            if (data_->lastSeen.size() > 2 * kMostBodies) data_->lastSeen.clear();
            if (body.valid && status.receiving) data_->lastSeen[key] = now;
            const auto seen = data_->lastSeen.find(key);
            if (seen == data_->lastSeen.end()) continue;
            all.push_back({body.name, role(body.name), body.pose,
                           1e-6 * static_cast<double>((now - seen->second).count()),
                           data_->steeringOf(status.address)});
        }
    return all;
}

std::optional<PoseRole> TrackerService::role(const std::string& body) const {
    const auto found = data_->met.find(body);
    return found == data_->met.end() ? std::nullopt : found->second;
}

void TrackerService::setRole(const std::string& body, std::optional<PoseRole> role) {
    data_->said[body] = role;
    data_->met[body] = role;
    data_->keepRoles();
    data_->tellRoles();
    emit changed();
}

void TrackerService::setSimulatedRoom(std::shared_ptr<const Installation> room) {
    const std::scoped_lock lock(data_->steeringMutex);
    data_->simulatedRoom = std::move(room);
    for (const auto& [uri, steering] : data_->steering)
        if (steering) steering->setRoom(data_->simulatedRoom);
}

int TrackerService::addTap(TrackerHub::Tap tap) { return data_->hub.addTap(std::move(tap)); }
void TrackerService::removeTap(int id) { data_->hub.removeTap(id); }

} // namespace lumorph::studio

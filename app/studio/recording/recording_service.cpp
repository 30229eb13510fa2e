#include "app/studio/recording/recording_service.h"

#include <algorithm>
#include <future>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <QDateTime>
#include <QLocale>
#include <QStandardPaths>
#include <QStorageInfo>
#include <QTemporaryDir>
#include <QTimer>

#include "app/recording/recorder.h"
#include "app/studio/recording/project_pack.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;

constexpr auto kRecordPlace = "record";
constexpr auto kFolderKey = "record/folder";
constexpr int kLookMilliseconds = 500;

std::int64_t roomOn(const fs::path& file) {
    fs::path folder = file.parent_path();
    std::error_code ignored;
    while (!fs::exists(folder, ignored) && folder.has_relative_path()) folder = folder.parent_path();
    const QStorageInfo disk(QString::fromStdString(folder.string()));
    return disk.isValid() ? disk.bytesAvailable() : RecordingService::kLeastRoom;
}

std::int64_t sizeOf(const fs::path& file) {
    std::error_code gone;
    const auto size = fs::file_size(file, gone);
    return gone ? 0 : static_cast<std::int64_t>(size);
}

/// A name that is not taken.
fs::path freshName(const fs::path& folder, const std::string& stem) {
    fs::path file = folder / (stem + ".lumorphrec");
    for (int number = 2; fs::exists(file); ++number)
        file = folder / (stem + ' ' + std::to_string(number) + ".lumorphrec");
    return file;
}

const char* wordOf(Notice::Level level) {
    return level == Notice::Level::error ? "failure" : level == Notice::Level::warning ? "warning" : "information";
}

const char* wordOf(LinkEvent::Kind kind) {
    return kind == LinkEvent::Kind::failure ? "failure" : kind == LinkEvent::Kind::warning ? "warning" : "information";
}

/// Where rows go from any thread, until it is shut.
class Gate {
public:
    explicit Gate(std::shared_ptr<Recorder> recorder)
        : recorder_(std::move(recorder)), begin_(SteadyClock().now()), end_(Microseconds::max()) {}

    [[nodiscard]] Microseconds begin() const noexcept { return begin_; }
    [[nodiscard]] std::string trouble() {
        const std::scoped_lock lock(mutex_);
        return recorder_ ? recorder_->trouble() : std::string();
    }
    template <class Make> void add(Make make) {
        const std::scoped_lock lock(mutex_);
        if (recorder_ && end_ == Microseconds::max()) recorder_->add(make(begin_));
    }
    /// A link's rows come in order, and later than they happened while it hands over what was before.
    void addServo(const ServoTraceRow& row) {
        const std::scoped_lock lock(mutex_);
        ++servoRows_;
        complete_ = row.time > end_;
        if (recorder_ && !complete_) recorder_->add(ServoRow{row.time - begin_, row.kind, row.bytes});
    }
    void end() {
        const std::scoped_lock lock(mutex_);
        end_ = SteadyClock().now();
    }
    /// When the link has told all up to the end, or has nothing more to tell.
    std::shared_ptr<Recorder> shut() {
        std::unique_lock lock(mutex_);
        for (std::uint64_t before = ~servoRows_; !complete_ && before != servoRows_;) {
            before = servoRows_;
            lock.unlock();
            std::this_thread::sleep_for(kQuiet);
            lock.lock();
        }
        return std::exchange(recorder_, nullptr);
    }

private:
    static constexpr std::chrono::milliseconds kQuiet{250};

    std::mutex mutex_;
    std::shared_ptr<Recorder> recorder_;
    const Microseconds begin_;
    Microseconds end_;
    std::uint64_t servoRows_ = 0;
    bool complete_ = false;
};

/// One that was begun before the recording is part of what was before.
void addFrame(Gate& gate, const MatchFrame& frame) {
    if (frame.time < gate.begin()) return;
    gate.add([&](Microseconds begin) { return rowOf(frame, begin); });
    for (const ShowInput& input : frame.inputs)
        gate.add([&](Microseconds begin) { return InputRow{frame.time - begin, input.name, input.value}; });
}

void addPoses(Gate& gate, const std::string& source, const TrackerFrame& frame) {
    const Microseconds now = SteadyClock().now();
    for (const TrackedBody& body : frame.bodies)
        gate.add([&](Microseconds begin) {
            return PoseRow{now - begin, frame.measured - begin, source, body.name, body.id, body.valid, body.pose};
        });
}

/// The same moment, written with its distance from UTC.
QDateTime withZone(const QDateTime& local) { return local.toOffsetFromUtc(local.offsetFromUtc()); }

/// A file that is begun, before anything is handed to it.
std::shared_ptr<Recorder> begun(const fs::path& file, std::map<std::string, std::string> facts,
                                const ProjectSource& source, const DeviceProfile& profile, const Progress& progress) {
    std::error_code problem;
    fs::create_directories(file.parent_path(), problem);
    if (problem)
        throw DeviceError(file.parent_path().string(), "the folder cannot be made (" + problem.message() + ")",
                          "choose a folder that you may write to");
    ProjectPack pack;
    if (source.state.rig.rig) pack = packProject(source, progress);
    facts["project"] = pack.text;
    if (!profile.servos.empty()) facts["profile"] = profileText(profile);
    auto recorder = std::make_shared<Recorder>(file, facts);
    for (FileRow& row : pack.files) recorder->add(std::move(row));
    return recorder;
}

} // namespace

struct RecordingService::Data {
    Data(RecordingService& owner, Settings& userSettings, StudioDocument& openDocument, ProjectService& projectService,
         StudioLoop& studioLoop, DeviceService& hisDevices, TrackerService& hisTrackers, Jobs& allJobs,
         Notices& allNotices)
        : record(owner), settings(userSettings), document(openDocument), service(projectService), loop(studioLoop),
          devices(hisDevices), trackers(hisTrackers), jobs(allJobs), notices(allNotices) {}

    void listen();
    void begin(std::shared_ptr<Recorder> recorder);
    void look();
    void end(bool tell);
    void tellEnd(const fs::path& ended, double seconds, const QString& trouble);
    void fail(const std::exception& error);
    void addEvent(std::string kind, const QString& text, const QString& remedy, Microseconds when);
    void addNotice(const QString& at);
    void addDeviceLines(int lines);

    RecordingService& record;
    Settings& settings;
    StudioDocument& document;
    ProjectService& service;
    StudioLoop& loop;
    DeviceService& devices;
    TrackerService& trackers;
    Jobs& jobs;
    Notices& notices;
    std::function<std::int64_t(const fs::path&)> room = &roomOn;
    Phase phase = Phase::idle;
    fs::path file;
    std::shared_ptr<Gate> gate; ///< empty before the first
    Jobs::Id starting = 0;
    int tap = 0;        ///< of the loop
    int trackerTap = 0; ///< of the trackers
    std::int64_t bytes = 0;
    double lasted = 0.0; ///< seconds, of the recording that ended
    QTimer looks;
    std::vector<std::future<void>> closing;
};

void RecordingService::Data::listen() {
    looks.setInterval(kLookMilliseconds);
    connect(&looks, &QTimer::timeout, &record, [this] { look(); });
    connect(&notices, &Notices::posted, &record, [this](const QString& at) { addNotice(at); });
    connect(&devices, &DeviceService::logged, &record, [this](int lines) { addDeviceLines(lines); });
    connect(&loop, &StudioLoop::stoppedChanged, &record, [this] {
        addEvent("information", loop.stopped() ? tr("STOP") : tr("Resumed after STOP"), {}, SteadyClock().now());
    });
}

void RecordingService::Data::begin(std::shared_ptr<Recorder> recorder) {
    gate = std::make_shared<Gate>(std::move(recorder));
    phase = Phase::recording;
    bytes = sizeOf(file);
    const auto into = gate;
    tap = loop.addTap([into](const MatchFrame& frame) { addFrame(*into, frame); });
    trackerTap = trackers.addTap(
        [into](const std::string& source, const TrackerFrame& frame) { addPoses(*into, source, frame); });
    devices.setTrace([into](const ServoTraceRow& row) { into->addServo(row); });
    // A show that stands still makes no frames: what is seen now is the first.
    if (const auto& frame = loop.frame()) {
        MatchFrame first = *frame;
        first.time = into->begin();
        addFrame(*into, first);
    }
    looks.start();
    emit record.changed();
}

void RecordingService::Data::addEvent(std::string kind, const QString& text, const QString& remedy, Microseconds when) {
    if (!gate) return;
    gate->add([&](Microseconds begin) {
        return EventRow{when - begin, std::move(kind), text.toStdString(), remedy.toStdString()};
    });
}

/// What the device tells comes by its log.
void RecordingService::Data::addNotice(const QString& at) {
    if (at == "device" || at == kRecordPlace) return;
    const std::vector<Notice> there = notices.at(at);
    if (there.empty()) return;
    const Notice& newest = there.front();
    addEvent(wordOf(newest.level), newest.subject + ": " + newest.why, newest.remedy, SteadyClock().now());
}

void RecordingService::Data::addDeviceLines(int lines) {
    const auto& log = devices.log();
    for (int k = std::min(lines, static_cast<int>(log.size())) - 1; k >= 0; --k) {
        const DeviceLogLine& line = log[static_cast<std::size_t>(k)];
        const Microseconds ago = std::chrono::milliseconds(line.time.msecsTo(QDateTime::currentDateTime()));
        addEvent(wordOf(line.kind), line.text, line.remedy, SteadyClock().now() - ago);
    }
}

/// The disk is looked after while nobody else does.
void RecordingService::Data::look() {
    std::error_code gone;
    if (!gate->trouble().empty()) return end(true); // told when it is closed
    if (!fs::exists(file, gone)) {
        end(false);
        return fail(DeviceError(file.string(), "the file was taken away while it was written",
                                "bring it back from the trash, or record again"));
    }
    bytes = sizeOf(file) + sizeOf(file.string() + "-wal");
    if (room(file) < kLeastRoom) {
        end(false);
        return fail(DeviceError(file.string(),
                                "recording stopped: less than " + std::to_string(kLeastRoom / 1'000'000) + " MB" +
                                    " are left on its disk; what was recorded is kept",
                                "free some space, or record to another disk"));
    }
    emit record.changed();
}

void RecordingService::Data::fail(const std::exception& error) {
    Notice notice = noticeOf(error);
    notice.actions.push_back({tr("Record elsewhere..."), [this] { emit record.chooseFile(); }});
    notices.post(kRecordPlace, std::move(notice));
}

/// `tell`: how it went; else the user was told already. Waiting for link and disk would hold the window up.
void RecordingService::Data::end(bool tell) {
    if (phase != Phase::recording) return;
    looks.stop();
    lasted = record.seconds();
    phase = Phase::idle;
    gate->end();
    loop.removeTap(tap);
    trackers.removeTap(trackerTap);
    devices.setTrace({});
    std::erase_if(closing,
                  [](const auto& one) { return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready; });
    closing.push_back(std::async(std::launch::async, [this, tell, ending = gate, ended = file, seconds = lasted] {
        const std::shared_ptr<Recorder> recorder = ending->shut();
        recorder->finish();
        QMetaObject::invokeMethod(
            &record,
            [this, tell, ended, seconds, trouble = QString::fromStdString(recorder->trouble())] {
                if (tell) tellEnd(ended, seconds, trouble);
                emit record.finished(QString::fromStdString(ended.string()));
            },
            Qt::QueuedConnection);
    }));
    emit record.changed();
}

void RecordingService::Data::tellEnd(const fs::path& ended, double seconds, const QString& trouble) {
    const QString name = QString::fromStdString(ended.filename().string());
    const QString path = QString::fromStdString(ended.string());
    if (trouble.isEmpty())
        notices.post(kRecordPlace,
                     {Notice::Level::info,
                      tr("Recorded"),
                      tr("%1, %2, %3").arg(name, clockText(seconds), bytesText(sizeOf(ended))),
                      {},
                      {{tr("Replay"), [this, path] { emit record.showWanted(path); }}, {tr("OK"), [] {}}}});
    else
        notices.post(kRecordPlace, {Notice::Level::error,
                                    name,
                                    tr("recording stopped: %1; what was recorded before is kept").arg(trouble),
                                    {},
                                    {{tr("Record elsewhere..."), [this] { emit record.chooseFile(); }}}});
}

RecordingService::RecordingService(Settings& settings, StudioDocument& document, ProjectService& service,
                                   StudioLoop& loop, DeviceService& devices, TrackerService& trackers, Jobs& jobs,
                                   Notices& notices)
    : data_(std::make_unique<Data>(*this, settings, document, service, loop, devices, trackers, jobs, notices)) {
    data_->listen();
}

RecordingService::~RecordingService() {
    data_->jobs.cancel(data_->starting);
    data_->end(false);
    data_->closing.clear(); // waits
}

void RecordingService::start() { start(freshFile()); }

void RecordingService::start(const fs::path& file) {
    if (data_->phase != Phase::idle) return;
    data_->notices.dismissAll(kRecordPlace);
    data_->file = file;
    data_->lasted = 0.0;
    data_->bytes = 0;
    data_->settings.setValue(kFolderKey, QString::fromStdString(file.parent_path().string()));
    if (data_->room(file) < kLeastRoom)
        return data_->fail(DeviceError(
            file.string(), "less than " + std::to_string(kLeastRoom / 1'000'000) + " MB" + " are left on its disk",
            "free some space, or record to another disk"));
    data_->phase = Phase::starting;
    const std::map<std::string, std::string> facts{
        {"program", "Lumorph " LUMORPH_VERSION},
        {"started", withZone(QDateTime::currentDateTime()).toString(Qt::ISODate).toStdString()},
        {"project_name", data_->document.name().toStdString()}};
    data_->starting = data_->jobs.run<std::shared_ptr<Recorder>>(
        kRecordPlace, tr("Starting the recording"),
        [file, facts, source = data_->service.project(), profile = data_->devices.profile()](const Progress& progress) {
            return begun(file, facts, source, profile, progress);
        },
        [this](std::shared_ptr<Recorder> recorder) { data_->begin(std::move(recorder)); },
        [this](const std::exception& error) {
            data_->phase = Phase::idle;
            data_->fail(error);
            emit changed();
        });
    emit changed();
}

void RecordingService::stop() {
    if (data_->phase == Phase::starting) {
        data_->jobs.cancel(data_->starting);
        data_->phase = Phase::idle;
        emit changed();
    }
    data_->end(true);
}

void RecordingService::mark(const QString& text, Microseconds when) {
    data_->addEvent("mark", text.trimmed().isEmpty() ? tr("Mark") : text.trimmed(), {}, when);
}

RecordingService::Phase RecordingService::phase() const noexcept { return data_->phase; }
const fs::path& RecordingService::file() const noexcept { return data_->file; }
std::int64_t RecordingService::bytes() const noexcept { return data_->bytes; }

double RecordingService::seconds() const {
    if (data_->phase != Phase::recording) return data_->lasted;
    return 1e-6 * static_cast<double>((SteadyClock().now() - data_->gate->begin()).count());
}

fs::path RecordingService::folder() const {
    const QString kept = data_->settings.value(kFolderKey).toString();
    if (!kept.isEmpty() && fs::is_directory(kept.toStdString())) return kept.toStdString();
    const QString documents = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
    return fs::path(documents.toStdString()) / "Lumorph recordings";
}

fs::path RecordingService::freshFile() const {
    const QString now = QDateTime::currentDateTime().toString("yyyy-MM-dd HH.mm.ss");
    return freshName(folder(), "Session " + now.toStdString());
}

void RecordingService::setRoom(std::function<std::int64_t(const fs::path&)> room) { data_->room = std::move(room); }

QString clockText(double seconds) {
    const auto whole = static_cast<std::int64_t>(std::max(0.0, seconds));
    const QString rest = QString("%1:%2").arg(whole / 60 % 60).arg(whole % 60, 2, 10, QChar('0'));
    return whole < 3600 ? rest : QString("%1:%2").arg(whole / 3600).arg(rest, 5, QChar('0'));
}

QString bytesText(std::int64_t bytes) {
    return QLocale::c().formattedDataSize(bytes, bytes < 1'000'000 ? 0 : 1, QLocale::DataSizeSIFormat);
}

} // namespace lumorph::studio

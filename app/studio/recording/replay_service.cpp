#include "app/studio/recording/replay_service.h"

#include <optional>
#include <utility>

#include <QCoreApplication>
#include <QStandardPaths>
#include <QThreadPool>
#include <QTimer>

#include "app/studio/recording/project_pack.h"
#include "app/studio/recording/replay_source.h"
#include "app/studio/recording/servo_proof.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;

constexpr auto kReplayPlace = "replay";
constexpr int kMoveMilliseconds = 50;

/// A recording, and what it was made with.
struct ReadSession {
    std::shared_ptr<const Recording> recording;
    ProjectPack project;
    bool sameProject = true; ///< as the open one
};

ReadSession readSession(const fs::path& file, const ProjectSource& open, const Progress& progress) {
    ReadSession session;
    session.recording = std::make_shared<const Recording>(readRecording(file, progress.part(0.0, 0.9)));
    const auto text = session.recording->facts.find("project");
    if (text != session.recording->facts.end()) session.project = {text->second, readFiles(file)};
    progress.report(0.95, "comparing projects");
    if (!session.project.text.empty() && open.state.rig.rig)
        session.sameProject = showsSame(session.project, packProject(open, progress));
    return session;
}

/// An hour is hundreds of megabytes; giving them back takes longer than a frame. By then the loop has let go of it too.
void letGo(std::shared_ptr<const Recording> recording) {
    if (!recording) return;
    QTimer::singleShot(1000, qApp, [held = std::move(recording)]() mutable {
        QThreadPool::globalInstance()->start([last = std::move(held)]() mutable { last.reset(); });
    });
}

fs::path projectsFolder() {
    const QString data = QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation);
    return fs::path(data.toStdString()) / "lumorph" / "recorded projects";
}

QString nameOf(const fs::path& file) { return QString::fromStdString(file.filename().string()); }

} // namespace

struct ReplayService::Data {
    Data(ReplayService& owner, StudioDocument& openDocument, ProjectService& projectService, StudioLoop& studioLoop,
         DeviceService& deviceService, Jobs& allJobs, Notices& allNotices)
        : replay(owner), document(openDocument), service(projectService), loop(studioLoop), devices(deviceService),
          jobs(allJobs), notices(allNotices) {}

    void listen();
    void take(const fs::path& from, ReadSession read);
    void show();
    void hide();
    void heedRig();
    void tellOther(bool shown);
    void fail(const std::exception& error);
    [[nodiscard]] bool fits() const;
    [[nodiscard]] bool shown() const { return source != nullptr; }

    ReplayService& replay;
    StudioDocument& document;
    ProjectService& service;
    StudioLoop& loop;
    DeviceService& devices;
    Jobs& jobs;
    Notices& notices;
    fs::path file;
    ReadSession session;
    std::shared_ptr<const Recording> none;
    std::shared_ptr<ReplaySource> source;
    fs::path awaited; ///< the recorded project's file, which is being opened
    Jobs::Id reading = 0, proving = 0, exporting = 0, unpacking = 0;
    double position = 0.0;
    bool playing = false;
    std::optional<double> left; ///< position in seconds at which it was suspended
    bool playedWhenLeft = false;
    QTimer moves;
};

void ReplayService::Data::listen() {
    moves.setInterval(kMoveMilliseconds);
    connect(&moves, &QTimer::timeout, &replay, [this] {
        const double at = source->position();
        const bool plays = source->playing();
        if (std::exchange(position, at) != at) emit replay.moved();
        if (std::exchange(playing, plays) != plays) emit replay.changed(); // it has come to its end
    });
    connect(&document, &StudioDocument::changed, &replay, [this](StateParts parts) {
        if (parts & (StatePart::rig | StatePart::rigEdited)) heedRig();
    });
    connect(&loop, &StudioLoop::taken, &replay, &ReplayService::suspend);
    connect(&service, &ProjectService::opened, &replay, [this](const QString& path) {
        if (awaited.empty() || path.toStdString() != awaited.string()) return;
        awaited.clear();
        session.sameProject = true;
        notices.dismissAll(kReplayPlace);
        if (!shown() && session.recording) show();
    });
}

bool ReplayService::Data::fits() const {
    const auto& rig = document.state().rig.rig;
    return rig && session.recording->frames.front().estimated.size() == rig->actuatorCount();
}

void ReplayService::Data::take(const fs::path& from, ReadSession read) {
    replay.close(); // one that was suspended, too
    file = from;
    session = std::move(read);
    notices.dismissAll(kReplayPlace);
    for (const std::string& warning : session.recording->warnings)
        notices.post(
            kReplayPlace,
            {Notice::Level::warning, tr("Recording %1").arg(nameOf(file)), QString::fromStdString(warning), {}, {}});
    if (session.recording->frames.empty()) {
        notices.post(kReplayPlace, {Notice::Level::warning,
                                    nameOf(file),
                                    tr("holds no frame: nothing was shown while it was recorded"),
                                    tr("choose another recording"),
                                    {}});
        return;
    }
    const bool shows = fits();
    if (shows) show();
    if (!shows || !session.sameProject) tellOther(shows);
}

void ReplayService::Data::show() {
    if (!fits()) return tellOther(false);
    const std::optional<double> from = std::exchange(left, std::nullopt);
    replay.setDrivesServos(false);
    source = std::make_shared<ReplaySource>(session.recording);
    if (from) source->seek(*from);
    if (!from || playedWhenLeft) source->play();
    playing = source->playing();
    position = source->position();
    loop.setSource(source);
    moves.start();
    emit replay.changed();
}

void ReplayService::Data::hide() {
    if (!shown()) return;
    moves.stop();
    source.reset();
    loop.setSource({});
    replay.setDrivesServos(false);
    emit replay.changed();
}

/// Servos of another rig cannot stand as the recording says.
void ReplayService::Data::heedRig() {
    if (!shown() || fits()) return;
    hide();
    if (awaited.empty()) tellOther(false);
}

void ReplayService::Data::tellOther(bool shown) {
    Notice notice;
    notice.level = shown ? Notice::Level::info : Notice::Level::warning;
    notice.subject = nameOf(file);
    notice.why = shown ? tr("was made with another project than the open one, so the light may be other than it was")
                       : tr("was made with another device than the open one");
    if (!session.project.text.empty())
        notice.actions.push_back({tr("Open its project"), [this] { replay.openProject(); }});
    else
        notice.remedy = tr("open the project that it was made with");
    if (shown) notice.actions.push_back({tr("Keep mine"), [] {}});
    notices.post(kReplayPlace, std::move(notice));
}

void ReplayService::Data::fail(const std::exception& error) { notices.post(kReplayPlace, noticeOf(error)); }

ReplayService::ReplayService(StudioDocument& document, ProjectService& service, StudioLoop& loop,
                             DeviceService& devices, Jobs& jobs, Notices& notices)
    : data_(std::make_unique<Data>(*this, document, service, loop, devices, jobs, notices)) {
    data_->listen();
}

ReplayService::~ReplayService() {
    for (const Jobs::Id id : {data_->reading, data_->proving, data_->exporting, data_->unpacking})
        data_->jobs.cancel(id);
    if (data_->shown()) data_->loop.setSource({});
}

void ReplayService::open(const fs::path& file) {
    data_->jobs.cancel(data_->reading);
    data_->reading = data_->jobs.run<ReadSession>(
        kReplayPlace, tr("Opening %1").arg(nameOf(file)),
        [file, open = data_->service.project()](const Progress& progress) { return readSession(file, open, progress); },
        [this, file](ReadSession session) { data_->take(file, std::move(session)); },
        [this](const std::exception& error) { data_->fail(error); });
}

void ReplayService::close() {
    const bool wasSuspended = std::exchange(data_->left, std::nullopt).has_value();
    data_->hide();
    data_->notices.dismissAll(kReplayPlace);
    letGo(std::exchange(data_->session, {}).recording);
    if (wasSuspended) emit changed();
}

void ReplayService::suspend() {
    if (!data_->shown()) return;
    data_->left = data_->source->position();
    data_->playedWhenLeft = data_->source->playing();
    data_->hide();
}

void ReplayService::resume() {
    if (suspended()) data_->show();
}

bool ReplayService::suspended() const noexcept { return data_->left.has_value(); }

const std::shared_ptr<const Recording>& ReplayService::recording() const noexcept {
    return data_->shown() ? data_->session.recording : data_->none;
}
const fs::path& ReplayService::file() const noexcept { return data_->file; }

void ReplayService::setPlaying(bool playing) {
    if (!data_->shown()) return;
    playing ? data_->source->play() : data_->source->pause();
    data_->playing = data_->source->playing();
    data_->loop.refresh();
    emit changed();
}

void ReplayService::seek(double seconds) {
    if (!data_->shown()) return;
    data_->source->seek(seconds);
    data_->position = data_->source->position();
    data_->loop.refresh();
    emit moved();
}

void ReplayService::setSpeed(double times) {
    if (!data_->shown()) return;
    data_->source->setSpeed(times);
    emit changed();
}

bool ReplayService::playing() const { return data_->shown() && data_->source->playing(); }
double ReplayService::position() const { return data_->shown() ? data_->source->position() : 0.0; }
double ReplayService::duration() const { return data_->shown() ? data_->source->duration() : 0.0; }
double ReplayService::speed() const { return data_->shown() ? data_->source->speed() : 1.0; }

void ReplayService::setDrivesServos(bool drives) {
    drives = drives && data_->shown();
    if (data_->devices.followsRecordings() == drives) return;
    data_->devices.setFollowsRecordings(drives);
    data_->loop.refresh(); // a recording that stands still gives its frame anew
    emit drivesServosChanged();
}
bool ReplayService::drivesServos() const { return data_->devices.followsRecordings(); }

void ReplayService::verify() {
    if (!data_->shown()) return;
    data_->proving = data_->jobs.run<ServoProof>(
        kReplayPlace, tr("Verifying the servo bytes"),
        [recording = data_->session.recording](const Progress& progress) {
            return proveServos(recording->servo, progress);
        },
        [this](const ServoProof& proof) {
            const bool equal = proof.difference.isEmpty();
            data_->notices.post(kReplayPlace, {equal ? Notice::Level::info : Notice::Level::warning,
                                               tr("Verified"),
                                               proofText(proof),
                                               {},
                                               {{tr("OK"), [] {}}}});
        },
        [this](const std::exception& error) { data_->fail(error); });
}

void ReplayService::exportTables(const fs::path& folder) {
    if (!data_->shown()) return;
    data_->exporting = data_->jobs.run<bool>(
        kReplayPlace, tr("Exporting tables"),
        [recording = data_->session.recording, folder](const Progress& progress) {
            exportCsv(*recording, folder, progress);
            return true;
        },
        [this, folder](bool) {
            data_->notices.post(kReplayPlace, {Notice::Level::info,
                                               tr("Exported"),
                                               tr("frames.csv, poses.csv, events.csv and servo.csv lie in %1")
                                                   .arg(QString::fromStdString(folder.string())),
                                               {},
                                               {{tr("OK"), [] {}}}});
        },
        [this](const std::exception& error) { data_->fail(error); });
}

void ReplayService::openProject() {
    if (data_->session.project.text.empty()) return;
    data_->unpacking = data_->jobs.run<fs::path>(
        kReplayPlace, tr("Opening its project"),
        [pack = data_->session.project, name = data_->file.stem().string()](const Progress&) {
            return unpackProject(pack, projectsFolder(), name);
        },
        [this](const fs::path& project) {
            data_->awaited = project;
            data_->service.openProject(project);
        },
        [this](const std::exception& error) { data_->fail(error); });
}

} // namespace lumorph::studio

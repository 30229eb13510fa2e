#include "app/studio/document/project_service.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <utility>

#include <QStandardPaths>

#include "app/applications/program_start.h"
#include "app/applications/registry/demos.h"
#include "app/studio/document/asset_opening.h"
#include "app/studio/document/assets.h"
#include "app/studio/document/field_building.h"
#include "app/studio/document/field_cache.h"
#include "app/studio/document/file_watch.h"
#include "app/studio/document/job_slots.h"
#include "app/studio/document/path_text.h"
#include "app/studio/document/rig_compiler.h"
#include "app/studio/document/scene_assets_reader.h"
#include "app/studio/document/session_keeper.h"
#include "app/studio/document/target_placing.h"
#include "app/weather/forecast_watch.h"
#include "app/weather/weather_fetch.h"
#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

/// What the scene's files are watched as, before their names.
constexpr const char* kScenePlace = "scene:";

/// A program that shows.
struct Played {
    std::shared_ptr<ShowProgram> program; ///< empty: it goes by time alone
    fs::path keepsake;                    ///< what it wants kept; empty: nothing is
    std::vector<Notice> notices;          ///< what it has to say: of its map, of what was kept
};

/// What was opened, and the program that shows with it.
struct Opened {
    LoadedProject loaded;
    OpenDemo demo;
    Played played;
};

/// The session that was kept, and the program that showed.
struct Kept {
    RestoredSession restored;
    Played played;
    std::optional<Notice> failure = {}; ///< why its application does not show
};

/// The same visitor's move shall not meet the same chance in each show.
std::uint64_t newSeed() {
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}

/// Null for one that is unknown here: another version may have kept the session.
const Demo* findDemo(const std::string& name) {
    const auto found = std::ranges::find(demos(), name, &Demo::name);
    return found == demos().end() ? nullptr : &*found;
}

/// The options of an application, and the feed of what changes while it runs.
struct Told {
    DemoTold told;
    DemoFeed feed;
    std::optional<Notice> notice;
};

/// A forecast on the web is fetched first, and again and again while the application has its feed: applications know no
/// network. Where none comes, the last one shows until one does.
Told withForecast(DemoTold told) {
    const auto weather = told.find("weather");
    if (weather == told.end() || !isWebAddress(weather->second)) return {std::move(told), {}, {}};
    const std::string address = weather->second;
    const CachedForecast forecast = fetchedForecast(address);
    weather->second = forecast.file.string();
    const auto watch = std::make_shared<ForecastWatch>(address, forecast.problem.empty());
    auto feed = [watch, age = forecast.age](const std::string& option) mutable -> std::optional<DemoNews> {
        if (option != "weather") return std::nullopt;
        if (age > 0.0) return DemoNews{{}, std::exchange(age, 0.0)};
        std::optional<std::string> text = watch->take();
        return text ? std::optional(DemoNews{std::move(*text), 0.0}) : std::nullopt;
    };
    std::optional<Notice> notice;
    if (!forecast.problem.empty())
        notice = Notice{Notice::Level::warning,
                        QString::fromStdString(address),
                        QString::fromStdString(forecast.problem),
                        QObject::tr("the forecast of %1 minutes ago shows until another comes")
                            .arg(std::lround(forecast.age / 60.0)),
                        {}};
    return {std::move(told), std::move(feed), std::move(notice)};
}

/// Where the keepsake of an application lies. A second studio begins with a copy of the first's.
fs::path keepsakeIn(const fs::path& folder, const std::string& demo) {
    const fs::path name = fs::path("applications") / (demo + ".json");
    const fs::path first = ProjectService::sessionFolder() / name;
    fs::path own = folder / name;
    std::error_code ignored;
    if (own != first && !fs::exists(own, ignored) && fs::exists(first, ignored)) {
        fs::create_directories(own.parent_path(), ignored);
        fs::copy_file(first, own, ignored);
    }
    return own;
}

/// Its program, which knows again what it wanted kept; none where it has none that plays. For a job's thread. Throws as
/// `beginProgram`, and DeviceError where a forecast does not come.
Played playedOf(const OpenDemo& open, const fs::path& folder, const Progress& progress) {
    const Demo* demo = open.plays ? findDemo(open.name) : nullptr;
    if (demo == nullptr || !demo->program) return {};
    Played played;
    if (demo->keeps) played.keepsake = keepsakeIn(folder, demo->name);
    Told told = withForecast(open.told);
    if (told.notice) played.notices.push_back(*told.notice);
    BegunProgram begun =
        beginProgram(*demo, {newSeed(), std::move(told.told), played.keepsake, std::move(told.feed)}, progress);
    played.program = std::move(begun.program);
    const QString name = QString::fromStdString(demo->name);
    for (const std::string& note : begun.notes)
        played.notices.push_back({Notice::Level::info, name, QString::fromStdString(note), {}, {}});
    if (!begun.problem.empty())
        played.notices.push_back({Notice::Level::warning,
                                  fileName(played.keepsake),
                                  QString::fromStdString(begun.problem),
                                  QObject::tr("what was kept lies in %1; it begins anew").arg(fullName(begun.aside)),
                                  {}});
    return played;
}

bool playsFor(Audience audience, const Demo& demo) {
    return demo.program && (audience == Audience::visitors || (demo.steps().empty() && !demo.hostEdits));
}

/// Where a session is read, and what of it is copied where.
struct SessionPlace {
    fs::path folder;  ///< of this program's sessions
    fs::path from;    ///< another folder of sessions, or the same
    std::string work; ///< the kept work to read instead; empty: the session that was kept last
};

Kept withProgram(RestoredSession restored, const fs::path& folder, const Progress& progress) {
    Kept kept{std::move(restored), {}, {}};
    OpenDemo& demo = kept.restored.session.demo;
    try {
        kept.played = playedOf(demo, folder, progress);
    } catch (const Error& error) { // the session is whole without it
        demo.plays = false;
        kept.failure = noticeOf(error);
        kept.failure->level = Notice::Level::warning;
        kept.played.notices.push_back(*kept.failure);
    }
    return kept;
}

std::optional<Kept> readSession(const SessionPlace& place, const Progress& progress) {
    std::optional<RestoredSession> session = SessionFolder::restore(place.from, place.folder, progress.part(0.0, 0.9));
    if (!session) return std::nullopt;
    return withProgram(std::move(*session), place.folder, progress.part(0.9, 1.0));
}

Kept readKeptWork(const SessionPlace& place, const Progress& progress) {
    const fs::path work = placeOfKeptWork(place.folder, place.work);
    if (work.empty()) throw DataError("kept work", "it is no longer there", "choose another");
    return withProgram(SessionFolder::restoreFrom(work, place.folder, progress.part(0.0, 0.9)), place.folder,
                       progress.part(0.9, 1.0));
}

/// Which demonstration is opened, and how.
struct Wanted {
    std::string name; ///< empty: a new project, the bundled tablet
    Audience audience = Audience::host;
    DemoTold told = {};                    ///< by the names of its options
    ProjectService::MakeProgram make = {}; ///< takes the place of its program
};

/// Neither a demonstration nor a new project belongs to a file of the user's.
Opened readBundled(const Wanted& wanted, const FieldCache& cache, const fs::path& folder, const Progress& progress) {
    const std::string& demo = wanted.name;
    Opened opened;
    LoadedProject& loaded = opened.loaded;
    if (demo.empty()) {
        auto rig = readRigAsset(resourceFile("models/tablet.glb"));
        loaded.state.rig = std::move(rig.asset);
        loaded.stamps.rig = rig.stamp;
    } else {
        const Demo& named = demoNamed(demo);
        loaded = loadedProject(named.open(progress));
        progress.throwIfCancelled();
        opened.demo = {demo, wanted.make || playsFor(wanted.audience, named), wanted.told};
        if (wanted.make)
            opened.played.program = wanted.make(newSeed());
        else
            opened.played = playedOf(opened.demo, folder, progress);
    }
    if (!loaded.state.field.field) loaded.state.field.field = cache.find(*loaded.state.rig.rig);
    return opened;
}

} // namespace

/// Projects and sessions, and what the pieces that open, build and place have in common.
struct ProjectService::Data {
    Data(ProjectService& owner, StudioDocument& openDocument, Jobs& allJobs, Notices& allNotices);

    void connectPieces();
    void watch();
    void openProject(const fs::path& file);
    /// A demo by its name, or a new project.
    void openBundled(Wanted wanted, std::function<void()> onReady);
    void replaceAll(Opened opened, const fs::path& file);
    void goOn(const SessionState& session, Played played);
    void saveTo(const fs::path& file);
    void restore(std::function<void()> onReady);
    void bringBack(const std::string& id);
    void bringBackNow(const SessionState& session, const std::string& id);
    [[nodiscard]] QString shownName() const;
    [[nodiscard]] ProjectSource source() const;
    [[nodiscard]] std::optional<SessionState> session() const;
    void tellChanged(const QString& place, const QString& path);
    void tellVanished(const QString& place, const QString& path);

    ProjectService& service;
    StudioDocument& document;
    Notices& notices;
    JobSlots jobs;
    ReadFiles read;
    ProjectExtras extras;
    OpenDemo demo;
    FieldCache cache;
    FileWatch files;
    SessionKeeper keeper;
    RigCompiler compiler;
    AssetOpening opening;
    FieldBuilding building;
    TargetPlacing placing;
    SceneAssetsReader scene;
};

ProjectService::Data::Data(ProjectService& owner, StudioDocument& openDocument, Jobs& allJobs, Notices& allNotices)
    : service(owner), document(openDocument), notices(allNotices), jobs(owner, allJobs, allNotices),
      cache(sessionFolder() / "fields"), keeper(sessionFolder(), [this] { return session(); }),
      compiler(document, notices), opening(document, jobs, notices, read, cache),
      building(document, jobs, notices, cache), placing(document, jobs, notices), scene(document, jobs, notices) {
    connect(&document, &StudioDocument::changed, &service, [this](StateParts parts) {
        if (parts & (StatePart::rig | StatePart::rigEdited | StatePart::field | StatePart::target | StatePart::scene))
            watch();
        keeper.touch();
    });
    connect(&document, &StudioDocument::titleChanged, &service, [this] { keeper.touch(); });
    connect(&files, &FileWatch::changed, &service,
            [this](const QString& place, const QString& path) { tellChanged(place, path); });
    connect(&files, &FileWatch::vanished, &service,
            [this](const QString& place, const QString& path) { tellVanished(place, path); });
    connect(&files, &FileWatch::restored, &service, [this](const QString& place, const QString& path) {
        notices.dismiss(place.startsWith(kScenePlace) ? QString("scene") : place, fileName(path.toStdString()));
    });
    connect(&keeper, &SessionKeeper::failed, &service, [this](const QString& why) {
        notices.post("project", {Notice::Level::warning, tr("Session"), why, tr("save the project"), {}});
    });
    connect(&keeper, &SessionKeeper::keptWorkChanged, &service, &ProjectService::keptWorkChanged);
    connect(&keeper, &SessionKeeper::tookOver, &service, &ProjectService::tookOver);
    connectPieces();
}

/// None of them knows another.
void ProjectService::Data::connectPieces() {
    connect(&opening, &AssetOpening::opened, &service, &ProjectService::opened);
    connect(&opening, &AssetOpening::rigOpened, &building, &FieldBuilding::buildMissing);
    connect(&opening, &AssetOpening::targetOpened, &placing, &TargetPlacing::expect);
    connect(&opening, &AssetOpening::projectChosen, &service, [this](const fs::path& file) { openProject(file); });
    connect(&opening, &AssetOpening::recordingChosen, &service, &ProjectService::recordingChosen);
    connect(&opening, &AssetOpening::fileWanted, &service, &ProjectService::chooseFile);
    connect(&building, &FieldBuilding::rigWanted, &service, [this] { emit service.chooseFile("rig"); });
    connect(&placing, &TargetPlacing::placesChanged, &service, &ProjectService::placesChanged);
    connect(&placing, &TargetPlacing::fieldWanted, &building, [this] { building.build({}, false); });
    connect(&placing, &TargetPlacing::targetWanted, &service, [this] { emit service.chooseFile("target"); });
    connect(&scene, &SceneAssetsReader::assetWanted, &service, &ProjectService::chooseAsset);
}

void ProjectService::Data::openProject(const fs::path& file) {
    jobs.run<LoadedProject>(
        "project", "project", tr("Opening %1").arg(fileName(file)),
        [file](const Progress& progress) { return loadProject(file, progress); },
        [this, file](const LoadedProject& loaded) {
            replaceAll({loaded, {}, {}}, file);
            for (const std::string& warning : loaded.warnings)
                notices.post("field",
                             {Notice::Level::warning, fileName(file), QString::fromStdString(warning), {}, {}});
            emit service.opened(fullName(file));
            emit service.openedElsewhere(fullName(file), loaded.installation);
        },
        {{tr("Choose another file..."), [this] { emit service.chooseFile("project"); }}});
}

void ProjectService::Data::openBundled(Wanted wanted, std::function<void()> onReady) {
    const auto ready = std::make_shared<std::function<void()>>(std::move(onReady));
    const QString name = QString::fromStdString(wanted.name);
    const QString told = wanted.name.empty() ? tr("Opening the tablet") : tr("Opening the demo");
    jobs.runWith<Opened>(
        "project", "project", told,
        [wanted = std::move(wanted), cache = cache, folder = keeper.folder()](const Progress& progress) {
            return readBundled(wanted, cache, folder, progress);
        },
        [this, ready](const Opened& opened) {
            replaceAll(opened, {});
            if (*ready) (*ready)();
        },
        [this, ready, name](const std::exception& error) {
            jobs.fail("project", error);
            emit service.demoFailed(name, noticeOf(error));
            if (*ready) (*ready)();
        });
}

void ProjectService::Data::replaceAll(Opened opened, const fs::path& file) {
    for (const char* slot : {"rig", "field", "target", "place"}) jobs.stop(slot);
    scene.reset();
    for (const char* place : {"rig", "field", "target", "match", "project", "scene"}) notices.dismissAll(place);
    document.commitPreview(tr("Edit")); // what is being dragged is work as well
    const std::optional<SessionState> before = document.modified() ? session() : std::nullopt;
    const std::string id = before ? keeper.replace(*before) : std::string();
    const QString name = shownName();
    LoadedProject& loaded = opened.loaded;
    read.remember(loaded.state, loaded.stamps);
    extras = std::move(loaded.extras);
    demo = std::move(opened.demo);
    loaded.state.installation.reset(); // the room stays as it is, whatever is opened in it
    document.reset(std::move(loaded.state), file);
    emit service.programOpened(std::move(opened.played.program), opened.played.keepsake);
    for (const Notice& notice : opened.played.notices) notices.post("project", notice);
    scene.takeOpened();
    building.buildMissing();
    if (!before) return;
    notices.post("project", {Notice::Level::info,
                             name,
                             tr("had changes that were not saved; they are kept"),
                             tr("bring it back now, or later by File, Bring back unsaved work"),
                             {{tr("Bring it back"), [this, before = *before, id] { bringBackNow(before, id); }}}});
}

/// What is still in memory.
void ProjectService::Data::bringBackNow(const SessionState& session, const std::string& id) {
    const auto goBack = [this, session, id](const Played& played) {
        goOn(session, played);
        document.undoStack().resetClean();
        keeper.release(id);
    };
    if (!session.demo.plays) return goBack({});
    // Its application may have a map to read.
    jobs.run<Played>(
        "project", "project", tr("Bringing it back"),
        [open = session.demo, folder = keeper.folder()](const Progress& progress) {
            return playedOf(open, folder, progress);
        },
        goBack);
}

/// What is on disk.
void ProjectService::Data::bringBack(const std::string& id) {
    jobs.run<Kept>(
        "project", "project", tr("Bringing it back"),
        [place = SessionPlace{keeper.folder(), {}, id}](const Progress& progress) {
            return readKeptWork(place, progress);
        },
        [this, id](const Kept& kept) {
            goOn(kept.restored.session, kept.played);
            document.undoStack().resetClean();
            keeper.release(id);
        });
}

void ProjectService::Data::goOn(const SessionState& session, Played played) {
    const ProjectSource& source = session.source;
    replaceAll({{source.state, {}, source.stamps, source.extras, {}}, session.demo, std::move(played)}, session.file);
}

/// What is open, for who reads of it later: the project's name, else what it was made of.
QString ProjectService::Data::shownName() const {
    const fs::path& rig = document.state().rig.path;
    if (!document.file().empty() || (demo.name.empty() && rig.empty())) return document.name();
    const Demo* open = findDemo(demo.name);
    return open != nullptr ? QString::fromStdString(open->title.english) : fileName(rig);
}

ProjectSource ProjectService::Data::source() const { return {document.state(), read.of(document.state()), extras}; }

std::optional<SessionState> ProjectService::Data::session() const {
    if (!document.state().rig.rig) return std::nullopt;
    const QUndoStack& steps = document.undoStack();
    return SessionState{source(),     document.file(), document.modified(), demo, steps.undoText().toStdString(),
                        steps.index()};
}

void ProjectService::Data::saveTo(const fs::path& file) {
    try {
        document.commitPreview(tr("Edit"));
        saveProject(source(), file);
        document.setSaved(file);
        notices.dismissAll("project");
        emit service.saved(fullName(file));
    } catch (const std::exception& error) {
        jobs.fail("project", error,
                  {{tr("Save somewhere else..."), [this] { emit service.saveElsewhere(); }},
                   {tr("Try again"), [this, file] { saveTo(file); }}});
    }
}

void ProjectService::Data::restore(std::function<void()> onReady) {
    const auto ready = std::make_shared<std::function<void()>>(std::move(onReady));
    const fs::path own = keeper.folder();
    const bool isOwn = keeper.first() || SessionFolder::hasSession(own);
    jobs.runWith<std::optional<Kept>>(
        "project", "project", tr("Opening the last session"),
        [place = SessionPlace{own, isOwn ? own : sessionFolder(), {}}](const Progress& progress) {
            return readSession(place, progress);
        },
        [this, ready, isOwn](const std::optional<Kept>& kept) {
            if (!kept) {
                openBundled({demos().front().name, Audience::host}, *ready);
                return;
            }
            const SessionState& session = kept->restored.session;
            if (isOwn) keeper.setRestored(kept->restored.number);
            goOn(session, kept->played);
            // Another studio's session is that one's to save.
            if (session.modified && isOwn) document.undoStack().resetClean();
            if (kept->failure) emit service.demoFailed(QString::fromStdString(session.demo.name), *kept->failure);
            if (*ready) (*ready)();
        },
        [this, ready, own, isOwn](const std::exception& error) {
            Notice notice = noticeOf(error);
            notice.why = tr("the last session could not be opened: %1").arg(notice.why);
            notice.remedy = isOwn ? tr("what is left of it lies in %1").arg(fullName(SessionFolder::moveAside(own)))
                                  : tr("another Lumorph has it; open what you need");
            // Told when the demo is there: what opens clears the notices of what was open.
            openBundled({demos().front().name, Audience::host}, [this, notice, ready] {
                notices.post("project", notice);
                if (*ready) (*ready)();
            });
        });
}

void ProjectService::Data::watch() {
    const StudioState& state = document.state();
    const AssetStamps stamps = read.of(state);
    std::map<QString, FileWatch::Watched> watched;
    const auto add = [&](const QString& place, const std::filesystem::path& path,
                         const std::optional<FileStamp>& stamp) {
        if (!path.empty() && stamp) watched[place] = {path, *stamp};
    };
    add("rig", state.rig.path, stamps.rig);
    add("field", state.field.path, stamps.field);
    add("target", state.target.path, stamps.target);
    for (const auto& [asset, stamp] : scene.stamps()) add(kScenePlace + QString::fromStdString(asset), asset, stamp);
    files.watch(watched);
}

void ProjectService::Data::tellChanged(const QString& place, const QString& path) {
    const std::filesystem::path file = path.toStdString();
    if (place.startsWith(kScenePlace)) return scene.readAgain(file.string());
    const auto again = [this, place, file] {
        if (place == "target")
            opening.readTargetAgain(file);
        else if (place == "rig")
            opening.openRig(file);
        else
            opening.openField(file);
    };
    notices.post(place, {Notice::Level::warning,
                         fileName(file),
                         tr("has changed on disk"),
                         tr("read it again, or keep what is open"),
                         {{tr("Read again"), again}, {tr("Keep"), [] {}}}});
}

void ProjectService::Data::tellVanished(const QString& place, const QString& path) {
    if (place.startsWith(kScenePlace)) return scene.tellVanished(path.toStdString());
    const auto saveCopy = [this] { emit service.saveElsewhere(); };
    notices.post(place, {Notice::Level::warning,
                         fileName(path.toStdString()),
                         tr("is no longer on the disk; what is open stays"),
                         tr("save the project, which then holds a copy of it"),
                         {{tr("Save a copy..."), saveCopy}, {tr("Dismiss"), [] {}}}});
}

ProjectService::ProjectService(StudioDocument& document, Jobs& jobs, Notices& notices, QObject* parent)
    : QObject(parent), data_(std::make_unique<Data>(*this, document, jobs, notices)) {}

ProjectSource ProjectService::project() const { return data_->source(); }

ProjectService::~ProjectService() = default;

void ProjectService::open(const std::filesystem::path& file) { data_->opening.open(file); }
void ProjectService::openProject(const std::filesystem::path& file) { data_->openProject(file); }
void ProjectService::openRig(const std::filesystem::path& path) { data_->opening.openRig(path); }
void ProjectService::takeRig(const std::shared_ptr<const Rig>& rig, const QString& name) {
    data_->opening.takeRig(rig, name);
}
void ProjectService::openField(const std::filesystem::path& file) { data_->opening.openField(file); }
void ProjectService::openTarget(const std::filesystem::path& file) { data_->opening.openTarget(file); }

void ProjectService::setPlacesNewTargets(bool places) { data_->placing.setPlacesNewTargets(places); }

void ProjectService::removeTarget() {
    data_->jobs.stop("target");
    data_->jobs.stop("place");
    data_->notices.dismissAll("target");
    data_->document.change(tr("Remove target"), [](StudioState& state) { state.target = {}; });
}

void ProjectService::buildField(const BuildOptions& options) { data_->building.build(options, true); }
void ProjectService::fit() { data_->placing.fit(); }
void ProjectService::autoPlace() { data_->placing.autoPlace(); }
void ProjectService::setRelief(bool relief) {
    data_->placing.autoPlace(relief ? ReliefChoice::always : ReliefChoice::never);
}
std::span<const PlacementCandidate> ProjectService::places() const { return data_->placing.places(); }
void ProjectService::choosePlace(std::size_t index) { data_->placing.choosePlace(index); }
bool ProjectService::autoPlaced() const { return data_->placing.autoPlaced(); }
void ProjectService::relink(const std::string& asset, const std::filesystem::path& file) {
    data_->scene.relink(asset, file);
}
void ProjectService::newProject() { data_->openBundled({}, {}); }
void ProjectService::openDemo(const std::string& name, Audience audience, const DemoTold& told) {
    data_->openBundled({name.empty() ? demos().front().name : name, audience, told}, {});
}
const Demo* ProjectService::demo() const noexcept { return findDemo(data_->demo.name); }
void ProjectService::endProgram() {
    if (!std::exchange(data_->demo.plays, false)) return;
    emit programOpened({}, {});
    data_->keeper.touch();
}
void ProjectService::openDemo(const std::string& name, MakeProgram make) {
    data_->openBundled({name, Audience::visitors, {}, std::move(make)}, {});
}

bool ProjectService::save() {
    const std::filesystem::path file = data_->document.file();
    if (file.empty()) return false;
    data_->saveTo(file);
    return true;
}

void ProjectService::saveAs(const std::filesystem::path& file) {
    std::filesystem::path named = file;
    if (named.extension() != ".lumorph") named += ".lumorph";
    data_->saveTo(named);
}

void ProjectService::restoreSession(std::function<void()> onReady) { data_->restore(std::move(onReady)); }

void ProjectService::keepSession() {
    try {
        data_->keeper.keepNow();
    } catch (const std::exception& error) {
        data_->jobs.fail("project", error);
    }
}

std::vector<KeptWork> ProjectService::keptWork() const { return data_->keeper.keptWork(); }
void ProjectService::bringBack(const std::string& id) { data_->bringBack(id); }
void ProjectService::setThrown(const std::string& id, bool thrown) {
    try {
        data_->keeper.setThrown(id, thrown);
    } catch (const std::exception& error) {
        data_->jobs.fail("project", error);
    }
}

bool ProjectService::keepsSession() const { return data_->keeper.first(); }
std::optional<QDateTime> ProjectService::otherSince() const { return data_->keeper.otherSince(); }

std::filesystem::path ProjectService::sessionFolder() {
    if (const char* chosen = std::getenv("LUMORPH_SESSION"); chosen && *chosen) return chosen;
    const QString data = QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation);
    return std::filesystem::path(data.toStdString()) / "lumorph" / "session";
}

} // namespace lumorph::studio

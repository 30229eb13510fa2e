#include "app/studio/document/project_service.h"

#include <cstdlib>

#include <QStandardPaths>

#include "app/studio/document/project_service_data.h"

namespace lumorph::studio {

ProjectService::Data::Data(ProjectService& owner, StudioDocument& openDocument, Jobs& allJobs, Notices& allNotices)
    : service(owner), document(openDocument), jobs(allJobs), notices(allNotices), cache(sessionFolder() / "fields"),
      keeper(sessionFolder(), [this] { return session(); }), compiler(openDocument, allNotices) {
    connect(&document, &StudioDocument::changed, &service, [this](StateParts parts) {
        if (parts & (StatePart::rig | StatePart::rigEdited | StatePart::field | StatePart::target | StatePart::scene))
            watchFiles();
        if (parts & StatePart::scene) readMissingAssets();
        if (parts & StatePart::field) {
            placeNew();
            tellStale();
        }
        keeper.touch();
    });
    connect(&document, &StudioDocument::titleChanged, &service, [this] { keeper.touch(); });
    connect(&watch, &FileWatch::changed, &service,
            [this](const QString& place, const QString& path) { tellChanged(place, path); });
    connect(&watch, &FileWatch::vanished, &service,
            [this](const QString& place, const QString& path) { tellVanished(place, path); });
    connect(&watch, &FileWatch::restored, &service, [this](const QString& place, const QString& path) {
        notices.dismiss(place.startsWith(kScenePlace) ? QString("scene") : place, fileName(path.toStdString()));
    });
    connect(&keeper, &SessionKeeper::failed, &service, [this](const QString& why) {
        notices.post("project", {Notice::Level::warning, tr("Session"), why, tr("save the project"), {}});
    });
}

ProjectService::ProjectService(StudioDocument& document, Jobs& jobs, Notices& notices, QObject* parent)
    : QObject(parent), data_(std::make_unique<Data>(*this, document, jobs, notices)) {}

ProjectSource ProjectService::project() const { return data_->source(); }

ProjectService::~ProjectService() {
    for (const auto& [slot, id] : data_->slots_) data_->jobs.cancel(id);
}

void ProjectService::open(const std::filesystem::path& file) { data_->openAsWhatItIs(file); }
void ProjectService::openProject(const std::filesystem::path& file) { data_->openProject(file); }
void ProjectService::openRig(const std::filesystem::path& path) { data_->openRig(path); }
void ProjectService::openField(const std::filesystem::path& file) { data_->openField(file); }
void ProjectService::openTarget(const std::filesystem::path& file) { data_->openTarget(file); }

void ProjectService::setPlacesNewTargets(bool places) { data_->placesNewTargets = places; }

void ProjectService::removeTarget() {
    data_->stop("target");
    data_->stop("place");
    data_->notices.dismissAll("target");
    data_->document.change(tr("Remove target"), [](StudioState& state) { state.target = {}; });
}

void ProjectService::buildField(const BuildOptions& options) { data_->build(options, true); }
void ProjectService::fit() { data_->fit(); }
void ProjectService::autoPlace() { data_->autoPlace(); }
void ProjectService::relink(const std::string& asset, const std::filesystem::path& file) { data_->relink(asset, file); }
void ProjectService::newProject() { data_->openBundled({}, {}); }
void ProjectService::openDemo(const std::string& name) { data_->openBundled(name, {}); }

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
        data_->fail("project", error);
    }
}

std::filesystem::path ProjectService::sessionFolder() {
    if (const char* chosen = std::getenv("LUMORPH_SESSION"); chosen && *chosen) return chosen;
    const QString data = QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation);
    return std::filesystem::path(data.toStdString()) / "lumorph" / "session";
}

void ProjectService::Data::watchFiles() {
    const StudioState& state = document.state();
    const AssetStamps stamps = read.of(state);
    std::map<QString, FileWatch::Watched> files;
    const auto add = [&](const QString& place, const std::filesystem::path& path,
                         const std::optional<FileStamp>& stamp) {
        if (!path.empty() && stamp) files[place] = {path, *stamp};
    };
    add("rig", state.rig.path, stamps.rig);
    add("field", state.field.path, stamps.field);
    add("target", state.target.path, stamps.target);
    for (const auto& [asset, stamp] : sceneStamps()) add(kScenePlace + QString::fromStdString(asset), asset, stamp);
    watch.watch(files);
}

void ProjectService::Data::tellChanged(const QString& place, const QString& path) {
    const std::filesystem::path file = path.toStdString();
    if (place.startsWith(kScenePlace)) return readAssetAgain(file.string());
    const auto again = [this, place, file] {
        if (place == "target")
            readTargetAgain(file);
        else if (place == "rig")
            openRig(file);
        else
            openField(file);
    };
    notices.post(place, {Notice::Level::warning,
                         fileName(file),
                         tr("has changed on disk"),
                         tr("read it again, or keep what is open"),
                         {{tr("Read again"), again}, {tr("Keep"), [] {}}}});
}

void ProjectService::Data::tellVanished(const QString& place, const QString& path) {
    if (place.startsWith(kScenePlace)) return tellVanishedAsset(path);
    const auto saveCopy = [this] { emit service.saveElsewhere(); };
    notices.post(place, {Notice::Level::warning,
                         fileName(path.toStdString()),
                         tr("is no longer on the disk; what is open stays"),
                         tr("save the project, which then holds a copy of it"),
                         {{tr("Save a copy..."), saveCopy}, {tr("Dismiss"), [] {}}}});
}

void ProjectService::Data::fail(const QString& place, const std::exception& error,
                                std::vector<Notice::Action> actions) {
    Notice notice = noticeOf(error);
    notice.actions = std::move(actions);
    notices.post(place, std::move(notice));
}

Notice::Action ProjectService::Data::chooseAnother(const QString& place) {
    return {tr("Choose another file..."), [this, place] { emit service.chooseFile(place); }};
}

} // namespace lumorph::studio

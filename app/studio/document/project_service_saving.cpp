#include "app/studio/document/project_service_data.h"
#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFieldDemo = "field";

/// A demo that is a project of its own; it belongs to no file of the user's.
LoadedProject readDemoProject(const std::string& name, const FieldCache& cache, const Progress& progress) {
    LoadedProject loaded = loadProject(resourceFile("projects/" + name + ".lumorph"), progress);
    if (!loaded.state.field.field) loaded.state.field.field = cache.find(*loaded.state.rig.rig);
    return loaded;
}

LoadedProject readBundled(const std::string& demo, const FieldCache& cache, const Progress& progress) {
    if (!demo.empty() && demo != kFieldDemo) return readDemoProject(demo, cache, progress);
    LoadedProject loaded;
    auto rig = readRigAsset(resourceFile("models/tablet.glb"));
    loaded.state.rig = std::move(rig.asset);
    loaded.stamps.rig = rig.stamp;
    loaded.state.field.field = cache.find(*loaded.state.rig.rig);
    if (demo.empty()) return loaded;
    auto target = readTargetAsset(resourceFile("targets/bloom.glb"), std::nullopt, progress);
    loaded.state.target = std::move(target.asset);
    loaded.stamps.target = target.stamp;
    loaded.state.placement =
        placementThatFits(*loaded.state.rig.rig, loaded.state.field.field.get(), loaded.state.target.target->box, {});
    return loaded;
}

} // namespace

void ProjectService::Data::openProject(const fs::path& file) {
    run<LoadedProject>(
        "project", "project", tr("Opening %1").arg(fileName(file)),
        [file](const Progress& progress) { return loadProject(file, progress); },
        [this, file](const LoadedProject& loaded) {
            replaceAll(loaded, file);
            for (const std::string& warning : loaded.warnings)
                notices.post("field",
                             {Notice::Level::warning, fileName(file), QString::fromStdString(warning), {}, {}});
            emit service.opened(fullName(file));
            emit service.openedElsewhere(fullName(file), loaded.installation);
        },
        {chooseAnother("project")});
}

void ProjectService::Data::openBundled(const std::string& demo, std::function<void()> onReady) {
    const auto ready = std::make_shared<std::function<void()>>(std::move(onReady));
    const QPointer<ProjectService> alive(&service);
    runWith<LoadedProject>(
        "project", "project", demo.empty() ? tr("Opening the tablet") : tr("Opening the demo"),
        [demo, cache = cache](const Progress& progress) { return readBundled(demo, cache, progress); },
        [this, ready](const LoadedProject& loaded) {
            replaceAll(loaded, {});
            if (*ready) (*ready)();
        },
        [this, alive, ready](const std::exception& error) {
            if (!alive) return;
            fail("project", error);
            if (*ready) (*ready)();
        });
}

void ProjectService::Data::replaceAll(LoadedProject loaded, const fs::path& file) {
    for (const char* slot : {"rig", "field", "target", "place", "scene"}) stop(slot);
    for (const char* place : {"rig", "field", "target", "match", "project", "scene"}) notices.dismissAll(place);
    const bool unsaved = document.modified();
    const SessionState before{source(), document.file(), unsaved};
    const QString name = document.name();
    read.remember(loaded.state, loaded.stamps);
    extras = std::move(loaded.extras);
    assetStamps.clear();
    reading.clear();
    loaded.state.installation.reset(); // the room stays as it is, whatever is opened in it
    document.reset(std::move(loaded.state), file);
    if (const auto& assets = document.state().assets) takeAssets(assets);
    buildMissing();
    if (!unsaved || !before.source.state.rig.rig) return;
    const auto bringBack = [this, before] {
        replaceAll({before.source.state, {}, before.source.stamps, before.source.extras, {}}, before.file);
        document.undoStack().resetClean();
    };
    notices.post("project", {Notice::Level::info,
                             name,
                             tr("had changes that were not saved"),
                             tr("bring it back to save them"),
                             {{tr("Bring it back"), bringBack}}});
}

ProjectSource ProjectService::Data::source() const { return {document.state(), read.of(document.state()), extras}; }

std::optional<SessionState> ProjectService::Data::session() const {
    if (!document.state().rig.rig) return std::nullopt;
    return SessionState{source(), document.file(), document.modified()};
}

void ProjectService::Data::saveTo(const fs::path& file) {
    try {
        document.commitPreview(tr("Edit"));
        saveProject(source(), file);
        document.setSaved(file);
        notices.dismissAll("project");
        emit service.saved(fullName(file));
    } catch (const std::exception& error) {
        fail("project", error,
             {{tr("Save somewhere else..."), [this] { emit service.saveElsewhere(); }},
              {tr("Try again"), [this, file] { saveTo(file); }}});
    }
}

void ProjectService::Data::restore(std::function<void()> onReady) {
    const auto ready = std::make_shared<std::function<void()>>(std::move(onReady));
    const QPointer<ProjectService> alive(&service);
    runWith<std::optional<SessionState>>(
        "project", "project", tr("Opening the last session"),
        [folder = sessionFolder()](const Progress& progress) { return SessionKeeper::restore(folder, progress); },
        [this, ready](const std::optional<SessionState>& session) {
            if (!session) {
                openBundled(kFirstDemo, *ready);
                return;
            }
            replaceAll({session->source.state, {}, session->source.stamps, session->source.extras, {}}, session->file);
            if (session->modified) document.undoStack().resetClean();
            if (*ready) (*ready)();
        },
        [this, alive, ready](const std::exception& error) {
            if (!alive) return;
            const fs::path aside = SessionKeeper::moveAside(sessionFolder());
            Notice notice = noticeOf(error);
            notice.why = tr("the last session could not be opened: %1").arg(notice.why);
            notice.remedy = tr("what is left of it lies in %1").arg(fullName(aside));
            // Told when the demo is there: what opens clears the notices of what was open.
            openBundled(kFirstDemo, [this, notice, ready] {
                notices.post("project", notice);
                if (*ready) (*ready)();
            });
        });
}

} // namespace lumorph::studio

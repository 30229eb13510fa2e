#include "app/studio/document/project_service_data.h"
#include "app/studio/document/scene_edit.h"
#include "app/studio/document/scene_files.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

/// What was read, and how the files looked just before.
struct ReadAssets {
    std::shared_ptr<const SceneAssets> assets;
    std::map<std::string, FileStamp> stamps;
};

ReadAssets readScene(const Scene& scene, const fs::path& project, const SceneAssets* before, const Progress& progress) {
    ReadAssets read;
    for (const std::string& asset : assetNames(scene))
        if (!isBundled(asset)) read.stamps[asset] = stampOf(asset);
    read.assets = loadSceneAssets(scene, project, before, progress);
    return read;
}

} // namespace

/// An edit, or undo, may name what was never read, or what has been let go since.
void ProjectService::Data::readMissingAssets() {
    const StudioState& state = document.state();
    if (holdsAll(state.assets.get(), *state.scene)) return;
    if (reading.empty() || reading != assetNames(*state.scene)) readAssets(state.assets);
}

void ProjectService::Data::readAssetAgain(const std::string& asset) {
    const auto& assets = document.state().assets;
    if (assets) readAssets(std::make_shared<const SceneAssets>(withoutAsset(*assets, asset)));
}

void ProjectService::Data::readAssets(std::shared_ptr<const SceneAssets> before) {
    const auto scene = document.state().scene;
    reading = assetNames(*scene);
    runWith<ReadAssets>(
        "scene", "scene", tr("Reading pictures and models"),
        [scene, project = document.file(), before = std::move(before)](const Progress& progress) {
            return readScene(*scene, project, before.get(), progress);
        },
        [this](const ReadAssets& result) {
            reading.clear();
            assetStamps = result.stamps;
            takeAssets(result.assets);
            document.setAssets(result.assets);
        },
        [this, alive = QPointer<ProjectService>(&service)](const std::exception& error) {
            if (!alive) return;
            reading.clear();
            fail("scene", error);
        });
}

/// Says what is wrong with them, and no longer what was.
void ProjectService::Data::takeAssets(const std::shared_ptr<const SceneAssets>& assets) {
    if (const auto& before = document.state().assets)
        for (const auto& [asset, problem] : before->problems)
            if (!assets->problems.contains(asset)) notices.dismiss("scene", fileName(asset));
    for (const auto& [asset, problem] : assets->problems)
        notices.post("scene", {Notice::Level::warning,
                               fileName(asset),
                               QString::fromStdString(problem),
                               {},
                               {offerRelink(asset), {tr("Dismiss"), [] {}}}});
}

std::map<std::string, FileStamp> ProjectService::Data::sceneStamps() {
    std::map<std::string, FileStamp> stamps;
    for (const std::string& asset : assetNames(*document.state().scene)) {
        if (isBundled(asset)) continue;
        if (!assetStamps.contains(asset)) assetStamps[asset] = stampOf(asset);
        stamps[asset] = assetStamps[asset];
    }
    return stamps;
}

Notice::Action ProjectService::Data::offerRelink(const std::string& asset) {
    return {tr("Relink..."), [this, asset] { emit service.chooseAsset(QString::fromStdString(asset)); }};
}

void ProjectService::Data::tellVanishedAsset(const QString& path) {
    notices.post("scene", {Notice::Level::warning,
                           fileName(path.toStdString()),
                           tr("is no longer on the disk; what is open stays"),
                           tr("save the project, which then holds a copy of it, or choose where it is now"),
                           {offerRelink(path.toStdString()), {tr("Dismiss"), [] {}}}});
}

void ProjectService::Data::relink(const std::string& asset, const fs::path& file) {
    notices.dismiss("scene", fileName(asset));
    editScene(document, tr("Relink %1").arg(fileName(asset)), [&](Scene& scene) {
        renameAssets(scene,
                     [&](const std::string& name) { return name == asset ? fs::absolute(file).string() : name; });
    });
}

} // namespace lumorph::studio

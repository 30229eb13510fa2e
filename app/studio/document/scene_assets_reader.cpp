#include "app/studio/document/scene_assets_reader.h"

#include <utility>

#include "app/studio/document/path_text.h"
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

SceneAssetsReader::SceneAssetsReader(StudioDocument& document, JobSlots& jobs, Notices& notices)
    : document_(document), jobs_(jobs), notices_(notices) {
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::scene) readMissing();
    });
}

void SceneAssetsReader::reset() {
    jobs_.stop("scene");
    stamps_.clear();
    reading_.clear();
}

void SceneAssetsReader::takeOpened() {
    if (const auto& assets = document_.state().assets) take(assets);
}

/// An edit, or undo, may name what was never read, or what has been let go since.
void SceneAssetsReader::readMissing() {
    const StudioState& state = document_.state();
    if (holdsAll(state.assets.get(), *state.scene)) return;
    if (reading_.empty() || reading_ != assetNames(*state.scene)) read(state.assets);
}

void SceneAssetsReader::readAgain(const std::string& asset) {
    const auto& assets = document_.state().assets;
    if (assets) read(std::make_shared<const SceneAssets>(withoutAsset(*assets, asset)));
}

void SceneAssetsReader::read(std::shared_ptr<const SceneAssets> before) {
    const auto scene = document_.state().scene;
    reading_ = assetNames(*scene);
    jobs_.runWith<ReadAssets>(
        "scene", "scene", tr("Reading pictures and models"),
        [scene, project = document_.file(), before = std::move(before)](const Progress& progress) {
            return readScene(*scene, project, before.get(), progress);
        },
        [this](const ReadAssets& result) {
            reading_.clear();
            stamps_ = result.stamps;
            take(result.assets);
            document_.setAssets(result.assets);
        },
        [this](const std::exception& error) {
            reading_.clear();
            jobs_.fail("scene", error);
        });
}

/// Says what is wrong with them, and no longer what was.
void SceneAssetsReader::take(const std::shared_ptr<const SceneAssets>& assets) {
    if (const auto& before = document_.state().assets)
        for (const auto& [asset, problem] : before->problems)
            if (!assets->problems.contains(asset)) notices_.dismiss("scene", fileName(asset));
    for (const auto& [asset, problem] : assets->problems)
        notices_.post("scene", {Notice::Level::warning,
                                fileName(asset),
                                QString::fromStdString(problem),
                                {},
                                {offerRelink(asset), {tr("Dismiss"), [] {}}}});
}

std::map<std::string, FileStamp> SceneAssetsReader::stamps() {
    std::map<std::string, FileStamp> stamps;
    for (const std::string& asset : assetNames(*document_.state().scene)) {
        if (isBundled(asset)) continue;
        if (!stamps_.contains(asset)) stamps_[asset] = stampOf(asset);
        stamps[asset] = stamps_[asset];
    }
    return stamps;
}

Notice::Action SceneAssetsReader::offerRelink(const std::string& asset) {
    return {tr("Relink..."), [this, asset] { emit assetWanted(QString::fromStdString(asset)); }};
}

void SceneAssetsReader::tellVanished(const std::string& asset) {
    notices_.post("scene", {Notice::Level::warning,
                            fileName(asset),
                            tr("is no longer on the disk; what is open stays"),
                            tr("save the project, which then holds a copy of it, or choose where it is now"),
                            {offerRelink(asset), {tr("Dismiss"), [] {}}}});
}

void SceneAssetsReader::relink(const std::string& asset, const fs::path& file) {
    notices_.dismiss("scene", fileName(asset));
    editScene(document_, tr("Relink %1").arg(fileName(asset)), [&](Scene& scene) {
        renameAssets(scene,
                     [&](const std::string& name) { return name == asset ? fs::absolute(file).string() : name; });
    });
}

} // namespace lumorph::studio

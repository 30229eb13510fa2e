#include "core/scene/scene_assets.h"

#include <set>

#include "core/base/error.h"
#include "core/scene/project_assets.h"
#include "core/scene/scene_asset_names.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

fs::path placeOf(const std::string& asset, const fs::path& projectFile) {
    if (!asset.starts_with("resource:") && fs::path(asset).is_absolute()) return asset;
    if (projectFile.empty() && !asset.starts_with("resource:"))
        throw DataError(asset, "is not known while the project has no folder", "save the project first");
    return assetPath(projectFile, asset);
}

std::shared_ptr<const Image> placeholder() {
    Image image({16, 16});
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            image.at(x, y) = (x / 4 + y / 4) % 2 == 0 ? Image::Pixel{255, 0, 255, 255} : Image::Pixel{96, 96, 96, 255};
    return std::make_shared<const Image>(std::move(image));
}

} // namespace

std::string imageName(const std::string& model, int image) { return model + "#" + std::to_string(image); }

std::vector<std::string> assetNames(const Scene& scene) {
    std::set<std::string> names;
    const auto add = [&names](const std::string& name) {
        if (!name.empty()) names.insert(name);
    };
    forEachAsset(scene, add, add);
    return {names.begin(), names.end()};
}

void renameAsset(Scene& scene, const std::string& from, const std::string& to) {
    const auto rename = [&from, &to](std::string& name) {
        if (name == from) name = to;
    };
    if (!from.empty()) forEachAsset(scene, rename, rename);
}

std::shared_ptr<const SceneAssets> loadSceneAssets(const Scene& scene, const std::filesystem::path& projectFile,
                                                   const SceneAssets* /*before*/, const Progress& progress) {
    auto assets = std::make_shared<SceneAssets>();
    const auto load = [&](const std::string& name, auto read, auto fail) {
        if (name.empty() || assets->images.contains(name) || assets->models.contains(name)) return;
        progress.throwIfCancelled();
        try {
            read(placeOf(name, projectFile));
        } catch (const Error& error) {
            assets->problems.emplace(name, error.what());
            fail();
        }
    };
    const auto image = [&](const std::string& name) {
        load(
            name, [&](const fs::path& file) { assets->images[name] = std::make_shared<const Image>(readPng(file)); },
            [&] { assets->images[name] = placeholder(); });
    };
    const auto model = [&](const std::string& name) {
        load(
            name,
            [&](const fs::path& file) {
                auto read = std::make_shared<SceneModel>();
                read->model = readModel(file);
                read->materials.resize(read->model.materials.size());
                assets->models[name] = std::move(read);
            },
            [] {});
    };
    forEachAsset(scene, image, model);
    return assets;
}

} // namespace lumorph

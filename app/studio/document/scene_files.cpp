#include "app/studio/document/scene_files.h"

#include <map>
#include <vector>

#include "app/studio/document/scene_edit.h"
#include "core/base/error.h"
#include "core/scene/project_assets.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

/// Takes what is in memory of an asset; empty when there is nothing.
std::string takenFromMemory(const std::string& asset, const SceneAssets& assets, const fs::path& projectFile,
                            const Progress& progress) {
    const auto take = [&](const char* extension, const std::vector<std::byte>& bytes) {
        const fs::path name = fs::path(asset).filename().replace_extension(extension);
        return takeAsset(projectFile, name.string(), bytes, progress);
    };
    if (assets.problems.contains(asset)) return {};
    if (const auto image = assets.images.find(asset); image != assets.images.end() && image->second)
        return take(".png", pngBytes(*image->second, asset));
    if (const auto model = assets.models.find(asset); model != assets.models.end() && model->second)
        return take(".glb", writeGlb(model->second->model));
    return {};
}

/// A name in the project's folder that says what is missing.
std::string namedAsMissing(const std::string& asset, const fs::path& projectFile) {
    return projectFile.stem().string() + " files/" + fs::path(asset).filename().string();
}

std::string taken(const std::string& asset, const SceneAssets* assets, const fs::path& projectFile,
                  const Progress& progress) {
    if (isBundled(asset)) return asset;
    const fs::path source = fs::path(asset).is_absolute() ? fs::path(asset) : projectFolder(projectFile) / asset;
    try {
        return takeAsset(projectFile, source, progress);
    } catch (const DataError&) {
    } // it has gone, or is no picture or model any more
    if (!assets) return namedAsMissing(asset, projectFile);
    const std::string name = takenFromMemory(asset, *assets, projectFile, progress);
    return name.empty() ? namedAsMissing(asset, projectFile) : name;
}

} // namespace

bool isBundled(const std::string& asset) { return asset.starts_with("resource:"); }

Scene withWholePaths(Scene scene, const fs::path& projectFile) {
    const fs::path folder = projectFolder(projectFile);
    renameAssets(scene, [&folder](const std::string& asset) {
        return isBundled(asset) || fs::path(asset).is_absolute() ? asset : (folder / asset).string();
    });
    return scene;
}

Scene withTakenFiles(Scene scene, const SceneAssets* assets, const fs::path& projectFile,
                     std::map<std::string, std::string>& names, const Progress& progress) {
    renameAssets(scene, [&](const std::string& asset) {
        const auto known = names.find(asset);
        return known != names.end() ? known->second
                                    : names.emplace(asset, taken(asset, assets, projectFile, progress)).first->second;
    });
    return scene;
}

bool holdsAll(const SceneAssets* assets, const Scene& scene) {
    for (const std::string& asset : assetNames(scene))
        if (!assets ||
            (!assets->images.contains(asset) && !assets->models.contains(asset) && !assets->problems.contains(asset)))
            return false;
    return true;
}

SceneAssets withoutAsset(SceneAssets assets, const std::string& asset) {
    if (const auto model = assets.models.find(asset); model != assets.models.end()) {
        const std::size_t images = model->second ? model->second->model.images.size() : 0;
        for (std::size_t i = 0; i < images; ++i) {
            const std::string name = imageName(asset, static_cast<int>(i));
            assets.images.erase(name);
            assets.problems.erase(name);
        }
        assets.models.erase(model);
    }
    assets.images.erase(asset);
    assets.problems.erase(asset);
    return assets;
}

} // namespace lumorph::studio

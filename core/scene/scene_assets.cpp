#include "core/scene/scene_assets.h"

#include <algorithm>
#include <optional>
#include <set>
#include <system_error>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/geometry/gltf_files.h"
#include "core/scene/project_assets.h"
#include "core/scene/scene_asset_names.h"
#include "core/scene/scene_model.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPictureBytes = std::size_t{256} << 20;

FileStamp stampOf(const fs::path& file) {
    FileStamp stamp{file, {}, UINTMAX_MAX};
    std::error_code failed;
    const std::uintmax_t bytes = fs::file_size(file, failed);
    if (!failed) stamp.bytes = bytes;
    const fs::file_time_type written = fs::last_write_time(file, failed);
    if (!failed) stamp.written = written;
    return stamp;
}

bool unchanged(const std::vector<FileStamp>& stamps) {
    return std::ranges::all_of(stamps, [](const FileStamp& stamp) { return stampOf(stamp.file) == stamp; });
}

/// Where a name leads, whether or not a file is there.
fs::path placeOf(const std::string& asset, const fs::path& projectFile) {
    const bool bundled = asset.starts_with("resource:");
    if (!bundled && fs::path(asset).is_absolute()) return asset;
    if (!bundled && projectFile.empty())
        throw DataError(asset, "cannot be found while the project has no folder", "save the project first");
    return assetPath(projectFile, asset);
}

class AssetLoader {
public:
    AssetLoader(const fs::path& projectFile, const SceneAssets* before, const Progress& progress)
        : projectFile_(projectFile), before_(before), progress_(progress), assets_(std::make_shared<SceneAssets>()) {}

    std::shared_ptr<const SceneAssets> run(const Scene& scene) {
        forEachAsset(
            scene, [this](const std::string& name) { addImage(name); },
            [this](const std::string& name) { addModel(name); });
        return std::move(assets_);
    }

private:
    void addImage(const std::string& name) {
        if (name.empty() || assets_->images.contains(name)) return;
        const auto place = placeFor(name);
        if (place && takenOver(name, *place)) return;
        std::shared_ptr<const Image>& image = assets_->images[name];
        image = attempt(name, place, [this, &name](const fs::path& file) {
            Image decoded = decodeImage(readFile(file, kMaxPictureBytes), name);
            budget_.charge(decoded);
            return std::make_shared<const Image>(std::move(decoded));
        });
        if (!image) image = std::make_shared<const Image>(placeholderImage());
    }

    void addModel(const std::string& name) {
        if (name.empty() || assets_->models.contains(name) || failedModels_.contains(name)) return;
        const auto place = placeFor(name);
        if (place && takenOver(name, *place)) return;
        const auto loaded = attempt(name, place, [this, &name](const fs::path& file) {
            watchReferred(file, assets_->stamps[name]);
            return std::make_shared<const LoadedModel>(loadSceneModel(file, name, budget_, progress_));
        });
        if (!loaded) {
            failedModels_.insert(name);
            return;
        }
        assets_->models[name] = loaded->model;
        for (const auto& [called, image] : loaded->images) assets_->images[called] = image;
        if (!loaded->problem.empty()) assets_->problems[name] = loaded->problem;
    }

    /// What a broken file refers to cannot be known; then it alone is watched, and its reader says what is wrong.
    static void watchReferred(const fs::path& file, std::vector<FileStamp>& stamps) {
        try {
            for (const ReferredFile& referred : filesReferredBy(file)) stamps.push_back(stampOf(referred.file));
        } catch (const DataError&) { // a picture that leads out, or what the reader refuses as well
        }
    }

    /// Nothing, and a problem, where a name leads nowhere.
    std::optional<fs::path> placeFor(const std::string& name) {
        progress_.throwIfCancelled();
        try {
            return placeOf(name, projectFile_);
        } catch (const Error& error) {
            assets_->problems[name] = named(name, error);
            return std::nullopt;
        }
    }

    template <typename Read>
    auto attempt(const std::string& name, const std::optional<fs::path>& place, Read read)
        -> decltype(read(fs::path())) {
        if (!place) return nullptr;
        progress_.report(0.0, "reading " + name);
        try {
            assets_->stamps[name] = {stampOf(*place)};
            return read(*place);
        } catch (const Error& error) {
            assets_->problems[name] = named(name, error);
            return nullptr;
        }
    }

    /// "asset: why; what to do", whatever file the error speaks of.
    static std::string named(const std::string& name, const Error& error) {
        return name + ": " + error.why() + "; " + error.remedy();
    }

    /// Takes over what has not changed since it was read.
    bool takenOver(const std::string& name, const fs::path& place) {
        if (!before_) return false;
        const auto stamps = before_->stamps.find(name);
        if (stamps == before_->stamps.end() || stamps->second.front().file != place || !unchanged(stamps->second))
            return false;
        const auto model = before_->models.find(name);
        const auto image = before_->images.find(name);
        if (image != before_->images.end()) takeOverImage(name);
        if (model != before_->models.end()) {
            assets_->models[name] = model->second;
            for (std::size_t i = 0; i < model->second->model.images.size(); ++i)
                takeOverImage(imageName(name, static_cast<int>(i)));
        }
        if (image == before_->images.end() && model == before_->models.end()) failedModels_.insert(name);
        if (const auto problem = before_->problems.find(name); problem != before_->problems.end())
            assets_->problems.insert(*problem);
        assets_->stamps.insert(*stamps);
        return true;
    }

    void takeOverImage(const std::string& name) {
        const auto image = before_->images.find(name);
        if (image == before_->images.end()) return;
        // It is in memory already.
        budget_.pixels -= std::min(budget_.pixels, image->second->pixels().size());
        assets_->images.insert(*image);
    }

    const fs::path& projectFile_;
    const SceneAssets* before_;
    const Progress& progress_;
    std::shared_ptr<SceneAssets> assets_;
    std::set<std::string> failedModels_;
    PictureBudget budget_;
};

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

void renameAssets(Scene& scene, const std::function<std::string(const std::string&)>& rename) {
    const auto visit = [&rename](std::string& name) {
        if (!name.empty()) name = rename(name);
    };
    forEachAsset(scene, visit, visit);
}

std::shared_ptr<const SceneAssets> loadSceneAssets(const Scene& scene, const std::filesystem::path& projectFile,
                                                   const SceneAssets* before, const Progress& progress) {
    return AssetLoader(projectFile, before, progress).run(scene);
}

} // namespace lumorph

#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "core/scene/scene_assets.h"

/// Reading what a scene shows. Private to core/scene.
namespace lumorph {

/// The grey and magenta squares that stand for a picture that cannot be shown.
[[nodiscard]] Image placeholderImage();

/// How much more may be unpacked; all pictures of a scene take at most 1 GiB.
struct PictureBudget {
    std::size_t pixels = std::size_t{1} << 28;
    /// Throws DataError where a picture is too much.
    void charge(const Image& image);
};

/// A model with its materials, and its pictures, decoded. A picture that is broken is no reason to leave the model out:
/// it becomes a placeholder, and `problem` says why; it is empty where all is well.
struct LoadedModel {
    std::shared_ptr<const SceneModel> model;
    std::map<std::string, std::shared_ptr<const Image>> images;
    std::string problem;
};

/// Reads a glTF; `name` is that of the asset, under which its pictures stand. Throws DataError and InvalidInput for a
/// model that cannot be shown, Cancelled.
[[nodiscard]] LoadedModel loadSceneModel(const std::filesystem::path& file, const std::string& name,
                                         PictureBudget& budget, const Progress& progress);

} // namespace lumorph

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/base/progress.h"
#include "core/geometry/model.h"
#include "core/scene/scene.h"

namespace lumorph {

/// A glTF ready to be posed. Its pictures stand in SceneAssets::images under `imageName`.
struct SceneModel {
    Model model;
    std::vector<Material> materials; ///< one a material of the glTF
};

/// A file as it was when it was read; another time or size means that it is another file by now.
struct FileStamp {
    std::filesystem::path file;
    std::filesystem::file_time_type written{};
    std::uintmax_t bytes = UINTMAX_MAX; ///< that, where there is no such file
    bool operator==(const FileStamp&) const = default;
};

/// What a scene names, read into memory. Immutable; shared between threads.
struct SceneAssets {
    std::map<std::string, std::shared_ptr<const Image>> images; ///< by asset name; a placeholder where it is broken
    std::map<std::string, std::shared_ptr<const SceneModel>> models; ///< missing where it is broken
    std::map<std::string, std::string> problems;                     ///< by asset name: what is wrong, and what to do
    std::map<std::string, std::vector<FileStamp>> stamps;            ///< by asset name: the files it was read from
};

/// The name under which a picture inside a glTF stands.
[[nodiscard]] std::string imageName(const std::string& model, int image);

/// Reads everything that a scene names. A broken or missing file is no error: it gets a placeholder and a line in
/// `problems`. What `before` holds and has not changed since is taken over, placeholders included. `projectFile` may be
/// empty: then only `resource:` names and absolute paths are found. Throws Cancelled.
[[nodiscard]] std::shared_ptr<const SceneAssets> loadSceneAssets(const Scene& scene,
                                                                 const std::filesystem::path& projectFile,
                                                                 const SceneAssets* before = nullptr,
                                                                 const Progress& progress = {});

/// All asset names of a scene, each once.
[[nodiscard]] std::vector<std::string> assetNames(const Scene& scene);

/// Gives every file that a scene names, pictures and models alike, the name that `rename` returns for it; what names
/// nothing goes on naming nothing.
void renameAssets(Scene& scene, const std::function<std::string(const std::string&)>& rename);

} // namespace lumorph

#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/base/progress.h"
#include "core/scene/project.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph::studio {

/// The scene with its files named by whole paths, so that it means the same wherever it is saved. Bundled resources
/// keep their names.
[[nodiscard]] Scene withWholePaths(Scene scene, const std::filesystem::path& projectFile);

/// The scene as a project file can hold it: its files are taken into the project's folder and named as they lie there.
/// One that has vanished is written as it is in memory; one that was never read is still named, so that it can be
/// relinked. What `names` holds, by its name in memory, is there already; what is taken is added to it. Throws
/// DeviceError when the disk refuses, Cancelled.
[[nodiscard]] Scene withTakenFiles(Scene scene, const SceneAssets* assets, const std::filesystem::path& projectFile,
                                   std::map<std::string, std::string>& names, const Progress& progress = {});

/// Whether everything that the scene names has been looked for.
[[nodiscard]] bool holdsAll(const SceneAssets* assets, const Scene& scene);
/// The assets without one of them, with all that came with it.
[[nodiscard]] SceneAssets withoutAsset(SceneAssets assets, const std::string& asset);

[[nodiscard]] bool isBundled(const std::string& asset);

} // namespace lumorph::studio

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/studio/document/assets.h"
#include "core/show/project_contents.h"

namespace lumorph::studio {

/// What a project file holds beside the state; read, kept and written back.
struct ProjectExtras {
    nlohmann::json view;
    nlohmann::json unknown;
};

/// A project and everything it names, read into memory.
struct LoadedProject {
    StudioState state;                                ///< without an installation: that is the room's
    std::shared_ptr<const Installation> installation; ///< the project's copy
    AssetStamps stamps;
    ProjectExtras extras;
    std::vector<std::string> warnings; ///< plain sentences, such as about a field that has to be built again
};

/// Reads a project with its rig, field, target and what its scene names. A field that cannot be read, or is another
/// rig's, is left out with a warning: it can be built again; a picture or model of the scene that cannot be read is
/// told in `StudioState::assets`. In memory the scene names its files by whole paths. Throws DataError for anything
/// else that is wrong; Cancelled.
[[nodiscard]] LoadedProject loadProject(const std::filesystem::path& file, const Progress& progress);

/// A demonstration, which names resources alone and brings no installation.
[[nodiscard]] LoadedProject loadedProject(const ProjectContents& demo);

/// The same without what the scene names, and that alone: for a session, whose scene goes by other names.
[[nodiscard]] LoadedProject loadProjectWithoutAssets(const std::filesystem::path& file, const Progress& progress);
void loadAssets(LoadedProject& loaded, const std::filesystem::path& file, const Progress& progress);

/// What is to be saved; a value, for any thread.
struct ProjectSource {
    StudioState state;
    AssetStamps stamps;
    ProjectExtras extras;
};

/// What a project's assets are called in its folder; empty for what there is not.
struct TakenAssets {
    std::string rig, field, target;
    std::map<std::string, std::string> scene; ///< by what the scene calls them in memory
    bool operator==(const TakenAssets&) const = default;
};

/// Saves a project: assets are taken into the folder beside it, then the file is replaced at once. What has vanished or
/// changed on disk since it was read is written as it is in memory. Throws DeviceError when the disk refuses; the old
/// project is as it was then. What is `there` by that name is not looked at again.
TakenAssets saveProject(const ProjectSource& source, const std::filesystem::path& file, const Progress& progress = {},
                        const TakenAssets& there = {});

} // namespace lumorph::studio

#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/loop/match_wish.h"
#include "core/scene/project.h"

namespace lumorph {

/// A project and all that it names, read into memory.
struct ProjectContents {
    Project project;
    std::shared_ptr<const Rig> rig;            ///< always there
    std::shared_ptr<const MatchField> field;   ///< empty where the project names none, or it is another rig's
    std::shared_ptr<const MatchTarget> target; ///< empty where the project names none
    std::shared_ptr<const SceneAssets> assets;
    std::vector<std::string> warnings; ///< plain sentences: of the field, and of pictures and models that are broken
};

/// Reads what a project names; `file` is the project's own, from which its paths lead. A field that cannot be read, or
/// is another rig's, is left out with a warning; a picture or model of the scene that cannot be read gets a placeholder
/// and a warning. Throws DataError for a rig or target that cannot be read, Cancelled.
[[nodiscard]] ProjectContents readContents(Project project, const std::filesystem::path& file,
                                           const Progress& progress = {});
[[nodiscard]] ProjectContents readContents(const std::filesystem::path& file, const Progress& progress = {});

/// What a show of it asks of the loop, in the project's own copy of the installation.
[[nodiscard]] MatchWish wishOf(const ProjectContents& contents);

} // namespace lumorph

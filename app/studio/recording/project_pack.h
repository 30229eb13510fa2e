#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/recording/session_rows.h"
#include "app/studio/document/project_io.h"
#include "core/base/progress.h"

namespace lumorph::studio {

/// A project as a recording keeps it: the text of its file, and the files that it names and that are not bundled. The
/// field is left out, since it is built again from the rig.
struct ProjectPack {
    std::string text;
    std::vector<FileRow> files; ///< by name
};

/// Throws as saveProject.
[[nodiscard]] ProjectPack packProject(ProjectSource source, const Progress& progress = {});

/// Writes it as a project into a folder of its own below `folder` and gives the project's file. Throws DeviceError.
[[nodiscard]] std::filesystem::path unpackProject(const ProjectPack& pack, const std::filesystem::path& folder,
                                                  const std::string& name);

/// Whether both show the same: rig, target and scene, however they are played.
[[nodiscard]] bool showsSame(const ProjectPack& a, const ProjectPack& b);

} // namespace lumorph::studio

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "app/cli/session.h"
#include "core/scene/show_frame.h"

namespace lumorph::cli {

/// Which moment of a project, and seen by whom.
struct ProjectMoment {
    double seconds = 0.0;         ///< since the show began
    std::optional<glm::vec3> eye; ///< in place of the scene's own, world metres
    std::optional<State> state;   ///< of the device; else it has followed the show from its beginning
};

/// A moment of a project as the passes draw it.
struct ProjectFrame {
    ShowFrame frame;
    std::vector<double> strokes; ///< of the device
    std::vector<std::string> warnings;
};

/// The file that an argument names: a path, or a bundled one such as `resource:projects/NAME.lumorph`. Throws
/// DataError when there is no such resource.
[[nodiscard]] std::filesystem::path projectFile(const std::string& name);

/// Reads a project and all it names, and lets its show run up to a moment. The same moment gives the same frame. Throws
/// DataError for what cannot be read, InvalidInput for a state that does not fit the device, Cancelled.
[[nodiscard]] ProjectFrame readProjectFrame(const std::filesystem::path& file, const ProjectMoment& moment,
                                            const Session& session);

} // namespace lumorph::cli

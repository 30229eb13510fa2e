#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/installation.h"
#include "core/scene/scene.h"

namespace lumorph::cli {

/// What a project's scene holds, and what of it cannot be found or read.
struct SceneReport {
    nlohmann::json json; ///< items by kind, servos' item, projectors, assets
    std::string text;    ///< the same in a line
    std::vector<DataError> problems;
};

[[nodiscard]] SceneReport sceneReport(const Scene& scene, const Installation& installation,
                                      const std::filesystem::path& projectFile);

} // namespace lumorph::cli

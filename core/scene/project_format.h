#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "core/scene/project.h"

/// The JSON of a project file. Private to core/scene.
namespace lumorph {

/// Brings a document to the schema of this program, one step a version. Throws DataError for a newer one.
[[nodiscard]] nlohmann::json migrated(nlohmann::json document, const std::string& file);

/// A project from a document of the present schema. Throws DataError naming the key.
[[nodiscard]] Project projectOf(nlohmann::json document, const std::string& file);

/// The document of a project, nothing checked.
[[nodiscard]] nlohmann::json documentOf(const Project& project);

} // namespace lumorph

#pragma once

#include <nlohmann/json.hpp>

#include "core/scene/installation.h"
#include "core/scene/json_section.h"
#include "core/scene/scene.h"

/// The sections `scene` and `installation` of a project file. Private to core/scene.
namespace lumorph {

/// Reads over `scene`: what is not stated stays. Throws DataError naming the key.
void readScene(const JsonSection& section, Scene& scene);

/// All of a scene, nothing checked; numbers that are not finite become null.
[[nodiscard]] nlohmann::json documentOf(const Scene& scene);

/// The same for an installation, whose file holds one too.
void readInstallation(const JsonSection& section, Installation& installation);
[[nodiscard]] nlohmann::json documentOf(const Installation& installation);

} // namespace lumorph

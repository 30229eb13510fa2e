#pragma once

#include <nlohmann/json.hpp>

#include "core/scene/json_section.h"
#include "core/scene/scene.h"

/// The section `scene` of a project file. Private to core/scene.
namespace lumorph {

/// Reads over `scene`: what is not stated stays. Throws DataError naming the key.
void readScene(const JsonSection& section, Scene& scene);

/// All of a scene, nothing checked; numbers that are not finite become null.
[[nodiscard]] nlohmann::json documentOf(const Scene& scene);

} // namespace lumorph

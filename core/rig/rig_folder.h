#pragma once

#include <filesystem>

#include "core/rig/rig.h"

namespace lumorph {

/// Reads a folder of one mesh per deformation state; see `readRig`.
[[nodiscard]] RigParts readRigFolder(const std::filesystem::path& folder);

} // namespace lumorph

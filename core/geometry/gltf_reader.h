#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/model.h"

namespace lumorph {

/// A model, and what of its file was passed over or could not be read, in plain sentences. A picture that cannot be
/// read (its Image has no bytes then) and extensions that only change how it looks are no reason to leave the geometry
/// out. Hidden nodes (KHR_node_visibility) keep no mesh, and each copy of a node that is drawn many times
/// (EXT_mesh_gpu_instancing) is a node of its own.
struct ReadModel {
    Model model;
    std::vector<std::string> warnings;
    std::vector<std::string> unread; ///< of those, the pictures that are missing or broken
};

/// As `readModel` and `readGlb`, which leave the warnings out. Throw DataError as these.
[[nodiscard]] ReadModel readModelFile(const std::filesystem::path& file);
[[nodiscard]] ReadModel readGlbBytes(std::span<const std::byte> bytes, const std::string& name);

} // namespace lumorph

#pragma once

#include <filesystem>
#include <string_view>

namespace lumorph {

/// Where resources are looked for, best place first; an empty path is no place.
struct ResourcePlaces {
    std::filesystem::path chosen;           ///< the environment's LUMORPH_RESOURCES
    std::filesystem::path executableFolder; ///< ../share/lumorph beside it, once installed
    std::filesystem::path sourceFolder;     ///< of the tree this was built from
};

/// The places of this process.
[[nodiscard]] ResourcePlaces resourcePlaces();

/// The resources folder (it holds `shaders`). A folder chosen by the environment is not replaced by
/// another. Throws DataError naming the folders looked at.
[[nodiscard]] std::filesystem::path resourcesFolder(const ResourcePlaces& places = resourcePlaces());

/// A file in the resources folder, such as "shaders/ground.frag". Throws DataError when it is missing.
[[nodiscard]] std::filesystem::path resourceFile(std::string_view name);

} // namespace lumorph

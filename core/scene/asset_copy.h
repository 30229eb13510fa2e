#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/progress.h"

/// How a file or a folder is copied into a project. Private to core/scene.
namespace lumorph {

/// The files that belong to an asset.
struct AssetFiles {
    struct File {
        std::filesystem::path name; ///< below the asset's folder
        std::filesystem::path file; ///< where it lies
        std::uintmax_t bytes = 0;
    };
    std::filesystem::path name; ///< of the file, or of the folder that holds the files
    std::filesystem::path main; ///< below that folder: what the project names; empty for the folder itself
    bool folder = false;
    std::vector<File> files;

    [[nodiscard]] std::uintmax_t bytes() const noexcept;
};

/// What belongs to a mesh, a glTF or a folder of meshes. Throws DataError when it is neither, cannot be read or is too
/// large.
[[nodiscard]] AssetFiles filesOfAsset(const std::filesystem::path& source);

/// Whether these very files, and nothing else, are at `place` already.
[[nodiscard]] bool holdsAsset(const std::filesystem::path& place, const AssetFiles& asset, const Progress& progress);

/// Copies the asset to `place`, whole or not at all; nothing may be there, and the folder around it must be. Throws
/// DeviceError, DataError or Cancelled.
void copyAsset(const AssetFiles& asset, const std::filesystem::path& place, const Progress& progress);

} // namespace lumorph

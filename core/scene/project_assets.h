#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/base/progress.h"

namespace lumorph {

/// Whether a name may stand for an asset: a path that stays in the project's folder by its words, or such a path after
/// `resource:`.
[[nodiscard]] bool isAssetName(std::string_view asset);

/// Where an asset of a project lies. Throws DataError naming the project, the asset and the remedy when it leaves the
/// folder, also through links, or is not there.
[[nodiscard]] std::filesystem::path assetPath(const std::filesystem::path& projectFile, const std::string& asset);

/// Takes a file (or a folder) into the folder beside the project, `NAME files/`, unless it lies in the project's folder
/// or is a bundled resource, and gives the asset's name. A glTF takes its buffers and images with it, in a folder of
/// its own; of a folder its meshes are taken. What is there already with the same contents is not copied again. A file
/// of the same name with other contents is not replaced: the newcomer gets a number. Everything is copied or nothing.
/// Throws DeviceError when the disk refuses, DataError when the source cannot be read, Cancelled when asked to stop.
[[nodiscard]] std::string takeAsset(const std::filesystem::path& projectFile, const std::filesystem::path& source,
                                    const Progress& progress = {});

/// The same for what is in memory alone: a file that needs no other, `name` with its extension and without a folder.
[[nodiscard]] std::string takeAsset(const std::filesystem::path& projectFile, const std::string& name,
                                    std::span<const std::byte> bytes, const Progress& progress = {});

/// The folder a project's assets are relative to: that of its file, links followed. Absolute.
[[nodiscard]] std::filesystem::path projectFolder(const std::filesystem::path& projectFile);

} // namespace lumorph

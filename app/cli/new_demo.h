#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumorph::cli {

/// Writes an application that compiles and plays, for its maker to change: its header and source in
/// `app/applications/NAME` and its picture, and names it where the project has to know it. Returns the files written,
/// relative to the tree. Throws InvalidInput for a name that is taken or cannot be one in C++, DataError for a folder
/// that is not Lumorph's source tree (nothing is written then), DeviceError where the disk refuses a file.
std::vector<std::filesystem::path> writeNewDemo(const std::filesystem::path& tree, const std::string& name);

} // namespace lumorph::cli

#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tests/core/temporary_folder.h"

namespace lumorph::test {

[[nodiscard]] std::vector<std::byte> bytesOfFile(const std::filesystem::path& file);
[[nodiscard]] std::string textOfFile(const std::filesystem::path& file);
void writeFile(const std::filesystem::path& file, std::span<const std::byte> bytes);
void writeFile(const std::filesystem::path& file, const std::string& text);

/// The names of all files in a folder, hidden ones included, sorted.
[[nodiscard]] std::vector<std::string> filesIn(const std::filesystem::path& folder);

/// A file of the resources folder, such as "models/tablet.glb".
[[nodiscard]] std::string resource(const std::string& name);

/// A folder with what a quick test of the command line needs: `rig.glb` (the cushion, three lifts),
/// `field.mdf` (its field, five levels) and `target.obj` (a box that stands on it).
class SmallWorkspace {
public:
    SmallWorkspace();
    /// Path of a file in the folder, as an argument.
    [[nodiscard]] std::string operator[](const std::string& name) const { return (folder_ / name).string(); }
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

private:
    TemporaryFolder folder_;
};

/// A file of the cut tablet, there for as long as the program runs.
[[nodiscard]] std::string cutTabletFile();

/// A folder with `tablet.mdf`, the field of the cut tablet as it is built by default.
class TabletWorkspace {
public:
    TabletWorkspace();
    [[nodiscard]] std::string operator[](const std::string& name) const { return (folder_ / name).string(); }
    [[nodiscard]] std::string field() const { return (*this)["tablet.mdf"]; }

private:
    TemporaryFolder folder_;
};

} // namespace lumorph::test

#pragma once

#include <filesystem>

#include <QString>

namespace lumorph::studio {

/// The last part of a path, as a user knows it.
[[nodiscard]] inline QString fileName(const std::filesystem::path& path) {
    const std::filesystem::path name = path.has_filename() ? path.filename() : path.parent_path().filename();
    return QString::fromStdString(name.string());
}
[[nodiscard]] inline QString fullName(const std::filesystem::path& path) {
    return QString::fromStdString(path.string());
}

} // namespace lumorph::studio

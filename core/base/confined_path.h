#pragma once

#include <filesystem>
#include <optional>

namespace lumorph {

/// Whether a path that a file names stays in that file's folder by its words alone: relative, naming something, without
/// a zero byte, and leaving by no "..": "a/../b" is "b".
[[nodiscard]] bool staysInside(const std::filesystem::path& relative);

/// Where `relative` leads from `folder`, links followed as far as the path exists; nothing when it leaves the folder,
/// by its words or through a link, or cannot be followed. Where it leads to nothing as it is written, names are taken
/// that differ in Unicode normal form or in case alone, and backslashes are taken for slashes: files that another
/// system wrote and a copy renamed.
[[nodiscard]] std::optional<std::filesystem::path> confinedPath(const std::filesystem::path& folder,
                                                                const std::filesystem::path& relative);

/// What lies in `folder` itself under the last name of `path`, whatever folders come before it there: a hint for the
/// error where confinedPath leads to nothing.
[[nodiscard]] std::optional<std::filesystem::path> sameNameIn(const std::filesystem::path& folder,
                                                              const std::filesystem::path& path);

/// Whether `path` is `folder` or lies in it; both absolute and without links, as `weakly_canonical` gives them.
[[nodiscard]] bool liesWithin(const std::filesystem::path& folder, const std::filesystem::path& path);

} // namespace lumorph

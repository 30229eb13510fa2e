#pragma once

#include <filesystem>
#include <optional>

namespace lumorph {

/// Whether a path that a file names stays in that file's folder by its words alone: relative, naming something, without
/// ".." and without a zero byte.
[[nodiscard]] bool staysInside(const std::filesystem::path& relative);

/// Where `relative` leads from `folder`, links followed as far as the path exists; nothing when it leaves the folder,
/// by its words or through a link, or cannot be followed.
[[nodiscard]] std::optional<std::filesystem::path> confinedPath(const std::filesystem::path& folder,
                                                                const std::filesystem::path& relative);

/// Whether `path` is `folder` or lies in it; both absolute and without links, as `weakly_canonical` gives them.
[[nodiscard]] bool liesWithin(const std::filesystem::path& folder, const std::filesystem::path& path);

} // namespace lumorph

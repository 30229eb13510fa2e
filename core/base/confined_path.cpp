#include "core/base/confined_path.h"

#include <algorithm>
#include <system_error>

namespace lumorph {

namespace fs = std::filesystem;

bool staysInside(const fs::path& relative) {
    if (relative.is_absolute() || relative.native().find('\0') != std::string::npos) return false;
    if (std::find(relative.begin(), relative.end(), "..") != relative.end()) return false;
    const fs::path plain = relative.lexically_normal();
    return !plain.empty() && plain != ".";
}

bool liesWithin(const fs::path& folder, const fs::path& path) {
    const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return end == folder.end();
}

std::optional<fs::path> confinedPath(const fs::path& folder, const fs::path& relative) {
    if (!staysInside(relative)) return std::nullopt;
    std::error_code failed;
    const fs::path root = fs::weakly_canonical(folder.empty() ? "." : folder, failed);
    if (failed) return std::nullopt;
    fs::path target = fs::weakly_canonical(root / relative, failed);
    if (failed || !liesWithin(root, target)) return std::nullopt;
    return target;
}

} // namespace lumorph

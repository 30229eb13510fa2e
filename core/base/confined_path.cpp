#include "core/base/confined_path.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "core/base/name_key.h"

namespace lumorph {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostEntries = 100'000; ///< of a folder that is looked through

/// The one entry of `folder` whose name differs from `name` in Unicode normal form or in case alone; nothing where
/// there is none or several.
std::optional<fs::path> likeNamed(const fs::path& folder, const fs::path& name) {
    const std::u32string key = nameKey(name.native());
    std::optional<fs::path> found;
    std::size_t seen = 0;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
        if (++seen > kMostEntries) return std::nullopt;
        if (nameKey(at->path().filename().native()) != key) continue;
        if (found) return std::nullopt;
        found = at->path().filename();
    }
    return found;
}

/// Where `relative`, which stays inside, leads to something from `root`: each part as it is written or, where nothing
/// is called so, by the name that is like it.
std::optional<fs::path> likeSpelled(const fs::path& root, const fs::path& relative) {
    fs::path at = root;
    for (const fs::path& part : relative) {
        if (part.empty() || part == ".") continue;
        std::error_code failed;
        if (fs::exists(fs::symlink_status(at / part, failed))) {
            at /= part;
            continue;
        }
        const auto like = likeNamed(at, part);
        if (!like) return std::nullopt;
        at /= *like;
    }
    return at;
}

fs::path withSlashes(const fs::path& path) {
    std::string text = path.native();
    std::ranges::replace(text, '\\', '/');
    return text;
}

/// Links followed; nothing where it leaves `root`.
std::optional<fs::path> followed(const fs::path& root, const fs::path& path) {
    std::error_code failed;
    fs::path target = fs::weakly_canonical(path, failed);
    if (failed || !liesWithin(root, target)) return std::nullopt;
    return target;
}

} // namespace

bool staysInside(const fs::path& relative) {
    if (relative.is_absolute() || relative.native().find('\0') != std::string::npos) return false;
    const fs::path plain = relative.lexically_normal();
    return !plain.empty() && plain != "." && plain != "./" && *plain.begin() != "..";
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
    const fs::path plain = relative.lexically_normal();
    auto target = followed(root, root / plain);
    if (!target || fs::exists(fs::symlink_status(*target, failed))) return target;
    if (const auto like = likeSpelled(root, plain)) return followed(root, *like);
    const fs::path slashes = withSlashes(relative).lexically_normal();
    if (slashes == plain) return target; // folders are not listed twice
    if (!staysInside(slashes)) return std::nullopt;
    if (const auto like = likeSpelled(root, slashes)) return followed(root, *like);
    return target;
}

std::optional<fs::path> sameNameIn(const fs::path& folder, const fs::path& path) {
    const fs::path name = withSlashes(path).filename();
    if (name.empty() || name == "..") return std::nullopt;
    std::error_code failed;
    if (fs::exists(folder / name, failed)) return name;
    return likeNamed(folder.empty() ? "." : folder, name);
}

} // namespace lumorph

#include "core/scene/project_assets.h"

#include <algorithm>
#include <optional>
#include <system_error>

#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/confined_path.h"
#include "core/base/file.h"
#include "core/base/resources.h"
#include "core/base/text.h"
#include "core/scene/asset_copy.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kResource = "resource:";

constexpr std::size_t kLongestName = 200; // of a path, in a message

/// The name under which a bundled resource is known; nothing for other files, or where there are no resources.
std::optional<std::string> resourceName(const fs::path& file) {
    try {
        const fs::path folder = fs::weakly_canonical(resourcesFolder());
        if (file == folder || !liesWithin(folder, file)) return std::nullopt;
        return std::string(kResource) + file.lexically_relative(folder).generic_string();
    } catch (const DataError&) {
        return std::nullopt;
    }
}

/// The name as a project file can hold it.
std::string checkedName(const std::string& name, const fs::path& source) {
    try {
        (void)nlohmann::json(name).dump();
    } catch (const nlohmann::json::exception&) {
        throw DataError(source.string(), "its name is not UTF-8", "rename it");
    }
    // A file that is really called so is not meant to be a resource.
    return name.starts_with(kResource) ? "./" + name : name;
}

fs::path existing(const fs::path& source) {
    std::error_code failed;
    fs::path real = fs::canonical(source, failed);
    if (failed)
        throw DataError(source.string(), "cannot be read: " + failed.message(),
                        "check that it exists and that you may read it");
    return real;
}

/// The folder for what a project takes in, made where it is missing and then removed again while it is empty.
class AssetFolder {
public:
    explicit AssetFolder(const fs::path& projectFile) : folder_(projectFolder(projectFile)) {
        name_ = fs::weakly_canonical(projectFile).stem().string() + " files";
        std::error_code failed;
        made_ = fs::create_directory(path(), failed);
        if (failed) throwWriteError(path(), failed.value());
        if (!confinedPath(folder_, name_))
            throw DataError(path().string(), "leads out of the project's folder through a link",
                            "replace the link by a folder");
    }
    AssetFolder(const AssetFolder&) = delete;
    AssetFolder& operator=(const AssetFolder&) = delete;
    ~AssetFolder() {
        std::error_code ignored;
        if (made_) fs::remove(path(), ignored); // goes only while it is empty
    }
    [[nodiscard]] fs::path path() const { return folder_ / name_; }
    [[nodiscard]] const fs::path& name() const noexcept { return name_; }

private:
    fs::path folder_;
    fs::path name_;
    bool made_ = false;
};

/// "dunes.glb", "dunes 2.glb", "dunes 3.glb" and so on.
fs::path numbered(const fs::path& name, bool folder, int number) {
    if (number == 1) return name;
    const std::string suffix = " " + std::to_string(number);
    if (folder) return name.string() + suffix;
    return name.stem().string() + suffix + name.extension().string();
}

/// Where the asset lies in `files`, below it: the first of its numbered names that is free, and is written then, or
/// that `holds` it already.
template <class Holds, class Write>
fs::path placeIn(const AssetFolder& files, const fs::path& name, bool folder, const Progress& progress, Holds holds,
                 Write write) {
    for (int number = 1;; ++number) {
        progress.throwIfCancelled();
        fs::path numberedName = numbered(name, folder, number);
        const fs::path place = files.path() / numberedName;
        std::error_code failed;
        const fs::file_type type = fs::symlink_status(place, failed).type();
        if (type == fs::file_type::none) throwWriteError(place, failed.value());
        const bool there = type != fs::file_type::not_found;
        if (there && !holds(place)) continue;
        if (!there) write(place);
        return numberedName;
    }
}

bool holdsBytes(const fs::path& place, std::span<const std::byte> bytes) {
    std::error_code failed;
    if (!fs::is_regular_file(fs::symlink_status(place, failed)) || fs::file_size(place, failed) != bytes.size() ||
        failed)
        return false;
    return std::ranges::equal(readFile(place, bytes.size()), bytes);
}

} // namespace

fs::path projectFolder(const fs::path& projectFile) {
    std::error_code failed;
    const fs::path file = fs::weakly_canonical(fs::absolute(projectFile, failed), failed);
    if (failed)
        throw DataError(projectFile.string(), "its folder cannot be found: " + failed.message(), "choose another file");
    return file.parent_path();
}

bool isAssetName(std::string_view asset) {
    if (asset.starts_with(kResource)) asset.remove_prefix(kResource.size());
    return staysInside(fs::path(asset));
}

fs::path assetPath(const fs::path& projectFile, const std::string& asset) {
    const std::string subject = projectFile.string();
    const bool bundled = asset.starts_with(kResource);
    const fs::path folder = bundled ? fs::weakly_canonical(resourcesFolder()) : projectFolder(projectFile);
    if (asset.empty()) throw DataError(subject, "names no such file", "choose one");
    const auto path = confinedPath(folder, bundled ? asset.substr(kResource.size()) : asset);
    if (!path)
        throw DataError(subject,
                        inQuotes(asset, kLongestName) + " leads out of the " +
                            (bundled ? "resources" : "project's folder"),
                        "put the file itself beside the project");
    std::error_code failed;
    if (!fs::exists(*path, failed)) {
        const auto near = bundled ? std::nullopt : sameNameIn(folder, asset);
        throw DataError(
            subject,
            inQuotes(asset, kLongestName) + " is not there" +
                (near ? ", but " + inQuotes(near->string(), kLongestName) + " lies beside the project" : std::string()),
            bundled ? "install Lumorph again"
            : near  ? "move it back to where the project looks for it, or choose it again"
                    : "put it back, or choose another file");
    }
    return *path;
}

std::string takeAsset(const fs::path& projectFile, const fs::path& source, const Progress& progress) {
    const fs::path real = existing(source);
    if (const auto resource = resourceName(real)) return *resource;
    const fs::path folder = projectFolder(projectFile);
    if (real != folder && liesWithin(folder, real))
        return checkedName(real.lexically_relative(folder).generic_string(), source);

    const AssetFiles asset = filesOfAsset(source);
    (void)checkedName(asset.name.string() + asset.main.string(), source);
    const AssetFolder files(projectFile);
    const fs::path name = placeIn(
        files, asset.name, asset.folder, progress,
        [&](const fs::path& place) { return holdsAsset(place, asset, progress); },
        [&](const fs::path& place) { copyAsset(asset, place, progress); });
    const fs::path inside = files.name() / name;
    return checkedName((asset.folder && !asset.main.empty() ? inside / asset.main : inside).generic_string(), source);
}

std::string takeAsset(const fs::path& projectFile, const std::string& name, std::span<const std::byte> bytes,
                      const Progress& progress) {
    (void)checkedName(name, name);
    const AssetFolder files(projectFile);
    const fs::path taken = placeIn(
        files, name, false, progress, [&](const fs::path& place) { return holdsBytes(place, bytes); },
        [&](const fs::path& place) { writeFileAtomically(place, bytes); });
    return checkedName((files.name() / taken).generic_string(), name);
}

} // namespace lumorph

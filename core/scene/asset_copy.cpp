#include "core/scene/asset_copy.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <system_error>

#include <unistd.h>

#include "core/base/atomic_file.h"
#include "core/base/confined_path.h"
#include "core/base/text.h"
#include "core/geometry/gltf_files.h"
#include "core/geometry/mesh_file.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk = std::size_t{1} << 20;

[[noreturn]] void failUnreadable(const fs::path& file, const std::string& reason) {
    throw DataError(file.string(), "cannot be read: " + reason, "check that it exists and that you may read it");
}

AssetFiles::File measured(fs::path name, const fs::path& file) {
    std::error_code failed;
    const bool regular = fs::is_regular_file(file, failed);
    if (failed) failUnreadable(file, failed.message());
    if (!regular) throw DataError(file.string(), "is not a file", "choose a file or a folder of meshes");
    const std::uintmax_t bytes = fs::file_size(file, failed);
    if (failed) failUnreadable(file, failed.message());
    if (bytes > kMaxFileBytes)
        throw DataError(file.string(), "is larger than " + std::to_string(kMaxFileBytes >> 20) + " MiB",
                        "reduce its detail or split it");
    return {std::move(name), file, bytes};
}

/// A mesh and, for a glTF, what it refers to.
void addMesh(const fs::path& file, std::vector<AssetFiles::File>& files) {
    files.push_back(measured(file.filename(), file));
    if (!isGltfFile(file)) return;
    for (const ReferredFile& referred : filesReferredBy(file)) {
        if (!staysInside(referred.name))
            throw DataError(file.string(), "refers to " + inQuotes(referred.name.string()) + ", outside of its folder",
                            "put what it needs beside it");
        if (!referred.missing) files.push_back(measured(referred.name, referred.file));
    }
}

AssetFiles filesOfFolder(const fs::path& folder) {
    std::error_code failed;
    AssetFiles asset{fs::weakly_canonical(folder, failed).filename(), {}, true, {}};
    if (asset.name.empty()) asset.name = "meshes"; // the root folder has no name
    failed.clear();
    for (fs::directory_iterator at(folder, failed); !failed && at != fs::directory_iterator(); at.increment(failed))
        if (isMeshFile(at->path())) addMesh(at->path(), asset.files);
    if (failed) failUnreadable(folder, failed.message());
    if (asset.files.empty())
        throw DataError(folder.string(), "holds no meshes", "choose a folder of one mesh per state");
    // Several glTF files may share a buffer.
    std::ranges::sort(asset.files, {}, &AssetFiles::File::name);
    const auto sameName = [](const AssetFiles::File& a, const AssetFiles::File& b) { return a.name == b.name; };
    asset.files.erase(std::unique(asset.files.begin(), asset.files.end(), sameName), asset.files.end());
    return asset;
}

struct Close {
    void operator()(std::FILE* stream) const noexcept { std::fclose(stream); }
};
using Stream = std::unique_ptr<std::FILE, Close>;

Stream opened(const fs::path& file) {
    Stream stream(std::fopen(file.c_str(), "rbe"));
    if (!stream) failUnreadable(file, std::generic_category().message(errno));
    return stream;
}

std::size_t readChunk(std::FILE* stream, const fs::path& file, std::vector<char>& chunk) {
    const std::size_t got = std::fread(chunk.data(), 1, chunk.size(), stream);
    if (std::ferror(stream) != 0) failUnreadable(file, std::generic_category().message(errno));
    return got;
}

bool sameContents(const fs::path& there, const AssetFiles::File& file, const Progress& progress) {
    std::error_code failed;
    if (fs::file_size(there, failed) != file.bytes || failed) return false;
    const Stream a = opened(there);
    const Stream b = opened(file.file);
    std::vector<char> ofA(kChunk);
    std::vector<char> ofB(kChunk);
    for (;;) {
        progress.throwIfCancelled();
        const std::size_t got = readChunk(a.get(), there, ofA);
        if (readChunk(b.get(), file.file, ofB) != got || std::memcmp(ofA.data(), ofB.data(), got) != 0) return false;
        if (got < kChunk) return true;
    }
}

/// A folder of its own beside the place of a copy, removed with all it holds.
class Staging {
public:
    explicit Staging(const fs::path& place) {
        std::string name = (place.parent_path() / ".lumorph-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throwWriteError(place, errno);
        path_ = name;
    }
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;
    ~Staging() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    [[nodiscard]] const fs::path& path() const noexcept { return path_; }

private:
    fs::path path_;
};

/// Copies whole assets; errors name the place they were meant for, not the one they are prepared in.
class Copier {
public:
    Copier(const AssetFiles& asset, const fs::path& place, const Progress& progress)
        : place_(place), progress_(progress), total_(static_cast<double>(std::max<std::uintmax_t>(asset.bytes(), 1))) {}

    void copy(const AssetFiles::File& file, const fs::path& to) {
        std::error_code failed;
        fs::create_directories(to.parent_path(), failed);
        if (failed) throwWriteError(place_, failed.value());
        const Stream from = opened(file.file);
        Stream stream(std::fopen(to.c_str(), "wbxe"));
        if (!stream) throwWriteError(place_, errno);
        std::vector<char> chunk(kChunk);
        while (const std::size_t got = readChunk(from.get(), file.file, chunk)) {
            progress_.throwIfCancelled();
            if (std::fwrite(chunk.data(), 1, got, stream.get()) != got) throwWriteError(place_, errno);
            done_ += static_cast<double>(got);
            progress_.report(std::min(done_ / total_, 1.0), "copying");
        }
        if (std::fflush(stream.get()) != 0) throwWriteError(place_, errno);
        if (::fsync(::fileno(stream.get())) != 0 && errno != EINVAL) throwWriteError(place_, errno);
        if (std::fclose(stream.release()) != 0) throwWriteError(place_, errno);
    }

private:
    const fs::path& place_;
    const Progress& progress_;
    double total_;
    double done_ = 0.0;
};

} // namespace

std::uintmax_t AssetFiles::bytes() const noexcept {
    std::uintmax_t sum = 0;
    for (const File& file : files) sum += file.bytes;
    return sum;
}

AssetFiles filesOfAsset(const fs::path& source) {
    std::error_code failed;
    if (fs::is_directory(source, failed)) return filesOfFolder(source);
    AssetFiles asset{source.filename(), source.filename(), false, {}};
    addMesh(source, asset.files);
    if (asset.files.size() == 1) return asset;
    asset.name = source.stem();
    asset.folder = true;
    return asset;
}

bool holdsAsset(const fs::path& place, const AssetFiles& asset, const Progress& progress) {
    std::error_code failed;
    const fs::file_status status = fs::symlink_status(place, failed);
    if (!asset.folder) return fs::is_regular_file(status) && sameContents(place, asset.files.front(), progress);
    if (!fs::is_directory(status)) return false;
    std::set<fs::path> there;
    for (fs::recursive_directory_iterator at(place, failed); !failed && at != fs::recursive_directory_iterator();
         at.increment(failed))
        if (!fs::is_directory(at->symlink_status())) there.insert(at->path().lexically_relative(place));
    if (failed || there.size() != asset.files.size()) return false;
    return std::ranges::all_of(asset.files, [&](const AssetFiles::File& file) {
        return there.contains(file.name) && fs::is_regular_file(fs::symlink_status(place / file.name)) &&
               sameContents(place / file.name, file, progress);
    });
}

void copyAsset(const AssetFiles& asset, const fs::path& place, const Progress& progress) {
    const Staging staging(place);
    const fs::path prepared = staging.path() / "asset";
    Copier copier(asset, place, progress);
    for (const AssetFiles::File& file : asset.files) copier.copy(file, asset.folder ? prepared / file.name : prepared);
    progress.throwIfCancelled();
    std::error_code failed;
    fs::rename(prepared, place, failed);
    if (failed) throwWriteError(place, failed.value());
}

} // namespace lumorph

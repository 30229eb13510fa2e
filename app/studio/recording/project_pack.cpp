#include "app/studio/recording/project_pack.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <span>
#include <utility>

#include <QTemporaryDir>
#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;

constexpr auto kFile = "session.lumorph";

std::string contentsOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw DeviceError(file.string(), "it cannot be read", "check who may read it");
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<FileRow> filesBeside(const fs::path& project, const Progress& progress) {
    std::vector<FileRow> files;
    const fs::path folder = project.parent_path();
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.path() == project) continue;
        progress.throwIfCancelled();
        const std::string bytes = contentsOf(entry.path());
        files.push_back({entry.path().lexically_relative(folder).generic_string(), {bytes.begin(), bytes.end()}});
    }
    std::ranges::sort(files, {}, &FileRow::name);
    return files;
}

/// What is seen of a project, without how it is played and looked at.
nlohmann::json seen(const std::string& text) {
    nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
    if (!document.is_object()) return {};
    for (const char* key : {"field", "placement", "strokes", "matching", "playback", "view"}) document.erase(key);
    return document;
}

/// One that is not there yet.
fs::path freshFolder(const fs::path& folder, const std::string& name) {
    fs::path fresh = folder / name;
    for (int number = 2; fs::exists(fresh); ++number) fresh = folder / (name + ' ' + std::to_string(number));
    return fresh;
}

} // namespace

ProjectPack packProject(ProjectSource source, const Progress& progress) {
    const QTemporaryDir folder;
    if (!folder.isValid())
        throw DeviceError("temporary folder", folder.errorString().toStdString(), "free some disk space");
    const fs::path file = fs::path(folder.path().toStdString()) / kFile;
    source.state.field = {};
    saveProject(source, file, progress);
    return {contentsOf(file), filesBeside(file, progress)};
}

fs::path unpackProject(const ProjectPack& pack, const fs::path& folder, const std::string& name) {
    const fs::path own = freshFolder(folder, name);
    const auto write = [&own](const fs::path& file, const auto& bytes) {
        std::error_code problem;
        fs::create_directories((own / file).parent_path(), problem);
        if (problem) throw DeviceError((own / file).string(), problem.message(), "free some disk space");
        writeFileAtomically(own / file, std::as_bytes(std::span(bytes)));
    };
    for (const FileRow& file : pack.files) write(file.name, file.bytes);
    write(name + ".lumorph", pack.text);
    return own / (name + ".lumorph");
}

bool showsSame(const ProjectPack& a, const ProjectPack& b) {
    return a.files == b.files && seen(a.text) == seen(b.text);
}

} // namespace lumorph::studio

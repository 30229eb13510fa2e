#include "devices/firmware/sketch.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "devices/firmware/pin_header.h"

namespace lumorph {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 1'000'000; // a board has room for 32 kB of code
constexpr auto kName = "tablet";
constexpr auto kMainFile = "tablet.ino";

using Files = std::map<std::string, std::vector<std::byte>>;

/// What an editor may have left beside the sources is no part of the sketch.
bool isSource(const fs::path& file) {
    const fs::path ending = file.extension();
    return ending == ".ino" || ending == ".cpp" || ending == ".h";
}

Files readSketch(const fs::path& folder) {
    Files files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (isSource(entry.path())) files[entry.path().filename().string()] = readFile(entry.path(), kMostBytes);
    return files;
}

/// A name without blanks, which the Arduino IDE takes for a sketch.
fs::path makeFreshFolder(const fs::path& parent) {
    std::error_code error;
    fs::path folder = parent / kName;
    for (int k = 2; fs::exists(fs::symlink_status(folder, error)); ++k)
        folder = parent / (std::string(kName) + "-" + std::to_string(k));
    if (!fs::create_directory(folder, error)) throwWriteError(folder, error ? error.value() : EEXIST);
    return folder;
}

} // namespace

fs::path sketchFolder(const fs::path& resources) {
    const std::array places = {resources / "firmware" / kName,
                               (resources / "../devices/firmware" / kName).lexically_normal()};
    std::error_code error;
    for (const fs::path& place : places)
        if (fs::is_regular_file(place / kMainFile, error)) return place;
    throw DataError(places.front().string(), "the sketch for the board is missing", "install Lumorph again");
}

fs::path writeSketch(const DeviceProfile& profile, const fs::path& parent, const BoardSequence* poses) {
    const std::string header = channelsHeader(profile);
    Files files = readSketch(sketchFolder());
    const auto put = [&files](const std::string& name, const std::string& text) {
        const auto bytes = std::as_bytes(std::span(text));
        files[name].assign(bytes.begin(), bytes.end());
    };
    put("channels.h", header);
    if (poses) put("poses.h", posesHeader(profile, *poses));
    fs::path folder = makeFreshFolder(parent);
    const std::string mainFile = folder.filename().string() + ".ino";
    try {
        for (const auto& [name, content] : files)
            writeFileAtomically(folder / (name == kMainFile ? mainFile : name), content);
    } catch (...) {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
        throw;
    }
    return folder;
}

} // namespace lumorph

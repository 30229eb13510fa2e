#include "core/base/resources.h"

#include <cstdlib>
#include <string>
#include <system_error>

#include "core/base/error.h"

namespace lumorph {
namespace {

bool holdsResources(const std::filesystem::path& folder) {
    std::error_code error;
    return !folder.empty() && std::filesystem::is_directory(folder / "shaders", error);
}

} // namespace

ResourcePlaces resourcePlaces() {
    ResourcePlaces places;
    if (const char* chosen = std::getenv("LUMORPH_RESOURCES")) places.chosen = chosen;
    std::error_code error;
    places.executableFolder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    places.sourceFolder = LUMORPH_SOURCE_RESOURCES;
    return places;
}

std::filesystem::path resourcesFolder(const ResourcePlaces& places) {
    const std::string remedy = "set LUMORPH_RESOURCES to the folder that holds `shaders`, or install Lumorph again";
    if (!places.chosen.empty()) {
        if (holdsResources(places.chosen)) return places.chosen;
        throw DataError(places.chosen.string(), "the folder in LUMORPH_RESOURCES holds no resources", remedy);
    }
    auto installed = places.executableFolder.empty()
                         ? std::filesystem::path()
                         : (places.executableFolder / "../share/lumorph").lexically_normal();
    if (holdsResources(installed)) return installed;
    if (holdsResources(places.sourceFolder)) return places.sourceFolder;
    throw DataError(installed.string(), "the resources of Lumorph are missing", remedy);
}

std::filesystem::path resourceFile(std::string_view name) {
    std::filesystem::path file = resourcesFolder() / name;
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error)) return file;
    throw DataError(file.string(), "the resource is missing", "install Lumorph again");
}

} // namespace lumorph

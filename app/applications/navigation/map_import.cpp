#include "app/applications/navigation/map_import.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/applications/navigation/city_json.h"
#include "app/applications/navigation/import_gdal.h"
#include "app/applications/navigation/import_state.h"
#include "app/applications/navigation/map_assembly.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph::navigation {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 400;

bool endsIn(const fs::path& file, std::initializer_list<std::string_view> endings) {
    const std::string name = lowerCase(file.filename().string());
    return std::ranges::any_of(endings, [&](std::string_view ending) { return name.ends_with(ending); });
}

bool isOutlines(const fs::path& file) {
    return endsIn(file, {".geojson", ".json", ".osm", ".pbf", ".cityjson", ".gpkg", ".shp"});
}

bool isHeights(const fs::path& file) {
    return endsIn(file, {".tif", ".tiff", ".png", ".hgt", ".asc", ".vrt", ".img", ".bil"});
}

bool isPhoto(const fs::path& file) { return endsIn(file, {".jpg", ".jpeg", ".jp2", ".webp", ".ecw", ".sid"}); }

/// What belongs to a file beside it: its place, projection, table, overviews.
bool isCompanion(const fs::path& file) {
    return file.filename().string().starts_with('.') ||
           endsIn(file,
                  {".aux.xml", ".ovr", ".msk",     ".tfw",     ".tifw", ".pgw", ".pngw", ".jgw", ".jpgw", ".wld",
                   ".prj",     ".qpj", ".dbf",     ".shx",     ".cpg",  ".sbn", ".sbx",  ".hdr", ".rrd",  ".ige",
                   ".rde",     ".stx", ".shp.xml", ".tif.xml", ".clr",  ".blw", ".bpw",  ".qix", ".qmd",  ".j2w"});
}

struct Found {
    std::vector<fs::path> maps, others; ///< what is read; what is none
};

Found filesOf(const fs::path& place) {
    std::error_code error;
    Found found;
    if (!fs::exists(place, error)) throw DataError(place.string(), "there is no such file or folder", "check its name");
    if (!fs::is_directory(place, error)) {
        found.maps.push_back(place);
        return found;
    }
    for (const auto& entry : fs::directory_iterator(place, error)) {
        if (!entry.is_regular_file(error) || isCompanion(entry.path())) continue;
        const bool map = isHeights(entry.path()) || isOutlines(entry.path());
        (map ? found.maps : found.others).push_back(entry.path());
        if (found.maps.size() > kMostFiles)
            throw DataError(place.string(), "it holds more than 400 map files", "choose a smaller piece of land");
    }
    std::ranges::sort(found.maps);
    std::ranges::sort(found.others);
    if (found.maps.empty())
        throw DataError(place.string(), "it holds no map files",
                        "put GeoTIFF, PNG, hgt, GeoJSON, CityJSON or OSM files there");
    return found;
}

Words whyNoMap(const fs::path& file) {
    if (isPhoto(file)) return {"it is a photo and has no heights", "sie ist ein Foto und enthält keine Höhen"};
    return {"it is of no kind of map that is known", "sie ist von keiner bekannten Art von Karte"};
}

} // namespace

ImportedMap importMap(const fs::path& fileOrFolder, const Progress& progress) {
    const GdalForFiles gdal;
    const Found found = filesOf(fileOrFolder);
    if (const fs::path& first = found.maps.front(); !isHeights(first) && !isOutlines(first))
        throw DataError(first.string(), whyNoMap(first).english,
                        "use GeoTIFF, PNG, hgt, GeoJSON, CityJSON, .osm or .pbf");
    ImportState state;
    std::vector<fs::path> heights;
    std::ranges::copy_if(found.maps, std::back_inserter(heights), isHeights);
    readGround(heights, state, progress);
    for (const fs::path& file : found.maps) {
        if (!isOutlines(file)) continue;
        if (isCityJson(file))
            readCity(file, state);
        else
            readOutlines(file, state, progress);
    }
    for (const fs::path& file : found.others) state.passOver(file, whyNoMap(file));
    if (!state.any)
        throw DataError(fileOrFolder.string(),
                        state.problem.empty() ? "nothing in it can be shown" : state.problem.english,
                        "check the file, or choose another one");
    ImportedMap imported;
    imported.projection = state.projection;
    try {
        const bool level = state.sources.heights.empty();
        imported.origin = state.sources.origin;
        imported.report = std::move(state.report);
        imported.map = assembled(std::move(state.sources), imported.report);
        if (level) imported.origin = {};
    } catch (const InvalidInput& problem) {
        throw DataError(fileOrFolder.string(), problem.why(), problem.remedy());
    }
    imported.map.title = fileOrFolder.stem().string();
    progress.report(1.0, "Ready");
    return imported;
}

std::string figuresOf(const ImportedMap& imported) {
    double tallest = 0.0;
    for (const Building& building : imported.map.buildings) tallest = std::max(tallest, building.ridge - building.base);
    return nlohmann::json{{"lowest", imported.map.heights.lowest()},
                          {"highest", imported.map.heights.highest()},
                          {"buildings", imported.report.buildings},
                          {"tallest", tallest},
                          {"passedOver", imported.report.passedOver}}
        .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace); // names of files may be no UTF-8
}

} // namespace lumorph::navigation

#include "app/applications/navigation/map_import.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogrsf_frmts.h>

#include <glm/common.hpp>

#include "app/applications/navigation/city_json.h"
#include "app/applications/navigation/map_assembly.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph::navigation {
namespace {

namespace fs = std::filesystem;
using Dataset = std::unique_ptr<GDALDataset>;

constexpr std::size_t kMostFiles = 400, kMostFeatures = 2'000'000;
constexpr double kHugePixels = 6.0e7;    ///< from so many on only some rows are read
constexpr int kHugeSide = 4096;          ///< of what is read of such a raster
constexpr double kAssumedSpacing = 30.0; ///< metres between samples of a picture that tells nothing
constexpr double kMetresADegree = 111320.0;

/// Keeps GDAL from printing, and what it said last.
class Quiet {
public:
    Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
    ~Quiet() { CPLPopErrorHandler(); }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
    [[nodiscard]] static std::string said() { return words().english; }
    [[nodiscard]] static Words words() {
        const std::string text = CPLGetLastErrorMsg();
        if (text.empty()) return {"it is damaged or of an unknown kind", "sie ist beschädigt oder von unbekannter Art"};
        return {"GDAL says " + inQuotes(text, 160), "GDAL sagt " + inQuotes(text, 160)};
    }
};

int CPL_STDCALL onProgress(double share, const char*, void* progress) {
    const auto& told = *static_cast<const Progress*>(progress);
    told.report(share, "Reading heights");
    return told.cancelled() ? FALSE : TRUE;
}

OGRSpatialReference systemOf(int epsg) {
    OGRSpatialReference system;
    (void)system.importFromEPSG(epsg);
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return system;
}

int utmAt(const glm::dvec2& lonLat) {
    const int zone = std::clamp(static_cast<int>(std::floor((lonLat.x + 180.0) / 6.0)) + 1, 1, 60);
    return (lonLat.y < 0.0 ? 32700 : 32600) + zone;
}

/// Words for GDAL's tools.
class ToolWords {
public:
    ToolWords& add(const std::string& word) {
        list_.AddString(word.c_str());
        return *this;
    }
    [[nodiscard]] char** list() { return list_.List(); }

private:
    CPLStringList list_;
};

/// Where a raster lies by its own word, or by a guess where that cannot be.
struct Lies {
    glm::dvec2 middle{0.0}; ///< in `system`
    glm::dvec2 size{0.0};
    std::string system; ///< as GDAL's tools take it; empty: plain metres of its own
};

class Reader {
public:
    explicit Reader(const Progress& progress) : progress_(progress) {}

    void read(const std::vector<fs::path>& files);
    [[nodiscard]] MapSources takeSources() { return std::move(sources_); }
    [[nodiscard]] MapReport& report() { return report_; }
    [[nodiscard]] const std::string& projection() const { return projection_; }
    [[nodiscard]] bool readAny() const { return any_; }

private:
    void note(const fs::path& file, const Words& text) {
        const std::string name = file.filename().string() + ": ";
        report_.notes.emplace_back(name + text.english, name + text.german);
    }
    void leaveOut(const fs::path& file) {
        const Words said = Quiet::words();
        note(file, {said.english + "; it is left out.", said.german + "; sie ist ausgelassen."});
    }
    Dataset thinned(const fs::path& file, Dataset raster);
    Dataset placed(const fs::path& file, Dataset raster);
    void mosaic(std::vector<Dataset> rasters);
    void takeHeights(GDALDataset& ground);
    void readOutlines(const fs::path& file);
    void readCity(const fs::path& file);
    void chooseSystem(const glm::dvec2& lonLat);
    [[nodiscard]] std::unique_ptr<OGRCoordinateTransformation> toMap(const OGRSpatialReference* from) const;
    void takeFeature(OGRFeature& feature, OGRGeometry& geometry);
    void takePolygon(OGRFeature& feature, const OGRPolygon& polygon);

    const Progress& progress_;
    MapSources sources_;
    MapReport report_;
    std::string projection_;    ///< of the map; empty until known
    bool metresOnly_ = false;   ///< heights lie nowhere on Earth
    std::vector<Dataset> held_; ///< that others stand on
    bool any_ = false;
};

/// A picture that tells nothing, degrees that say they are metres, and the like: what is probably meant.
Dataset Reader::placed(const fs::path& file, Dataset raster) {
    double geo[6];
    const bool located = raster->GetGeoTransform(geo) == CE_None;
    const OGRSpatialReference* system = raster->GetSpatialRef();
    const auto copied = [&](const double* transform, const char* srs) {
        auto* driver = GetGDALDriverManager()->GetDriverByName("VRT");
        Dataset copy(driver->CreateCopy("", raster.get(), FALSE, nullptr, nullptr, nullptr));
        if (!copy) throw DataError(file.string(), Quiet::said(), "convert it to GeoTIFF");
        double changed[6];
        std::copy(transform, transform + 6, changed);
        (void)copy->SetGeoTransform(changed);
        if (srs != nullptr) (void)copy->SetProjection(srs);
        held_.push_back(std::move(raster));
        return copy;
    };
    if (!located) {
        note(file, {"it does not say where it lies: its samples are taken as 30 m apart, its values as metres.",
                    "sie sagt nicht, wo sie liegt: angenommen sind 30 m von Wert zu Wert, und Werte in Metern."});
        const double plain[6] = {0.0, kAssumedSpacing, 0.0, 0.0, 0.0, -kAssumedSpacing};
        return copied(plain, nullptr);
    }
    const double right = geo[0] + geo[1] * raster->GetRasterXSize(),
                 bottom = geo[3] + geo[5] * raster->GetRasterYSize();
    const bool looksLikeDegrees = std::abs(geo[1]) < 0.5 && std::abs(geo[0]) <= 180.5 && std::abs(right) <= 180.5 &&
                                  std::abs(geo[3]) <= 90.5 && std::abs(bottom) <= 90.5;
    if (system == nullptr) {
        if (!looksLikeDegrees) return raster;
        note(file,
             {"it names no projection; its coordinates look like degrees and are taken as such (WGS 84).",
              "sie nennt keine Projektion; ihre Koordinaten sehen wie Grade aus und gelten als solche (WGS 84)."});
        return copied(geo, SRS_WKT_WGS84_LAT_LONG);
    }
    if (system->IsGeographic() && !looksLikeDegrees && (std::abs(geo[0]) > 361.0 || std::abs(geo[3]) > 91.0)) {
        note(file, {"it says its coordinates are degrees, but they cannot be: they are taken as metres.",
                    "ihre Koordinaten sollen Grade sein, was nicht sein kann: sie gelten als Meter."});
        return copied(geo, "");
    }
    if (system->IsProjected() && looksLikeDegrees) {
        note(file, {"it says its coordinates are metres, but they look like degrees and are taken as such (WGS 84).",
                    "ihre Koordinaten sollen Meter sein, sehen aber wie Grade aus und gelten als solche (WGS 84)."});
        return copied(geo, SRS_WKT_WGS84_LAT_LONG);
    }
    return raster;
}

/// Of a huge raster only as many rows and columns are read as will be shown; overviews are used where it has some.
Dataset Reader::thinned(const fs::path& file, Dataset raster) {
    const glm::dvec2 size(raster->GetRasterXSize(), raster->GetRasterYSize());
    if (size.x * size.y <= kHugePixels) return raster;
    const double share = kHugeSide / std::max(size.x, size.y);
    ToolWords words;
    words.add("-of")
        .add("MEM")
        .add("-b")
        .add("1")
        .add("-outsize")
        .add(std::to_string(std::lround(size.x * share)))
        .add(std::to_string(std::max(2L, std::lround(size.y * share))));
    GDALTranslateOptions* options = GDALTranslateOptionsNew(words.list(), nullptr);
    GDALTranslateOptionsSetProgress(options, onProgress, const_cast<Progress*>(&progress_));
    Dataset thin(static_cast<GDALDataset*>(GDALTranslate("", raster.get(), options, nullptr)));
    GDALTranslateOptionsFree(options);
    progress_.throwIfCancelled();
    if (!thin) throw DataError(file.string(), Quiet::said(), "check the file, or choose another one");
    const std::string samples =
        std::to_string(raster->GetRasterXSize()) + " x " + std::to_string(raster->GetRasterYSize());
    note(file, {"it has " + samples + " samples, of which only some are read.",
                "sie hat " + samples + " Werte, von denen nur ein Teil gelesen wird."});
    return thin;
}

void Reader::chooseSystem(const glm::dvec2& lonLat) {
    if (projection_.empty() && !metresOnly_) projection_ = "EPSG:" + std::to_string(utmAt(lonLat));
}

/// All rasters as one ground in metres.
void Reader::mosaic(std::vector<Dataset> rasters) {
    if (rasters.empty()) return;
    GDALDataset& first = *rasters.front();
    const OGRSpatialReference* system = first.GetSpatialRef();
    double geo[6];
    (void)first.GetGeoTransform(geo);
    ToolWords words;
    words.add("-of").add("MEM").add("-ot").add("Float32").add("-dstnodata").add("nan").add("-wm").add("64");
    if (system != nullptr && !system->IsEmpty() && !system->IsLocal()) {
        double x = geo[0] + 0.5 * geo[1] * first.GetRasterXSize(), y = geo[3] + 0.5 * geo[5] * first.GetRasterYSize();
        OGRSpatialReference from(*system), degrees = systemOf(4326);
        from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        const std::unique_ptr<OGRCoordinateTransformation> there(OGRCreateCoordinateTransformation(&from, &degrees));
        if (!there || !there->Transform(1, &x, &y))
            throw DataError("map", "its projection cannot be understood", "convert it to WGS 84 with gdalwarp");
        chooseSystem({x, y});
        words.add("-t_srs").add(projection_);
    } else {
        metresOnly_ = true;
    }
    words.add("-r").add("bilinear");
    std::vector<GDALDatasetH> sources;
    for (const Dataset& raster : rasters) sources.push_back(raster.get());
    // How large it becomes is seen in a first, virtual warp.
    ToolWords look(words);
    look.add("-of").add("VRT");
    GDALWarpAppOptions* options = GDALWarpAppOptionsNew(look.list(), nullptr);
    const Dataset plan(static_cast<GDALDataset*>(
        GDALWarp("", nullptr, static_cast<int>(sources.size()), sources.data(), options, nullptr)));
    GDALWarpAppOptionsFree(options);
    if (!plan) throw DataError("map", Quiet::said(), "convert the heights to one GeoTIFF with gdalwarp");
    double planned[6];
    (void)plan->GetGeoTransform(planned);
    const double wide = planned[1] * plan->GetRasterXSize(), tall = -planned[5] * plan->GetRasterYSize();
    const double spacing = std::max({planned[1], -planned[5], wide / kMostSamples, tall / kMostSamples});
    words.add("-tr").add(std::to_string(spacing)).add(std::to_string(spacing));
    options = GDALWarpAppOptionsNew(words.list(), nullptr);
    GDALWarpAppOptionsSetProgress(options, onProgress, const_cast<Progress*>(&progress_));
    const Dataset ground(static_cast<GDALDataset*>(
        GDALWarp("", nullptr, static_cast<int>(sources.size()), sources.data(), options, nullptr)));
    GDALWarpAppOptionsFree(options);
    progress_.throwIfCancelled();
    if (!ground) throw DataError("map", Quiet::said(), "convert the heights to one GeoTIFF with gdalwarp");
    takeHeights(*ground);
}

void Reader::takeHeights(GDALDataset& ground) {
    double geo[6];
    (void)ground.GetGeoTransform(geo);
    sources_.samples = {ground.GetRasterXSize(), ground.GetRasterYSize()};
    if (sources_.samples.x < 2 || sources_.samples.y < 2)
        throw DataError("map", "its heights are fewer than two a side", "choose a larger piece of land");
    sources_.spacing = geo[1];
    sources_.origin = {geo[0] + 0.5 * geo[1], geo[3] + 0.5 * geo[5]};
    sources_.heights.resize(static_cast<std::size_t>(sources_.samples.x) *
                            static_cast<std::size_t>(sources_.samples.y));
    GDALRasterBand* band = ground.GetRasterBand(1);
    if (band->RasterIO(GF_Read, 0, 0, sources_.samples.x, sources_.samples.y, sources_.heights.data(),
                       sources_.samples.x, sources_.samples.y, GDT_Float32, 0, 0) != CE_None)
        throw DataError("map", Quiet::said(), "check the file, or choose another one");
    for (float& height : sources_.heights)
        if (!(std::abs(height) < 12000.0F)) height = std::numeric_limits<float>::quiet_NaN(); // no such land
    any_ = true;
}

std::unique_ptr<OGRCoordinateTransformation> Reader::toMap(const OGRSpatialReference* from) const {
    if (projection_.empty()) return nullptr;
    OGRSpatialReference source = from != nullptr ? *from : systemOf(4326), target;
    source.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    (void)target.SetFromUserInput(projection_.c_str());
    target.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return std::unique_ptr<OGRCoordinateTransformation>(OGRCreateCoordinateTransformation(&source, &target));
}

std::string fieldOf(OGRFeature& feature, const char* name) {
    const int index = feature.GetFieldIndex(name);
    return index >= 0 && feature.IsFieldSetAndNotNull(index) ? feature.GetFieldAsString(index) : "";
}

/// A tag of an OSM extract that has no field of its own: "name"=>"value".
std::string tagOf(OGRFeature& feature, const std::string& name) {
    const std::string own = fieldOf(feature, name.c_str());
    if (!own.empty()) return own;
    const std::string tags = fieldOf(feature, "other_tags");
    const std::string key = "\"" + name + "\"=>\"";
    const std::size_t at = tags.find(key);
    if (at == std::string::npos) return {};
    const std::size_t from = at + key.size();
    return tags.substr(from, tags.find('"', from) - from);
}

/// As people there say it, but where the map knows it in the reader's own language.
Words nameOf(OGRFeature& feature) {
    const std::string local = tagOf(feature, "name");
    const auto in = [&](const char* tag) {
        std::string name = tagOf(feature, tag);
        return name.empty() ? local : name;
    };
    Words name(in("name:en"), in("name:de"));
    if (name.english.empty()) name.english = name.german;
    if (name.german == name.english) name.german.clear();
    return name;
}

std::optional<double> heightOf(OGRFeature& feature) {
    for (const char* name : {"height", "HEIGHT", "Height", "building:height", "measuredHeight", "hoehe"}) {
        const std::string text = tagOf(feature, name);
        const double value = CPLAtof(text.c_str());
        if (!text.empty() && value > 0.0 && value < 1000.0) return value;
    }
    for (const char* name : {"building:levels", "levels"}) {
        const double storeys = CPLAtof(tagOf(feature, name).c_str());
        if (storeys > 0.0 && storeys < 300.0) return 3.0 * storeys + 1.0;
    }
    return std::nullopt;
}

double widthOf(const std::string& highway) {
    for (const auto& [name, width] : {std::pair{"motorway", 14.0},
                                      {"trunk", 11.0},
                                      {"primary", 9.0},
                                      {"secondary", 8.0},
                                      {"tertiary", 7.0},
                                      {"footway", 2.0},
                                      {"path", 1.5}})
        if (highway.starts_with(name)) return width;
    return 5.0;
}

void Reader::takePolygon(OGRFeature& feature, const OGRPolygon& polygon) {
    const OGRLinearRing* ring = polygon.getExteriorRing();
    if (ring == nullptr || ring->getNumPoints() < 4) {
        ++report_.leftOut;
        return;
    }
    MapSources::Outline outline;
    for (int k = 0; k + 1 < ring->getNumPoints(); ++k) outline.ring.emplace_back(ring->getX(k), ring->getY(k));
    outline.height = heightOf(feature);
    outline.name = nameOf(feature);
    sources_.outlines.push_back(std::move(outline));
}

void Reader::takeFeature(OGRFeature& feature, OGRGeometry& geometry) {
    const auto kind = wkbFlatten(geometry.getGeometryType());
    if (kind == wkbPoint) {
        Words name = nameOf(feature);
        if (name.empty()) return;
        const std::string place = tagOf(feature, "place");
        const int rank = place == "city" || place == "town"    ? 0
                         : place == "village"                  ? 1
                         : tagOf(feature, "natural") == "peak" ? 1
                                                               : 2;
        const auto& point = static_cast<const OGRPoint&>(geometry);
        sources_.names.push_back({std::move(name), {point.getX(), point.getY()}, rank == 0 ? 2500.0 : 1200.0, rank});
    } else if (kind == wkbLineString) {
        const std::string highway = fieldOf(feature, "highway");
        if (feature.GetFieldIndex("other_tags") >= 0 && highway.empty()) return; // an extract's power lines, walls, ...
        MapSources::Line line;
        const auto& points = static_cast<const OGRLineString&>(geometry);
        for (int k = 0; k < points.getNumPoints(); ++k) line.points.emplace_back(points.getX(k), points.getY(k));
        line.width = highway.empty() ? line.width : widthOf(highway);
        sources_.lines.push_back(std::move(line));
    } else if (kind == wkbPolygon) {
        takePolygon(feature, static_cast<const OGRPolygon&>(geometry));
    } else if (kind == wkbMultiPolygon || kind == wkbGeometryCollection || kind == wkbMultiLineString ||
               kind == wkbMultiPoint) {
        auto& parts = static_cast<OGRGeometryCollection&>(geometry);
        for (int k = 0; k < parts.getNumGeometries(); ++k) takeFeature(feature, *parts.getGeometryRef(k));
    }
}

void Reader::readOutlines(const fs::path& file) {
    const Dataset data(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
    if (!data) return leaveOut(file);
    if (metresOnly_ && data->GetLayerCount() > 0 && data->GetLayer(0)->GetSpatialRef() != nullptr)
        return note(file,
                    {"the heights do not say where they lie, so its outlines cannot be put on them and are left out.",
                     "die Höhen sagen nicht, wo sie liegen: ihre Umrisse passen auf nichts und fehlen."});
    std::size_t count = 0;
    OGRLayer* layer = nullptr;
    double share = 0.0;
    CPLErrorReset();
    for (;;) {
        const OGRFeatureUniquePtr feature(data->GetNextFeature(&layer, &share, nullptr, nullptr));
        if (!feature) break;
        if (++count % 1024 == 0) {
            progress_.throwIfCancelled();
            progress_.report(share, "Reading outlines");
        }
        if (count > kMostFeatures) {
            const std::string most = std::to_string(kMostFeatures);
            note(file, {"it has more than " + most + " things; the rest is left out.",
                        "sie enthält mehr als " + most + " Dinge; der Rest fehlt."});
            break;
        }
        const bool osm = feature->GetFieldIndex("other_tags") >= 0;
        std::unique_ptr<OGRGeometry> geometry(feature->StealGeometry());
        if (!geometry || geometry->IsEmpty()) {
            ++report_.leftOut;
            continue;
        }
        const bool area = geometry->getDimension() == 2;
        if (osm && area && tagOf(*feature, "building").empty()) continue;
        OGREnvelope box;
        geometry->getEnvelope(&box);
        const OGRSpatialReference* system = layer != nullptr ? layer->GetSpatialRef() : nullptr;
        if (!metresOnly_ && projection_.empty()) {
            glm::dvec2 at(box.MinX, box.MinY);
            OGRSpatialReference from = system != nullptr ? *system : systemOf(4326), degrees = systemOf(4326);
            from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
            if (const std::unique_ptr<OGRCoordinateTransformation> there(
                    OGRCreateCoordinateTransformation(&from, &degrees));
                there)
                (void)there->Transform(1, &at.x, &at.y);
            if (std::abs(at.x) > 180.0 || std::abs(at.y) > 90.0)
                return note(file, {"its coordinates are no degrees, as it says they are; it is left out.",
                                   "ihre Koordinaten sind keine Grade, wie sie sagt; sie ist ausgelassen."});
            chooseSystem(at);
        }
        if (area && !geometry->IsValid()) {
            geometry.reset(geometry->MakeValid());
            ++(geometry ? report_.mended : report_.leftOut);
            if (!geometry) continue;
        }
        if (!metresOnly_) {
            const std::unique_ptr<OGRCoordinateTransformation> way = toMap(system);
            if (!way || geometry->transform(way.get()) != OGRERR_NONE) {
                ++report_.leftOut;
                continue;
            }
        }
        takeFeature(*feature, *geometry);
        any_ = true;
    }
    if (CPLGetLastErrorType() >= CE_Failure) {
        const Words said = Quiet::words();
        note(file, {said.english + "; what comes after is left out.", said.german + "; was danach kommt, fehlt."});
    }
    if (count == 0) note(file, {"it is empty.", "sie ist leer."});
}

void Reader::readCity(const fs::path& file) {
    const CityModel city = readCityJson(file);
    report_.leftOut += city.withoutShape;
    if (metresOnly_)
        return note(file,
                    {"the heights do not say where they lie, so its buildings cannot be put on them and are left out.",
                     "die Höhen sagen nicht, wo sie liegen: ihre Gebäude passen auf nichts und fehlen."});
    OGRSpatialReference system = systemOf(city.epsg > 0 ? city.epsg : 4326);
    if (city.epsg <= 0) note(file, {"it names no reference system.", "sie nennt kein Bezugssystem."});
    for (const CityBuilding& building : city.buildings) {
        MapSources::Outline outline;
        std::vector<glm::dvec3> ring = building.footprint;
        if (projection_.empty()) {
            OGRSpatialReference degrees = systemOf(4326);
            glm::dvec2 at(ring.front());
            if (const std::unique_ptr<OGRCoordinateTransformation> there(
                    OGRCreateCoordinateTransformation(&system, &degrees));
                there)
                (void)there->Transform(1, &at.x, &at.y);
            chooseSystem(at);
        }
        const std::unique_ptr<OGRCoordinateTransformation> way = toMap(&system);
        for (glm::dvec3& p : ring) {
            if (way && way->Transform(1, &p.x, &p.y)) outline.ring.emplace_back(p);
        }
        outline.height = building.height > 0.0 ? std::optional(building.height) : std::nullopt;
        outline.name = building.name;
        sources_.outlines.push_back(std::move(outline));
        any_ = true;
    }
}

bool isOutlines(const fs::path& file) {
    const std::string extension = lowerCase(file.extension().string());
    return extension == ".geojson" || extension == ".json" || extension == ".osm" || extension == ".pbf" ||
           extension == ".cityjson" || extension == ".gpkg" || extension == ".shp";
}

bool isHeights(const fs::path& file) {
    const std::string extension = lowerCase(file.extension().string());
    return extension == ".tif" || extension == ".tiff" || extension == ".png" || extension == ".hgt" ||
           extension == ".asc" || extension == ".vrt" || extension == ".img" || extension == ".bil";
}

void Reader::read(const std::vector<fs::path>& files) {
    std::vector<Dataset> rasters;
    for (const fs::path& file : files) {
        if (!isHeights(file)) continue;
        CPLErrorReset();
        Dataset raster(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
        if (!raster || raster->GetRasterCount() < 1) {
            leaveOut(file);
            continue;
        }
        rasters.push_back(placed(file, thinned(file, std::move(raster))));
        progress_.throwIfCancelled();
    }
    mosaic(std::move(rasters));
    for (const fs::path& file : files) {
        if (!isOutlines(file)) continue;
        if (isCityJson(file))
            readCity(file);
        else
            readOutlines(file);
    }
}

std::vector<fs::path> filesOf(const fs::path& place) {
    std::error_code error;
    if (!fs::exists(place, error)) throw DataError(place.string(), "there is no such file or folder", "check its name");
    if (!fs::is_directory(place, error)) return {place};
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(place, error)) {
        if (!entry.is_regular_file(error) || (!isHeights(entry.path()) && !isOutlines(entry.path()))) continue;
        files.push_back(entry.path());
        if (files.size() > kMostFiles)
            throw DataError(place.string(), "it holds more than 400 map files", "choose a smaller piece of land");
    }
    std::ranges::sort(files);
    if (files.empty())
        throw DataError(place.string(), "it holds no map files",
                        "put GeoTIFF, PNG, hgt, GeoJSON, CityJSON or OSM files there");
    return files;
}

} // namespace

ImportedMap importMap(const fs::path& fileOrFolder, const Progress& progress) {
    const Quiet quiet;
    GDALAllRegister();
    const std::vector<fs::path> files = filesOf(fileOrFolder);
    if (files.size() == 1 && !isHeights(files.front()) && !isOutlines(files.front()))
        throw DataError(fileOrFolder.string(), "it is of no kind of map that is known",
                        "use GeoTIFF, PNG, hgt, GeoJSON, CityJSON, .osm or .pbf");
    Reader reader(progress);
    reader.read(files);
    ImportedMap imported;
    if (!reader.readAny()) {
        const std::vector<Words>& notes = reader.report().notes;
        throw DataError(fileOrFolder.string(), notes.empty() ? "nothing in it can be shown" : notes.front().english,
                        "check the file, or choose another one");
    }
    MapSources sources = reader.takeSources();
    imported.projection = reader.projection();
    try {
        const bool level = sources.heights.empty();
        imported.origin = sources.origin;
        imported.report = std::move(reader.report());
        imported.map = assembled(std::move(sources), imported.report);
        if (level) imported.origin = {};
    } catch (const InvalidInput& problem) {
        throw DataError(fileOrFolder.string(), problem.why(), problem.remedy());
    }
    imported.map.title = fileOrFolder.stem().string();
    progress.report(1.0, "Ready");
    return imported;
}

} // namespace lumorph::navigation

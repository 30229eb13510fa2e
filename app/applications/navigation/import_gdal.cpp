#include "app/applications/navigation/import_gdal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <mutex>
#include <string_view>
#include <utility>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_http.h>
#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <ogr_srs_api.h>
#include <ogrsf_frmts.h>

#include "core/base/text.h"

namespace lumorph::navigation {
namespace {

constexpr const char* kTags = "/vsimem/lumorph/osm.ini";
constexpr std::array kThreadSettings{std::pair{"GDAL_VRT_ENABLE_PYTHON", "NO"},
                                     // Vertical systems are read from old files, too.
                                     std::pair{"GTIFF_REPORT_COMPD_CS", "YES"}, std::pair{"OSM_CONFIG_FILE", kTags}};

/// Which tags of OpenStreetMap are read (osmconf.ini of GDAL). Its own file lacks building parts, which it takes for
/// lines, and need not be installed.
constexpr std::string_view kOsmTags = R"(
closed_ways_are_polygons=building,building:part
attribute_name_laundering=no
[points]
attributes=name,name:en,name:de,place,natural
other_tags=no
[lines]
attributes=name,name:en,name:de,highway,building,building:part,height,building:height,building:levels,levels,roof:levels,roof:height,roof:shape,min_height,building:min_level
other_tags=no
[multipolygons]
attributes=name,name:en,name:de,building,building:part,height,building:height,building:levels,levels,roof:levels,roof:height,roof:shape,min_height,building:min_level
other_tags=no
[multilinestrings]
attributes=name,highway
other_tags=no
[other_relations]
attributes=name
other_tags=no
)";

void* openNothing(void*, const char*, const char*) { return nullptr; }
int statNothing(void*, const char*, VSIStatBufL*, int) { return -1; }

CPLHTTPResult* fetchNothing(const char*, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc, void*, void*) {
    auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
    result->nStatus = -1;
    result->pszErrBuf = CPLStrdup("a map file reaches no network");
    return result;
}

/// A file may name another one by an address: of a virtual raster's pieces, of its overviews in an .aux.xml. What is
/// typed into the program is none either: it has no end.
void closeNetwork() {
    VSIFilesystemPluginCallbacksStruct* nothing = VSIAllocFilesystemPluginCallbacksStruct();
    nothing->open = openNothing;
    nothing->stat = statNothing;
    for (const char* prefix :
         {"/vsistdin/", "/vsistdin?", "/vsicurl/", "/vsicurl?", "/vsicurl_streaming/", "/vsis3/", "/vsis3_streaming/",
          "/vsigs/", "/vsigs_streaming/", "/vsiaz/", "/vsiaz_streaming/", "/vsiadls/", "/vsioss/", "/vsioss_streaming/",
          "/vsiswift/", "/vsiswift_streaming/", "/vsiwebhdfs/", "/vsihdfs/"})
        (void)VSIInstallPluginHandler(prefix, nothing);
    VSIFreeFilesystemPluginCallbacksStruct(nothing);
    CPLHTTPSetFetchCallback(fetchNothing, nullptr);
    OSRSetPROJEnableNetwork(FALSE);
}

/// Not all that GDAL has: what a virtual raster names is opened by these alone, too.
void registerDrivers() {
    GDALRegister_MEM();
    // Made, never opened: its names are addresses of this process.
    if (GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM")) memory->pfnOpen = nullptr;
    GDALRegister_VRT();
    GDALRegister_GTiff();
    GDALRegister_PNG();
    GDALRegister_SRTMHGT();
    GDALRegister_AAIGrid();
    GDALRegister_GRASSASCIIGrid();
    GDALRegister_HFA();
    GDALRegister_EHdr();
    RegisterOGRGeoJSON();
    RegisterOGROSM();
    RegisterOGRShape();
    RegisterOGRGeoPackage();
    VSIFCloseL(VSIFileFromMemBuffer(kTags, reinterpret_cast<GByte*>(const_cast<char*>(kOsmTags.data())),
                                    kOsmTags.size(), FALSE));
}

bool beginsWith(const std::filesystem::path& file, std::string_view word) {
    std::string begin(256, ' ');
    std::ifstream(file, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
    const std::size_t at = begin.find('<');
    return at != std::string::npos && std::string_view(begin).substr(at).starts_with(word);
}

} // namespace

GdalForFiles::GdalForFiles() {
    static std::once_flag once;
    std::call_once(once, [] {
        registerDrivers();
        closeNetwork();
    });
    for (const auto& [name, value] : kThreadSettings) CPLSetThreadLocalConfigOption(name, value);
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
}

GdalForFiles::~GdalForFiles() {
    CPLPopErrorHandler();
    for (const auto& [name, value] : kThreadSettings) CPLSetThreadLocalConfigOption(name, nullptr);
}

Words gdalWords() {
    const std::string text = CPLGetLastErrorMsg();
    if (text.empty()) return {"it is damaged or of an unknown kind", "sie ist beschädigt oder von unbekannter Art"};
    return {"GDAL says " + inQuotes(text, 160), "GDAL sagt " + inQuotes(text, 160)};
}

Dataset openRaster(const std::filesystem::path& file) {
    constexpr std::array<const char*, 8> kFiles{"GTiff",          "PNG", "SRTMHGT", "AAIGrid",
                                                "GRASSASCIIGrid", "HFA", "EHdr",    nullptr};
    constexpr std::array<const char*, 2> kVirtual{"VRT", nullptr};
    CPLErrorReset();
    const bool asVirtual = lowerCase(file.extension().string()) == ".vrt";
    Dataset raster(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY,
                                     asVirtual ? kVirtual.data() : kFiles.data()));
    if (!raster && !asVirtual && beginsWith(file, "<VRTDataset"))
        CPLError(CE_Failure, CPLE_OpenFailed,
                 "It is a virtual raster (VRT) under another ending, and other files that it names are not opened");
    return raster;
}

Dataset openOutlines(const std::filesystem::path& file) {
    constexpr std::array<const char*, 5> kFiles{"GeoJSON", "OSM", "ESRI Shapefile", "GPKG", nullptr};
    CPLErrorReset();
    return Dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kFiles.data()));
}

OGRSpatialReference systemOf(int epsg) {
    OGRSpatialReference system;
    if (system.importFromEPSG(epsg) != OGRERR_NONE) system.Clear();
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return system;
}

OGRSpatialReference systemOf(const std::string& projection) {
    OGRSpatialReference system;
    if (system.SetFromUserInput(projection.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) !=
        OGRERR_NONE)
        system.Clear();
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return system;
}

OGRSpatialReference levelSystem(const OGRSpatialReference& system) {
    OGRSpatialReference level(system);
    (void)level.StripVertical();
    level.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    return level;
}

Transformation transformation(const OGRSpatialReference& from, const OGRSpatialReference& to) {
    return Transformation(OGRCreateCoordinateTransformation(&from, &to));
}

std::optional<glm::dvec2> lonLatOf(const OGRSpatialReference& system, glm::dvec2 point) {
    const Transformation there = transformation(levelSystem(system), systemOf(4326));
    if (!there || !there->Transform(1, &point.x, &point.y)) return std::nullopt;
    if (!(std::abs(point.x) <= 360.0 && std::abs(point.y) <= 90.0)) return std::nullopt;
    return point;
}

std::optional<double> metresOfUnit(const std::string& unit) {
    constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937.0;
    static constexpr struct {
        std::string_view name;
        double metres;
    } kUnits[] = {{"m", 1.0},
                  {"metre", 1.0},
                  {"metres", 1.0},
                  {"meter", 1.0},
                  {"meters", 1.0},
                  {"dm", 0.1},
                  {"decimetre", 0.1},
                  {"decimeters", 0.1},
                  {"cm", 0.01},
                  {"centimetre", 0.01},
                  {"centimeters", 0.01},
                  {"mm", 0.001},
                  {"millimetre", 0.001},
                  {"millimeters", 0.001},
                  {"km", 1000.0},
                  {"kilometre", 1000.0},
                  {"ft", kFoot},
                  {"'", kFoot},
                  {"foot", kFoot},
                  {"feet", kFoot},
                  {"international foot", kFoot},
                  {"international feet", kFoot},
                  {"us-ft", kSurveyFoot},
                  {"us_ft", kSurveyFoot},
                  {"ftus", kSurveyFoot},
                  {"us ft", kSurveyFoot},
                  {"sft", kSurveyFoot},
                  {"us foot", kSurveyFoot},
                  {"us feet", kSurveyFoot},
                  {"us survey foot", kSurveyFoot},
                  {"us survey feet", kSurveyFoot},
                  {"foot_us", kSurveyFoot},
                  {"fathom", 1.8288},
                  {"fathoms", 1.8288},
                  {"yd", 0.9144},
                  {"yard", 0.9144}};
    const std::string small = lowerCase(unit);
    const auto found = std::ranges::find(kUnits, small, &std::remove_cvref_t<decltype(kUnits[0])>::name);
    return found == std::end(kUnits) ? std::nullopt : std::optional(found->metres);
}

} // namespace lumorph::navigation

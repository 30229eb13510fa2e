#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gdal_utils.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/import_gdal.h"
#include "app/applications/navigation/import_heights.h"
#include "app/applications/navigation/import_state.h"
#include "core/base/error.h"

namespace lumorph::navigation {
namespace {

namespace fs = std::filesystem;

constexpr double kHugePixels = 6.0e7;    ///< from so many on only some rows are read
constexpr int kHugeSide = 4096;          ///< of what is read of such a raster
constexpr double kAssumedSpacing = 30.0; ///< metres between samples of a picture that says nothing

int CPL_STDCALL onProgress(double share, const char*, void* progress) {
    const auto& told = *static_cast<const Progress*>(progress);
    told.report(share, "Reading heights");
    return told.cancelled() ? FALSE : TRUE;
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

glm::dvec2 pointOf(const RasterPlace& place, const glm::dvec2& pixel) {
    const auto& t = place.transform;
    return {t[0] + t[1] * pixel.x + t[2] * pixel.y, t[3] + t[4] * pixel.x + t[5] * pixel.y};
}

/// Where a raster lies: by what it says, or, where that cannot be, by what is probably meant.
RasterPlace placeOf(ImportState& state, const fs::path& file, GDALDataset& raster) {
    RasterPlace place;
    if (raster.GetGeoTransform(place.transform.data()) != CE_None) {
        state.note(file, {"it does not say where it lies: its samples are taken as 30 m apart.",
                          "sie sagt nicht, wo sie liegt: angenommen sind 30 m von Wert zu Wert."});
        place.transform = {0.0, kAssumedSpacing, 0.0, 0.0, 0.0, -kAssumedSpacing};
        return place;
    }
    if (const OGRSpatialReference* system = raster.GetSpatialRef(); system != nullptr && !system->IsLocal())
        place.system = levelSystem(*system);
    const glm::dvec2 size(raster.GetRasterXSize(), raster.GetRasterYSize());
    const glm::dvec2 from = pointOf(place, {0.0, 0.0}), to = pointOf(place, size);
    const glm::dvec2 most = glm::max(glm::abs(from), glm::abs(to));
    const glm::dvec2 step(std::hypot(place.transform[1], place.transform[4]),
                          std::hypot(place.transform[2], place.transform[5]));
    const bool looksLikeDegrees = std::max(step.x, step.y) < 0.5 && most.x <= 180.5 && most.y <= 90.5;
    const auto asDegrees = [&](const Words& why) {
        state.note(file, why);
        place.system = systemOf(4326);
    };
    if (place.system.IsEmpty()) {
        if (looksLikeDegrees)
            asDegrees(
                {"it names no projection; its coordinates look like degrees and are taken as such (WGS 84).",
                 "sie nennt keine Projektion; ihre Koordinaten sehen wie Grade aus und gelten als solche (WGS 84)."});
    } else if (place.system.IsGeographic() && !looksLikeDegrees && (most.x > 361.0 || most.y > 91.0)) {
        state.note(file, {"it says its coordinates are degrees, but they cannot be: they are taken as metres.",
                          "ihre Koordinaten sollen Grade sein, was nicht sein kann: sie gelten als Meter."});
        place.system.Clear();
    } else if (place.system.IsProjected() && looksLikeDegrees) {
        asDegrees({"it says its coordinates are metres, but they look like degrees and are taken as such (WGS 84).",
                   "ihre Koordinaten sollen Meter sein, sehen aber wie Grade aus und gelten als solche (WGS 84)."});
    }
    return place;
}

/// A raster with heights, and the middle of it.
struct Piece {
    fs::path file;
    Dataset heights;
    RasterPlace place;
    glm::dvec2 middle{0.0};
};

/// Of a huge raster only as many rows and columns are read as will be shown; overviews are used where it has some.
Dataset thinned(ImportState& state, const fs::path& file, Dataset raster, const Progress& progress) {
    const glm::dvec2 size(raster->GetRasterXSize(), raster->GetRasterYSize());
    if (size.x * size.y <= kHugePixels) return raster;
    const double share = kHugeSide / std::max(size.x, size.y);
    ToolWords words;
    words.add("-of")
        .add("MEM")
        .add("-outsize")
        .add(std::to_string(std::max(2L, std::lround(size.x * share))))
        .add(std::to_string(std::max(2L, std::lround(size.y * share))));
    GDALTranslateOptions* options = GDALTranslateOptionsNew(words.list(), nullptr);
    GDALTranslateOptionsSetProgress(options, onProgress, const_cast<Progress*>(&progress));
    Dataset thin(static_cast<GDALDataset*>(GDALTranslate("", raster.get(), options, nullptr)));
    GDALTranslateOptionsFree(options);
    progress.throwIfCancelled();
    if (!thin) return thin;
    const std::string samples =
        std::to_string(raster->GetRasterXSize()) + " x " + std::to_string(raster->GetRasterYSize());
    state.note(file, {"it has " + samples + " samples, of which only some are read.",
                      "sie hat " + samples + " Werte, von denen nur ein Teil gelesen wird."});
    return thin;
}

/// The projection of a raster whose metres are true ones and run north: those of UTM. Its samples then stay as they
/// are.
std::string ownProjection(const RasterPlace& place) {
    if (place.system.GetUTMZone() == 0 || std::abs(place.system.GetLinearUnits() - 1.0) > 1e-9) return {};
    const char* authority = place.system.GetAuthorityName(nullptr);
    const char* code = place.system.GetAuthorityCode(nullptr);
    if (authority != nullptr && code != nullptr && std::string(authority) == "EPSG") return "EPSG:" + std::string(code);
    char* text = nullptr;
    (void)place.system.exportToWkt(&text);
    std::string projection = text != nullptr ? text : "";
    CPLFree(text);
    return projection;
}

/// Those that lie on one Earth, or else in one plane: the others are passed over.
void keepThoseTogether(ImportState& state, std::vector<Piece>& pieces) {
    const auto somewhere = std::ranges::find_if(pieces, [](const Piece& p) { return !p.place.system.IsEmpty(); });
    if (somewhere == pieces.end()) {
        state.metresOnly = true;
        return;
    }
    std::vector<Piece> kept;
    for (Piece& piece : pieces) {
        const OGRSpatialReference& system = piece.place.system;
        const std::optional<glm::dvec2> lonLat = system.IsEmpty() ? std::nullopt : lonLatOf(system, piece.middle);
        if (!lonLat) {
            state.passOver(piece.file,
                           system.IsEmpty()
                               ? Words{"it does not say where it lies, as the heights beside it do",
                                       "sie sagt nicht, wo sie liegt, wie die Höhen daneben es tun"}
                               : Words{"its projection cannot be understood (gdalwarp -t_srs EPSG:4326 helps)",
                                       "ihre Projektion ist nicht zu verstehen (gdalwarp -t_srs EPSG:4326 hilft)"});
            continue;
        }
        if (state.projection.empty()) state.projection = ownProjection(piece.place);
        state.chooseSystem(*lonLat);
        char* text = nullptr;
        (void)system.exportToWkt(&text);
        if (text != nullptr && std::ranges::find(state.systems, text) == state.systems.end())
            state.systems.emplace_back(text);
        CPLFree(text);
        kept.push_back(std::move(piece));
    }
    pieces = std::move(kept);
}

Dataset warped(const std::vector<Piece>& pieces, ToolWords words, const Progress* progress) {
    std::vector<GDALDatasetH> sources;
    sources.reserve(pieces.size());
    for (const Piece& piece : pieces) sources.push_back(piece.heights.get());
    GDALWarpAppOptions* options = GDALWarpAppOptionsNew(words.list(), nullptr);
    if (progress != nullptr) GDALWarpAppOptionsSetProgress(options, onProgress, const_cast<Progress*>(progress));
    Dataset made(static_cast<GDALDataset*>(
        GDALWarp("", nullptr, static_cast<int>(sources.size()), sources.data(), options, nullptr)));
    GDALWarpAppOptionsFree(options);
    if (progress != nullptr) progress->throwIfCancelled();
    if (!made) throw DataError("map", gdalWords().english, "convert the heights to one GeoTIFF with gdalwarp");
    return made;
}

std::vector<float> bandOf(GDALDataset& ground, int number) {
    const int columns = ground.GetRasterXSize(), rows = ground.GetRasterYSize();
    std::vector<float> samples(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    if (ground.GetRasterBand(number)->RasterIO(GF_Read, 0, 0, columns, rows, samples.data(), columns, rows, GDT_Float32,
                                               0, 0, nullptr) != CE_None)
        throw DataError("map", gdalWords().english, "check the file, or choose another one");
    return samples;
}

/// Takes the ground, and counts what is missing on the rasters alone: what lies beside a tile that is turned, or
/// between tiles, is no hole in its heights.
void takeHeights(ImportState& state, GDALDataset& ground) {
    MapSources& sources = state.sources;
    double geo[6];
    (void)ground.GetGeoTransform(geo);
    sources.samples = {ground.GetRasterXSize(), ground.GetRasterYSize()};
    if (sources.samples.x < 2 || sources.samples.y < 2)
        throw DataError("map", "its heights are fewer than two a side", "choose a larger piece of land");
    sources.spacing = geo[1];
    sources.origin = {geo[0] + 0.5 * geo[1], geo[3] + 0.5 * geo[5]};
    sources.heights = bandOf(ground, 1);
    constexpr float kAllMissing = 0.999F;
    double missing = 0.0;
    std::size_t on = 0;
    const std::vector<float> shares = bandOf(ground, 2);
    for (std::size_t k = 0; k < shares.size(); ++k) {
        const float share = shares[k];
        if (!std::isfinite(share)) continue;
        if (share >= kAllMissing && std::isfinite(sources.heights[k])) { // another file has heights there
            ++on;
            continue;
        }
        ++on;
        missing += static_cast<double>(share);
    }
    state.report.filled = on > 0 ? missing / static_cast<double>(on) : 0.0;
    state.any = true;
}

/// All pieces as one ground in metres.
void mosaic(ImportState& state, const std::vector<Piece>& pieces, const Progress& progress) {
    ToolWords words;
    words.add("-of").add("MEM").add("-ot").add("Float32").add("-dstnodata").add("nan").add("-wm").add("64");
    words.add("-wo").add("UNIFIED_SRC_NODATA=NO").add("-r").add("bilinear");
    if (!state.metresOnly) words.add("-t_srs").add(state.projection);
    // How large it becomes is seen in a first, virtual warp.
    ToolWords look(words);
    look.add("-of").add("VRT");
    const Dataset plan = warped(pieces, look, nullptr);
    double planned[6];
    (void)plan->GetGeoTransform(planned);
    const double wide = planned[1] * plan->GetRasterXSize(), tall = -planned[5] * plan->GetRasterYSize();
    const double spacing = std::max({planned[1], -planned[5], wide / kMostSamples, tall / kMostSamples});
    words.add("-tr").add(std::to_string(spacing)).add(std::to_string(spacing));
    const Dataset ground = warped(pieces, words, &progress);
    takeHeights(state, *ground);
}

/// A file as heights; nothing where it has none, which is said.
std::optional<Piece> pieceOf(ImportState& state, const fs::path& file, const Progress& progress) {
    Dataset raster = openRaster(file);
    if (!raster || raster->GetRasterCount() < 1) {
        state.passOver(file, gdalWords());
        return std::nullopt;
    }
    const std::variant<HeightCode, Words> code = heightCodeOf(*raster);
    if (const Words* why = std::get_if<Words>(&code)) {
        state.passOver(file, *why);
        return std::nullopt;
    }
    const auto& heights = std::get<HeightCode>(code);
    if (!heights.note.empty()) state.note(file, heights.note);
    Piece piece{file, nullptr, placeOf(state, file, *raster), {}};
    piece.middle = pointOf(piece.place, 0.5 * glm::dvec2(raster->GetRasterXSize(), raster->GetRasterYSize()));
    piece.heights = thinned(state, file, heightRaster(std::move(raster), heights, piece.place), progress);
    if (piece.heights) return piece;
    state.passOver(file, gdalWords());
    return std::nullopt;
}

} // namespace

void readGround(const std::vector<fs::path>& files, ImportState& state, const Progress& progress) {
    std::vector<Piece> pieces;
    for (const fs::path& file : files) {
        if (std::optional<Piece> piece = pieceOf(state, file, progress)) pieces.push_back(std::move(*piece));
        progress.throwIfCancelled();
    }
    keepThoseTogether(state, pieces);
    if (!pieces.empty())
        mosaic(state, pieces, progress);
    else
        state.metresOnly = false;
}

} // namespace lumorph::navigation

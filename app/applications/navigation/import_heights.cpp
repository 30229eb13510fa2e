#include "app/applications/navigation/import_heights.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace lumorph::navigation {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostHeight = 12000.0; ///< metres over or below the sea: there is no such land
constexpr int kLooked = 256;            ///< samples a side by which colours are judged

/// Numbers that stand for missing heights, also where a file does not say so; of Terrain-RGB black does.
bool meansMissing(double sample, HeightCode::Colors colors) {
    return sample == -9999.0 || sample == -32768.0 || sample == -32767.0 ||
           (colors == HeightCode::Colors::terrainRgb && sample == -10000.0);
}

double heightOf(HeightCode::Colors colors, double red, double green, double blue) {
    return colors == HeightCode::Colors::terrarium ? 256.0 * red + green + blue / 256.0 - 32768.0
                                                   : 0.1 * (65536.0 * red + 256.0 * green + blue) - 10000.0;
}

/// One band, the middle of it at most.
struct Patch {
    explicit Patch(GDALRasterBand& band)
        : size(std::min(band.GetXSize(), kLooked), std::min(band.GetYSize(), kLooked)),
          samples(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y)) {
        const glm::ivec2 from((band.GetXSize() - size.x) / 2, (band.GetYSize() - size.y) / 2);
        whole = band.RasterIO(GF_Read, from.x, from.y, size.x, size.y, samples.data(), size.x, size.y, GDT_Float64, 0,
                              0, nullptr) == CE_None;
    }
    glm::ivec2 size;
    std::vector<double> samples;
    bool whole = false;
};

/// Whether colours are heights: their surface then is steady where the bytes jump, because a step of the high byte
/// comes with one of the low byte back. In a photo all bytes rise and fall together, and the "surface" jumps by whole
/// steps of the high byte.
bool areHeights(HeightCode::Colors colors, const Patch& red, const Patch& green, const Patch& blue,
                const Patch& opaque) {
    constexpr double kLow = -11500.0, kHigh = 9000.0;  ///< metres: from the deepest sea to the highest summit
    constexpr double kInside = 0.99, kSteadiest = 8.0; ///< share of the samples; metres a step of the bytes
    double rise = 0.0, steps = 0.0;
    std::size_t inside = 0, known = 0;
    bool grey = true;
    const auto pair = [&](std::size_t a, std::size_t b) {
        if (opaque.samples[a] <= 0.0 || opaque.samples[b] <= 0.0) return;
        const auto height = [&](std::size_t k) {
            return heightOf(colors, red.samples[k], green.samples[k], blue.samples[k]);
        };
        rise += std::abs(height(b) - height(a));
        for (const Patch* band : {&red, &green, &blue}) steps += std::abs(band->samples[b] - band->samples[a]);
    };
    const auto columns = static_cast<std::size_t>(red.size.x);
    for (std::size_t k = 0; k < red.samples.size(); ++k) {
        if (opaque.samples[k] <= 0.0) continue;
        const double height = heightOf(colors, red.samples[k], green.samples[k], blue.samples[k]);
        ++known;
        inside += height >= kLow && height <= kHigh ? 1 : 0;
        grey = grey && red.samples[k] == green.samples[k] && green.samples[k] == blue.samples[k];
        if ((k + 1) % columns != 0) pair(k, k + 1);
        if (k + columns < red.samples.size()) pair(k, k + columns);
    }
    if (known == 0 || grey || static_cast<double>(inside) < kInside * static_cast<double>(known)) return false;
    if (steps > 0.0) return rise <= kSteadiest * steps;
    // All of one colour: the sea, or a picture.
    const auto first = static_cast<std::size_t>(std::ranges::find_if(opaque.samples, [](double v) { return v > 0.0; }) -
                                                opaque.samples.begin());
    return std::abs(heightOf(colors, red.samples[first], green.samples[first], blue.samples[first])) < 0.1;
}

/// The code of a picture's colours; `none` for any other picture.
HeightCode::Colors colorCodeOf(GDALDataset& raster) {
    const Patch red(*raster.GetRasterBand(1)), green(*raster.GetRasterBand(2)), blue(*raster.GetRasterBand(3)),
        opaque(*raster.GetRasterBand(1)->GetMaskBand());
    if (!red.whole || !green.whole || !blue.whole || !opaque.whole) return HeightCode::Colors::none;
    for (const auto colors : {HeightCode::Colors::terrarium, HeightCode::Colors::terrainRgb})
        if (areHeights(colors, red, green, blue, opaque)) return colors;
    return HeightCode::Colors::none;
}

/// Metres of the unit of a raster's vertical reference system; nothing where it has none.
std::optional<double> verticalUnitOf(const OGRSpatialReference* system) {
    if (system == nullptr || !system->IsCompound()) return std::nullopt;
    const double metres = system->GetTargetLinearUnits("VERT_CS", nullptr);
    return metres > 0.0 ? std::optional(metres) : std::nullopt;
}

bool namesHeights(const std::string& description) {
    const std::string small = lowerCase(description);
    const auto isLetter = [&](std::size_t at) { return at < small.size() && small[at] >= 'a' && small[at] <= 'z'; };
    // Short ones are words of their own: "random" has one within it.
    const auto has = [&](std::string_view word) {
        for (std::size_t at = small.find(word); at != std::string::npos; at = small.find(word, at + 1))
            if (word.size() > 3 || ((at == 0 || !isLetter(at - 1)) && !isLetter(at + word.size()))) return true;
        return false;
    };
    return std::ranges::any_of(std::array{"height", "elevation", "altitude", "dem", "dtm", "dsm", "dgm", "dom", "höhe"},
                               has);
}

int colorBands(GDALDataset& raster) {
    int count = 0;
    for (int k = 1; k <= raster.GetRasterCount(); ++k) {
        const GDALColorInterp kind = raster.GetRasterBand(k)->GetColorInterpretation();
        count += kind == GCI_RedBand || kind == GCI_GreenBand || kind == GCI_BlueBand ? 1 : 0;
    }
    return count;
}

/// Bands that are more than the transparency of others.
int dataBands(GDALDataset& raster) {
    int count = 0;
    for (int k = 1; k <= raster.GetRasterCount(); ++k)
        count += raster.GetRasterBand(k)->GetColorInterpretation() == GCI_AlphaBand ? 0 : 1;
    return count;
}

std::string number(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text;
}

Words unusual(double scale, double offset, double metres) {
    Words note;
    const auto add = [&](const std::string& english, const std::string& german) {
        note.english += (note.english.empty() ? "its heights are " : ", ") + english;
        note.german += (note.german.empty() ? "ihre Höhen sind " : ", ") + german;
    };
    if (scale != 1.0) add("scaled by " + number(scale), "mit " + number(scale) + " skaliert");
    if (offset != 0.0) add("moved by " + number(offset), "um " + number(offset) + " verschoben");
    if (metres != 1.0)
        add("in units of " + number(metres) + " m (feet have 0.3048)",
            "in Einheiten von " + number(metres) + " m (Fuß haben 0,3048)");
    if (note.english.empty()) return note;
    note.english += ", as it says.";
    note.german += ", wie sie sagt.";
    return note;
}

Words coloursWhy(GDALDataset& raster) {
    const std::string bands = std::to_string(raster.GetRasterCount());
    return {"it is a picture of colours (" + bands + (bands == "1" ? " band" : " bands") +
                "), as photos are, and has no heights",
            "sie ist ein Farbbild (" + bands + (bands == "1" ? " Kanal" : " Kanäle") +
                "), wie Fotos es sind, und enthält keine Höhen"};
}

/// A band that is read from another raster: its heights, or 1 where they are missing and 0 where they are known.
class HeightBand final : public GDALRasterBand {
public:
    enum class Gives { heights, missing };
    HeightBand(GDALDataset& source, const HeightCode& code, Gives gives) : source_(source), code_(code), gives_(gives) {
        eDataType = GDT_Float32;
        nRasterXSize = source.GetRasterXSize();
        nRasterYSize = source.GetRasterYSize();
        source.GetRasterBand(1)->GetBlockSize(&nBlockXSize, &nBlockYSize);
    }
    double GetNoDataValue(int* known) override {
        if (known != nullptr) *known = gives_ == Gives::heights ? TRUE : FALSE;
        return kMissing;
    }

protected:
    CPLErr IReadBlock(int column, int row, void* data) override {
        const int x = column * nBlockXSize, y = row * nBlockYSize;
        const int width = std::min(nBlockXSize, nRasterXSize - x), height = std::min(nBlockYSize, nRasterYSize - y);
        return IRasterIO(GF_Read, x, y, width, height, data, width, height, GDT_Float32, sizeof(float),
                         static_cast<GSpacing>(sizeof(float)) * nBlockXSize, nullptr);
    }
    CPLErr IRasterIO(GDALRWFlag flag, int x, int y, int width, int height, void* data, int columns, int rows,
                     GDALDataType type, GSpacing pixel, GSpacing line, GDALRasterIOExtraArg*) override {
        if (flag != GF_Read) return CE_Failure;
        const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        // Samples between others would mix bytes of colours, and missing heights with known ones: the nearest are read.
        const auto read = [&](GDALRasterBand* band, std::vector<double>& to) {
            to.resize(count);
            return band->RasterIO(GF_Read, x, y, width, height, to.data(), columns, rows, GDT_Float64, 0, 0, nullptr) ==
                   CE_None;
        };
        GDALRasterBand* first = source_.GetRasterBand(1);
        if (!read(first, samples_)) return CE_Failure;
        if ((first->GetMaskFlags() & GMF_ALL_VALID) != 0)
            opaque_.assign(count, 255.0);
        else if (!read(first->GetMaskBand(), opaque_))
            return CE_Failure;
        if (code_.colors != HeightCode::Colors::none) {
            if (!read(source_.GetRasterBand(2), green_) || !read(source_.GetRasterBand(3), blue_)) return CE_Failure;
            for (std::size_t k = 0; k < count; ++k)
                samples_[k] = heightOf(code_.colors, samples_[k], green_[k], blue_[k]);
        }
        for (std::size_t k = 0; k < count; ++k) {
            const double metres = code_.scale * samples_[k] + code_.offset;
            const bool known =
                opaque_[k] > 0.0 && std::abs(metres) < kMostHeight && !meansMissing(samples_[k], code_.colors);
            samples_[k] = gives_ == Gives::missing ? (known ? 0.0 : 1.0) : known ? metres : kMissing;
        }
        for (int row = 0; row < rows; ++row)
            GDALCopyWords64(samples_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns),
                            GDT_Float64, sizeof(double), static_cast<std::uint8_t*>(data) + row * line, type,
                            static_cast<int>(pixel), columns);
        return CE_None;
    }

private:
    GDALDataset& source_;
    HeightCode code_;
    Gives gives_;
    std::vector<double> samples_, green_, blue_, opaque_;
};

class HeightRaster final : public GDALDataset {
public:
    HeightRaster(Dataset source, const HeightCode& code, const RasterPlace& place)
        : source_(std::move(source)), place_(place) {
        nRasterXSize = source_->GetRasterXSize();
        nRasterYSize = source_->GetRasterYSize();
        SetBand(1, new HeightBand(*source_, code, HeightBand::Gives::heights)); // which the dataset owns
        SetBand(2, new HeightBand(*source_, code, HeightBand::Gives::missing));
    }
    CPLErr GetGeoTransform(double* transform) override {
        std::ranges::copy(place_.transform, transform);
        return CE_None;
    }
    const OGRSpatialReference* GetSpatialRef() const override {
        return place_.system.IsEmpty() ? nullptr : &place_.system;
    }

private:
    Dataset source_;
    RasterPlace place_;
};

} // namespace

std::variant<HeightCode, Words> heightCodeOf(GDALDataset& raster) {
    GDALRasterBand& band = *raster.GetRasterBand(1);
    const GDALDataType type = band.GetRasterDataType();
    if (band.GetColorTable() != nullptr || GDALDataTypeIsComplex(type) != 0) return coloursWhy(raster);
    const bool bytes = type == GDT_Byte;
    const int bands = dataBands(raster);
    if (bytes && bands == 3) {
        const HeightCode::Colors colors = colorCodeOf(raster);
        if (colors == HeightCode::Colors::terrarium)
            return HeightCode{
                colors,
                1.0,
                0.0,
                {"its colours are read as heights (Terrarium).", "ihre Farben werden als Höhen gelesen (Terrarium)."}};
        if (colors == HeightCode::Colors::terrainRgb)
            return HeightCode{colors,
                              1.0,
                              0.0,
                              {"its colours are read as heights (Terrain-RGB).",
                               "ihre Farben werden als Höhen gelesen (Terrain-RGB)."}};
    }
    if (colorBands(raster) >= 3) return coloursWhy(raster);
    const std::string unit = band.GetUnitType();
    const std::optional<double> ofUnit = metresOfUnit(unit), ofSystem = verticalUnitOf(raster.GetSpatialRef());
    if (!unit.empty() && !ofUnit && !ofSystem)
        return Words{"its values are in " + inQuotes(unit, 20) + ", which measures no height",
                     "ihre Werte sind in " + inQuotes(unit, 20) + ", was keine Höhe misst"};
    const double scale = band.GetScale(nullptr), offset = band.GetOffset(nullptr);
    const double metres = ofUnit.value_or(ofSystem.value_or(1.0));
    const bool saysHeights = ofUnit || ofSystem || scale != 1.0 || offset != 0.0 || namesHeights(band.GetDescription());
    if (!saysHeights && bands >= 3) return coloursWhy(raster);
    if (!saysHeights && bytes)
        return Words{
            "it is a grey picture of 8 bits that names no unit, as hillshades and photos are, and counts as one "
            "without heights (where it has some, gdal_translate -ot Int16 says so)",
            "sie ist ein graues Bild mit 8 Bit und ohne Einheit, wie Schummerungen und Fotos es sind, und gilt als "
            "eines ohne Höhen (enthält sie welche, sagt es gdal_translate -ot Int16)"};
    HeightCode code{HeightCode::Colors::none, metres * (scale != 0.0 ? scale : 1.0), metres * offset,
                    unusual(scale != 0.0 ? scale : 1.0, offset, metres)};
    if (bands > 1) {
        const std::string more = std::to_string(bands);
        code.note.english += (code.note.empty() ? "" : " ") + ("only the first of its " + more + " bands is read.");
        code.note.german +=
            (code.note.german.empty() ? "" : " ") + ("nur der erste ihrer " + more + " Kanäle wird gelesen.");
    }
    return code;
}

Dataset heightRaster(Dataset raster, const HeightCode& code, const RasterPlace& place) {
    return std::make_unique<HeightRaster>(std::move(raster), code, place);
}

} // namespace lumorph::navigation

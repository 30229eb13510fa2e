#include "tests/support/truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "calibration/lab/lab_lens.h"

namespace lumorph::test {
namespace {

/// A rectangle of projector pixels, first to last but one.
struct Region {
    glm::ivec2 low{std::numeric_limits<int>::max()};
    glm::ivec2 high{std::numeric_limits<int>::min()};

    [[nodiscard]] glm::ivec2 size() const { return glm::max(high - low, glm::ivec2(0)); }
};

/// What a ray through a part of a projector pixel meets.
struct Part {
    glm::vec2 eyePixel{0.0F};
    float share = 0.0F; ///< of the picture's light that comes back from white; 0: nothing that the eye sees
};

/// Quadratic B-spline: a box of width 1 convolved with a tent of width 2.
double footprint(double x) {
    const double away = std::abs(x);
    if (away < 0.5) return 0.75 - away * away;
    return away < 1.5 ? 0.5 * (1.5 - away) * (1.5 - away) : 0.0;
}

/// Pixels of the projector on what the eye sees of the device, with some around.
Region regionOf(const LabSight& sight, glm::ivec2 size, int around) {
    Region region;
    for (std::size_t ray = 0; ray < sight.gleams.size(); ++ray) {
        const LabSight::Gleam& gleam = sight.gleams[ray];
        if (gleam.share <= 0.0F || sight.surfaces[ray] != TruthBench::kDevice) continue;
        region.low = glm::min(region.low, glm::ivec2(glm::floor(gleam.pixel)));
        region.high = glm::max(region.high, glm::ivec2(glm::floor(gleam.pixel)) + 1);
    }
    region.low = glm::max(region.low - around, glm::ivec2(0));
    region.high = glm::min(region.high + around, size);
    return region;
}

} // namespace

struct TruthBench::Data {
    TruthSetup setup;
    Lab lab;
    LabLens eyeLens;
    LabLens lamp;
    LabSight sight;
    Region region;
    glm::ivec2 grid{0};        ///< parts across and down the region
    std::vector<Part> parts;   ///< row after row
    std::vector<int> badAbove; ///< of all parts above and left (summed): those not to be judged
    std::vector<std::uint8_t> judged;

    explicit Data(const TruthSetup& s)
        : setup(s), lab({{{s.device}, {s.table}}, {}, {{s.projector, Image(s.projector.camera.size)}}}),
          eyeLens(lensOf(s.eye, "eye")), lamp(lensOf(s.projector.camera, "projector")),
          sight(lab.look(s.eye, s.samples)), region(regionOf(sight, s.projector.camera.size, s.around)),
          grid(region.size() * s.fine) {}

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.x) + static_cast<std::size_t>(x);
    }
    [[nodiscard]] glm::dvec2 projectorPixel(int x, int y) const {
        return glm::dvec2(region.low) - 0.5 + (glm::dvec2(x, y) + 0.5) / static_cast<double>(setup.fine);
    }
    [[nodiscard]] glm::vec2 gridPlace(const glm::vec2& pixel) const {
        return (pixel - glm::vec2(region.low) + 0.5F) * static_cast<float>(setup.fine) - 0.5F;
    }
    void castRow(int y, std::vector<std::optional<glm::dvec3>>& points, std::vector<std::uint8_t>& bad);
    void cast();
    void markEdges(const std::vector<std::optional<glm::dvec3>>& points, std::vector<std::uint8_t>& bad) const;
    void addUp(const std::vector<std::uint8_t>& bad);
    /// Whether no part within the band around a projector pixel's place is bad.
    [[nodiscard]] bool isGood(const glm::vec2& pixel) const;
    void judge();
    [[nodiscard]] std::vector<glm::vec3> lightOfParts(const LabPicture& eyePicture) const;
    [[nodiscard]] std::vector<glm::vec3> filtered(const std::vector<glm::vec3>& light, glm::ivec2 step) const;
};

void TruthBench::Data::castRow(int y, std::vector<std::optional<glm::dvec3>>& points, std::vector<std::uint8_t>& bad) {
    for (int x = 0; x < grid.x; ++x) {
        const auto direction = rayThrough(lamp, projectorPixel(x, y));
        const auto hit = direction ? lab.trace(lamp.position, *direction) : std::nullopt;
        if (!hit) continue;
        points[index(x, y)] = hit->point;
        const double cosine = -glm::dot(hit->normal, *direction);
        const auto pixel = imageOf(eyeLens, hit->point);
        if (!pixel || !inImage(eyeLens, *pixel) || !lab.sees(hit->point, hit->normal, eyeLens.position)) continue;
        const double ratio = setup.projector.referenceDistance / hit->distance;
        parts[index(x, y)] = {glm::vec2(*pixel), static_cast<float>(setup.projector.peak * cosine * ratio * ratio)};
        bad[index(x, y)] = cosine < kSteepestIncidence ? 1 : 0;
    }
}

void TruthBench::Data::cast() {
    parts.assign(index(0, grid.y), {});
    std::vector<std::optional<glm::dvec3>> points(parts.size());
    std::vector<std::uint8_t> bad(parts.size(), 1);
    tbb::parallel_for(0, grid.y, [&](int y) { castRow(y, points, bad); });
    markEdges(points, bad);
    addUp(bad);
}

/// Neighbours much farther apart than one slanting surface would have them lie on two surfaces.
void TruthBench::Data::markEdges(const std::vector<std::optional<glm::dvec3>>& points,
                                 std::vector<std::uint8_t>& bad) const {
    const double nominal = setup.projector.referenceDistance / lamp.focal.x / setup.fine;
    const auto mark = [&](std::size_t one, std::size_t other) {
        if (points[one] && points[other] && glm::length(*points[one] - *points[other]) < 8.0 * nominal) return;
        bad[one] = 1;
        bad[other] = 1;
    };
    for (int y = 0; y < grid.y; ++y)
        for (int x = 0; x < grid.x; ++x) {
            if (x + 1 < grid.x) mark(index(x, y), index(x + 1, y));
            if (y + 1 < grid.y) mark(index(x, y), index(x, y + 1));
        }
}

void TruthBench::Data::addUp(const std::vector<std::uint8_t>& bad) {
    const auto stride = static_cast<std::size_t>(grid.x + 1);
    badAbove.assign(stride * static_cast<std::size_t>(grid.y + 1), 0);
    for (int y = 0; y < grid.y; ++y) {
        int row = 0;
        for (int x = 0; x < grid.x; ++x) {
            row += bad[index(x, y)];
            const std::size_t here = static_cast<std::size_t>(y + 1) * stride + static_cast<std::size_t>(x + 1);
            badAbove[here] = badAbove[here - stride] + row;
        }
    }
}

bool TruthBench::Data::isGood(const glm::vec2& pixel) const {
    const glm::vec2 place = gridPlace(pixel);
    const float band = static_cast<float>(kBand * setup.fine);
    const glm::ivec2 low(glm::floor(place - band));
    const glm::ivec2 high(glm::ceil(place + band));
    if (low.x < 0 || low.y < 0 || high.x >= grid.x || high.y >= grid.y) return false;
    const auto sum = [&](int x, int y) {
        return badAbove[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.x + 1) +
                        static_cast<std::size_t>(x)];
    };
    return sum(high.x + 1, high.y + 1) - sum(low.x, high.y + 1) - sum(high.x + 1, low.y) + sum(low.x, low.y) == 0;
}

void TruthBench::Data::judge() {
    const auto rays = static_cast<std::size_t>(setup.samples * setup.samples);
    judged.assign(sight.gleams.size() / rays, 0);
    const glm::ivec2 border(kFrame * glm::dvec2(sight.size));
    for (std::size_t i = 0; i < judged.size(); ++i) {
        const glm::ivec2 pixel(static_cast<int>(i) % sight.size.x, static_cast<int>(i) / sight.size.x);
        const glm::ivec2 beyond = sight.size - 1 - pixel;
        if (std::min(pixel.x, beyond.x) < border.x || std::min(pixel.y, beyond.y) < border.y) continue;
        judged[i] = std::all_of(sight.gleams.begin() + static_cast<std::ptrdiff_t>(i * rays),
                                sight.gleams.begin() + static_cast<std::ptrdiff_t>((i + 1) * rays),
                                [&](const LabSight::Gleam& gleam) { return gleam.share > 0 && isGood(gleam.pixel); })
                        ? 1
                        : 0;
    }
}

std::vector<glm::vec3> TruthBench::Data::lightOfParts(const LabPicture& eyePicture) const {
    std::vector<glm::vec3> light(parts.size(), glm::vec3(0.0F));
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
        if (parts[i].share > 0.0F) light[i] = lightAt(eyePicture, parts[i].eyePixel);
    });
    return light;
}

std::vector<glm::vec3> TruthBench::Data::filtered(const std::vector<glm::vec3>& light, glm::ivec2 step) const {
    const int reach = static_cast<int>(std::ceil(1.5 * setup.fine));
    std::vector<float> weights;
    for (int k = -reach; k <= reach; ++k)
        weights.push_back(static_cast<float>(footprint(static_cast<double>(k) / setup.fine) / setup.fine));
    std::vector<glm::vec3> out(light.size(), glm::vec3(0.0F));
    tbb::parallel_for(0, grid.y, [&](int y) {
        for (int x = 0; x < grid.x; ++x) {
            const glm::ivec2 first = glm::ivec2(x, y) - reach * step;
            const glm::ivec2 last = glm::ivec2(x, y) + reach * step;
            if (first.x < 0 || first.y < 0 || last.x >= grid.x || last.y >= grid.y) continue; // never judged
            glm::vec3 sum(0.0F);
            for (std::size_t k = 0; k < weights.size(); ++k) {
                const glm::ivec2 at = first + static_cast<int>(k) * step;
                sum += weights[k] * light[index(at.x, at.y)];
            }
            out[index(x, y)] = sum;
        }
    });
    return out;
}

TruthBench::TruthBench(const TruthSetup& setup) : data_(std::make_unique<Data>(setup)) {
    data_->cast();
    data_->judge();
}

TruthBench::~TruthBench() = default;

const Lab& TruthBench::lab() const { return data_->lab; }
const CalibratedCamera& TruthBench::eye() const { return data_->setup.eye; }
const InstalledProjector& TruthBench::projector() const { return data_->setup.projector; }
const LabSight& TruthBench::sight() const { return data_->sight; }

bool TruthBench::besideEdge(glm::ivec2 pixel) const {
    const int margin = static_cast<int>(std::ceil(kBand)) + 1;
    const glm::ivec2 low = data_->region.low + margin;
    const glm::ivec2 high = data_->region.high - margin;
    const bool inside = pixel.x >= low.x && pixel.y >= low.y && pixel.x < high.x && pixel.y < high.y;
    return inside && !data_->isGood(pixel);
}

const std::vector<std::uint8_t>& TruthBench::judged() const { return data_->judged; }

std::size_t TruthBench::judgedPixels() const {
    return static_cast<std::size_t>(std::count(data_->judged.begin(), data_->judged.end(), 1));
}

std::vector<std::uint8_t> TruthBench::judgedDevice() const {
    const LabSight& sight = data_->sight;
    const auto rays = static_cast<std::size_t>(sight.samples * sight.samples);
    std::vector<std::uint8_t> marked = data_->judged;
    for (std::size_t i = 0; i < marked.size(); ++i)
        if (sight.surfaces[i * rays] != kDevice) marked[i] = 0;
    return marked;
}

Image TruthBench::ideal(const LabPicture& eyePicture) const {
    const std::vector<glm::vec3> light = data_->lightOfParts(eyePicture);
    const glm::ivec2 size = data_->region.size();
    const int fine = data_->setup.fine;
    const InstalledProjector& projector = data_->setup.projector;
    Image image(projector.camera.size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            glm::vec3 sum(0.0F);
            float count = 0.0F;
            for (int i = 0; i < fine * fine; ++i) {
                const std::size_t part = data_->index(x * fine + i % fine, y * fine + i / fine);
                if (data_->parts[part].share <= 0.0F) continue;
                sum += light[part] / data_->parts[part].share;
                count += 1.0F;
            }
            if (count == 0.0F) continue;
            Image::Pixel& pixel = image.at(data_->region.low.x + x, data_->region.low.y + y);
            for (std::size_t c = 0; c < 3; ++c) {
                const auto channel = static_cast<int>(c);
                const double value = static_cast<double>(sum[channel] / count / projector.gain[channel]);
                const double encoded = projector.gamma == 0.0
                                           ? srgbOfLight(value)
                                           : std::pow(std::clamp(value, 0.0, 1.0), 1.0 / projector.gamma);
                pixel[c] = static_cast<std::uint8_t>(std::lround(255.0 * encoded));
            }
        }
    return image;
}

LabPicture TruthBench::lowPassed(const LabPicture& eyePicture) const {
    LabPicture surface{data_->grid, {}};
    surface.light = data_->filtered(data_->filtered(data_->lightOfParts(eyePicture), {1, 0}), {0, 1});
    const LabSight& sight = data_->sight;
    const auto rays = static_cast<std::size_t>(sight.samples * sight.samples);
    LabPicture out{sight.size, std::vector<glm::vec3>(sight.gleams.size() / rays)};
    tbb::parallel_for(std::size_t{0}, out.light.size(), [&](std::size_t i) {
        for (std::size_t ray = i * rays; ray < (i + 1) * rays; ++ray)
            out.light[i] += lightAt(surface, data_->gridPlace(sight.gleams[ray].pixel)) / static_cast<float>(rays);
    });
    return out;
}

LabPicture TruthBench::seen(const Image& projected) {
    data_->lab.show(0, projected);
    return {data_->sight.size, data_->lab.radiance(data_->sight)};
}

std::vector<glm::dvec3> TruthBench::devicePoints(int spacing) const {
    std::vector<glm::dvec3> points;
    for (int y = data_->region.low.y; y < data_->region.high.y; y += spacing)
        for (int x = data_->region.low.x; x < data_->region.high.x; x += spacing) {
            const auto direction = rayThrough(data_->lamp, {x, y});
            const auto hit = direction ? data_->lab.trace(data_->lamp.position, *direction) : std::nullopt;
            if (hit && hit->surface == kDevice && data_->isGood({x, y})) points.push_back(hit->point);
        }
    return points;
}

double psnr(const LabPicture& one, const LabPicture& other, std::span<const std::uint8_t> marked) {
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < marked.size(); ++i) {
        if (marked[i] == 0) continue;
        for (int c = 0; c < 3; ++c) {
            const double difference =
                srgbOfLight(static_cast<double>(one.light[i][c])) - srgbOfLight(static_cast<double>(other.light[i][c]));
            squares += difference * difference;
        }
        count += 3.0;
    }
    return squares <= 1e-10 * count ? 100.0 : -10.0 * std::log10(squares / count);
}

LabPicture painted(const Lab& lab, const CalibratedCamera& eye,
                   const std::function<glm::vec3(const Lab::Hit&)>& color) {
    const LabLens lens = lensOf(eye, "eye");
    LabPicture picture{eye.size, {}};
    picture.light.resize(static_cast<std::size_t>(eye.size.x) * static_cast<std::size_t>(eye.size.y));
    tbb::parallel_for(0, eye.size.y, [&](int y) {
        for (int x = 0; x < eye.size.x; ++x) {
            const auto direction = rayThrough(lens, {x, y});
            const auto hit = direction ? lab.trace(lens.position, *direction) : std::nullopt;
            if (hit) picture.light[static_cast<std::size_t>(y * eye.size.x + x)] = color(*hit);
        }
    });
    return picture;
}

LabPicture lightOf(const Image& image) { return labPicture(image, 0.0, glm::vec3(1.0F)); }

namespace {

struct Spot {
    glm::dvec2 centre{0.0};
    double light = 0.0;
};

/// Empty where light reaches the window's rim.
std::optional<Spot> spotAt(const LabPicture& picture, glm::ivec2 middle, int reach) {
    constexpr double kDark = 0.004;
    Spot spot;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            const glm::vec3& light =
                picture.light[static_cast<std::size_t>((middle.y + y) * picture.size.x + middle.x + x)];
            const double sum = static_cast<double>(light.r + light.g + light.b) / 3.0;
            if (std::max(std::abs(x), std::abs(y)) == reach && sum > kDark) return std::nullopt;
            spot.centre += sum * glm::dvec2(x, y);
            spot.light += sum;
        }
    if (spot.light < 5.0) return std::nullopt;
    spot.centre /= spot.light;
    return spot;
}

} // namespace

std::vector<double> spotErrors(const LabPicture& one, const LabPicture& other, std::span<const glm::dvec2> spots,
                               int reach, std::span<const std::uint8_t> marked) {
    std::vector<double> errors;
    for (const glm::dvec2& place : spots) {
        const glm::ivec2 middle(glm::round(place));
        bool whole =
            middle.x >= reach && middle.y >= reach && middle.x + reach < one.size.x && middle.y + reach < one.size.y;
        for (int y = -reach; whole && y <= reach; ++y)
            for (int x = -reach; whole && x <= reach; ++x)
                whole = marked[static_cast<std::size_t>((middle.y + y) * one.size.x + middle.x + x)] != 0;
        if (!whole) continue;
        const auto first = spotAt(one, middle, reach);
        const auto second = spotAt(other, middle, reach);
        if (first && second) errors.push_back(glm::length(first->centre - second->centre));
    }
    return errors;
}

double meanOf(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double quantileOf(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
}

} // namespace lumorph::test

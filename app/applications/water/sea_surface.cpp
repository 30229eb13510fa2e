#include "app/applications/water/sea_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/water/sea_pictures.h"

namespace lumorph::sea {
namespace {

using Primitive = Model::Primitive;

constexpr int kC = SeaSurface::kColumns, kR = SeaSurface::kRows;
constexpr glm::dvec2 kSeaHalf = Ripples::kHalf;
constexpr double kCell = 2.0 * 0.105 / (kC - 1); ///< metres, in both directions
constexpr double kLongest = 0.1;                 ///< metres; waves below it get sharp crests
constexpr double kSharpens = 120.0;              ///< 1 / m, by their square
constexpr double kFloatProbe = 0.008;            ///< metres to each side
constexpr double kSteep = 0.72, kBreaks = 0.6;   ///< slope where foam begins, and how much more is all white
constexpr double kFoamLasts = 0.9;               ///< seconds until 1/e
constexpr double kFoamComes = 4.0;               ///< 1 / s
constexpr double kLineWide = 0.0028;             ///< metres of foam along what lies in the water
constexpr double kRimFoam = 0.50, kRimLine = 0.0022;
constexpr float kVeil = 0.0003F; ///< metres of foam over the water
constexpr float kLeastFoam = 0.04F;

std::size_t cell(int i, int j) { return static_cast<std::size_t>(j) * kC + static_cast<std::size_t>(i); }
glm::dvec2 cellPlace(int i, int j) { return -kSeaHalf + kCell * glm::dvec2(i, j); }

/// Two triangles for each square of the grid.
std::vector<glm::uvec3> gridTriangles() {
    std::vector<glm::uvec3> triangles;
    for (int j = 0; j + 1 < kR; ++j)
        for (int i = 0; i + 1 < kC; ++i) {
            const auto a = static_cast<std::uint32_t>(cell(i, j)), below = static_cast<std::uint32_t>(cell(i, j + 1));
            triangles.emplace_back(a, below, below + 1);
            triangles.emplace_back(a, below + 1, a + 1);
        }
    return triangles;
}

/// A side of the block: which grid points lie on it, counter-clockwise from above, and how it looks.
struct Side {
    glm::ivec2 from, step;
    int count;
    glm::vec3 normal;
};
constexpr std::array<Side, 4> kSides{{{{0, kR - 1}, {1, 0}, kC, {0.0F, 0.0F, 1.0F}},
                                      {{kC - 1, kR - 1}, {0, -1}, kR, {1.0F, 0.0F, 0.0F}},
                                      {{kC - 1, 0}, {-1, 0}, kC, {0.0F, 0.0F, -1.0F}},
                                      {{0, 0}, {0, 1}, kR, {-1.0F, 0.0F, 0.0F}}}};

std::vector<glm::uvec3> sideTriangles() {
    std::vector<glm::uvec3> triangles;
    std::uint32_t first = 0;
    for (const Side& side : kSides) {
        for (std::uint32_t i = 0; i + 1 < static_cast<std::uint32_t>(side.count); ++i) {
            const std::uint32_t head = first + 2 * i;
            triangles.emplace_back(head, head + 1, head + 3);
            triangles.emplace_back(head, head + 3, head + 2);
        }
        first += 2 * static_cast<std::uint32_t>(side.count);
    }
    return triangles;
}

/// One wave along columns or rows: the sine of a sum is two products a point.
struct WaveLine {
    std::vector<float> sine, cosine;
    WaveLine(int count, double first, double perMetre, double phase) {
        for (int i = 0; i < count; ++i) {
            const double angle = perMetre * (first + kCell * i) + phase;
            sine.push_back(static_cast<float>(std::sin(angle)));
            cosine.push_back(static_cast<float>(std::cos(angle)));
        }
    }
};

void addWave(std::vector<float>& heights, const Wave& wave, double storm, double seconds) {
    const double k = 2.0 * std::numbers::pi / wave.length;
    const double turns = wave.period > 0.0 ? std::fmod(seconds / wave.period, 1.0) : 0.0;
    const double phase = wave.phase.inRadians() - 2.0 * std::numbers::pi * turns;
    const WaveLine x(kC, -kSeaHalf.x, k * std::cos(wave.direction.inRadians()), phase);
    const WaveLine z(kR, -kSeaHalf.y, k * std::sin(wave.direction.inRadians()), 0.0);
    const auto amplitude = static_cast<float>(storm * wave.amplitude);
    for (std::size_t j = 0; j < kR; ++j)
        for (std::size_t i = 0; i < kC; ++i)
            heights[j * kC + i] += amplitude * (x.sine[i] * z.cosine[j] + x.cosine[i] * z.sine[j]);
}

/// Metres from a waterline; below 0 inside it.
double fromLine(const Waterline& line, const glm::dvec2& at) {
    const glm::dvec2 way = at - line.place;
    const double c = std::cos(line.turn), s = std::sin(line.turn);
    const glm::dvec2 turned(c * way.x + s * way.y, c * way.y - s * way.x);
    const glm::dvec2 beyond = glm::abs(turned) - (line.half - line.radius);
    return glm::length(glm::max(beyond, 0.0)) + std::min(std::max(beyond.x, beyond.y), 0.0) - line.radius;
}

} // namespace

SeaSurface::SeaSurface()
    : heights_(std::size_t{kC} * kR, 0.0F), slopes_(heights_.size(), glm::vec2(0.0F)), white_(heights_.size(), 0.0F),
      topTriangles_(gridTriangles()), sideTriangles_(sideTriangles()) {
    for (int j = 0; j < kR; ++j)
        for (int i = 0; i < kC; ++i) {
            const glm::dvec2 at = cellPlace(i, j), inset = kSeaHalf - glm::abs(at);
            const double far = std::min(inset.x, inset.y) / kRimLine;
            rim_.push_back(static_cast<float>(kRimFoam * std::exp(-far)));
            lace_.push_back(static_cast<float>(9.0 * (at.x + 0.4 * at.y) + 0.35 * softNoise(at / 0.006, 3)));
        }
    foam_ = rim_;
}

void SeaSurface::addWaves(std::span<const Wave> waves, double storm, double seconds) {
    double square = 0.0;
    std::ranges::fill(heights_, 0.0F);
    for (const Wave& wave : waves)
        if (wave.length < kLongest) {
            addWave(heights_, wave, storm, seconds);
            square += 0.5 * storm * storm * wave.amplitude * wave.amplitude;
        }
    // Sharp crests and flat troughs, with as much water as before.
    for (float& height : heights_)
        height += static_cast<float>(kSharpens) * (height * height - static_cast<float>(square));
    for (const Wave& wave : waves)
        if (wave.length >= kLongest) addWave(heights_, wave, storm, seconds);
}

void SeaSurface::setHeights(std::span<const Wave> waves, double storm, double seconds, const Slosh& slosh,
                            const Ripples& ripples) {
    addWaves(waves, storm, seconds);
    for (int j = 0; j < kR; ++j)
        for (int i = 0; i < kC; ++i) {
            const glm::dvec2 at = cellPlace(i, j);
            heights_[cell(i, j)] += static_cast<float>(slosh.heightAt(at) + ripples.heightAt(at));
        }
    findSlopes();
}

void SeaSurface::findSlopes() {
    for (int j = 0; j < kR; ++j)
        for (int i = 0; i < kC; ++i) {
            const int left = std::max(i - 1, 0), right = std::min(i + 1, kC - 1);
            const int above = std::max(j - 1, 0), below = std::min(j + 1, kR - 1);
            slopes_[cell(i, j)] = glm::vec2(heights_[cell(right, j)] - heights_[cell(left, j)],
                                            heights_[cell(i, below)] - heights_[cell(i, above)]) /
                                  (static_cast<float>(kCell) * glm::vec2(right - left, below - above));
        }
}

void SeaSurface::advanceFoam(double seconds, std::span<const Waterline> lines) {
    const auto kept = static_cast<float>(std::exp(-seconds / kFoamLasts));
    const auto comes = static_cast<float>(kFoamComes * seconds);
    for (std::size_t k = 0; k < white_.size(); ++k) {
        const float steep = (glm::length(slopes_[k]) - static_cast<float>(kSteep)) / static_cast<float>(kBreaks);
        white_[k] = std::min(1.0F, kept * white_[k] + comes * std::clamp(steep, 0.0F, 1.0F));
        if (white_[k] < 1e-6F) white_[k] = 0.0F; // before it is denormal, which is slow
        foam_[k] = std::max(white_[k], rim_[k]);
    }
    for (const Waterline& line : lines) addFoamAlong(line);
}

void SeaSurface::addFoamAlong(const Waterline& line) {
    const glm::dvec2 reach(glm::length(line.half) + 3.0 * kLineWide);
    const glm::ivec2 first(glm::floor((line.place - reach + kSeaHalf) / kCell));
    const glm::ivec2 last(glm::ceil((line.place + reach + kSeaHalf) / kCell));
    for (int j = std::max(first.y, 0); j <= std::min(last.y, kR - 1); ++j)
        for (int i = std::max(first.x, 0); i <= std::min(last.x, kC - 1); ++i) {
            const double far = std::max(0.0, fromLine(line, cellPlace(i, j))) / kLineWide;
            float& foam = foam_[cell(i, j)];
            foam = std::max(foam, static_cast<float>(0.72 * std::exp(-far * far)));
        }
}

void SeaSurface::splash(const glm::dvec2& place, double radius) {
    for (int j = 0; j < kR; ++j)
        for (int i = 0; i < kC; ++i) {
            const double far = glm::distance(place, cellPlace(i, j)) / radius;
            float& white = white_[cell(i, j)];
            if (far < 2.5) white = std::min(1.0F, white + static_cast<float>(std::exp(-far * far)));
        }
}

double SeaSurface::sampleAt(const std::vector<float>& values, const glm::dvec2& place) const noexcept {
    const glm::dvec2 at = glm::clamp((place + kSeaHalf) / kCell, glm::dvec2(0.0), glm::dvec2(kC - 1, kR - 1));
    const glm::ivec2 low = glm::min(glm::ivec2(at), glm::ivec2(kC - 2, kR - 2));
    const glm::dvec2 f = at - glm::dvec2(low);
    const std::size_t k = cell(low.x, low.y);
    return std::lerp(std::lerp(double{values[k]}, double{values[k + 1]}, f.x),
                     std::lerp(double{values[k + kC]}, double{values[k + kC + 1]}, f.x), f.y);
}

double SeaSurface::heightAt(const glm::dvec2& place) const noexcept { return sampleAt(heights_, place); }
double SeaSurface::foamAt(const glm::dvec2& place) const noexcept { return sampleAt(foam_, place); }

glm::dvec2 SeaSurface::slopeAt(const glm::dvec2& place) const noexcept {
    const glm::dvec2 x(kFloatProbe, 0.0), z(0.0, kFloatProbe);
    return glm::dvec2(heightAt(place + x) - heightAt(place - x), heightAt(place + z) - heightAt(place - z)) /
           (2.0 * kFloatProbe);
}

HeightGrid SeaSurface::heights() const {
    HeightGrid grid{-kSeaHalf, kSeaHalf, (kC + 1) / 2, (kR + 1) / 2, {}};
    for (int j = 0; j < kR; j += 2)
        for (int i = 0; i < kC; i += 2) grid.heights.push_back(heights_[cell(i, j)] + static_cast<float>(kLevel));
    return grid;
}

Primitive SeaSurface::top() const {
    Primitive top;
    top.material = kSeaTop;
    top.triangles = topTriangles_;
    for (int j = 0; j < kR; ++j)
        for (int i = 0; i < kC; ++i) {
            const std::size_t k = cell(i, j);
            const glm::dvec2 at = cellPlace(i, j);
            top.positions.emplace_back(at.x, kLevel + static_cast<double>(heights_[k]), at.y);
            top.normals.push_back(glm::normalize(glm::vec3(-slopes_[k].x, 1.0F, -slopes_[k].y)));
            top.texcoords.emplace_back(at + kBedHalf);
        }
    return top;
}

Primitive SeaSurface::sides() const {
    Primitive sides;
    sides.material = kSeaSide;
    sides.triangles = sideTriangles_;
    for (const Side& side : kSides)
        for (int n = 0; n < side.count; ++n) {
            const glm::ivec2 at = side.from + n * side.step;
            const glm::dvec2 place = cellPlace(at.x, at.y);
            const double top = kLevel + static_cast<double>(heights_[cell(at.x, at.y)]);
            const double foot = std::min(top, kFloor);
            for (const double y : {top, foot}) {
                sides.positions.emplace_back(place.x, y, place.y);
                sides.normals.push_back(side.normal);
                sides.texcoords.emplace_back(kCell * n, std::clamp((top - y) / kSideDeep, 0.01, 0.99));
            }
        }
    return sides;
}

/// Only where there is some; the second coordinate is how much.
Primitive SeaSurface::foam() const {
    Primitive foam;
    foam.material = kSeaFoam;
    std::vector<std::int32_t> index(heights_.size(), -1);
    const auto vertex = [&](std::uint32_t k) {
        if (index[k] < 0) {
            index[k] = static_cast<std::int32_t>(foam.positions.size());
            const glm::dvec2 at = cellPlace(static_cast<int>(k) % kC, static_cast<int>(k) / kC);
            foam.positions.emplace_back(at.x, static_cast<float>(kLevel) + heights_[k] + kVeil, at.y);
            foam.normals.push_back(glm::normalize(glm::vec3(-slopes_[k].x, 1.0F, -slopes_[k].y)));
            foam.texcoords.emplace_back(lace_[k], std::clamp(foam_[k], 0.02F, 0.98F));
        }
        return static_cast<std::uint32_t>(index[k]);
    };
    for (const glm::uvec3& t : topTriangles_)
        if (std::max({foam_[t.x], foam_[t.y], foam_[t.z]}) > kLeastFoam) {
            const std::uint32_t a = vertex(t.x), b = vertex(t.y), c = vertex(t.z);
            foam.triangles.emplace_back(a, b, c);
        }
    return foam;
}

std::shared_ptr<const SceneModel> SeaSurface::model() const {
    auto made = std::make_shared<SceneModel>(seaModel({top(), sides(), foam()}));
    made->materials = seaMaterials();
    return made;
}

} // namespace lumorph::sea

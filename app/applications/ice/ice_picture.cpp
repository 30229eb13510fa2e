#include "app/applications/ice/ice_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "app/applications/ice/pond_bed.h"

namespace lumorph::ice {
namespace {

constexpr glm::vec3 kSnowWhite{0.97F, 0.985F, 1.0F};
constexpr glm::vec3 kDeepIce{0.36F, 0.62F, 0.74F};  ///< clear ice over dark water
constexpr glm::vec3 kMilkyIce{0.66F, 0.84F, 0.91F}; ///< that froze fast
constexpr glm::vec3 kThinIce{0.55F, 0.85F, 0.93F};  ///< near rims, where light comes through
constexpr glm::vec3 kWetIce{0.26F, 0.52F, 0.64F};   ///< nearly gone
constexpr float kPaintsTo = 0.25F; ///< of a field's shape: beyond the rim too, as far as pictures are blurred
constexpr glm::vec3 kRimLine{0.93F, 1.0F, 1.0F};
constexpr glm::vec3 kWetEdge{0.30F, 0.60F, 0.71F};

double chanceAt(int x, int y, std::uint64_t seed) {
    std::uint64_t bits = seed * 0x9e3779b97f4a7c15ULL ^
                         static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32U ^
                         static_cast<std::uint32_t>(y);
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebULL;
    return static_cast<double>((bits ^ (bits >> 31U)) >> 11U) * 0x1p-53;
}

/// Value noise in [0, 1] with features of size 1.
double valueNoise(const glm::dvec2& at, std::uint64_t seed) {
    const glm::dvec2 floor = glm::floor(at), within = at - floor;
    const glm::dvec2 soft = within * within * (3.0 - 2.0 * within);
    const auto i = static_cast<int>(floor.x), j = static_cast<int>(floor.y);
    return glm::mix(glm::mix(chanceAt(i, j, seed), chanceAt(i + 1, j, seed), soft.x),
                    glm::mix(chanceAt(i, j + 1, seed), chanceAt(i + 1, j + 1, seed), soft.x), soft.y);
}

double layered(const glm::dvec2& at, std::uint64_t seed) {
    return 0.55 * valueNoise(at, seed) + 0.28 * valueNoise(2.1 * at, seed + 1) + 0.17 * valueNoise(4.3 * at, seed + 2);
}

/// Drifts that the wind has laid along its way, torn into streaks at their rims.
double snowAt(const glm::dvec2& home, std::uint64_t seed) {
    const glm::dvec2 along(0.8 * home.x + 0.6 * home.y, -0.6 * home.x + 0.8 * home.y);
    const double drifts = layered({along.x / 0.060, along.y / 0.022}, seed);
    const double streaks = layered({along.x / 0.013, along.y / 0.0022}, seed + 5) - 0.5;
    return glm::smoothstep(0.44, 0.66, drifts + 0.34 * streaks);
}

/// How clear the ice is: milky where it froze fast.
double clearAt(const glm::dvec2& home, std::uint64_t seed) {
    return glm::smoothstep(0.25, 0.75, layered(home / 0.019, seed));
}

/// Thin cracks inside: crests of a noise whose place is bent by another.
double veinsAt(const glm::dvec2& home, std::uint64_t seed) {
    const glm::dvec2 bent =
        home + 0.006 * (glm::dvec2(valueNoise(home / 0.016, seed), valueNoise(home / 0.016, seed + 1)) - 0.5);
    const auto crest = [&](double size, double wide, std::uint64_t of) {
        const double away = std::abs(valueNoise(bent / size, of) - 0.5);
        return 1.0 - glm::smoothstep(0.0, wide, away);
    };
    return std::min(1.0, crest(0.024, 0.012, seed + 2) + 0.45 * crest(0.017, 0.045, seed + 3));
}

/// Gas that froze in: discs in clusters, one in some squares.
double bubblesAt(const glm::dvec2& home, std::uint64_t seed) {
    constexpr double kSquare = 0.0030;
    const glm::dvec2 at =
        home / kSquare + 0.7 * glm::dvec2(valueNoise(home / 0.007, seed + 5), valueNoise(home / 0.007, seed + 6));
    const glm::dvec2 square = glm::floor(at);
    const auto i = static_cast<int>(square.x), j = static_cast<int>(square.y);
    const double cluster = valueNoise(home / 0.020, seed);
    if (chanceAt(i, j, seed + 1) > 0.7 * glm::smoothstep(0.60, 0.90, cluster)) return 0.0;
    const double radius = 0.07 + 0.20 * std::pow(chanceAt(i, j, seed + 4), 2.0);
    const glm::dvec2 chance(chanceAt(i, j, seed + 2), chanceAt(i, j, seed + 3));
    const glm::dvec2 centre = square + radius + (1.0 - 2.0 * radius) * chance;
    return 1.0 - glm::smoothstep(0.5 * radius, radius + 0.05, glm::distance(at, centre));
}

std::uint8_t byteOf(double share) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

float step(float from, float to, float value) {
    const float share = std::clamp((value - from) / (to - from), 0.0F, 1.0F);
    return share * share * (3.0F - 2.0F * share);
}

Image::Pixel pixelOf(const glm::vec3& color) {
    const glm::vec3 bytes = 255.0F * glm::clamp(color, 0.0F, 1.0F) + 0.5F;
    return {static_cast<std::uint8_t>(bytes.x), static_cast<std::uint8_t>(bytes.y), static_cast<std::uint8_t>(bytes.z),
            255};
}

glm::ivec2 pictureSize() { return glm::ivec2(glm::ceil(2.0 * kPondHalf / IcePicture::kPixel)); }

/// Samples in which two fields of one floe differ, and one more to each side; x and y of the first and the last.
struct Samples {
    glm::ivec2 low{1 << 20}, high{-(1 << 20)};
};

Samples differing(const FloeField& now, const FloeField* before) {
    Samples found;
    for (int j = 0; j < now.size.y; ++j)
        for (int i = 0; i < now.size.x; ++i) {
            const glm::ivec2 at = now.min + glm::ivec2(i, j);
            if (before) {
                const glm::ivec2 then = at - before->min;
                const std::size_t k = now.at(i, j);
                if (then.x >= 0 && then.y >= 0 && then.x < before->size.x && then.y < before->size.y) {
                    const std::size_t old = before->at(then.x, then.y);
                    if (std::abs(now.inland[k] - before->inland[old]) < 0.01F &&
                        std::abs(now.shape[k] - before->shape[old]) < 0.02F &&
                        std::abs(now.thickness[k] - before->thickness[old]) < 0.01F)
                        continue;
                } else if (now.shape[k] < 0.01F) {
                    continue;
                }
            }
            found.low = glm::min(found.low, at - 1);
            found.high = glm::max(found.high, at + 1);
        }
    return found;
}

} // namespace

glm::dvec2 IcePicture::placeOf(int x, int y) noexcept {
    const glm::dvec2 size(pictureSize());
    return kPondHalf * (2.0 * (glm::dvec2(x, y) + 0.5) / size - 1.0);
}

IcePicture::IcePicture(std::uint64_t seed) : now_(pictureSize(), pixelOf(kThinIce)) {
    for (int y = 0; y < now_.size().y; ++y)
        for (int x = 0; x < now_.size().x; ++x) {
            const glm::dvec2 home = placeOf(x, y);
            details_.push_back({byteOf(snowAt(home, seed)), byteOf(veinsAt(home, seed + 20)),
                                byteOf(bubblesAt(home, seed + 40)), byteOf(clearAt(home, seed + 80)),
                                byteOf(0.5 * valueNoise(home / 0.0008, seed + 60) + 0.5 * chanceAt(x, y, seed + 61))});
            usual_.push_back(colorOf(details_.back(), {}));
        }
}

Image::Pixel IcePicture::colorOf(const Detail& detail, const Ice& ice) {
    const auto share = [](std::uint8_t byte) { return static_cast<float>(byte) * (1.0F / 255.0F); };
    const float depth = step(0.55F, 0.97F, ice.inland), whole = step(0.30F, 0.95F, ice.thickness);
    glm::vec3 color = glm::mix(kThinIce, glm::mix(kMilkyIce, kDeepIce, share(detail.clear)), depth);
    color = glm::mix(color, kSnowWhite, 0.42F * share(detail.veins) * (0.3F + 0.7F * depth));
    color = glm::mix(color, kSnowWhite, 0.60F * share(detail.bubbles) * depth);
    color = glm::mix(kWetIce, color, 0.25F + 0.75F * whole);
    const float snow = share(detail.snow) * step(0.60F, 0.92F, ice.inland) * step(0.75F, 1.0F, ice.thickness);
    color = glm::mix(color, kSnowWhite, 0.90F * snow);
    color *= 0.95F + (0.05F + 0.05F * snow) * share(detail.grain);
    const float line = step(0.52F, 0.62F, ice.shape) * (1.0F - step(0.68F, 0.90F, ice.shape));
    color = glm::mix(color, kRimLine, 0.80F * line);
    return pixelOf(glm::mix(kWetEdge, color, step(0.46F, 0.56F, ice.shape)));
}

/// Pixels of a row, as far as they lie between samples of the field.
void IcePicture::paintRow(const FloeField& field, int y, int first, int end) {
    const auto width = static_cast<std::size_t>(now_.size().x);
    const glm::dvec2 from = placeOf(first, y) / FloeField::kStep - glm::dvec2(field.min);
    const double across = 2.0 * kPondHalf.x / now_.size().x / FloeField::kStep;
    const auto j = static_cast<int>(std::floor(from.y));
    if (j < 0 || j + 1 >= field.size.y) return;
    const auto far = static_cast<float>(from.y - j);
    for (int x = first; x < end; ++x) {
        const double at = from.x + across * (x - first);
        const auto i = static_cast<int>(at);
        if (at < 0.0 || i + 1 >= field.size.x) continue;
        const auto right = static_cast<float>(at - i);
        const std::size_t near = field.at(i, j), next = field.at(i, j + 1);
        const auto between = [&](const std::vector<float>& of) {
            return (1.0F - far) * ((1.0F - right) * of[near] + right * of[near + 1]) +
                   far * ((1.0F - right) * of[next] + right * of[next + 1]);
        };
        const Ice ice{between(field.shape), between(field.inland), between(field.thickness)};
        if (ice.shape <= kPaintsTo) continue;
        const std::size_t pixel = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
        const bool usual = ice.shape > 0.95F && ice.inland > 0.97F && ice.thickness > 0.995F;
        now_.pixels()[pixel] = usual ? usual_[pixel] : colorOf(details_[pixel], ice);
    }
}

void IcePicture::paint(const FloeField& field, const FloeField* before) {
    const Samples samples = differing(field, before);
    if (samples.low.x > samples.high.x) return;
    const glm::dvec2 size(now_.size());
    const auto pixelAt = [&](const glm::ivec2& sample) {
        return (FloeField::kStep * glm::dvec2(sample) / kPondHalf + 1.0) * 0.5 * size;
    };
    const glm::ivec2 first = glm::max(glm::ivec2(pixelAt(samples.low)), 0);
    const glm::ivec2 end = glm::min(glm::ivec2(pixelAt(samples.high)) + 1, now_.size());
    for (int y = first.y; y < end.y; ++y) paintRow(field, y, first.x, end.x);
    shared_.reset();
}

const std::shared_ptr<const Image>& IcePicture::image() {
    if (!shared_) shared_ = std::make_shared<const Image>(now_);
    return shared_;
}

Image rimPicture() {
    struct Stop {
        float depth;
        glm::vec3 color;
    };
    static constexpr std::array<Stop, 6> kStops{{{0.0F, {0.93F, 1.0F, 1.0F}},
                                                 {0.10F, {0.80F, 0.96F, 0.99F}},
                                                 {0.20F, {0.48F, 0.82F, 0.91F}},
                                                 {0.30F, {0.20F, 0.52F, 0.64F}}, // wet by the water's line
                                                 {0.55F, {0.22F, 0.62F, 0.72F}},
                                                 {1.0F, {0.05F, 0.26F, 0.34F}}}};
    Image picture({4, 64});
    for (int y = 0; y < 64; ++y) {
        const float depth = (static_cast<float>(y) + 0.5F) / 64.0F;
        std::size_t k = 1;
        while (k + 1 < kStops.size() && kStops[k].depth < depth) ++k;
        const float share =
            std::clamp((depth - kStops[k - 1].depth) / (kStops[k].depth - kStops[k - 1].depth), 0.0F, 1.0F);
        for (int x = 0; x < 4; ++x) picture.at(x, y) = pixelOf(glm::mix(kStops[k - 1].color, kStops[k].color, share));
    }
    return picture;
}

} // namespace lumorph::ice

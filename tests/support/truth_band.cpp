#include "tests/support/truth_band.h"

#include <algorithm>
#include <optional>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "calibration/lab/lab_lens.h"

namespace lumorph::test {
namespace {

constexpr int kSweeps = 60; ///< by then the error falls by less than a thousandth a sweep
constexpr int kStencil = 3; ///< a ray lights from four pixels, so that only neighbours meet

using Ray = BandBench::Ray;

/// The least squares over the band's pixels: values x in [0, 1] that minimise |Ax - b|^2, kept as A^T A and A^T b.
class BandSystem {
public:
    BandSystem(glm::ivec2 size, const std::vector<std::uint8_t>& band, const glm::vec3& white)
        : size_(size), white_(white) {
        numbers_.assign(band.size(), -1);
        for (std::size_t i = 0; i < band.size(); ++i) {
            if (band[i] == 0) continue;
            numbers_[i] = static_cast<int>(places_.size());
            places_.push_back(i);
        }
        rows_.resize(places_.size());
    }

    [[nodiscard]] std::size_t index(glm::ivec2 pixel) const {
        return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(size_.x) +
               static_cast<std::size_t>(pixel.x);
    }
    void add(const Ray& ray, const glm::vec3& wanted, const LabPicture& fixed) {
        glm::dvec3 open(wanted);
        for (int k = 0; k < 4; ++k) {
            const std::size_t at = index(ray.corner + tap(k));
            if (numbers_[at] < 0) open -= static_cast<double>(weight(ray, k)) * glm::dvec3(fixed.light[at]);
        }
        for (int k = 0; k < 4; ++k) {
            const int number = numbers_[index(ray.corner + tap(k))];
            if (number < 0 || !(weight(ray, k) > 0.0F)) continue;
            Row& row = rows_[static_cast<std::size_t>(number)];
            row.right += static_cast<double>(weight(ray, k)) * open;
            for (int j = 0; j < 4; ++j) {
                if (numbers_[index(ray.corner + tap(j))] < 0) continue;
                const glm::ivec2 apart = tap(j) - tap(k) + kStencil / 2;
                row.left[static_cast<std::size_t>(apart.y * kStencil + apart.x)] +=
                    static_cast<double>(weight(ray, k)) * static_cast<double>(weight(ray, j));
            }
        }
    }
    /// Projected Gauss-Seidel, from the picture's own values on.
    void solve(LabPicture& picture) const {
        for (int sweep = 0; sweep < kSweeps; ++sweep)
            for (std::size_t n = 0; n < places_.size(); ++n) improve(n, picture);
    }
    static glm::ivec2 tap(int k) { return {k % 2, k / 2}; }

private:
    struct Row {
        std::array<double, static_cast<std::size_t>(kStencil* kStencil)> left{};
        glm::dvec3 right{0.0};
    };

    static float weight(const Ray& ray, int k) { return ray.weights[static_cast<std::size_t>(k)]; }

    void improve(std::size_t n, LabPicture& picture) const {
        const Row& row = rows_[n];
        constexpr int kOwn = kStencil * kStencil / 2;
        if (!(row.left[kOwn] > 1e-12)) return;
        const glm::ivec2 place(static_cast<int>(places_[n]) % size_.x, static_cast<int>(places_[n]) / size_.x);
        glm::dvec3 rest = row.right;
        for (int k = 0; k < kStencil * kStencil; ++k) {
            const double coupled = row.left[static_cast<std::size_t>(k)];
            if (k == kOwn || coupled == 0.0) continue;
            rest -= coupled *
                    glm::dvec3(picture.light[index(place + glm::ivec2(k % kStencil, k / kStencil) - kStencil / 2)]);
        }
        picture.light[places_[n]] = glm::vec3(glm::clamp(rest / row.left[kOwn], glm::dvec3(0.0), white_));
    }

    glm::ivec2 size_;
    glm::dvec3 white_;
    std::vector<int> numbers_;
    std::vector<std::size_t> places_;
    std::vector<Row> rows_;
};

double errorOf(const Ray& ray, const glm::vec3& wanted, const BandSystem& system, const LabPicture& picture) {
    glm::vec3 light(0.0F);
    for (int k = 0; k < 4; ++k)
        light +=
            ray.weights[static_cast<std::size_t>(k)] * picture.light[system.index(ray.corner + BandSystem::tap(k))];
    const glm::dvec3 difference = glm::dvec3(light) - glm::dvec3(wanted);
    return glm::dot(difference, difference);
}

/// Casts the eye's rays through a pixel, and keeps those that the band lights.
class RayCaster {
public:
    RayCaster(const TruthBench& bench, const std::vector<std::uint8_t>& band, int samples)
        : bench_(bench), band_(band), samples_(samples), eye_(lensOf(bench.eye(), "eye")),
          lamp_(lensOf(bench.projector().camera, "projector")) {}

    void cast(glm::ivec2 pixel, std::vector<Ray>& rays) const {
        for (int i = 0; i < samples_ * samples_; ++i) {
            const glm::dvec2 within = (glm::dvec2(i % samples_, i / samples_) + 0.5) / static_cast<double>(samples_);
            const glm::dvec2 at = glm::dvec2(pixel) + within - 0.5;
            const auto direction = rayThrough(eye_, at);
            const auto hit = direction ? bench_.lab().trace(eye_.position, *direction) : std::nullopt;
            if (!hit || !bench_.lab().lit(0, hit->point, hit->normal)) continue;
            const auto place = imageOf(lamp_, hit->point);
            if (!place || !lightsBand(*place)) continue;
            const glm::dvec3 way = lamp_.position - hit->point;
            const double ratio = bench_.projector().referenceDistance / glm::length(way);
            const auto share = static_cast<float>(bench_.projector().peak * ratio * ratio *
                                                  glm::dot(glm::normalize(way), hit->normal));
            Ray ray{glm::vec2(at), corner(*place), {}};
            const glm::vec2 part = glm::clamp(glm::vec2(*place) - glm::vec2(ray.corner), 0.0F, 1.0F);
            ray.weights = {share * (1.0F - part.x) * (1.0F - part.y), share * part.x * (1.0F - part.y),
                           share * (1.0F - part.x) * part.y, share * part.x * part.y};
            rays.push_back(ray);
        }
    }
    /// Of a place in the projector's picture: whether one of the four pixels that light it belongs to the band.
    [[nodiscard]] bool lightsBand(const glm::dvec2& place) const {
        for (int k = 0; k < 4; ++k) {
            const glm::ivec2 at = corner(place) + BandSystem::tap(k);
            if (band_[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(lamp_.size.x) +
                      static_cast<std::size_t>(at.x)] != 0)
                return true;
        }
        return false;
    }

private:
    [[nodiscard]] glm::ivec2 corner(const glm::dvec2& place) const {
        return glm::clamp(glm::ivec2(glm::floor(place)), glm::ivec2(0), lamp_.size - 2);
    }

    const TruthBench& bench_;
    const std::vector<std::uint8_t>& band_;
    int samples_;
    LabLens eye_, lamp_;
};

/// Eye pixels, but for the frame where the eye's picture fades, whose ray or that of a pixel beside them meets light of
/// the band.
std::vector<glm::ivec2> bandPixels(const TruthBench& bench, const RayCaster& caster) {
    const LabSight& sight = bench.sight();
    const auto rays = static_cast<std::size_t>(sight.samples * sight.samples);
    const glm::ivec2 border = glm::max(glm::ivec2(TruthBench::kFrame * glm::dvec2(sight.size)), 1);
    const auto number = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(sight.size.x) + static_cast<std::size_t>(x);
    };
    std::vector<std::uint8_t> met(sight.gleams.size() / rays);
    for (std::size_t i = 0; i < met.size(); ++i) {
        const LabSight::Gleam& gleam = sight.gleams[i * rays];
        met[i] = gleam.share > 0.0F && caster.lightsBand(gleam.pixel) ? 1 : 0;
    }
    std::vector<glm::ivec2> pixels;
    for (int y = border.y; y < sight.size.y - border.y; ++y)
        for (int x = border.x; x < sight.size.x - border.x; ++x) {
            bool any = false;
            for (int k = 0; k < 9; ++k) any = any || met[number(x + k % 3 - 1, y + k / 3 - 1)] != 0;
            if (any) pixels.emplace_back(x, y);
        }
    return pixels;
}

} // namespace

BandBench::BandBench(const TruthBench& bench, int samples) : bench_(bench) {
    const glm::ivec2 size = bench.projector().camera.size;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) band_.push_back(bench.besideEdge({x, y}) ? 1 : 0);
    const RayCaster caster(bench, band_, samples);
    const std::vector<glm::ivec2> pixels = bandPixels(bench, caster);
    std::vector<std::vector<Ray>> found(pixels.size());
    tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) { caster.cast(pixels[i], found[i]); });
    for (const auto& some : found) rays_.insert(rays_.end(), some.begin(), some.end());
}

BandError BandBench::error(const LabPicture& eyePicture, const Image& projected) const {
    const glm::vec3& white = bench_.projector().gain;
    LabPicture picture = labPicture(projected, bench_.projector().gamma, white);
    BandSystem system(projected.size(), band_, white);
    for (const Ray& ray : rays_) system.add(ray, lightAt(eyePicture, ray.eyePixel), picture);
    const auto sum = [&] {
        double all = 0.0;
        for (const Ray& ray : rays_) all += errorOf(ray, lightAt(eyePicture, ray.eyePixel), system, picture);
        return all;
    };
    BandError error;
    error.rendered = sum();
    system.solve(picture);
    error.least = sum();
    return error;
}

} // namespace lumorph::test

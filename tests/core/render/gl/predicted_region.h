#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/core/render/eye/eye_stage.h"

namespace lumorph {

/// One step of a picture as it is displayed.
inline constexpr float kStep = 1.0F / 255.0F;

/// As displayed: in dark places a step is much less light than in bright ones.
inline float encoded(float light) {
    return light <= 0.0031308F ? 12.92F * light : 1.055F * std::pow(light, 1.0F / 2.4F) - 0.055F;
}
inline bool changed(const glm::vec4& a, const glm::vec4& b) {
    const auto differs = [](float x, float y) { return x != y && std::abs(encoded(x) - encoded(y)) > kStep; };
    return differs(a.r, b.r) || differs(a.g, b.g) || differs(a.b, b.b);
}

/// For each pixel what the eye's ray meets first, and where.
struct Met {
    int thing = EyeStage::nothing;
    glm::dvec3 place{0.0};
    glm::dvec3 normal{0.0};
    bool shadowOfItem = false;
};
inline std::vector<Met> meet(const ShowFrame& frame, const CalibratedCamera& camera) {
    const RayOracle rays = EyeStage::oracle(frame);
    std::vector<Met> all;
    for (int y = 0; y < camera.size.y; ++y)
        for (int x = 0; x < camera.size.x; ++x) {
            Met met;
            const glm::dvec3 from = EyeStage::origin(camera);
            const glm::dvec3 direction = EyeStage::ray(camera, x, y);
            if (const auto hit = rays.cast(from, direction)) {
                met.thing = hit->thing;
                met.place = from + hit->distance * direction;
                met.normal = hit->normal;
                if (!frame.posed.lights.empty()) {
                    const glm::dvec3 light(frame.posed.lights.front().position);
                    met.shadowOfItem =
                        rays.cast(met.place + 1e-6 * hit->normal, light, 1e-9, EyeStage::firstItem).has_value();
                }
            }
            all.push_back(met);
        }
    return all;
}
inline bool onDevice(const Met& met) { return met.thing == EyeStage::device; }

/// The pixels with any marked one within `band`.
inline std::vector<bool> grown(const std::vector<bool>& marked, glm::ivec2 size, int band) {
    std::vector<bool> result(marked.size(), false);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            if (!marked[static_cast<std::size_t>(y * size.x + x)]) continue;
            for (int j = std::max(y - band, 0); j <= std::min(y + band, size.y - 1); ++j)
                for (int i = std::max(x - band, 0); i <= std::min(x + band, size.x - 1); ++i)
                    result[static_cast<std::size_t>(j * size.x + i)] = true;
        }
    return result;
}
/// Whether any pixel within `band` fulfils a condition.
template <class Condition>
std::vector<bool> near(const std::vector<Met>& met, glm::ivec2 size, int band, const Condition& condition) {
    std::vector<bool> marked;
    for (const Met& pixel : met) marked.push_back(condition(pixel));
    return grown(marked, size, band);
}

struct Change {
    int inside = 0, area = 0, outside = 0;
};
inline Change changeOf(const LinearPicture& before, const LinearPicture& after, const std::vector<bool>& region) {
    Change change;
    for (std::size_t i = 0; i < region.size(); ++i) {
        const bool differs = changed(before.pixels[i], after.pixels[i]);
        change.area += region[i] ? 1 : 0;
        change.inside += differs && region[i] ? 1 : 0;
        change.outside += differs && !region[i] ? 1 : 0;
    }
    return change;
}

/// Peak signal over noise, in decibels, of the pixels of a region.
inline double psnr(const LinearPicture& a, const LinearPicture& b, const std::vector<bool>& region) {
    double squares = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < region.size(); ++i) {
        if (!region[i]) continue;
        for (int c = 0; c < 3; ++c) squares += std::pow(a.pixels[i][c] - b.pixels[i][c], 2.0);
        ++count;
    }
    return -10.0 * std::log10(squares / (3.0 * std::max(count, 1)) + 1e-12);
}

} // namespace lumorph

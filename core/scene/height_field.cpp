#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scene/height_formula.h"
#include "core/scene/posed_scene.h"

namespace lumorph {

WaveNumbers waveNumbers(const Wave& wave, double seconds) {
    const double k = 2.0 * std::numbers::pi / wave.length;
    // Whole periods are taken away while there are digits to spare: a show may run for weeks.
    const double turns = wave.period > 0.0 ? std::fmod(seconds / wave.period, 1.0) : 0.0;
    return {k * std::cos(wave.direction.inRadians()), k * std::sin(wave.direction.inRadians()),
            wave.phase.inRadians() - 2.0 * std::numbers::pi * turns};
}

float calmness(const HeightItem& item, const glm::vec2& point) {
    if (!(item.calmEdge > 0.0)) return 1.0F;
    const glm::vec2 inset = 0.5F * item.size - glm::abs(point);
    const float share = std::clamp(std::min(inset.x, inset.y) / static_cast<float>(item.calmEdge), 0.0F, 1.0F);
    return share * share * (3.0F - 2.0F * share);
}

float pictureHeight(const HeightItem& item, const Image& image, const glm::vec2& point) {
    if (image.pixels().empty()) return 0.0F;
    const glm::ivec2 last = image.size() - 1;
    const glm::vec2 share = glm::clamp(point / item.size + 0.5F, 0.0F, 1.0F);
    const glm::vec2 at = glm::clamp(share * glm::vec2(image.size()) - 0.5F, glm::vec2(0.0F), glm::vec2(last));
    const glm::ivec2 low(at);
    const glm::ivec2 high = glm::min(low + 1, last);
    const glm::vec2 f = at - glm::vec2(low);
    const auto grey = [&image](int x, int y) {
        const Image::Pixel& p = image.at(x, y);
        return (0.2126F * static_cast<float>(p[0]) + 0.7152F * static_cast<float>(p[1]) +
                0.0722F * static_cast<float>(p[2])) /
               255.0F;
    };
    const float upper = glm::mix(grey(low.x, low.y), grey(high.x, low.y), f.x);
    const float lower = glm::mix(grey(low.x, high.y), grey(high.x, high.y), f.x);
    return static_cast<float>(item.imageHeight) * glm::mix(upper, lower, f.y);
}

void sampleHeights(const HeightItem& item, const Image* image, double seconds, std::span<const glm::vec2> points,
                   std::span<float> out) {
    std::vector<WaveNumbers> waves;
    for (const Wave& wave : item.waves) waves.push_back(waveNumbers(wave, seconds));
    for (std::size_t i = 0; i < std::min(points.size(), out.size()); ++i) {
        const glm::vec2& p = points[i];
        const glm::vec2 inset = 0.5F * item.size - glm::abs(p);
        out[i] = 0.0F;
        if (!(inset.x >= 0.0F && inset.y >= 0.0F)) continue;
        double sum = 0.0;
        for (std::size_t w = 0; w < waves.size(); ++w)
            sum += item.waves[w].amplitude * std::sin(waves[w].x * static_cast<double>(p.x) +
                                                      waves[w].z * static_cast<double>(p.y) + waves[w].phase);
        out[i] = calmness(item, p) * static_cast<float>(sum) + (image ? pictureHeight(item, *image, p) : 0.0F);
    }
}

} // namespace lumorph

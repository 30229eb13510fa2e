#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "resources/materials/generator/textures.h"
#include "resources/materials/generator/tiling.h"

namespace lumorph {
namespace {

constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;

/// A wave with whole numbers of crests to a repeat, so that it tiles; and of periods to a loop.
struct Ripple {
    glm::vec2 crests{0.0F};
    float amplitude = 0.0F;
    float phase = 0.0F;
    float cycles = 0.0F;
};

std::vector<Ripple> ripples(int count, float shortest, float longest, std::uint32_t seed) {
    std::vector<Ripple> all;
    for (std::uint32_t i = 0; all.size() < static_cast<std::size_t>(count); ++i) {
        const float number = shortest * std::pow(longest / shortest, hashed(i, 0, seed));
        const float angle = kTurn * (hashed(i, 1, seed) - 0.5F) * 0.7F; // mostly along one direction
        const glm::vec2 crests = glm::round(number * glm::vec2(std::cos(angle), std::sin(angle)));
        const float length = glm::length(crests);
        if (length < 1.0F) continue;
        all.push_back({crests, std::pow(length, -1.15F), kTurn * hashed(i, 2, seed),
                       std::round(0.5F + 2.0F * hashed(i, 3, seed))});
    }
    return all;
}

/// Sharp crests, flat troughs.
float surface(const std::vector<Ripple>& waves, glm::vec2 at) {
    float sum = 0.0F;
    for (const Ripple& wave : waves) {
        const float s = 0.5F + 0.5F * std::sin(kTurn * glm::dot(wave.crests, at) + wave.phase);
        sum += wave.amplitude * std::pow(s, 1.8F);
    }
    return sum;
}

glm::vec2 slope(const std::vector<Ripple>& waves, glm::vec2 at, float loop) {
    glm::vec2 sum(0.0F);
    for (const Ripple& wave : waves) {
        const float angle = kTurn * (glm::dot(wave.crests, at) - wave.cycles * loop) + wave.phase;
        sum += wave.amplitude * std::cos(angle) * wave.crests;
    }
    return sum;
}

/// Light that a moving surface bends onto the ground: rays are followed down and counted where they land.
Heights caustics(float loop) {
    constexpr int kSide = 128;
    constexpr int kRays = 6; // to a pixel's side
    const std::vector<Ripple> waves = ripples(14, 1.2F, 5.0F, 5);
    Heights light(kSide);
    for (int y = 0; y < kSide * kRays; ++y) {
        for (int x = 0; x < kSide * kRays; ++x) {
            const glm::vec2 from = (glm::vec2(x, y) + 0.5F) / static_cast<float>(kSide * kRays);
            const glm::vec2 to = (from - 0.034F * slope(waves, from, loop)) * static_cast<float>(kSide) - 0.5F;
            const glm::vec2 low = glm::floor(to);
            const glm::vec2 f = to - low;
            const int column = static_cast<int>(low.x);
            const int row = static_cast<int>(low.y);
            light.at(column, row) += (1.0F - f.x) * (1.0F - f.y);
            light.at(column + 1, row) += f.x * (1.0F - f.y);
            light.at(column, row + 1) += (1.0F - f.x) * f.y;
            light.at(column + 1, row + 1) += f.x * f.y;
        }
    }
    for (float& value : light.values()) value /= kRays * kRays;
    return blurred(light, 1);
}

/// Sixteen moments of a loop, four to a row.
Image causticsSheet() {
    constexpr int kFrame = 128;
    std::vector<Heights> frames;
    for (int i = 0; i < 16; ++i) frames.push_back(caustics(static_cast<float>(i) / 16.0F));
    return painted([&](int x, int y) {
        const float light = frames[static_cast<std::size_t>(y / kFrame * 4 + x / kFrame)].at(x % kFrame, y % kFrame);
        const float bright = 1.0F - std::exp(-0.55F * light);
        return glm::mix(glm::vec3(0.10F, 0.42F, 0.52F), glm::vec3(0.95F, 1.0F, 0.98F), std::pow(bright, 1.25F) * 1.15F);
    });
}

} // namespace

std::vector<NamedPicture> waterPictures() {
    const std::vector<Ripple> waves = ripples(60, 3.0F, 24.0F, 2);
    Heights heights = drawn([&](glm::vec2 at) { return surface(waves, at); });
    normalize(heights);
    return {{"water_normal", normalsOf(heights, 0.075F)}, {"caustics", causticsSheet()}};
}

} // namespace lumorph

#include "resources/materials/generator/tiling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph {
namespace {

std::uint32_t mixed(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
    std::uint32_t h = x * 0x8DA6B343U ^ y * 0xD8163841U ^ seed * 0xCB1AB31FU;
    h = (h ^ (h >> 15U)) * 0x2C1B3C6DU;
    h = (h ^ (h >> 12U)) * 0x297A2D39U;
    return h ^ (h >> 15U);
}

int wrapped(int i, int count) { return ((i % count) + count) % count; }

float slopeAt(int x, int y, glm::ivec2 cells, std::uint32_t seed, glm::vec2 offset) {
    const auto wx = static_cast<std::uint32_t>(wrapped(x, cells.x));
    const auto wy = static_cast<std::uint32_t>(wrapped(y, cells.y));
    const float angle = 2.0F * std::numbers::pi_v<float> * hashed(wx, wy, seed);
    return std::cos(angle) * offset.x + std::sin(angle) * offset.y;
}

std::uint8_t byteOf(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

} // namespace

float hashed(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
    return static_cast<float>(mixed(x, y, seed) >> 8U) / 16777216.0F;
}

float noise(glm::vec2 at, glm::ivec2 cells, std::uint32_t seed) {
    const glm::vec2 p = at * glm::vec2(cells);
    const glm::vec2 low = glm::floor(p);
    const glm::vec2 f = p - low;
    const glm::vec2 s = f * f * f * (f * (f * 6.0F - 15.0F) + 10.0F);
    const int x = static_cast<int>(low.x);
    const int y = static_cast<int>(low.y);
    const float a = slopeAt(x, y, cells, seed, f);
    const float b = slopeAt(x + 1, y, cells, seed, f - glm::vec2(1.0F, 0.0F));
    const float c = slopeAt(x, y + 1, cells, seed, f - glm::vec2(0.0F, 1.0F));
    const float d = slopeAt(x + 1, y + 1, cells, seed, f - glm::vec2(1.0F, 1.0F));
    return 1.5F * glm::mix(glm::mix(a, b, s.x), glm::mix(c, d, s.x), s.y);
}

float cloudy(glm::vec2 at, glm::ivec2 cells, int octaves, std::uint32_t seed, float gain) {
    float sum = 0.0F;
    float weight = 1.0F;
    float weights = 0.0F;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * noise(at, cells, seed + static_cast<std::uint32_t>(i) * 101U);
        weights += weight;
        weight *= gain;
        cells *= 2;
    }
    return sum / weights;
}

void forPointsAround(glm::vec2 at, int cells, std::uint32_t seed, float jitter,
                     const std::function<void(std::uint32_t, glm::vec2)>& see) {
    const glm::vec2 p = at * static_cast<float>(cells);
    const int x = static_cast<int>(std::floor(p.x));
    const int y = static_cast<int>(std::floor(p.y));
    for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
            const auto cx = static_cast<std::uint32_t>(wrapped(x + dx, cells));
            const auto cy = static_cast<std::uint32_t>(wrapped(y + dy, cells));
            const glm::vec2 shift(hashed(cx, cy, seed) - 0.5F, hashed(cx, cy, seed + 77U) - 0.5F);
            see(cy * static_cast<std::uint32_t>(cells) + cx, p - (glm::vec2(x + dx, y + dy) + 0.5F + jitter * shift));
        }
    }
}

Scatter scattered(glm::vec2 at, int cells, std::uint32_t seed, float jitter) {
    Scatter found{9.0F, 9.0F, 0, {}};
    forPointsAround(at, cells, seed, jitter, [&found](std::uint32_t id, glm::vec2 offset) {
        const float distance = glm::length(offset);
        if (distance < found.nearest)
            found = {distance, found.nearest, id, offset};
        else if (distance < found.second)
            found.second = distance;
    });
    return found;
}

Heights drawn(const std::function<float(glm::vec2)>& value) {
    Heights heights;
    for (int y = 0; y < heights.side(); ++y)
        for (int x = 0; x < heights.side(); ++x)
            heights.at(x, y) = value((glm::vec2(x, y) + 0.5F) / static_cast<float>(heights.side()));
    return heights;
}

void normalize(Heights& heights) {
    const auto [low, high] = std::ranges::minmax(heights.values());
    for (float& value : heights.values()) value = (value - low) / std::max(high - low, 1e-9F);
}

Heights blurred(const Heights& heights, int passes) {
    Heights now = heights;
    for (int pass = 0; pass < passes; ++pass) {
        Heights next(now.side());
        for (int y = 0; y < now.side(); ++y)
            for (int x = 0; x < now.side(); ++x)
                next.at(x, y) = 0.25F * now.at(x, y) +
                                0.125F * (now.at(x - 1, y) + now.at(x + 1, y) + now.at(x, y - 1) + now.at(x, y + 1)) +
                                0.0625F * (now.at(x - 1, y - 1) + now.at(x + 1, y - 1) + now.at(x - 1, y + 1) +
                                           now.at(x + 1, y + 1));
        now = std::move(next);
    }
    return now;
}

Image painted(const std::function<glm::vec3(int, int)>& color, int side) {
    Image image({side, side});
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const glm::vec3 c = color(x, y);
            image.at(x, y) = {byteOf(c.r), byteOf(c.g), byteOf(c.b), 255};
        }
    }
    return image;
}

Image normalsOf(const Heights& heights, float strength) {
    const float scale = 0.5F * strength * static_cast<float>(heights.side());
    return painted(
        [&](int x, int y) {
            const float right = scale * (heights.at(x + 1, y) - heights.at(x - 1, y));
            const float down = scale * (heights.at(x, y + 1) - heights.at(x, y - 1));
            const glm::vec3 normal = 0.5F + 0.5F * glm::normalize(glm::vec3(-right, down, 1.0F));
            // Even numbers only: no eye sees it, and the file is a quarter smaller.
            return glm::round(normal * 127.0F) * 2.0F / 255.0F;
        },
        heights.side());
}

float smooth(float from, float to, float value) {
    const float t = std::clamp((value - from) / (to - from), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
}

} // namespace lumorph

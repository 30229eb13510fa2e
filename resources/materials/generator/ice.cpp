#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "resources/materials/generator/textures.h"
#include "resources/materials/generator/tiling.h"

namespace lumorph {
namespace {

glm::vec2 warped(glm::vec2 at, float by) {
    return at + by * glm::vec2(cloudy(at, {6, 6}, 3, 31), cloudy(at, {6, 6}, 3, 37));
}

/// Thin where cells of a scatter meet, broken up so that cracks begin and end.
float crack(glm::vec2 at, int cells, std::uint32_t seed, float width, float cover) {
    const Scatter cell = scattered(warped(at, 0.05F), cells, seed, 0.95F);
    const float line = 1.0F - smooth(0.0F, width, cell.second - cell.nearest);
    return line * smooth(-cover, 0.25F - cover, noise(at, {5, 5}, seed + 9));
}

float cracks(glm::vec2 at) {
    const float large = crack(at, 4, 51, 0.030F, 0.45F);
    const float fine = 0.55F * crack(at, 11, 61, 0.045F, -0.05F);
    return std::min(1.0F, large + fine);
}

/// The frosted fans beside the large cracks: planes inside the ice that catch the light.
float veils(glm::vec2 at) {
    const Scatter cell = scattered(warped(at, 0.05F), 4, 51, 0.95F);
    const float near = 1.0F - smooth(0.0F, 0.28F, cell.second - cell.nearest);
    return near * near * smooth(-0.1F, 0.6F, cloudy(at, {7, 7}, 4, 71));
}

/// x: how much of a bubble is there, y: its bright upper rim.
glm::vec2 bubbles(glm::vec2 at) {
    glm::vec2 sum(0.0F);
    for (const auto& [cells, seed, share, size] :
         {std::tuple{14, 81U, 0.30F, 0.22F}, {30, 87U, 0.28F, 0.27F}, {52, 93U, 0.22F, 0.30F}}) {
        const Scatter cell = scattered(at, cells, seed, 0.5F);
        if (hashed(cell.id, 1, seed) > share) continue;
        const float radius = size * (0.4F + 0.6F * hashed(cell.id, 2, seed));
        const float inside = 1.0F - smooth(radius * 0.85F, radius, cell.nearest);
        const float rim = inside * smooth(radius * 0.45F, radius * 0.95F, cell.nearest);
        sum += glm::vec2(inside * 0.5F, rim * (0.55F - 0.45F * cell.offset.y / radius));
    }
    return glm::min(sum, glm::vec2(1.0F));
}

glm::vec3 iceColor(glm::vec2 at) {
    const float depth = 0.5F + 0.5F * cloudy(warped(at, 0.06F), {3, 3}, 5, 21);
    glm::vec3 color =
        glm::mix(glm::vec3(0.36F, 0.60F, 0.74F), glm::vec3(0.74F, 0.88F, 0.94F), smooth(0.22F, 0.82F, depth));
    color = glm::mix(color, glm::vec3(0.90F, 0.96F, 0.98F), 0.5F * veils(at));
    const glm::vec2 bubble = bubbles(at);
    color = glm::mix(color, glm::vec3(0.55F, 0.75F, 0.85F), 0.35F * bubble.x);
    color = glm::mix(color, glm::vec3(0.97F, 0.99F, 1.0F), 0.8F * bubble.y);
    return glm::mix(color, glm::vec3(0.97F, 0.99F, 1.0F), 0.85F * cracks(at));
}

float iceHeight(glm::vec2 at) { return 0.5F * cloudy(at, {5, 5}, 4, 23) - 0.35F * cracks(at) + 0.10F * bubbles(at).x; }

/// What melts first is dark: round holes that grow, then the joints between floes.
float meltOrder(glm::vec2 at) {
    const glm::vec2 rough = warped(at, 0.03F);
    float order = 1.0F;
    for (const auto& [cells, seed] : {std::pair{5, 15U}, {9, 25U}}) {
        forPointsAround(rough, cells, seed, 0.8F,
                        [&order, cells = cells, seed = seed](std::uint32_t id, glm::vec2 way) {
                            const float start = 0.06F + 0.85F * hashed(id, 7, seed);
                            order = std::min(order, start + (cells < 9 ? 1.1F : 0.7F) * glm::length(way));
                        });
    }
    const Scatter floe = scattered(warped(at, 0.045F), 4, 51, 0.95F);
    return std::min(order, 0.48F + 1.1F * (floe.second - floe.nearest));
}

} // namespace

std::vector<NamedPicture> icePictures() {
    const auto middle = [](int x, int y) { return (glm::vec2(x, y) + 0.5F) / 512.0F; };
    Heights order = drawn(meltOrder);
    order = blurred(order, 2);
    normalize(order);
    return {{"ice", painted([&](int x, int y) { return iceColor(middle(x, y)); })},
            {"ice_normal", normalsOf(blurred(drawn(iceHeight), 1), 0.012F)},
            {"ice_holes", painted([&](int x, int y) { return glm::vec3(order.at(x, y)); })}};
}

} // namespace lumorph

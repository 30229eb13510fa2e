#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "resources/materials/generator/textures.h"
#include "resources/materials/generator/tiling.h"

namespace lumorph {
namespace {

glm::vec2 middle(int x, int y) { return (glm::vec2(x, y) + 0.5F) / static_cast<float>(kTextureSide); }

/// Fibres that lie in all directions.
float paperHeight(glm::vec2 at) {
    return 0.4F * cloudy(at, {24, 24}, 3, 5) + 0.3F * noise(at, {70, 18}, 6) + 0.3F * noise(at, {18, 70}, 7);
}

glm::vec3 paperColor(glm::vec2 at) { return glm::vec3(0.965F, 0.955F, 0.93F) * (1.0F + 0.012F * paperHeight(at)); }

/// Cobbles with sandy joints.
float stoneDome(const Scatter& cell) { return smooth(0.03F, 0.34F, cell.second - cell.nearest); }

Scatter cobble(glm::vec2 at) {
    return scattered(at + 0.012F * glm::vec2(noise(at, {14, 14}, 3), noise(at, {14, 14}, 4)), 9, 41, 0.75F);
}

float stoneHeight(glm::vec2 at) { return stoneDome(cobble(at)) + 0.05F * cloudy(at, {32, 32}, 3, 8); }

glm::vec3 stoneColor(glm::vec2 at) {
    const Scatter cell = cobble(at);
    const float tone = hashed(cell.id, 1, 1);
    glm::vec3 stone = glm::mix(glm::vec3(0.47F, 0.47F, 0.48F), glm::vec3(0.66F, 0.62F, 0.57F), tone);
    if (hashed(cell.id, 2, 1) > 0.8F) stone = glm::vec3(0.50F, 0.43F, 0.40F);
    stone *= 1.0F + 0.12F * cloudy(at, {28, 28}, 3, 9);
    const glm::vec3 joint = glm::vec3(0.34F, 0.31F, 0.27F) * (1.0F + 0.12F * noise(at, {80, 80}, 10));
    return glm::mix(joint, stone, smooth(0.02F, 0.12F, cell.second - cell.nearest));
}

float metalHeight(glm::vec2 at) { return 0.6F * noise(at, {3, 200}, 3) + 0.4F * noise(at, {7, 128}, 4); }

glm::vec3 metalColor(glm::vec2 at) {
    return glm::vec3(0.76F, 0.77F, 0.78F) * (1.0F + 0.05F * metalHeight(at) + 0.03F * cloudy(at, {3, 3}, 3, 5));
}

} // namespace

std::vector<NamedPicture> plainPictures() {
    const auto color = [](glm::vec3 (*paint)(glm::vec2)) {
        return painted([paint](int x, int y) { return paint(middle(x, y)); });
    };
    return {{"paper", color(paperColor)}, {"paper_normal", normalsOf(drawn(paperHeight), 0.0012F)},
            {"stone", color(stoneColor)}, {"stone_normal", normalsOf(blurred(drawn(stoneHeight), 1), 0.012F)},
            {"metal", color(metalColor)}, {"metal_normal", normalsOf(drawn(metalHeight), 0.0006F)}};
}

} // namespace lumorph

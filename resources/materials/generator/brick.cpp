#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "resources/materials/generator/textures.h"
#include "resources/materials/generator/tiling.h"

namespace lumorph {
namespace {

constexpr int kCourses = 8;
constexpr int kAlong = 4;
constexpr float kMortar = 0.0085F; ///< half a joint, in widths of the picture

struct Place {
    std::uint32_t brick = 0;
    float depth = 0.0F; ///< from the brick's edge inwards, in widths of the picture; negative in a joint
    glm::vec2 inside{0.0F};
};

Place placeOf(glm::vec2 at) {
    // Edges are a little worn.
    at += 0.0016F * glm::vec2(noise(at, {40, 40}, 3), noise(at, {40, 40}, 4));
    at -= glm::floor(at);
    const float row = at.y * kCourses;
    const int course = static_cast<int>(row);
    const float column = at.x * kAlong + (course % 2 == 0 ? 0.0F : 0.5F);
    const int brick = static_cast<int>(column) % kAlong;
    Place place;
    place.brick = static_cast<std::uint32_t>(course * kAlong + brick);
    place.inside = {column - std::floor(column), row - static_cast<float>(course)};
    const glm::vec2 edge = glm::min(place.inside, 1.0F - place.inside) / glm::vec2(kAlong, kCourses) - kMortar;
    place.depth = std::min(edge.x, edge.y);
    return place;
}

glm::vec3 brickColor(glm::vec2 at) {
    const Place place = placeOf(at);
    const float grain = cloudy(at, {48, 48}, 3, 8);
    const glm::vec3 joint = glm::vec3(0.69F, 0.66F, 0.61F) * (1.0F + 0.10F * grain);
    const float kind = hashed(place.brick, 1, 2);
    glm::vec3 color = glm::mix(glm::vec3(0.62F, 0.25F, 0.18F), glm::vec3(0.75F, 0.38F, 0.25F), kind);
    if (hashed(place.brick, 5, 9) > 0.84F) color = glm::vec3(0.44F, 0.20F, 0.17F); // burnt darker
    color *= 0.9F + 0.2F * hashed(place.brick, 2, 3);
    color *= 1.0F + 0.13F * grain + 0.10F * cloudy(at, {12, 12}, 2, 9);
    const float speck = noise(at, {110, 110}, 12);
    color = glm::mix(color, glm::vec3(0.30F, 0.15F, 0.12F), 0.6F * smooth(0.55F, 0.7F, speck));
    color *= glm::mix(0.82F, 1.0F, smooth(0.0F, 0.006F, place.depth));
    return glm::mix(joint * glm::mix(1.0F, 0.72F, smooth(-kMortar, 0.0F, place.depth)), color,
                    smooth(-0.0010F, 0.0010F, place.depth));
}

float brickHeight(glm::vec2 at) {
    const Place place = placeOf(at);
    const float tilt = (hashed(place.brick, 3, 4) - 0.5F) * (place.inside.x - 0.5F) +
                       (hashed(place.brick, 4, 5) - 0.5F) * (place.inside.y - 0.5F);
    const float grain = cloudy(at, {40, 40}, 3, 8);
    const float face = 1.0F + 0.10F * tilt + 0.06F * grain;
    return glm::mix(0.08F * grain, face, smooth(-0.0015F, 0.0045F, place.depth));
}

} // namespace

std::vector<NamedPicture> brickPictures() {
    const auto color = painted([](int x, int y) { return brickColor((glm::vec2(x, y) + 0.5F) / 512.0F); });
    return {{"brick", color}, {"brick_normal", normalsOf(drawn(brickHeight), 0.010F)}};
}

} // namespace lumorph

#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "resources/materials/generator/textures.h"
#include "resources/materials/generator/tiling.h"

namespace lumorph {
namespace {

constexpr int kBoards = 4;
constexpr float kGap = 0.006F; ///< between boards, in widths of the picture

/// A place on a board.
struct Place {
    int board = 0;
    float along = 0.0F;  ///< in [0, 1) from end to end
    float across = 0.0F; ///< in [0, 1) over the board
    float edge = 0.0F;   ///< distance to the next edge, in widths of the picture
};

Place placeOf(glm::vec2 at) {
    Place place;
    const float row = at.y * kBoards;
    place.board = static_cast<int>(row);
    place.across = row - static_cast<float>(place.board);
    const float end = hashed(static_cast<std::uint32_t>(place.board), 3, 11);
    place.along = at.x - end + (at.x < end ? 1.0F : 0.0F);
    place.edge =
        std::min(std::min(place.across, 1.0F - place.across) / kBoards, std::min(place.along, 1.0F - place.along));
    return place;
}

/// How far growth rings lie from the heart of the tree, bent by a knot and by slow warps.
float ringsOf(const Place& place) {
    const auto board = static_cast<std::uint32_t>(place.board);
    const glm::vec2 at(place.along, (place.across + static_cast<float>(place.board) * 3.7F) / 16.0F);
    const float warp = 0.10F * cloudy(at, {3, 8}, 3, 40 + board);
    const float heart = 0.5F + 0.9F * (hashed(board, 1, 5) - 0.5F);
    float distance = std::abs(place.across - heart + warp);
    // Knots push the grain aside.
    const glm::vec2 knot(0.2F + 0.6F * hashed(board, 2, 6), 0.25F + 0.5F * hashed(board, 4, 7));
    const glm::vec2 away((place.along - knot.x) * kBoards, place.across - knot.y);
    if (board % 2 == 1) {
        const float near = glm::length(away * glm::vec2(0.75F, 1.35F));
        distance = glm::mix(1.35F * near, distance + 0.18F * std::exp(-9.0F * near), smooth(0.06F, 0.42F, near));
    }
    return distance;
}

float knotShade(const Place& place) {
    const auto board = static_cast<std::uint32_t>(place.board);
    if (board % 2 == 0) return 0.0F;
    const glm::vec2 knot(0.2F + 0.6F * hashed(board, 2, 6), 0.25F + 0.5F * hashed(board, 4, 7));
    const glm::vec2 away((place.along - knot.x) * kBoards, place.across - knot.y);
    return 1.0F - smooth(0.03F, 0.16F, glm::length(away * glm::vec2(0.8F, 1.3F)));
}

/// Late wood: each ring darkens slowly and ends at once.
float lateWood(float rings) {
    const float phase = rings * 13.0F;
    const float ring = phase - std::floor(phase);
    return smooth(0.15F, 0.9F, ring) * (1.0F - smooth(0.93F, 1.0F, ring));
}

float pores(const Place& place) {
    const auto board = static_cast<std::uint32_t>(place.board);
    const float streaks =
        noise({place.along, (place.across + static_cast<float>(board)) / kBoards}, {22, 190}, 90 + board);
    return smooth(0.28F, 0.75F, streaks);
}

float fibres(const Place& place) {
    const auto board = static_cast<std::uint32_t>(place.board);
    return cloudy({place.along, (place.across + static_cast<float>(board)) / kBoards}, {5, 96}, 2, 60 + board);
}

glm::vec3 woodColor(glm::vec2 at) {
    const Place place = placeOf(at);
    const auto board = static_cast<std::uint32_t>(place.board);
    const float late = lateWood(ringsOf(place));
    const float tone = hashed(board, 9, 21);
    const glm::vec3 light = glm::mix(glm::vec3(0.83F, 0.66F, 0.47F), glm::vec3(0.70F, 0.49F, 0.31F), tone);
    const glm::vec3 dark = glm::mix(glm::vec3(0.62F, 0.42F, 0.25F), glm::vec3(0.53F, 0.34F, 0.19F), tone);
    glm::vec3 color = glm::mix(light, dark, 0.85F * late);
    color *= 1.0F + 0.07F * fibres(place);
    color *= 1.0F - 0.20F * pores(place);
    color = glm::mix(color, glm::vec3(0.33F, 0.19F, 0.10F), 0.75F * knotShade(place));
    color *= 1.0F + 0.05F * cloudy(at, {3, 5}, 2, 17);
    return color * glm::mix(0.30F, 1.0F, smooth(0.15F * kGap, kGap, place.edge));
}

float woodHeight(glm::vec2 at) {
    const Place place = placeOf(at);
    const float grain = 0.35F * lateWood(ringsOf(place)) + 0.12F * fibres(place) - 0.4F * pores(place);
    return grain + 3.0F * smooth(0.0F, 1.6F * kGap, place.edge);
}

} // namespace

std::vector<NamedPicture> woodPictures() {
    const auto color = painted([](int x, int y) { return woodColor((glm::vec2(x, y) + 0.5F) / 512.0F); });
    return {{"wood", color}, {"wood_normal", normalsOf(drawn(woodHeight), 0.0011F)}};
}

} // namespace lumorph

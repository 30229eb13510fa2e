#include "app/applications/navigation/palette.h"

#include <array>

#include <glm/common.hpp>

#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/shapes.h"
#include "app/applications/navigation/solid.h"

namespace lumorph::navigation {
namespace {

constexpr int kCells = 8; ///< of the palette a side
constexpr int kCellPixels = 64;
constexpr int kShadesRow = 4; ///< of a cell, and in so many rows
constexpr int kFacades = 32;  ///< cells from here on: the paints once more, with windows
static_assert(kPaints <= kFacades && kShadesRow * kShadesRow == kShades);

/// A paint in its shades: each a little lighter or darker, warmer or colder.
glm::vec3 shaded(const glm::vec3& color, int x, int y) {
    constexpr int kPatch = kCellPixels / kShadesRow;
    const glm::ivec2 shade(x / kPatch, y / kPatch);
    const auto light = static_cast<float>(0.24 * (chanceOf(shade, 61) - 0.5));
    const auto warm = static_cast<float>(0.10 * (chanceOf(shade, 62) - 0.5));
    return color * (1.0F + light) * glm::vec3(1.0F + warm, 1.0F, 1.0F - warm);
}

/// Rows of dark windows in a wall that dirt and the shadow of the ground darken at its foot.
glm::vec3 facade(const glm::vec3& color, int x, int y) {
    constexpr int kBayPixels = kCellPixels / kBays, kStoreyPixels = kCellPixels / kStoreys;
    const int up = kCellPixels - 1 - y, storey = up / kStoreyPixels;
    const int across = x % kBayPixels, over = up % kStoreyPixels;
    const auto foot = static_cast<float>(smoothStep(-0.5 * kStoreyPixels, 0.8 * kStoreyPixels, up));
    const glm::vec3 wall = color * (0.55F + 0.45F * foot);
    if (storey + 1 >= kStoreys || over < 4 || over > 12 || across < 2 || across > 5) return wall;
    return {0.27F, 0.28F, 0.31F};
}

} // namespace

glm::vec2 facadePlace(Paint paint, float bays, float storeys) noexcept {
    constexpr float kRim = 0.5F / kCellPixels; // so that no other cell shines in
    const int k = kFacades + static_cast<int>(paint);
    const glm::vec2 share(bays / kBays, 1.0F - storeys / kStoreys);
    return (glm::vec2(k % kCells, k / kCells) + glm::clamp(share, kRim, 1.0F - kRim)) / static_cast<float>(kCells);
}

glm::vec3 colorOf(Paint paint) noexcept {
    constexpr std::array<glm::vec3, kPaints> kColors{
        {{0.97F, 0.96F, 0.93F}, {0.95F, 0.89F, 0.76F}, {0.88F, 0.79F, 0.62F}, {0.93F, 0.75F, 0.66F},
         {0.58F, 0.40F, 0.26F}, {0.66F, 0.64F, 0.60F}, {0.66F, 0.37F, 0.26F}, {0.56F, 0.29F, 0.22F},
         {0.53F, 0.32F, 0.24F}, {0.38F, 0.41F, 0.46F}, {0.88F, 0.62F, 0.30F}, {0.38F, 0.57F, 0.50F},
         {0.38F, 0.56F, 0.24F}, {0.50F, 0.62F, 0.26F}, {0.16F, 0.36F, 0.22F}, {0.22F, 0.42F, 0.24F},
         {0.08F, 0.32F, 0.46F}, {0.30F, 0.22F, 0.15F}, {0.66F, 0.48F, 0.32F}, {0.80F, 0.72F, 0.60F},
         {1.0F, 0.99F, 0.95F},  {0.60F, 0.60F, 0.60F}, {0.86F, 0.77F, 0.57F}, {0.80F, 0.79F, 0.76F},
         {0.76F, 0.77F, 0.67F}}};
    return kColors[static_cast<std::size_t>(paint)];
}

glm::vec2 paintPlace(Paint paint) noexcept {
    const int k = static_cast<int>(paint);
    return (glm::vec2(k % kCells, k / kCells) + 0.5F) / static_cast<float>(kCells);
}

glm::vec2 paintPlace(Paint paint, int shade) noexcept {
    const int k = static_cast<int>(paint), s = shade % kShades;
    const glm::vec2 inCell = (glm::vec2(s % kShadesRow, s / kShadesRow) + 0.5F) / static_cast<float>(kShadesRow);
    return (glm::vec2(k % kCells, k / kCells) + inCell) / static_cast<float>(kCells);
}

std::shared_ptr<const Image> paletteImage() {
    auto image = std::make_shared<Image>(glm::ivec2(kCells * kCellPixels));
    for (int k = 0; k < kPaints; ++k)
        for (const int cell : {k, kFacades + k})
            for (int y = 0; y < kCellPixels; ++y)
                for (int x = 0; x < kCellPixels; ++x) {
                    const glm::vec3 color = colorOf(static_cast<Paint>(k));
                    const glm::ivec3 shown(
                        255.0F * glm::clamp(cell < kFacades ? shaded(color, x, y) : facade(color, x, y), 0.0F, 1.0F) +
                        0.5F);
                    image->at(cell % kCells * kCellPixels + x, cell / kCells * kCellPixels + y) = {
                        static_cast<std::uint8_t>(shown.r), static_cast<std::uint8_t>(shown.g),
                        static_cast<std::uint8_t>(shown.b), 255};
                }
    return image;
}

} // namespace lumorph::navigation

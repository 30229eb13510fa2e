#include "app/output/picture_pair.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/render/figure/text.h"

namespace lumorph {
namespace {

constexpr float kEmShare = 0.036F;     ///< of the pictures' height
constexpr float kPlateOpacity = 0.66F; ///< letters are read on pictures of any brightness
const glm::vec3 kPlate(14.0F, 18.0F, 22.0F);

void copyTo(Image& whole, const Image& part, int left) {
    for (int y = 0; y < part.size().y; ++y)
        for (int x = 0; x < part.size().x; ++x) whole.at(left + x, y) = part.at(x, y);
}

/// Darkens a box with round ends; pixels.
void layPlate(Image& image, const glm::vec2& middle, const glm::vec2& half) {
    const float round = half.y;
    for (int y = static_cast<int>(middle.y - half.y) - 1; y <= static_cast<int>(middle.y + half.y) + 1; ++y)
        for (int x = static_cast<int>(middle.x - half.x) - 1; x <= static_cast<int>(middle.x + half.x) + 1; ++x) {
            if (x < 0 || y < 0 || x >= image.size().x || y >= image.size().y) continue;
            const glm::vec2 out = glm::max(glm::abs(glm::vec2(x, y) + 0.5F - middle) - (half - round), 0.0F);
            const float share = kPlateOpacity * glm::clamp(round - glm::length(out) + 0.5F, 0.0F, 1.0F);
            Image::Pixel& pixel = image.at(x, y);
            for (int c = 0; c < 3; ++c) {
                const auto k = static_cast<std::size_t>(c);
                pixel[k] =
                    static_cast<std::uint8_t>(std::lround(glm::mix(static_cast<float>(pixel[k]), kPlate[c], share)));
            }
        }
}

void writeCaption(Image& image, const Font& font, const std::string& text, float left, float width) {
    const auto height = static_cast<float>(image.size().y);
    const float em = std::max(9.0F, kEmShare * height);
    const std::string fitted = font.fitted(text, em, width - 3.0F * em);
    const float wide = font.width(fitted, em);
    const glm::vec2 middle(left + 0.5F * width, height - 1.7F * em);
    layPlate(image, middle, {0.5F * wide + em, 0.85F * em});
    font.write(image, fitted, {middle.x - 0.5F * wide, middle.y + 0.36F * em}, em, glm::vec3(1.0F));
}

} // namespace

Image besideEachOther(const Image& left, const Image& right, const std::array<Words, 2>& captions, Language language) {
    if (left.size().y != right.size().y)
        throw InvalidInput("pictures", "they are not of the same height", "draw both with the same size");
    Image whole({left.size().x + right.size().x, left.size().y});
    copyTo(whole, left, 0);
    copyTo(whole, right, left.size().x);
    for (int y = 0; y < whole.size().y; ++y)
        for (int x = left.size().x - 1; x <= left.size().x; ++x) whole.at(x, y) = {255, 255, 255, 255};
    const Font font(resourceFile("fonts/Inter-SemiBold.otf"));
    writeCaption(whole, font, captions[0].in(language), 0.0F, static_cast<float>(left.size().x));
    writeCaption(whole, font, captions[1].in(language), static_cast<float>(left.size().x),
                 static_cast<float>(right.size().x));
    return whole;
}

glm::ivec2 inlaySize(glm::ivec2 picture) {
    const int wide = std::max(16, static_cast<int>(std::lround(0.2 * picture.x)));
    return {wide, wide * 5 / 8};
}

void putInlay(Image& picture, const Image& inlay) {
    const int margin = std::max(1, picture.size().x / 60), line = std::max(1, picture.size().x / 640);
    const glm::ivec2 size = inlay.size(), low(picture.size().x - size.x - margin, margin);
    if (low.x < 0 || low.y + size.y > picture.size().y) return;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const bool rim = std::min({x, y, size.x - 1 - x, size.y - 1 - y}) < line;
            picture.at(low.x + x, low.y + y) = rim ? Image::Pixel{150, 152, 156, 255} : inlay.at(x, y);
        }
}

} // namespace lumorph

#include "core/render/figure/text.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>

#include "core/base/error.h"
#include "core/base/file.h"

namespace lumorph {
namespace {

// The code points of UTF-8 text; a broken sequence becomes U+FFFD.
std::vector<int> codePoints(std::string_view text) {
    std::vector<int> points;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i++]);
        const int more = lead < 0x80 ? 0 : lead >> 5 == 6 ? 1 : lead >> 4 == 14 ? 2 : lead >> 3 == 30 ? 3 : -1;
        int point = more < 0 ? 0xFFFD : more == 0 ? lead : lead & (0x3F >> more);
        for (int k = 0; k < more; ++k) {
            if (i >= text.size() || (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) {
                point = 0xFFFD;
                break;
            }
            point = point << 6 | (static_cast<unsigned char>(text[i++]) & 0x3F);
        }
        points.push_back(point);
    }
    return points;
}

void blend(Image::Pixel& pixel, const glm::vec3& color, float share) {
    for (int c = 0; c < 3; ++c) {
        auto& channel = pixel[static_cast<std::size_t>(c)];
        const float value = static_cast<float>(channel);
        channel = static_cast<std::uint8_t>(std::lround(value + (255.0F * color[c] - value) * share));
    }
}

} // namespace

struct Font::Data {
    std::vector<std::byte> bytes;
    stbtt_fontinfo info{};

    // Calls back with every glyph and its pen position along the line; returns the line's width.
    template <class Glyph> float layOut(std::string_view text, float pixels, Glyph&& glyph) const {
        const float scale = stbtt_ScaleForMappingEmToPixels(&info, pixels);
        float pen = 0.0F;
        int before = 0;
        for (const int point : codePoints(text)) {
            if (before != 0) pen += scale * static_cast<float>(stbtt_GetCodepointKernAdvance(&info, before, point));
            glyph(point, pen, scale);
            int advance = 0;
            stbtt_GetCodepointHMetrics(&info, point, &advance, nullptr);
            pen += scale * static_cast<float>(advance);
            before = point;
        }
        return pen;
    }
};

Font::Font(const std::filesystem::path& file) : data_(std::make_unique<Data>()) {
    data_->bytes = readFile(file, std::size_t{64} << 20);
    const auto* bytes = reinterpret_cast<const unsigned char*>(data_->bytes.data());
    const int offset = data_->bytes.size() < 12 ? -1 : stbtt_GetFontOffsetForIndex(bytes, 0);
    if (offset < 0 || !stbtt_InitFont(&data_->info, bytes, offset))
        throw DataError(file.string(), "not a TrueType or OpenType font", "install Lumorph again");
}

Font::~Font() = default;
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;

float Font::width(std::string_view text, float pixels) const {
    return data_->layOut(text, pixels, [](int, float, float) {});
}

void Font::write(Image& image, std::string_view text, glm::vec2 origin, float pixels, const glm::vec3& color,
                 float opacity) const {
    const int baseline = static_cast<int>(std::lround(origin.y));
    data_->layOut(text, pixels, [&](int point, float pen, float scale) {
        const float left = std::floor(origin.x + pen);
        int width = 0;
        int height = 0;
        int x0 = 0;
        int y0 = 0;
        const std::unique_ptr<unsigned char, void (*)(void*)> coverage(
            stbtt_GetCodepointBitmapSubpixel(&data_->info, scale, scale, origin.x + pen - left, 0.0F, point, &width,
                                             &height, &x0, &y0),
            [](void* bitmap) { stbtt_FreeBitmap(static_cast<unsigned char*>(bitmap), nullptr); });
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const glm::ivec2 at(static_cast<int>(left) + x0 + x, baseline + y0 + y);
                if (at.x < 0 || at.y < 0 || at.x >= image.size().x || at.y >= image.size().y) continue;
                blend(image.at(at.x, at.y), color,
                      opacity * static_cast<float>(coverage.get()[y * width + x]) / 255.0F);
            }
    });
}

std::string Font::fitted(std::string_view text, float pixels, float limit) const {
    if (width(text, pixels) <= limit) return std::string(text);
    std::string shorter(text);
    while (!shorter.empty()) {
        // Cut a whole code point: its continuation bytes, then its lead.
        while (!shorter.empty() && (static_cast<unsigned char>(shorter.back()) & 0xC0) == 0x80) shorter.pop_back();
        if (!shorter.empty()) shorter.pop_back();
        if (width(shorter + "…", pixels) <= limit) break;
    }
    return shorter + "…";
}

} // namespace lumorph

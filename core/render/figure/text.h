#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/image.h"

namespace lumorph {

/// A typeface that writes into images; no GL. UTF-8; left to right, with kerning.
class Font {
public:
    /// Throws DataError when the file is no TrueType or OpenType font.
    explicit Font(const std::filesystem::path& file);
    ~Font();
    Font(Font&&) noexcept;
    Font& operator=(Font&&) noexcept;

    /// Width in pixels of one line at an em of `pixels`.
    [[nodiscard]] float width(std::string_view text, float pixels) const;

    /// Writes one line, its baseline beginning at `origin` (pixels from the top left corner), in an
    /// sRGB colour of 0 to 1; what lies outside the image is cut off.
    void write(Image& image, std::string_view text, glm::vec2 origin, float pixels, const glm::vec3& color,
               float opacity = 1.0F) const;

    /// `text` if it fits into `limit` pixels, else as much of it as fits with an ellipsis.
    [[nodiscard]] std::string fitted(std::string_view text, float pixels, float limit) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph

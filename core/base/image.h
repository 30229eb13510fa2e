#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

namespace lumorph {

/// Largest width and height of an image, in pixels.
inline constexpr int kMaxImageSide = 16'384;

/// A picture of 8-bit sRGB red, green, blue and linear alpha; row 0 is the top.
class Image {
public:
    using Pixel = std::array<std::uint8_t, 4>;

    Image() = default;
    /// Throws InvalidInput unless both sides are in [1, kMaxImageSide].
    explicit Image(glm::ivec2 size, Pixel fill = {0, 0, 0, 255});

    [[nodiscard]] glm::ivec2 size() const noexcept { return size_; }
    [[nodiscard]] Pixel& at(int x, int y) noexcept { return pixels_[index(x, y)]; }
    [[nodiscard]] const Pixel& at(int x, int y) const noexcept { return pixels_[index(x, y)]; }
    [[nodiscard]] std::vector<Pixel>& pixels() noexcept { return pixels_; }
    [[nodiscard]] const std::vector<Pixel>& pixels() const noexcept { return pixels_; }
    bool operator==(const Image&) const = default;

private:
    [[nodiscard]] std::size_t index(int x, int y) const noexcept {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
    }

    glm::ivec2 size_{0};
    std::vector<Pixel> pixels_;
};

/// Half its size, at least one pixel: each is the mean of four.
[[nodiscard]] Image halved(const Image& image);

/// The image as a PNG file. Written beside the target and renamed, so that a failure leaves no half
/// file. Throws InvalidInput for an empty image, DeviceError when the disk refuses.
void writePng(const Image& image, const std::filesystem::path& file);
/// What writePng writes; `name` is what errors call it.
[[nodiscard]] std::vector<std::byte> pngBytes(const Image& image, const std::string& name);

/// Most pixels of a picture that is decoded: 8192 x 8192.
inline constexpr std::int64_t kMaxDecodedPixels = std::int64_t{1} << 26;

/// A PNG or JPEG held in memory; missing alpha becomes 255. `name` stands in errors. Its size is looked at before
/// anything is unpacked. Throws DataError when it is neither, is broken, or has more than kMaxDecodedPixels.
[[nodiscard]] Image decodeImage(std::span<const std::byte> bytes, const std::string& name);

/// Reads a PNG of 8 bits a channel or more; missing alpha becomes 255. Throws DataError when the file
/// is missing, broken or larger than kMaxImageSide.
[[nodiscard]] Image readPng(const std::filesystem::path& file);

} // namespace lumorph

#include "core/base/image.h"

#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include <zlib.h>

// Packs the rows of a PNG file: zlib at its fastest level takes half the time of stb's own packing, and the file is a
// third smaller. The caller frees what is returned.
static unsigned char* packRows(unsigned char* rows, int length, int* packedLength, int /*quality*/) {
    uLongf size = compressBound(static_cast<uLong>(length));
    auto* packed = static_cast<unsigned char*>(std::malloc(size));
    if (packed == nullptr) return nullptr;
    if (compress2(packed, &size, rows, static_cast<uLong>(length), Z_BEST_SPEED) != Z_OK) {
        std::free(packed);
        return nullptr;
    }
    *packedLength = static_cast<int>(size);
    return packed;
}

// Private to this file, so that another reader of pictures may bring its own copy.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBIW_ZLIB_COMPRESS packRows
#include <stb/stb_image_write.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"

namespace lumorph {
namespace {

void appendBytes(void* bytes, void* data, int size) {
    const auto* begin = static_cast<const std::byte*>(data);
    auto& all = *static_cast<std::vector<std::byte>*>(bytes);
    all.insert(all.end(), begin, begin + size);
}

} // namespace

Image::Image(glm::ivec2 size, Pixel fill) : size_(size) {
    if (size.x < 1 || size.y < 1 || size.x > kMaxImageSide || size.y > kMaxImageSide)
        throw InvalidInput("image size " + std::to_string(size.x) + "x" + std::to_string(size.y),
                           "an image cannot have this size",
                           "use 1 to " + std::to_string(kMaxImageSide) + " pixels a side");
    pixels_.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), fill);
}

Image halved(const Image& image) {
    Image half(glm::max(image.size() / 2, glm::ivec2(1)));
    for (int y = 0; y < half.size().y; ++y)
        for (int x = 0; x < half.size().x; ++x)
            for (std::size_t c = 0; c < 4; ++c) {
                const int right = std::min(2 * x + 1, image.size().x - 1);
                const int below = std::min(2 * y + 1, image.size().y - 1);
                half.at(x, y)[c] =
                    static_cast<std::uint8_t>((image.at(2 * x, 2 * y)[c] + image.at(right, 2 * y)[c] +
                                               image.at(2 * x, below)[c] + image.at(right, below)[c] + 2) /
                                              4);
            }
    return half;
}

std::vector<std::byte> pngBytes(const Image& image, const std::string& name) {
    if (image.pixels().empty()) throw InvalidInput(name, "the image is empty", "draw something first");
    std::vector<std::byte> bytes;
    const auto [width, height] = std::pair(image.size().x, image.size().y);
    if (!stbi_write_png_to_func(appendBytes, &bytes, width, height, 4, image.pixels().data(), width * 4))
        throw DeviceError(name, "the image cannot be packed", "free some memory");
    return bytes;
}

void writePng(const Image& image, const std::filesystem::path& file) {
    writeFileAtomically(file, pngBytes(image, file.string()));
}

Image decodeImage(std::span<const std::byte> bytes, const std::string& name) {
    const auto fail = [&name](const std::string& why) {
        throw DataError(name, why, "save it again as PNG or JPEG, or choose another picture");
    };
    constexpr std::size_t kMaxBytes = std::size_t{1} << 30; // stb counts in int
    if (bytes.empty()) fail("is empty");
    if (bytes.size() > kMaxBytes) fail("is larger than 1 GiB");
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const auto length = static_cast<int>(bytes.size());
    int width = 0;
    int height = 0;
    if (!stbi_info_from_memory(data, length, &width, &height, nullptr))
        fail(std::string("is no PNG or JPEG that can be read (") + stbi_failure_reason() + ")");
    if (width < 1 || height < 1 || std::int64_t{width} * height > kMaxDecodedPixels)
        fail("has " + std::to_string(width) + " x " + std::to_string(height) + " pixels, too many to unpack");
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, length, &width, &height, nullptr, 4), stbi_image_free);
    if (!pixels) fail(std::string("is broken (") + stbi_failure_reason() + ")");
    Image image({width, height});
    std::memcpy(image.pixels().data(), pixels.get(), image.pixels().size() * sizeof(Image::Pixel));
    return image;
}

Image readPng(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, std::size_t{1} << 30);
    int width = 0;
    int height = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> data(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()), &width,
                              &height, nullptr, 4),
        stbi_image_free);
    if (!data)
        throw DataError(file.string(), std::string("not a PNG that can be read (") + stbi_failure_reason() + ")",
                        "save it again as PNG");
    Image image({width, height});
    std::memcpy(image.pixels().data(), data.get(), image.pixels().size() * sizeof(Image::Pixel));
    return image;
}

} // namespace lumorph

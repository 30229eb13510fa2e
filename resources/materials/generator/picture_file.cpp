#include "resources/materials/generator/picture_file.h"

#include <span>
#include <vector>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace lumorph {

void writeOpaquePng(const Image& image, const std::filesystem::path& file) {
    std::vector<std::uint8_t> channels;
    channels.reserve(image.pixels().size() * 3);
    for (const Image::Pixel& pixel : image.pixels()) channels.insert(channels.end(), pixel.begin(), pixel.begin() + 3);
    std::vector<std::byte> bytes;
    const auto append = [](void* all, void* data, int size) {
        const auto part = std::span(static_cast<const std::byte*>(data), static_cast<std::size_t>(size));
        auto& to = *static_cast<std::vector<std::byte>*>(all);
        to.insert(to.end(), part.begin(), part.end());
    };
    stbi_write_png_compression_level = 64; // how far it looks for repeats
    const glm::ivec2 size = image.size();
    if (!stbi_write_png_to_func(append, &bytes, size.x, size.y, 3, channels.data(), 3 * size.x))
        throw DeviceError(file.string(), "the picture cannot be packed", "free some memory");
    writeFileAtomically(file, bytes);
}

} // namespace lumorph

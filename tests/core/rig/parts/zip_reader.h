#pragma once

#include <cstddef>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <zlib.h>

namespace lumorph::test {

/// The files in a ZIP archive by name, read by its central directory (PKWARE APPNOTE 4.3.12, 4.5.3) and inflated by
/// zlib.
inline std::map<std::string, std::string> unzipped(std::span<const std::byte> zip) {
    const auto number = [&](std::size_t at, std::size_t bytes) {
        std::size_t value = 0;
        for (std::size_t k = 0; k < bytes; ++k) value |= static_cast<std::size_t>(zip[at + k]) << (8 * k);
        return value;
    };
    // With sizes of eight bytes, which lib3mf writes: the end of the directory, and a field of each entry.
    std::size_t end = zip.size() - 22;
    while (number(end, 4) != 0x06064b50) --end;
    std::map<std::string, std::string> files;
    std::size_t at = number(end + 48, 8);
    for (std::size_t left = number(end + 32, 8); left > 0; --left) {
        if (number(at, 4) != 0x02014b50) throw std::runtime_error("no entry of a central directory");
        const std::size_t field = at + 46 + number(at + 28, 2);
        if (number(at + 24, 4) != 0xFFFFFFFF || number(field, 2) != 1 || number(field + 2, 2) < 24)
            throw std::runtime_error("no field of long sizes");
        const std::size_t size = number(field + 4, 8);
        const std::size_t packed = number(field + 12, 8);
        const std::size_t local = number(field + 20, 8);
        const std::string name(reinterpret_cast<const char*>(&zip[at + 46]), number(at + 28, 2));
        const std::size_t data = local + 30 + number(local + 26, 2) + number(local + 28, 2);
        std::string text(size, '\0');
        if (number(at + 10, 2) == 0) {
            std::memcpy(text.data(), &zip[data], text.size());
        } else {
            z_stream stream{};
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(&zip[data]));
            stream.avail_in = static_cast<uInt>(packed);
            stream.next_out = reinterpret_cast<Bytef*>(text.data());
            stream.avail_out = static_cast<uInt>(text.size());
            if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::runtime_error("zlib");
            const int result = inflate(&stream, Z_FINISH);
            inflateEnd(&stream);
            if (result != Z_STREAM_END) throw std::runtime_error("a file of the archive does not inflate");
        }
        files[name] = std::move(text);
        at += 46 + number(at + 28, 2) + number(at + 30, 2) + number(at + 32, 2);
    }
    return files;
}

} // namespace lumorph::test

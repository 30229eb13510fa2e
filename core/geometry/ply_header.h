#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lumorph {

/// What the head of a PLY file says about its body.
struct PlyHeader {
    enum class Format { text, littleEndian, bigEndian };
    enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
    struct Property {
        std::string name;
        Type type = Type::float32; ///< of the value, or of a list's items
        bool list = false;
        Type countType = Type::uint8; ///< of a list's length; an integer
    };
    struct Element {
        std::string name;
        std::uint64_t count = 0;
        std::vector<Property> properties;
    };

    Format format = Format::text;
    std::vector<Element> elements;
    std::size_t bodyOffset = 0; ///< in bytes from the start of the text it was read from
    std::size_t bodyLine = 1;
};

[[nodiscard]] std::size_t sizeOf(PlyHeader::Type type) noexcept;
[[nodiscard]] bool isInteger(PlyHeader::Type type) noexcept;

/// Throws DataError with the line: not a PLY file, an unknown format, type or statement, cut short.
[[nodiscard]] PlyHeader readPlyHeader(std::string_view text, const std::string& name);

} // namespace lumorph

#include "core/geometry/ply_header.h"

#include <array>
#include <utility>

#include "core/base/text.h"
#include "core/geometry/text_scanner.h"

namespace lumorph {
namespace {

using Type = PlyHeader::Type;

constexpr std::array<std::pair<std::string_view, Type>, 16> kTypes{{
    {"char", Type::int8},
    {"int8", Type::int8},
    {"uchar", Type::uint8},
    {"uint8", Type::uint8},
    {"short", Type::int16},
    {"int16", Type::int16},
    {"ushort", Type::uint16},
    {"uint16", Type::uint16},
    {"int", Type::int32},
    {"int32", Type::int32},
    {"uint", Type::uint32},
    {"uint32", Type::uint32},
    {"float", Type::float32},
    {"float32", Type::float32},
    {"double", Type::float64},
    {"float64", Type::float64},
}};

/// More are no mesh; a limit keeps a hostile head from costing memory and time.
constexpr std::size_t kMaxProperties = 1000;

class HeaderReader {
public:
    HeaderReader(std::string_view text, const std::string& name) : scanner_(text, name) {}

    PlyHeader read() {
        if (scanner_.wordOnLine() != "ply")
            scanner_.fail("it does not begin with 'ply'", "check that the file is a PLY file, or export it again");
        scanner_.restOfLine();
        readFormat();
        while (statement()) continue;
        header_.bodyOffset = scanner_.position();
        header_.bodyLine = scanner_.line();
        return std::move(header_);
    }

private:
    void readFormat() {
        std::string_view keyword = scanner_.wordOnLine();
        while (keyword == "comment" || keyword == "obj_info") {
            scanner_.restOfLine();
            keyword = scanner_.wordOnLine();
        }
        const std::string_view format = scanner_.wordOnLine();
        const std::string_view version = scanner_.wordOnLine();
        if (keyword != "format") scanner_.fail("the statement 'format' is missing", "export the model again");
        if (format == "ascii")
            header_.format = PlyHeader::Format::text;
        else if (format == "binary_little_endian")
            header_.format = PlyHeader::Format::littleEndian;
        else if (format == "binary_big_endian")
            header_.format = PlyHeader::Format::bigEndian;
        else
            scanner_.fail("the format " + inQuotes(format) + " is not known", "export the model as binary or text PLY");
        if (version != "1.0") scanner_.fail("version " + inQuotes(version) + " is not 1.0", "export the model again");
        scanner_.restOfLine();
    }

    /// Reads one line of the head; false after the last.
    bool statement() {
        if (scanner_.atEnd()) scanner_.failTruncated("'end_header'");
        const std::string_view keyword = scanner_.wordOnLine();
        if (keyword == "element")
            element();
        else if (keyword == "property")
            property();
        else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info" && keyword != "end_header")
            scanner_.fail(inQuotes(keyword) + " is not a statement of a PLY head", "export the model again");
        scanner_.restOfLine();
        return keyword != "end_header";
    }

    void element() {
        const std::string_view name = scanner_.wordOnLine();
        const std::int64_t count = scanner_.integer(scanner_.wordOnLine(), "number of elements");
        if (count < 0) scanner_.fail("the number of elements is negative", "export the model again");
        header_.elements.push_back({std::string(name), static_cast<std::uint64_t>(count), {}});
    }

    void property() {
        if (header_.elements.empty())
            scanner_.fail("a property stands before the first element", "export the model again");
        if (++properties_ > kMaxProperties)
            scanner_.fail("the head has more than " + std::to_string(kMaxProperties) + " properties",
                          "export the model without its extra properties");
        PlyHeader::Property property;
        std::string_view word = scanner_.wordOnLine();
        if (word == "list") {
            property.list = true;
            property.countType = type(scanner_.wordOnLine());
            if (!isInteger(property.countType))
                scanner_.fail("a list's length is not an integer", "export the model again");
            word = scanner_.wordOnLine();
        }
        property.type = type(word);
        property.name = scanner_.wordOnLine();
        header_.elements.back().properties.push_back(std::move(property));
    }

    Type type(std::string_view word) const {
        for (const auto& [name, type] : kTypes)
            if (name == word) return type;
        scanner_.fail(inQuotes(word) + " is not a type of a PLY property", "export the model again");
    }

    TextScanner scanner_;
    PlyHeader header_;
    std::size_t properties_ = 0;
};

} // namespace

std::size_t sizeOf(Type type) noexcept {
    switch (type) {
    case Type::int8:
    case Type::uint8:
        return 1;
    case Type::int16:
    case Type::uint16:
        return 2;
    case Type::int32:
    case Type::uint32:
    case Type::float32:
        return 4;
    case Type::float64:
        return 8;
    }
    return 0;
}

bool isInteger(Type type) noexcept { return type != Type::float32 && type != Type::float64; }

PlyHeader readPlyHeader(std::string_view text, const std::string& name) { return HeaderReader(text, name).read(); }

} // namespace lumorph

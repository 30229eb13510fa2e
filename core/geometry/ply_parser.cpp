#include "core/geometry/mesh_parsers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/base/text.h"
#include "core/geometry/binary_reader.h"
#include "core/geometry/mesh_builder.h"
#include "core/geometry/ply_header.h"
#include "core/geometry/text_scanner.h"

namespace lumorph {
namespace {

using Type = PlyHeader::Type;
using Property = PlyHeader::Property;

std::uint64_t linesWithWords(std::string_view text) {
    std::uint64_t lines = 0;
    for (TextScanner scanner(text, ""); !scanner.word().empty(); scanner.restOfLine()) ++lines;
    return lines;
}

/// Values of a text body, word by word.
class TextBody {
public:
    TextBody(std::string_view text, const PlyHeader& header, const std::string& name)
        : scanner_(text.substr(header.bodyOffset), name), headLines_(header.bodyLine - 1) {
        std::uint64_t elements = 0;
        for (const PlyHeader::Element& element : header.elements)
            if (!element.properties.empty()) elements += element.count;
        const std::uint64_t lines = linesWithWords(text.substr(header.bodyOffset));
        skipsRests_ = lines >= elements;
        keepsToLine_ = lines == elements;
    }

    void beginElement() { first_ = true; }
    /// Where each element has a line, what is left of it belongs to none.
    void endElement() {
        if (!skipsRests_ || scanner_.wordOnLine().empty()) return;
        if (++longLines_ == 1) firstLong_ = headLines_ + scanner_.line();
        while (!scanner_.wordOnLine().empty()) continue;
    }
    void addWarnings(std::vector<std::string>& warnings) const {
        if (longLines_ == 0) return;
        warnings.push_back((longLines_ == 1 ? "1 line holds" : std::to_string(longLines_) + " lines hold") +
                           " more than the head of the file names, first line " + std::to_string(firstLong_) +
                           "; the rest of " + (longLines_ == 1 ? "it" : "each") + " is passed over.");
    }

    double real(Type) { return number("a value"); }
    std::int64_t integer(Type) { return whole(number("a list")); }
    void skip(const Property& property) {
        const std::int64_t words = property.list ? integer(property.countType) : 1;
        for (std::int64_t i = 0; i < words; ++i) (void)number("a value");
    }
    [[nodiscard]] std::size_t remaining() const noexcept { return scanner_.remaining(); }
    [[nodiscard]] bool finished() { return scanner_.word().empty(); }
    [[noreturn]] void fail(const std::string&, std::uint64_t, const std::string& why, const std::string& remedy) const {
        throw DataError(scanner_.name() + ", line " + std::to_string(headLines_ + scanner_.line()), why, remedy);
    }

private:
    double number(const std::string& what) {
        const std::string_view word = keepsToLine_ && !first_ ? scanner_.wordOnLine() : scanner_.word();
        first_ = false;
        double value = 0.0;
        if (word.empty() && !scanner_.atEnd() && !restIsBlank())
            fail("", 0, "the line ends where " + what + " should follow",
                 "correct the line, or export the model again");
        if (word.empty())
            fail("", 0, "the file ends where " + what + " should follow", "it is cut short; copy or export it again");
        if (!parseReal(word, value)) fail("", 0, inQuotes(word) + " is not a number", "export the model again");
        return value;
    }
    std::int64_t whole(double value) const {
        if (!(std::abs(value) < 1e15) || value != std::floor(value))
            fail("", 0, "an index or a list's length is not a whole number", "export the model again");
        return static_cast<std::int64_t>(value);
    }

    [[nodiscard]] bool restIsBlank() const {
        TextScanner rest = scanner_;
        return rest.word().empty();
    }

    TextScanner scanner_;
    std::size_t headLines_;
    bool skipsRests_ = false;  ///< there are lines enough for all elements
    bool keepsToLine_ = false; ///< there is just one for each
    bool first_ = true;        ///< the next value begins an element
    std::uint64_t longLines_ = 0;
    std::size_t firstLong_ = 0;
};

/// Values of a binary body. The element under way stands in errors.
class BinaryBody {
public:
    BinaryBody(std::string_view text, const PlyHeader& header, const std::string& name)
        : bytes_(std::as_bytes(std::span(text)).subspan(header.bodyOffset)),
          order_(header.format == PlyHeader::Format::bigEndian ? std::endian::big : std::endian::little), name_(name) {}

    void beginElement() const noexcept {}
    void endElement() const noexcept {}
    void addWarnings(std::vector<std::string>&) const {}
    double real(Type type) {
        const auto raw = take(sizeOf(type));
        switch (type) {
        case Type::float32:
            return readNumber<float>(raw, order_);
        case Type::float64:
            return readNumber<double>(raw, order_);
        default:
            return static_cast<double>(integerOf(raw, type));
        }
    }
    std::int64_t integer(Type type) { return integerOf(take(sizeOf(type)), type); }
    void skip(const Property& property) {
        const std::int64_t count = property.list ? integer(property.countType) : 1;
        if (count <= 0) return;
        // No product here overflows: a list's length has 32 bits.
        take(static_cast<std::size_t>(count) * sizeOf(property.type));
    }
    [[nodiscard]] std::size_t remaining() const noexcept { return bytes_.size(); }
    /// Some writers pad the end with blanks or zeros.
    [[nodiscard]] bool finished() const noexcept {
        return std::ranges::all_of(bytes_, [](std::byte b) {
            return b == std::byte{0} || b == std::byte{' '} || b == std::byte{'\n'} || b == std::byte{'\r'};
        });
    }
    [[noreturn]] void fail(const std::string& element, std::uint64_t index, const std::string& why,
                           const std::string& remedy) const {
        throw DataError(name_ + ", " + element + " " + std::to_string(index), why, remedy);
    }

private:
    std::span<const std::byte> take(std::size_t count) {
        if (count > bytes_.size())
            throw DataError(name_, "the file ends inside its data", "it is cut short; copy or export it again");
        const auto taken = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return taken;
    }
    [[nodiscard]] std::int64_t integerOf(std::span<const std::byte> raw, Type type) const noexcept {
        switch (type) {
        case Type::int8:
            return readNumber<std::int8_t>(raw, order_);
        case Type::uint8:
            return readNumber<std::uint8_t>(raw, order_);
        case Type::int16:
            return readNumber<std::int16_t>(raw, order_);
        case Type::uint16:
            return readNumber<std::uint16_t>(raw, order_);
        case Type::int32:
            return readNumber<std::int32_t>(raw, order_);
        case Type::uint32:
            return readNumber<std::uint32_t>(raw, order_);
        default:
            return 0;
        }
    }

    std::span<const std::byte> bytes_;
    std::endian order_;
    std::string name_;
};

/// Fewest bytes an element takes in the body.
std::size_t leastBytes(const PlyHeader::Element& element, PlyHeader::Format format) {
    std::size_t bytes = 0;
    for (const Property& property : element.properties)
        bytes += format == PlyHeader::Format::text ? 1 : sizeOf(property.list ? property.countType : property.type);
    return bytes;
}

template <typename Body> class PlyBodyParser {
public:
    PlyBodyParser(const PlyHeader& header, Body body, const std::string& name)
        : header_(header), body_(std::move(body)), name_(name), builder_(name, "face") {}

    TriangleMesh parse(std::vector<std::string>* warnings) {
        for (const PlyHeader::Element& element : header_.elements) {
            checkCount(element);
            if (element.name == "vertex")
                vertices(element);
            else if (element.name == "face")
                faces(element);
            else
                passOver(element);
        }
        if (!body_.finished())
            throw DataError(name_, "more data follows after the last element of its head",
                            "correct the counts in the file's head, or export it again");
        TriangleMesh mesh = builder_.finish();
        if (warnings != nullptr) body_.addWarnings(*warnings);
        return mesh;
    }

private:
    [[nodiscard]] std::uint64_t countOf(std::string_view element) const {
        std::uint64_t count = 0;
        for (const PlyHeader::Element& each : header_.elements)
            if (each.name == element) count += each.count;
        return count;
    }

    void checkCount(const PlyHeader::Element& element) const {
        const std::size_t least = leastBytes(element, header_.format);
        if (least > 0 && element.count > body_.remaining() / least)
            throw DataError(name_,
                            "its head promises " + std::to_string(element.count) + " times " + inQuotes(element.name) +
                                ", more than the file has room for",
                            "it is cut short or damaged; copy or export it again");
    }

    void vertices(const PlyHeader::Element& element) {
        std::array<std::optional<std::size_t>, 3> columns;
        for (std::size_t i = 0; i < element.properties.size(); ++i)
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (element.properties[i].name == std::string(1, "xyz"[axis]) && !element.properties[i].list)
                    columns[axis] = i;
        if (!columns[0] || !columns[1] || !columns[2])
            throw DataError(name_, "its vertices have no x, y and z", "export the model again");
        builder_.reserve(element.count, 0, body_.remaining());
        for (std::uint64_t v = 0; v < element.count; ++v) {
            glm::vec3 position(0.0F);
            body_.beginElement();
            for (std::size_t i = 0; i < element.properties.size(); ++i) {
                const auto axis = std::ranges::find(columns, std::optional(i)) - columns.begin();
                if (axis < 3)
                    position[static_cast<int>(axis)] = coordinate(element.properties[i].type, v + 1);
                else
                    body_.skip(element.properties[i]);
            }
            body_.endElement();
            builder_.addVertex(position);
        }
    }

    float coordinate(Type type, std::uint64_t vertex) {
        const auto value = static_cast<float>(body_.real(type));
        if (!std::isfinite(value))
            body_.fail("vertex", vertex, "a coordinate is not a finite number",
                       "remove the vertex, or export the model again");
        return value;
    }

    void faces(const PlyHeader::Element& element) {
        const auto indices = std::ranges::find_if(element.properties, [](const Property& property) {
            return property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
        });
        if (indices == element.properties.end() || !isInteger(indices->type))
            throw DataError(name_, "its faces have no list 'vertex_indices' of integers", "export the model again");
        checkFaceCount(element.count, countOf("vertex"), name_ + ", its head");
        builder_.reserve(0, element.count, body_.remaining());
        for (std::uint64_t f = 0; f < element.count; ++f) {
            body_.beginElement();
            for (const Property& property : element.properties) {
                if (&property == &*indices)
                    corners(property, f + 1);
                else
                    body_.skip(property);
            }
            body_.endElement();
            builder_.endPolygon(f + 1);
        }
    }

    void corners(const Property& property, std::uint64_t face) {
        const std::int64_t count = body_.integer(property.countType);
        if (count < 0) body_.fail("face", face, "its number of corners is negative", "export the model again");
        for (std::int64_t i = 0; i < count; ++i) builder_.addCorner(body_.integer(property.type));
    }

    void passOver(const PlyHeader::Element& element) {
        if (element.name == "tristrips")
            throw DataError(name_, "it holds triangle strips", "export the model with plain faces");
        if (element.properties.empty()) return;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            body_.beginElement();
            for (const Property& property : element.properties) body_.skip(property);
            body_.endElement();
        }
    }

    const PlyHeader& header_;
    Body body_;
    std::string name_;
    MeshBuilder builder_;
};

} // namespace

TriangleMesh parsePly(std::span<const std::byte> bytes, const std::string& name, std::vector<std::string>* warnings) {
    const PlainText plain(bytes);
    const std::string_view text = plain.view();
    if (text.empty()) throw DataError(name, "the file is empty", "export the model again");
    const PlyHeader header = readPlyHeader(text, name);
    if (header.format == PlyHeader::Format::text)
        return PlyBodyParser(header, TextBody(text, header, name), name).parse(warnings);
    return PlyBodyParser(header, BinaryBody(text, header, name), name).parse(warnings);
}

} // namespace lumorph

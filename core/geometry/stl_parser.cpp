#include "core/geometry/mesh_parsers.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/base/text.h"
#include "core/geometry/binary_reader.h"
#include "core/geometry/mesh_builder.h"
#include "core/geometry/mesh_file.h"
#include "core/geometry/position_index.h"
#include "core/geometry/text_scanner.h"

namespace lumorph {
namespace {

constexpr std::size_t kHeaderBytes = 84; ///< 80 free ones and the number of triangles
constexpr std::size_t kTriangleBytes = 50;

bool equalsIgnoringCase(std::string_view word, std::string_view lower) noexcept {
    return word.size() == lower.size() &&
           std::ranges::equal(word, lower, {}, [](unsigned char c) { return std::tolower(c); });
}

class TextStlParser {
public:
    TextStlParser(std::string_view text, const std::string& name) : scanner_(text, name), builder_(name, "line") {}

    TriangleMesh parse() {
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
            if (!equalsIgnoringCase(word, "solid")) failUnexpected(word, "'solid'");
            scanner_.restOfLine(); // its name
            solid();
        }
        return builder_.finish();
    }

private:
    void solid() {
        for (;;) {
            const std::string_view word = scanner_.word();
            if (equalsIgnoringCase(word, "endsolid")) break;
            if (!equalsIgnoringCase(word, "facet")) failUnexpected(word, "'facet' or 'endsolid'");
            scanner_.restOfLine(); // its normal, often wrong or NaN; the corners' order says the same
            facet();
        }
        scanner_.restOfLine();
    }

    void facet() {
        const std::size_t line = scanner_.line();
        expect("outer");
        expect("loop");
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            const float x = scanner_.coordinate(scanner_.word(), "x coordinate");
            const float y = scanner_.coordinate(scanner_.word(), "y coordinate");
            const float z = scanner_.coordinate(scanner_.word(), "z coordinate");
            const auto [index, isNew] = places_.insert({x, y, z});
            if (isNew) builder_.addVertex({x, y, z});
            builder_.addCorner(index);
        }
        expect("endloop");
        expect("endfacet");
        builder_.endPolygon(line);
    }

    void expect(std::string_view keyword) {
        const std::string_view word = scanner_.word();
        if (!equalsIgnoringCase(word, keyword)) failUnexpected(word, inQuotes(keyword));
    }

    [[noreturn]] void failUnexpected(std::string_view word, const std::string& expected) const {
        if (word.empty()) scanner_.failTruncated(expected);
        scanner_.fail("expected " + expected + ", found " + inQuotes(word), "export the model again");
    }

    TextScanner scanner_;
    MeshBuilder builder_;
    PositionIndex places_;
};

glm::vec3 readCorner(std::span<const std::byte> bytes, std::size_t triangle, const std::string& name) {
    const glm::vec3 p(readNumber<float>(bytes), readNumber<float>(bytes.subspan(4)),
                      readNumber<float>(bytes.subspan(8)));
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        throw DataError(name + ", triangle " + std::to_string(triangle), "a coordinate is not a finite number",
                        "remove the triangle, or export the model again");
    return p;
}

TriangleMesh parseBinary(std::span<const std::byte> bytes, const std::string& name) {
    const std::size_t count = readNumber<std::uint32_t>(bytes.subspan(80));
    if (count > kMaxTriangles)
        throw DataError(name,
                        "has " + std::to_string(count) + " triangles, more than the limit of " +
                            std::to_string(kMaxTriangles),
                        "reduce its detail (decimate it) before exporting");
    MeshBuilder builder(name, "triangle");
    PositionIndex places;
    builder.reserve(count / 2, count, bytes.size());
    for (std::size_t t = 0; t < count; ++t) {
        const auto corners = bytes.subspan(kHeaderBytes + t * kTriangleBytes + 12, 36); // after the normal
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const glm::vec3 position = readCorner(corners.subspan(12 * corner), t + 1, name);
            const auto [index, isNew] = places.insert(position);
            if (isNew) builder.addVertex(position);
            builder.addCorner(index);
        }
        builder.endPolygon(t + 1);
    }
    return builder.finish();
}

/// Some binary files begin with "solid" too, but only a text has a facet soon after.
bool looksLikeText(std::span<const std::byte> bytes) {
    const PlainText begin(bytes.first(std::min<std::size_t>(bytes.size(), 4096)));
    TextScanner scanner(begin.view(), "");
    if (!equalsIgnoringCase(scanner.word(), "solid")) return false;
    scanner.restOfLine();
    const std::string_view next = scanner.word();
    return next.empty() || equalsIgnoringCase(next, "facet") || equalsIgnoringCase(next, "endsolid");
}

/// What some programs write behind the last triangle: a line end, padding, a note. Whole triangles are none of these:
/// then the head counts too few.
bool isTail(std::span<const std::byte> tail, std::uint64_t body) {
    constexpr std::uint64_t kLongestNote = 4096;
    const auto isBlank = [](std::byte b) {
        return b == std::byte{0} || b == std::byte{' '} || b == std::byte{'\n'} || b == std::byte{'\r'};
    };
    if (std::ranges::all_of(tail, isBlank)) return true;
    return tail.size() % kTriangleBytes != 0 && tail.size() <= std::max(kLongestNote, body);
}

} // namespace

TriangleMesh parseStl(std::span<const std::byte> bytes, const std::string& name, std::vector<std::string>* warnings) {
    if (bytes.empty()) throw DataError(name, "the file is empty", "export the model again");
    const std::uint64_t stated =
        bytes.size() >= kHeaderBytes ? readNumber<std::uint32_t>(bytes.subspan(80)) : std::uint32_t{0};
    const std::uint64_t expected = kHeaderBytes + kTriangleBytes * stated;
    if (bytes.size() >= kHeaderBytes && bytes.size() == expected) return parseBinary(bytes, name);
    if (looksLikeText(bytes)) {
        const PlainText text(bytes);
        return TextStlParser(text.view(), name).parse();
    }
    if (stated > 0 && bytes.size() > expected &&
        isTail(bytes.subspan(static_cast<std::size_t>(expected)), expected - kHeaderBytes)) {
        const std::uint64_t more = bytes.size() - expected;
        TriangleMesh mesh = parseBinary(bytes, name);
        if (warnings != nullptr)
            warnings->push_back("The file goes on behind its last triangle: " + std::to_string(more) +
                                (more == 1 ? " byte is" : " bytes are") + " passed over.");
        return mesh;
    }
    if (bytes.size() < kHeaderBytes)
        throw DataError(name, "is too short for an STL file, and does not begin with 'solid'",
                        "check that it is an STL file, or export it again");
    throw DataError(name,
                    "its head promises " + std::to_string(stated) + " triangles, which take " +
                        std::to_string(expected) + " bytes, but the file has " + std::to_string(bytes.size()),
                    "it is cut short or not an STL file; copy or export it again");
}

} // namespace lumorph

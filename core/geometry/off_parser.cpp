#include "core/base/plain_text.h"
#include "core/base/text.h"
#include "core/geometry/mesh_parsers.h"

#include "core/geometry/mesh_builder.h"
#include "core/geometry/text_scanner.h"

namespace lumorph {
namespace {

/// Reads "[ST][C][N]OFF". Some files have the first count glued to it ("OFF490"); it is returned,
/// otherwise nothing is.
std::string_view readKeyword(TextScanner& scanner) {
    const std::string_view word = scanner.word();
    std::string_view rest = word;
    if (rest.starts_with("ST")) rest.remove_prefix(2);
    if (rest.starts_with("C")) rest.remove_prefix(1);
    if (rest.starts_with("N")) rest.remove_prefix(1);
    if (rest.starts_with("4OFF") || rest.starts_with("nOFF") || rest.starts_with("4nOFF"))
        scanner.fail("its points are not three-dimensional (" + inQuotes(word) + ")", "export a plain OFF file");
    const bool known = rest.starts_with("OFF") && rest.find_first_not_of("0123456789", 3) == rest.npos;
    if (!known)
        scanner.fail("it does not begin with OFF but with " + inQuotes(word),
                     "check that the file is an OFF file, or export it again");
    return rest.substr(3);
}

std::uint64_t readCount(TextScanner& scanner, std::string_view word, std::string_view what) {
    const std::int64_t count = scanner.integer(word, what);
    if (count < 0) scanner.fail("the " + std::string(what) + " is negative", "export the model again");
    return static_cast<std::uint64_t>(count);
}

void readVertices(TextScanner& scanner, MeshBuilder& builder, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::string_view first = scanner.word();
        if (first.empty()) scanner.failTruncated("vertex " + std::to_string(i + 1) + " of " + std::to_string(count));
        const float x = scanner.coordinate(first, "x coordinate");
        const float y = scanner.coordinate(scanner.wordOnLine(), "y coordinate");
        const float z = scanner.coordinate(scanner.wordOnLine(), "z coordinate");
        builder.addVertex({x, y, z});
        scanner.restOfLine(); // normal, colour, texture coordinates
    }
}

void readFaces(TextScanner& scanner, MeshBuilder& builder, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::string_view first = scanner.word();
        const std::size_t line = scanner.line();
        if (first.empty()) scanner.failTruncated("face " + std::to_string(i + 1) + " of " + std::to_string(count));
        const std::uint64_t corners = readCount(scanner, first, "number of corners");
        for (std::uint64_t k = 0; k < corners; ++k) {
            const std::string_view word = scanner.word();
            if (word.empty()) scanner.failTruncated("a corner of face " + std::to_string(i + 1));
            builder.addCorner(scanner.integer(word, "corner of a face"));
        }
        builder.endPolygon(line);
        scanner.restOfLine(); // colour
    }
}

} // namespace

TriangleMesh parseOff(std::span<const std::byte> bytes, const std::string& name) {
    const PlainText text(bytes);
    TextScanner scanner(text.view(), name);
    if (bytes.empty()) scanner.fail("the file is empty", "export the model again");
    std::string_view first = readKeyword(scanner);
    if (first.empty()) first = scanner.word();
    if (first == "BINARY") scanner.fail("it is a binary OFF file", "export it as a text OFF, or as PLY, STL or OBJ");
    if (first.empty()) scanner.failTruncated("the number of vertices");
    const std::uint64_t vertices = readCount(scanner, first, "number of vertices");
    const std::uint64_t faces = readCount(scanner, scanner.word(), "number of faces");
    const std::string_view edges = scanner.wordOnLine(); // often left out, never needed
    if (!edges.empty()) (void)readCount(scanner, edges, "number of edges");
    scanner.restOfLine();

    MeshBuilder builder(name, "line");
    builder.reserve(vertices, faces, scanner.remaining());
    readVertices(scanner, builder, vertices);
    readFaces(scanner, builder, faces);
    if (const std::string_view extra = scanner.word(); !extra.empty())
        scanner.fail("after the last of " + std::to_string(faces) + " faces follows " + inQuotes(extra),
                     "correct the counts in the file's head, or export it again");
    return builder.finish();
}

} // namespace lumorph

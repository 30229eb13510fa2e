#include "core/base/plain_text.h"
#include "core/base/text.h"
#include "core/geometry/mesh_parsers.h"

#include <algorithm>
#include <array>

#include "core/geometry/mesh_builder.h"
#include "core/geometry/text_scanner.h"

namespace lumorph {
namespace {

/// Statements that say nothing about polygons: attributes, grouping, materials, free-form geometry.
constexpr std::array kPassedOver = std::to_array<std::string_view>(
    {"vt",     "vn",     "vp",     "vc",   "g",     "o",        "s",        "mg",         "usemtl",
     "usemap", "mtllib", "maplib", "lod",  "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj",
     "cstype", "deg",    "bmat",   "step", "curv",  "curv2",    "surf",     "parm",       "trim",
     "hole",   "scrv",   "sp",     "end",  "con",   "ctech",    "stech",    "cdc",        "cdp",
     "bsp",    "bzp",    "res",    "l",    "p",     "call",     "csh"});

class ObjParser {
public:
    ObjParser(std::string_view text, const std::string& name)
        : scanner_(text, name, TextScanner::Continuation::backslash), builder_(name, "line") {}

    TriangleMesh parse() {
        for (std::string_view keyword = scanner_.word(); !keyword.empty(); keyword = scanner_.word()) {
            if (keyword == "v")
                vertex();
            else if (keyword == "f" || keyword == "fo")
                face();
            else if (std::ranges::find(kPassedOver, keyword) != kPassedOver.end())
                passOver();
            else
                scanner_.fail(inQuotes(keyword) + " is not a statement of an OBJ file",
                              "check that the file is a Wavefront OBJ, or export it again");
        }
        return builder_.finish();
    }

private:
    void vertex() {
        const float x = scanner_.coordinate(scanner_.wordOnLine(), "x coordinate");
        const float y = scanner_.coordinate(scanner_.wordOnLine(), "y coordinate");
        const float z = scanner_.coordinate(scanner_.wordOnLine(), "z coordinate");
        builder_.addVertex({x, y, z});
        passOver(); // a weight or a colour
    }

    void face() {
        const std::size_t line = scanner_.line();
        for (std::string_view word = scanner_.wordOnLine(); !word.empty(); word = scanner_.wordOnLine())
            builder_.addCorner(corner(word));
        if (builder_.cornersUnderWay() < 3)
            scanner_.fail("a face has " + std::to_string(builder_.cornersUnderWay()) + " corners",
                          "give it three or more, or remove it");
        builder_.endPolygon(line);
    }

    /// `7`, `7/1`, `7//3` or `7/1/3`: the first number is the vertex.
    std::int64_t corner(std::string_view word) {
        const std::size_t slash = std::min(word.find('/'), word.size());
        if (word.find_first_not_of("-+/0123456789", slash) != word.npos)
            scanner_.fail(inQuotes(word) + " is not a corner of a face", "write corners like 7, 7/1, 7//3 or 7/1/3");
        const std::int64_t index = scanner_.integer(word.substr(0, slash), "corner of a face");
        if (index > 0) return index - 1;
        if (index == 0) scanner_.fail("a face refers to vertex 0", "count vertices from 1");
        const auto soFar = static_cast<std::int64_t>(builder_.vertexCount());
        if (index < -soFar)
            scanner_.fail("a face refers to vertex " + std::to_string(index) + ", but only " + std::to_string(soFar) +
                              " vertices stand before it",
                          "export the model again");
        return soFar + index;
    }

    void passOver() {
        while (!scanner_.wordOnLine().empty()) continue;
    }

    TextScanner scanner_;
    MeshBuilder builder_;
};

} // namespace

TriangleMesh parseObj(std::span<const std::byte> bytes, const std::string& name) {
    const PlainText text(bytes);
    return ObjParser(text.view(), name).parse();
}

} // namespace lumorph

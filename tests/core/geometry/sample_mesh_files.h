#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/mesh_parsers.h"
#include "core/geometry/mesh_writers.h"

namespace lumorph {

inline std::span<const std::byte> bytesOf(const std::string& text) { return std::as_bytes(std::span(text)); }

template <typename Number> std::string raw(Number value, std::endian order = std::endian::little) {
    std::string bytes(sizeof(Number), '\0');
    std::memcpy(bytes.data(), &value, sizeof(Number));
    if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

// The known solid: an L-shaped prism (a dented hexagon, extruded), its sides quads. Volume 3 x 2 = 6.
inline constexpr int kPoints[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

inline std::vector<glm::vec3> prismPoints() {
    std::vector<glm::vec3> points;
    for (const float z : {0.0F, 2.0F})
        for (const auto& p : kPoints) points.emplace_back(p[0], p[1], z);
    return points;
}

inline std::vector<std::vector<int>> prismFaces() {
    std::vector<std::vector<int>> faces{{5, 4, 3, 2, 1, 0}, {6, 7, 8, 9, 10, 11}};
    for (int i = 0; i < 6; ++i) faces.push_back({i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6});
    return faces;
}

inline std::string point(const glm::vec3& p) {
    return std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z);
}

/// OBJ with everything that other programs put into it.
inline std::string prismObj() {
    std::string text = "# exported\nmtllib prism.mtl\no Prism\ng all sides\n";
    for (const glm::vec3& p : prismPoints()) text += "v " + point(p) + "\n";
    text += "vt 0.5 0.5\nvn 0 0 1\ns off\nusemtl paper\n";
    const char* const corners[] = {"", "/1", "//1", "/1/1"};
    std::size_t kind = 0;
    for (const std::vector<int>& face : prismFaces()) {
        text += "f";
        for (const int i : face) text += " " + std::to_string(i + 1) + corners[kind % 4];
        ++kind;
        text += "\n";
    }
    return text;
}

inline std::string prismObjNegative() {
    std::string text;
    for (const glm::vec3& p : prismPoints()) text += "v " + point(p) + " 0.1 0.2 0.3\n";
    for (const std::vector<int>& face : prismFaces()) {
        text += "f \\\n ";
        for (const int i : face) text += " " + std::to_string(i - 12) + "/-1/-1";
        text += " # a comment\n";
    }
    return text + "vt 0 0\nvn 0 0 1\n\n\n";
}

inline std::string prismObjFacesFirst() {
    std::string faces;
    for (const std::vector<int>& face : prismFaces()) {
        faces += "f";
        for (const int i : face) faces += " " + std::to_string(i + 1);
        faces += "\n";
    }
    for (const glm::vec3& p : prismPoints()) faces += "v " + point(p) + "\n";
    return faces;
}

inline std::string prismOff(const std::string& keyword, const std::string& vertexExtra, const std::string& faceExtra) {
    std::string text = keyword + " 12 8 0\n# points\n\n";
    for (const glm::vec3& p : prismPoints()) text += point(p) + vertexExtra + "\n";
    for (const std::vector<int>& face : prismFaces()) {
        text += std::to_string(face.size()) + " ";
        for (const int i : face) text += " " + std::to_string(i);
        text += faceExtra + "\n";
    }
    return text;
}

inline std::string prismPlyText() {
    std::string text = "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement vertex 12\nproperty uchar red\n"
                       "property float x\nproperty double y\nproperty float z\nproperty list uchar float weights\n"
                       "element material 1\nproperty int id\nelement face 8\nproperty uchar flags\n"
                       "property list uchar int vertex_index\nend_header\n";
    for (const glm::vec3& p : prismPoints()) text += "255 " + point(p) + " 2 0.5 nan\n";
    text += "7\n";
    for (const std::vector<int>& face : prismFaces()) {
        text += "1 " + std::to_string(face.size());
        for (const int i : face) text += " " + std::to_string(i);
        text += "\n";
    }
    return text;
}

template <typename Count, typename Index>
inline std::string prismPly(std::endian order, const std::string& countType, const std::string& indexType,
                            const std::string& newline = "\n") {
    std::string text = "ply\nformat binary_" + std::string(order == std::endian::big ? "big" : "little") +
                       "_endian 1.0\nelement vertex 12\nproperty short tag\nproperty list uchar ushort extra\n"
                       "property double x\nproperty float y\nproperty int z\nelement face 8\nproperty list " +
                       countType + " " + indexType + " vertex_indices\nproperty uchar red\nend_header\n";
    text = replaced(text, "\n", newline);
    for (const glm::vec3& p : prismPoints())
        text += raw(std::int16_t{-3}, order) + raw(std::uint8_t{2}, order) + raw(std::uint16_t{1}, order) +
                raw(std::uint16_t{2}, order) + raw(double{p.x}, order) + raw(p.y, order) +
                raw(static_cast<std::int32_t>(p.z), order);
    for (const std::vector<int>& face : prismFaces()) {
        text += raw(static_cast<Count>(face.size()), order);
        for (const int i : face) text += raw(static_cast<Index>(i), order);
        text += '\x7F';
    }
    return text;
}

inline TriangleMesh prism() { return parseObj(bytesOf(prismObjFacesFirst()), "prism"); }

inline std::string prismStlText() {
    const TriangleMesh mesh = prism();
    std::string text = "solid a name with words\n";
    for (const glm::uvec3& t : mesh.triangles) {
        text += "  facet normal nan -nan(ind) 0\n    outer loop\n";
        for (int k = 0; k < 3; ++k) text += "      vertex " + point(mesh.positions[t[k]]) + "\n";
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid a name with words\n";
}

inline std::string prismStl(const std::string& head) {
    const std::vector<std::byte> bytes = writeStl(prism());
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.replace(0, 80, head + std::string(80 - head.size(), ' '));
}

} // namespace lumorph

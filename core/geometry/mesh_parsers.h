#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {

/// Parsers of mesh files held in memory. `name` stands in errors. All give a mesh with at least one
/// triangle, finite positions and valid indices, in the file's own units and axes, or throw
/// DataError with the line (text) or the element (binary), the cause and the remedy. Polygons are
/// triangulated in their best-fit plane. Counts in a header are never trusted with memory. Text may be UTF-8 or UTF-16.
/// What of a sound mesh is passed over is added to `warnings`, in plain sentences.

/// Wavefront OBJ: polygons of `v` and `f`; groups, materials, normals, texture coordinates and
/// vertex colours are passed over. A face may refer to vertices that stand after it.
[[nodiscard]] TriangleMesh parseObj(std::span<const std::byte> bytes, const std::string& name);

/// STL, text or binary (told apart by the size that a binary header states, not by the word
/// "solid"). Vertices at exactly the same place become one. Less than a triangle's bytes, blanks or a note may follow a
/// binary one.
[[nodiscard]] TriangleMesh parseStl(std::span<const std::byte> bytes, const std::string& name,
                                    std::vector<std::string>* warnings = nullptr);

/// PLY 1.0, text or binary of either byte order: elements `vertex` (x, y, z) and `face`
/// (vertex_indices or vertex_index); everything else is passed over, in a text with a line for each element also what
/// a line holds beyond what the head names.
[[nodiscard]] TriangleMesh parsePly(std::span<const std::byte> bytes, const std::string& name,
                                    std::vector<std::string>* warnings = nullptr);

/// OFF in text form with any of the prefixes ST, C and N; one vertex a line, colours passed over.
[[nodiscard]] TriangleMesh parseOff(std::span<const std::byte> bytes, const std::string& name);

} // namespace lumorph

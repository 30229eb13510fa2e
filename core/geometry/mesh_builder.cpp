#include "core/geometry/mesh_builder.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/geometry/mesh_file.h"
#include "core/geometry/polygon_triangulation.h"

namespace lumorph {
namespace {

/// The same corner several times in a row, as collapsed quads are often written, counts once.
void withoutRepeats(std::span<const std::int64_t> corners, std::vector<std::uint32_t>& out) {
    out.clear();
    for (const std::int64_t corner : corners)
        if (out.empty() || out.back() != corner) out.push_back(static_cast<std::uint32_t>(corner));
    while (out.size() > 1 && out.front() == out.back()) out.pop_back();
}

} // namespace

void checkFaceCount(std::uint64_t faces, std::uint64_t vertices, const std::string& place) {
    // A few vertices may meet in any number of faces: fans, stars.
    constexpr std::uint64_t kFew = 10'000;
    if (faces <= kFew || faces / kMaxFacesAVertex <= vertices) return;
    throw DataError(place,
                    "it has " + std::to_string(faces) + " faces on " + std::to_string(vertices) +
                        " vertices, so that most of them repeat one another",
                    "remove repeated faces in a modelling program, and export the model again");
}

MeshBuilder::MeshBuilder(std::string name, std::string placeName)
    : name_(std::move(name)), placeName_(std::move(placeName)) {}

void MeshBuilder::reserve(std::uint64_t vertices, std::uint64_t polygons, std::size_t bytesLeft) {
    // No vertex or polygon takes less than six bytes in any format; text ones take more.
    const std::uint64_t most = bytesLeft / 6;
    positions_.reserve(static_cast<std::size_t>(std::min(vertices, most)));
    polygons_.reserve(static_cast<std::size_t>(std::min(polygons, most)));
    corners_.reserve(static_cast<std::size_t>(3 * std::min(polygons, most)));
}

void MeshBuilder::endPolygon(std::size_t place) {
    const std::size_t count = cornersUnderWay();
    if (count < 3) {
        corners_.resize(polygonStart_);
        return;
    }
    if (count > kMaxPolygonCorners)
        fail(place,
             "a face has " + std::to_string(count) + " corners, more than the limit of " +
                 std::to_string(kMaxPolygonCorners),
             "triangulate the model before exporting it");
    triangles_ += count - 2;
    if (triangles_ > kMaxTriangles)
        fail(place, "the mesh has more than " + std::to_string(kMaxTriangles) + " triangles, the limit",
             "reduce its detail (decimate it) before exporting");
    polygons_.push_back({corners_.size(), place});
    polygonStart_ = corners_.size();
}

void MeshBuilder::checkIndices(std::span<const std::int64_t> corners, std::size_t place) const {
    for (const std::int64_t corner : corners)
        if (corner < 0 || corner >= static_cast<std::int64_t>(positions_.size()))
            fail(place,
                 "a face refers to vertex " + std::to_string(corner) + " (counted from 0), but the file has " +
                     std::to_string(positions_.size()) + " vertices",
                 "export the model again; the file is damaged or cut short");
}

TriangleMesh MeshBuilder::finish() {
    if (polygons_.empty())
        throw DataError(name_,
                        positions_.empty() ? std::string("holds no mesh")
                                           : "holds " + std::to_string(positions_.size()) + " points but no faces",
                        "export the model as a surface of polygons");
    checkFaceCount(polygons_.size(), positions_.size(), name_);
    if (positions_.size() > std::numeric_limits<std::uint32_t>::max())
        throw DataError(name_, "has too many vertices", "reduce its detail before exporting");

    TriangleMesh mesh;
    mesh.triangles.reserve(triangles_);
    std::vector<std::uint32_t> ring;
    std::size_t start = 0;
    for (const Polygon& polygon : polygons_) {
        const std::span<const std::int64_t> corners(corners_.data() + start, polygon.end - start);
        start = polygon.end;
        checkIndices(corners, polygon.place);
        if (corners.size() == 3) {
            mesh.triangles.emplace_back(corners[0], corners[1], corners[2]);
            continue;
        }
        withoutRepeats(corners, ring);
        if (ring.size() >= 3) triangulatePolygon(positions_, ring, mesh.triangles);
    }
    mesh.positions = std::move(positions_);
    *this = MeshBuilder(name_, placeName_);
    if (mesh.empty())
        throw DataError(name_, "every face of it is collapsed to a point or a line", "export the model again");
    return mesh;
}

void MeshBuilder::fail(std::size_t place, const std::string& why, const std::string& remedy) const {
    throw DataError(name_ + ", " + placeName_ + " " + std::to_string(place), why, remedy);
}

} // namespace lumorph

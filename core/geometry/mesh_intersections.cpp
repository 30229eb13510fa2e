#include "core/geometry/mesh_check.h"

#include <array>
#include <optional>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include "core/geometry/mesh_topology.h"

namespace lumorph {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;

struct Face {
    std::array<Point, 3> points;
    std::array<std::uint32_t, 3> places;
};

/// Whether the other two corners of `face` lie strictly on one side of the plane of `plane`.
bool beside(const Face& plane, const Point& p, const Point& q) {
    const CGAL::Orientation side = CGAL::orientation(plane.points[0], plane.points[1], plane.points[2], p);
    return side != CGAL::COPLANAR && side == CGAL::orientation(plane.points[0], plane.points[1], plane.points[2], q);
}

Triangle triangleOf(const Face& face) { return {face.points[0], face.points[1], face.points[2]}; }

/// Corner k of a face, k counting round.
const Point& at(const Face& face, std::size_t k) { return face.points[k % 3]; }

/// Faces that share one corner meet elsewhere too when the edge across from it cuts the other face.
bool crossBesidesCorner(const Face& a, std::size_t cornerA, const Face& b, std::size_t cornerB) {
    const Point& a1 = at(a, cornerA + 1);
    const Point& a2 = at(a, cornerA + 2);
    const Point& b1 = at(b, cornerB + 1);
    const Point& b2 = at(b, cornerB + 2);
    if (beside(a, b1, b2) || beside(b, a1, a2)) return false;
    return CGAL::do_intersect(triangleOf(a), Segment(b1, b2)) || CGAL::do_intersect(triangleOf(b), Segment(a1, a2));
}

/// Faces that share the edge from `from` to `to` overlap when they are folded flat onto each other.
bool overlapAtEdge(const Point& from, const Point& to, const Point& tipA, const Point& tipB) {
    return CGAL::coplanar(from, to, tipA, tipB) && CGAL::coplanar_orientation(from, to, tipA, tipB) == CGAL::POSITIVE;
}

bool cross(const Face& a, const Face& b) {
    std::array<std::size_t, 3> inA{};
    std::array<std::size_t, 3> inB{};
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (a.places[i] == b.places[j]) {
                inA[shared] = i;
                inB[shared++] = j;
            }
    if (shared == 3) return true;
    if (shared == 2)
        return overlapAtEdge(a.points[inA[0]], a.points[inA[1]], a.points[3 - inA[0] - inA[1]],
                             b.points[3 - inB[0] - inB[1]]);
    if (shared == 1) return crossBesidesCorner(a, inA[0], b, inB[0]);
    return CGAL::do_intersect(triangleOf(a), triangleOf(b));
}

/// The triangle as CGAL sees it; none for one without area, which cuts nothing.
std::optional<Face> faceOf(const TriangleMesh& mesh, const MeshTopology& topology, std::uint32_t triangle) {
    if (topology.ignored[triangle]) return std::nullopt;
    Face face;
    for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = vertexAt(mesh, 3 * triangle + k);
        const glm::vec3& p = mesh.positions[vertex];
        face.points[k] = Point(p.x, p.y, p.z);
        face.places[k] = topology.places[vertex];
    }
    if (CGAL::collinear(face.points[0], face.points[1], face.points[2])) return std::nullopt;
    return face;
}

} // namespace

std::size_t countSelfIntersections(const TriangleMesh& mesh) {
    using FaceBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
    const MeshTopology topology = meshTopology(mesh);
    std::vector<Face> faces;
    std::vector<FaceBox> boxes;
    faces.reserve(mesh.triangles.size());
    boxes.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::optional<Face> face = faceOf(mesh, topology, t);
        if (!face) continue;
        Box bounds;
        for (std::uint32_t k = 0; k < 3; ++k) bounds.include(mesh.positions[vertexAt(mesh, 3 * t + k)]);
        boxes.emplace_back(
            CGAL::Bbox_3(bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y, bounds.max.z),
            static_cast<std::uint32_t>(faces.size()));
        faces.push_back(*face);
    }

    // The way out of CGAL's search once there is nothing more to learn.
    struct Enough {};
    std::size_t count = 0;
    const auto visit = [&](const FaceBox& a, const FaceBox& b) {
        if (cross(faces[a.info()], faces[b.info()]) && ++count >= kMaxIntersectionsCounted) throw Enough();
    };
    try {
        CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), visit);
    } catch (const Enough&) {
        return count;
    }
    return count;
}

} // namespace lumorph

#include "core/geometry/mesh_check.h"

#include <algorithm>
#include <array>
#include <cmath>

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
};

using FaceBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

// The way out of CGAL's search once there is nothing more to learn.
struct Enough {};

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
            if (a.points[i] == b.points[j]) {
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

bool isFinite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Triangles as CGAL sees them, with their boxes; without those that have no area, which cut nothing.
struct Faces {
    std::vector<Face> faces;
    std::vector<std::uint32_t> numbers; ///< of the triangles
    std::vector<FaceBox> boxes;         ///< their info is an index into both

    void reserve(std::size_t count) {
        faces.reserve(count);
        numbers.reserve(count);
        boxes.reserve(count);
    }
    void add(const TriangleMesh& mesh, std::uint32_t triangle) {
        Face face;
        Box bounds;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const glm::vec3& p = mesh.positions[vertexAt(mesh, 3 * triangle + k)];
            if (!isFinite(p)) return;
            face.points[k] = Point(p.x, p.y, p.z);
            bounds.include(p);
        }
        if (CGAL::collinear(face.points[0], face.points[1], face.points[2])) return;
        boxes.emplace_back(
            CGAL::Bbox_3(bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y, bounds.max.z),
            static_cast<std::uint32_t>(faces.size()));
        faces.push_back(face);
        numbers.push_back(triangle);
    }
};

Faces facesOf(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
    Faces faces;
    faces.reserve(triangles.size());
    for (const std::uint32_t t : triangles) faces.add(mesh, t);
    return faces;
}

glm::vec3 vectorOf(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// Adds where the edges of `a` pierce `b`.
void includePiercings(const Face& a, const Face& b, Box& where) {
    const Kernel::Vector_3 normal = CGAL::normal(b.points[0], b.points[1], b.points[2]);
    for (std::size_t k = 0; k < 3; ++k) {
        const Point& from = at(a, k);
        const Point& to = at(a, k + 1);
        if (!CGAL::do_intersect(triangleOf(b), Segment(from, to))) continue;
        const double before = normal * (from - b.points[0]);
        const double after = normal * (to - b.points[0]);
        if (before == after) continue;
        const double share = std::clamp(before / (before - after), 0.0, 1.0);
        where.include(vectorOf(from + share * (to - from)));
    }
}

/// The box of where two faces that cross meet; of those that lie flat on each other, of what their boxes share.
Box meetingOf(const Face& a, const FaceBox& boxOfA, const Face& b, const FaceBox& boxOfB) {
    Box where;
    includePiercings(a, b, where);
    includePiercings(b, a, where);
    if (!where.empty()) return where;
    for (int k = 0; k < 3; ++k) {
        where.min[k] = static_cast<float>(std::max(boxOfA.min_coord(k), boxOfB.min_coord(k)));
        where.max[k] = static_cast<float>(std::min(boxOfA.max_coord(k), boxOfB.max_coord(k)));
    }
    return where;
}

} // namespace

std::size_t countSelfIntersections(const TriangleMesh& mesh) {
    const MeshTopology topology = meshTopology(mesh);
    Faces all;
    all.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (!topology.ignored[t]) all.add(mesh, t);
    std::size_t count = 0;
    const auto visit = [&](const FaceBox& a, const FaceBox& b) {
        if (cross(all.faces[a.info()], all.faces[b.info()]) && ++count >= kMaxIntersectionsCounted) throw Enough();
    };
    try {
        CGAL::box_self_intersection_d(all.boxes.begin(), all.boxes.end(), visit);
    } catch (const Enough&) {
        return count;
    }
    return count;
}

std::vector<TriangleCrossing> findCrossings(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
                                            std::span<const std::uint32_t> others, std::size_t most) {
    Faces some = facesOf(mesh, triangles);
    Faces rest = facesOf(mesh, others);
    std::vector<TriangleCrossing> found;
    const auto visit = [&](const Faces& ofB) {
        return [&](const FaceBox& a, const FaceBox& b) {
            const Face& faceA = some.faces[a.info()];
            const Face& faceB = ofB.faces[b.info()];
            if (!cross(faceA, faceB)) return;
            found.push_back({some.numbers[a.info()], ofB.numbers[b.info()], meetingOf(faceA, a, faceB, b)});
            if (found.size() >= most) throw Enough();
        };
    };
    try {
        if (most == 0) return found;
        CGAL::box_self_intersection_d(some.boxes.begin(), some.boxes.end(), visit(some));
        CGAL::box_intersection_d(some.boxes.begin(), some.boxes.end(), rest.boxes.begin(), rest.boxes.end(),
                                 visit(rest));
    } catch (const Enough&) {
        return found;
    }
    return found;
}

} // namespace lumorph

#include "core/geometry/plane_mesh.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
template <typename Crossings>
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               Crossings>;

template <typename Plane>
std::vector<typename Plane::Vertex_handle> insertPoints(Plane& plane, const std::vector<glm::dvec2>& points) {
    std::vector<typename Plane::Vertex_handle> handles;
    for (std::uint32_t k = 0; k < points.size(); ++k) {
        handles.push_back(plane.insert(Kernel::Point_2(points[k].x, points[k].y)));
        handles.back()->info() = k;
    }
    if (plane.number_of_vertices() != points.size())
        throw InvalidInput("plane mesh", "two points are at the same place", "remove one");
    return handles;
}

template <typename Face> glm::uvec3 verticesOf(const Face& face) {
    return {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
}

} // namespace

std::vector<glm::uvec3> triangulatePlane(const std::vector<glm::dvec2>& points,
                                         const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges,
                                         const std::function<bool(const glm::dvec2&)>& keep) {
    Triangulation<CGAL::No_constraint_intersection_tag> plane;
    const auto handles = insertPoints(plane, points);
    for (const auto& [a, b] : edges) plane.insert_constraint(handles[a], handles[b]);
    std::vector<glm::uvec3> triangles;
    for (const auto face : plane.finite_face_handles()) {
        const glm::uvec3 t = verticesOf(face);
        if (keep((points[t.x] + points[t.y] + points[t.z]) / 3.0)) triangles.push_back(t);
    }
    return triangles;
}

PlaneMesh triangulateCrossing(const std::vector<glm::dvec2>& points,
                              const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges) {
    Triangulation<CGAL::Exact_predicates_tag> plane;
    const auto handles = insertPoints(plane, points);
    constexpr std::uint32_t kNew = 0xFFFFFFFF;
    for (const auto& [a, b] : edges)
        if (a != b) plane.insert_constraint(handles[a], handles[b]);
    PlaneMesh mesh{points, {}};
    for (const auto vertex : plane.finite_vertex_handles()) vertex->info() = kNew;
    for (std::uint32_t k = 0; k < handles.size(); ++k) handles[k]->info() = k;
    for (const auto vertex : plane.finite_vertex_handles()) {
        if (vertex->info() != kNew) continue;
        vertex->info() = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.emplace_back(vertex->point().x(), vertex->point().y());
    }
    for (const auto face : plane.finite_face_handles()) mesh.triangles.push_back(verticesOf(face));
    return mesh;
}

void addWall(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b,
             std::vector<glm::uvec3>& triangles) {
    std::size_t i = 0;
    std::size_t j = 0;
    while (i + 1 < a.size() || j + 1 < b.size()) {
        // Climb where the lower share of the way has been gone, so that rows meet rows.
        const bool climbB =
            i + 1 == a.size() || (j + 1 < b.size() && (j + 1) * (a.size() - 1) <= (i + 1) * (b.size() - 1));
        if (climbB) {
            triangles.emplace_back(a[i], b[j], b[j + 1]);
            ++j;
        } else {
            triangles.emplace_back(a[i], b[j], a[i + 1]);
            ++i;
        }
    }
}

double signedArea(const std::vector<glm::dvec2>& polygon) noexcept {
    double area = 0.0;
    for (std::size_t k = 0; k < polygon.size(); ++k)
        area += 0.5 * crossOf(polygon[k], polygon[(k + 1) % polygon.size()]);
    return area;
}

bool insidePolygon(const std::vector<glm::dvec2>& polygon, const glm::dvec2& point) {
    bool inside = false;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2& a = polygon[k];
        const glm::dvec2& b = polygon[(k + 1) % polygon.size()];
        if ((a.y > point.y) == (b.y > point.y)) continue;
        if (point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
    return inside;
}

} // namespace lumorph

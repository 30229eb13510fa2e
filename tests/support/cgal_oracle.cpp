#include "tests/support/cgal_oracle.h"

#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/intersections.h>

namespace lumorph::test {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Side = CGAL::Side_of_triangle_mesh<Mesh, Kernel>;

Kernel::Point_3 pointOf(const glm::dvec3& p) { return {p.x, p.y, p.z}; }

} // namespace

struct InsideOracle::Pieces {
    std::vector<Mesh> meshes;
    std::vector<std::unique_ptr<Side>> sides;
};

InsideOracle::InsideOracle(const TriangleMesh& mesh) : pieces_(std::make_unique<Pieces>()) {
    Mesh whole;
    std::vector<Mesh::Vertex_index> vertices;
    vertices.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) vertices.push_back(whole.add_vertex(pointOf(glm::dvec3(p))));
    for (const glm::uvec3& t : mesh.triangles) whole.add_face(vertices[t.x], vertices[t.y], vertices[t.z]);
    CGAL::Polygon_mesh_processing::split_connected_components(whole, pieces_->meshes);
    for (const Mesh& piece : pieces_->meshes) pieces_->sides.push_back(std::make_unique<Side>(piece));
}

InsideOracle::~InsideOracle() = default;

bool InsideOracle::operator()(const glm::dvec3& point) const {
    for (const auto& side : pieces_->sides)
        if ((*side)(pointOf(point)) == CGAL::ON_BOUNDED_SIDE) return true;
    return false;
}

bool boxMeetsTriangle(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& a, const glm::dvec3& b,
                      const glm::dvec3& c) {
    return CGAL::do_intersect(Kernel::Iso_cuboid_3(pointOf(low), pointOf(high)),
                              Kernel::Triangle_3(pointOf(a), pointOf(b), pointOf(c)));
}

bool crossesItself(const TriangleMesh& mesh) {
    Mesh judged;
    std::vector<Mesh::Vertex_index> vertices;
    vertices.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) vertices.push_back(judged.add_vertex(pointOf(glm::dvec3(p))));
    for (const glm::uvec3& t : mesh.triangles)
        if (judged.add_face(vertices[t.x], vertices[t.y], vertices[t.z]) == Mesh::null_face()) return true;
    return !CGAL::is_closed(judged) || CGAL::Polygon_mesh_processing::does_self_intersect(judged);
}

} // namespace lumorph::test

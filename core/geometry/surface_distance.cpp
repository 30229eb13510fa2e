#include "core/geometry/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/base/error.h"
#include "core/geometry/disjoint_sets.h"
#include "core/geometry/mesh_topology.h"

namespace lumorph {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;
using Graph = CGAL::Surface_mesh<Point>;
using Heat = CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Graph, CGAL::Heat_method_3::Intrinsic_Delaunay>;

constexpr float kNoWay = std::numeric_limits<float>::infinity();
constexpr double kFar = std::numeric_limits<double>::infinity();

Point toPoint(const glm::vec3& p) { return {p.x, p.y, p.z}; }
glm::vec3 toVec(const Point& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

bool finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Finds the triangle next to a point, and what lies across the solid.
class SurfaceFinder {
public:
    SurfaceFinder(const TriangleMesh& mesh, const std::vector<bool>& ignored) {
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (ignored[t]) continue;
            const glm::uvec3& corners = mesh.triangles[t];
            const Kernel::Triangle_3 triangle(toPoint(mesh.positions[corners.x]), toPoint(mesh.positions[corners.y]),
                                              toPoint(mesh.positions[corners.z]));
            if (triangle.is_degenerate()) continue;
            triangles_.push_back(triangle);
            numbers_.push_back(static_cast<std::uint32_t>(t));
        }
        if (triangles_.empty())
            throw InvalidInput("mesh", "it has no triangle with an area", "give a mesh with a surface");
        tree_.insert(triangles_.begin(), triangles_.end());
        tree_.build();
    }

    struct Place {
        Point point;
        std::uint32_t triangle = 0; ///< of the mesh
        Kernel::Vector_3 normal;    ///< of length 1
    };
    [[nodiscard]] Place nearest(const glm::vec3& to) const {
        const auto [point, at] = tree_.closest_point_and_primitive(toPoint(to));
        const Kernel::Vector_3 across = at->supporting_plane().orthogonal_vector();
        return {point, numberOf(at), across / std::sqrt(across.squared_length())};
    }
    /// Where a straight line through the solid comes out of it again, at most so far away.
    [[nodiscard]] std::optional<glm::vec3> across(const Place& from, double most) const {
        constexpr double kBelow = 1e-6; // metres: not where it begins
        const Point begin = from.point - kBelow * from.normal;
        std::optional<Point> nearest;
        std::vector<Tree::Intersection_and_primitive_id<Kernel::Segment_3>::Type> all;
        tree_.all_intersections(Kernel::Segment_3(begin, begin - most * from.normal), std::back_inserter(all));
        for (const auto& [what, at] : all)
            if (const Point* p = boost::get<Point>(&what))
                if (!nearest || CGAL::squared_distance(begin, *p) < CGAL::squared_distance(begin, *nearest))
                    nearest = *p;
        return nearest ? std::optional(toVec(*nearest)) : std::nullopt;
    }

private:
    [[nodiscard]] std::uint32_t numberOf(Triangles::const_iterator at) const {
        return numbers_[static_cast<std::size_t>(at - triangles_.begin())];
    }
    Triangles triangles_;
    std::vector<std::uint32_t> numbers_;
    Tree tree_;
};

void check(const TriangleMesh& mesh, std::span<const glm::vec3> places) {
    if (places.empty() || mesh.triangles.empty())
        throw InvalidInput("distances on a surface", "there is no place to begin at, or no surface", "name a place");
    for (const glm::vec3& place : places)
        if (!finite(place)) throw InvalidInput("a place", "it is not finite", "give three finite numbers");
}

/// A mesh as its triangles meet over edges: a fan of triangles around a place is a node. Seams are closed, and what
/// only touches at a place stays apart.
struct Fans {
    Fans(const TriangleMesh& mesh, const MeshTopology& topology) : nodeOf(3 * mesh.triangles.size(), 0) {
        const std::size_t corners = nodeOf.size();
        DisjointSets sets(corners), pieces(mesh.triangles.size());
        for (std::uint32_t h = 0; h < corners; ++h) {
            const std::uint32_t other = topology.partner[h];
            if (other == MeshTopology::kNone || topology.ignored[h / 3]) continue;
            sets.join(h, nextInTriangle(other));
            sets.join(nextInTriangle(h), other);
            pieces.join(h / 3, other / 3);
        }
        for (std::uint32_t h = 0; h < corners; ++h) {
            if (sets.find(h) == h) nodeOf[h] = static_cast<std::uint32_t>(vertices.size()), vertices.push_back(0);
            nodeOf[h] = nodeOf[sets.find(h)];
            vertices[nodeOf[h]] = vertexAt(mesh, h);
        }
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) pieceOf.push_back(pieces.find(t));
    }
    std::vector<std::uint32_t> nodeOf;   ///< one a corner
    std::vector<std::uint32_t> vertices; ///< one a node: a vertex of the mesh that lies there
    std::vector<std::uint32_t> pieceOf;  ///< one a triangle
};

/// By the heat method on the pieces that hold the places; one a node, infinite elsewhere. None where it fails.
std::optional<std::vector<double>> heated(const TriangleMesh& mesh, const MeshTopology& topology, const Fans& fans,
                                          const std::vector<SurfaceFinder::Place>& places) {
    std::set<std::uint32_t> pieces;
    for (const auto& place : places) pieces.insert(fans.pieceOf[place.triangle]);
    Graph graph;
    std::vector<Graph::Vertex_index> at(fans.vertices.size());
    std::map<std::uint32_t, Graph::Face_index> faceOf;
    std::set<std::uint32_t> begun;
    for (const auto& place : places) begun.insert(place.triangle);
    const auto vertexOf = [&](std::uint32_t corner) {
        Graph::Vertex_index& vertex = at[fans.nodeOf[corner]];
        if (!vertex.is_valid()) vertex = graph.add_vertex(toPoint(mesh.positions[vertexAt(mesh, corner)]));
        return vertex;
    };
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (topology.ignored[t] || !pieces.contains(fans.pieceOf[t])) continue;
        const auto face = graph.add_face(vertexOf(3 * t), vertexOf(3 * t + 1), vertexOf(3 * t + 2));
        if (!face.is_valid()) return std::nullopt;
        if (begun.contains(t)) faceOf[t] = face;
    }
    std::set<Graph::Vertex_index> sources;
    for (const auto& place : places) {
        constexpr double kSame = 1e-6; // of the edge, squared
        std::optional<Graph::Vertex_index> corner;
        double edge = 0.0;
        for (std::uint32_t k = 0; k < 3; ++k)
            edge =
                std::max(edge, CGAL::squared_distance(graph.point(vertexOf(3 * place.triangle + k)),
                                                      graph.point(vertexOf(nextInTriangle(3 * place.triangle + k)))));
        for (std::uint32_t k = 0; k < 3; ++k)
            if (const auto v = vertexOf(3 * place.triangle + k);
                CGAL::squared_distance(graph.point(v), place.point) < kSame * edge)
                corner = v;
        if (corner) {
            sources.insert(*corner);
        } else if (const auto face = faceOf.find(place.triangle); face != faceOf.end()) {
            // One vertex a triangle: others in it are nearer than the mesh tells places apart.
            const auto halfEdge = CGAL::Euler::add_center_vertex(graph.halfedge(face->second), graph);
            graph.point(graph.target(halfEdge)) = place.point;
            sources.insert(graph.target(halfEdge));
            faceOf.erase(face);
        }
    }
    const auto distance = graph.add_property_map<Graph::Vertex_index, double>("v:distance", 0.0).first;
    try {
        Heat heat(graph);
        heat.add_sources(sources);
        heat.estimate_geodesic_distances(distance);
    } catch (const std::exception&) {
        return std::nullopt; // the mesh is too bad for its equations
    }
    std::vector<double> result(fans.vertices.size(), kFar);
    for (std::size_t n = 0; n < result.size(); ++n) {
        if (!at[n].is_valid()) continue;
        if (!std::isfinite(distance[at[n]])) return std::nullopt;
        result[n] = distance[at[n]];
    }
    return result;
}

/// The distance at `k` of a triangle whose other corners are `a` and `b` from where it began: that is unfolded into the
/// triangle's plane, on the side away from `k`. Infinite where the straight way from there misses the edge.
double acrossTriangle(double edge, double toA, double toB, double ka, double kb) {
    const double x = (toA * toA - toB * toB + edge * edge) / (2.0 * edge);
    const double below2 = toA * toA - x * x;
    const double kx = (ka * ka - kb * kb + edge * edge) / (2.0 * edge);
    const double above2 = ka * ka - kx * kx;
    if (below2 < 0.0 || above2 <= 0.0) return kFar;
    const double below = std::sqrt(below2), above = std::sqrt(above2);
    const double crossing = x + (kx - x) * below / (below + above);
    if (crossing < 0.0 || crossing > edge) return kFar;
    return std::hypot(kx - x, above + below);
}

/// Goes from node to node, the nearest first: along edges, and across triangles where `unfold` is set.
class March {
public:
    March(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& nodeOf,
          std::size_t nodes)
        : mesh_(mesh), nodeOf_(nodeOf), start_(nodes + 1, 0) {
        const auto eachCorner = [&](auto&& visit) {
            for (std::uint32_t h = 0; h < nodeOf.size(); ++h)
                if (!topology.ignored[h / 3]) visit(h);
        };
        eachCorner([&](std::uint32_t h) { ++start_[nodeOf[h] + 1]; });
        for (std::size_t n = 0; n < nodes; ++n) start_[n + 1] += start_[n];
        corners_.resize(start_.back());
        std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
        eachCorner([&](std::uint32_t h) { corners_[next[nodeOf[h]]++] = h; });
    }

    [[nodiscard]] std::vector<double> from(const std::vector<SurfaceFinder::Place>& places, bool unfold,
                                           const Progress& progress) {
        const std::size_t nodes = start_.size() - 1;
        distance_.assign(nodes, kFar);
        done_.assign(nodes, false);
        for (const auto& place : places)
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t corner = 3 * place.triangle + k;
                reach(nodeOf_[corner], std::sqrt(CGAL::squared_distance(place.point, toPoint(at(corner)))));
            }
        for (std::size_t steps = 0; !waiting_.empty(); ++steps) {
            const auto [far, node] = waiting_.top();
            waiting_.pop();
            if (done_[node]) continue;
            done_[node] = true;
            if (steps % 4096 == 0) progress.throwIfCancelled();
            for (std::uint32_t c = start_[node]; c < start_[node + 1]; ++c) pass(corners_[c], unfold);
        }
        return std::move(distance_);
    }

private:
    [[nodiscard]] const glm::vec3& at(std::uint32_t corner) const { return mesh_.positions[vertexAt(mesh_, corner)]; }
    [[nodiscard]] double between(std::uint32_t a, std::uint32_t b) const {
        return glm::distance(glm::dvec3(at(a)), glm::dvec3(at(b)));
    }
    void reach(std::uint32_t node, double distance) {
        if (!(distance < distance_[node])) return;
        distance_[node] = distance;
        done_[node] = false;
        waiting_.emplace(distance, node);
    }
    /// From a corner that is reached to the others of its triangle.
    void pass(std::uint32_t corner, bool unfold) {
        const std::uint32_t one = nextInTriangle(corner), two = nextInTriangle(one);
        for (const auto& [to, other] : {std::pair(one, two), std::pair(two, one)}) {
            const double here = distance_[nodeOf_[corner]], there = distance_[nodeOf_[other]];
            reach(nodeOf_[to], here + between(corner, to));
            if (unfold && std::isfinite(there))
                reach(nodeOf_[to],
                      acrossTriangle(between(corner, other), here, there, between(corner, to), between(other, to)));
        }
    }

    const TriangleMesh& mesh_;
    const std::vector<std::uint32_t>& nodeOf_;
    std::vector<std::uint32_t> start_, corners_; ///< of each node
    std::vector<double> distance_;
    std::vector<bool> done_;
    std::priority_queue<std::pair<double, std::uint32_t>, std::vector<std::pair<double, std::uint32_t>>, std::greater<>>
        waiting_;
};

/// The shortest of what the corners of each vertex say; corners of a triangle without area are none.
std::vector<float> atVertices(const TriangleMesh& mesh, const std::vector<std::uint32_t>& nodeOf,
                              const std::vector<double>& distance) {
    std::vector<float> metres(mesh.positions.size(), kNoWay);
    for (std::uint32_t h = 0; h < nodeOf.size(); ++h) {
        float& vertex = metres[vertexAt(mesh, h)];
        vertex = std::min(vertex, static_cast<float>(distance[nodeOf[h]]));
    }
    return metres;
}

double straight(const std::vector<SurfaceFinder::Place>& places, const glm::vec3& to) {
    double least = kFar;
    for (const auto& place : places) least = std::min(least, CGAL::squared_distance(place.point, toPoint(to)));
    return std::sqrt(least);
}

} // namespace

SurfaceDistances surfaceDistances(const TriangleMesh& mesh, std::span<const glm::vec3> places,
                                  const Progress& progress) {
    check(mesh, places);
    progress.report(-1.0, "finding the way along the surface");
    const MeshTopology topology = meshTopology(mesh);
    std::vector<SurfaceFinder::Place> from;
    {
        const SurfaceFinder finder(mesh, topology.ignored);
        for (const glm::vec3& place : places) from.push_back(finder.nearest(place));
    }
    progress.throwIfCancelled();
    if (topology.crowdedEdges.empty() && topology.disagreements == 0) {
        const Fans fans(mesh, topology);
        if (auto distance = heated(mesh, topology, fans, from)) {
            progress.throwIfCancelled();
            const auto longest = March(mesh, topology, fans.nodeOf, fans.vertices.size()).from(from, false, progress);
            for (std::size_t n = 0; n < distance->size(); ++n)
                if (std::isfinite(longest[n]))
                    (*distance)[n] =
                        std::clamp((*distance)[n],
                                   std::min(straight(from, mesh.positions[fans.vertices[n]]), longest[n]), longest[n]);
            return {atVertices(mesh, fans.nodeOf, *distance), true};
        }
    }
    std::vector<std::uint32_t> placeOf;
    for (std::uint32_t h = 0; h < 3 * mesh.triangles.size(); ++h) placeOf.push_back(topology.places[vertexAt(mesh, h)]);
    const std::size_t count = static_cast<std::size_t>(*std::max_element(placeOf.begin(), placeOf.end())) + 1;
    return {atVertices(mesh, placeOf, March(mesh, topology, placeOf, count).from(from, true, progress)), false};
}

std::vector<glm::vec3> placesOnBothSides(const TriangleMesh& mesh, std::span<const glm::vec3> points,
                                         double thickness) {
    check(mesh, points);
    const SurfaceFinder finder(mesh, meshTopology(mesh).ignored);
    std::vector<glm::vec3> places;
    for (const glm::vec3& point : points) {
        const SurfaceFinder::Place place = finder.nearest(point);
        places.push_back(toVec(place.point));
        if (const auto other = finder.across(place, thickness)) places.push_back(*other);
    }
    return places;
}

} // namespace lumorph

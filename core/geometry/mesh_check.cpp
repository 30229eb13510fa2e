#include "core/geometry/mesh_check.h"

#include <limits>

#include <glm/geometric.hpp>

#include "core/geometry/mesh_topology.h"
#include "core/geometry/triangle_area.h"

namespace lumorph {
namespace {

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

} // namespace

std::vector<std::string> MeshReport::findings() const {
    std::vector<std::string> sentences;
    if (triangles == 0) {
        sentences.emplace_back("The mesh has no triangles; export the model again with its surface.");
        return sentences;
    }
    if (boundaryEdges > 0)
        sentences.push_back("The surface has holes (" + counted(boundaryEdges, "edge has", "edges have") +
                            " a triangle on one side only); repair the mesh, or close it in a modelling program.");
    if (nonManifoldEdges > 0)
        sentences.push_back(counted(nonManifoldEdges, "edge joins", "edges join") +
                            " more than two triangles, or two that face opposite ways; repair the mesh, or remove "
                            "inner walls and repeated faces in a modelling program.");
    if (degenerateTriangles > 0)
        sentences.push_back(counted(degenerateTriangles, "triangle has", "triangles have") +
                            " no area; repair the mesh to drop them.");
    if (selfIntersections > 0)
        sentences.push_back("The surface cuts through itself (" +
                            counted(selfIntersections, "pair of triangles", "pairs of triangles") +
                            "); unite the overlapping parts in a modelling program.");
    if (inwardComponents > 0)
        sentences.push_back(counted(inwardComponents, "piece is", "pieces are") +
                            " inside out; repair the mesh to turn them outwards.");
    return sentences;
}

MeshReport checkMesh(const TriangleMesh& mesh, IntersectionTest intersections) {
    const MeshTopology topology = meshTopology(mesh);
    const std::vector<MeshComponent> components = meshComponents(mesh, topology);
    MeshReport report;
    report.vertices = mesh.positions.size();
    report.triangles = mesh.triangles.size();
    report.components = components.size();
    report.boundaryEdges = topology.boundary.size();
    report.nonManifoldEdges = topology.crowdedEdges.size() + topology.disagreements;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (topology.ignored[t] || isFlat(mesh, t)) ++report.degenerateTriangles;
    for (const MeshComponent& component : components) report.volume += component.volume;
    report.inwardComponents = inwardComponents(mesh, components).size();
    if (intersections == IntersectionTest::run) report.selfIntersections = countSelfIntersections(mesh);
    return report;
}

} // namespace lumorph

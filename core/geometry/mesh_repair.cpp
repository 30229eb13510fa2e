#include "core/geometry/mesh_check.h"

#include <algorithm>

#include "core/geometry/mesh_topology.h"
#include "core/geometry/soup_cleaning.h"
#include "core/geometry/surface_stitching.h"

namespace lumorph {
namespace {

void note(std::vector<std::string>& actions, std::size_t count, const std::string& one, const std::string& many) {
    if (count == 0) return;
    actions.push_back(count == 1 ? one : std::to_string(count) + " " + many);
}

/// Sound apart from crossings, which no repair here takes away.
bool nothingToRepair(const MeshReport& report) {
    MeshReport rest = report;
    rest.selfIntersections = 0;
    return rest.findings().empty() || report.triangles == 0;
}

/// Turns pieces that are inside out, along with the pieces inside them: those were cavities as the
/// mesh meant it, and stay so.
std::size_t turnOutwards(TriangleMesh& mesh) {
    const std::vector<MeshComponent> components = meshComponents(mesh, meshTopology(mesh));
    const std::vector<std::size_t> inward = inwardComponents(mesh, components);
    std::vector<bool> turn(components.size(), false);
    for (const std::size_t i : inward) turn[i] = true;
    for (std::size_t k = 0; k < components.size(); ++k) {
        if (turn[k] || !components[k].closed || !components[k].coherent) continue;
        turn[k] =
            std::ranges::any_of(inward, [&](std::size_t i) { return nesting(mesh, components[k], components[i]) < 0; });
    }
    for (std::size_t i = 0; i < components.size(); ++i)
        if (turn[i])
            for (const std::uint32_t t : components[i].triangles) std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    return inward.size();
}

} // namespace

MeshRepair repairMesh(const TriangleMesh& mesh, std::size_t maxHoleEdges) {
    MeshRepair repair{mesh, checkMesh(mesh), {}, {}};
    repair.after = repair.before;
    if (nothingToRepair(repair.before)) return repair;

    TriangleMesh work = mesh;
    std::vector<std::string>& actions = repair.actions;
    note(actions, dropCollapsedTriangles(work), "A triangle collapsed to a line or a point was dropped.",
         "triangles collapsed to a line or a point were dropped.");
    note(actions, dissolveFlatTriangles(work), "A triangle without area was taken out.",
         "triangles without area were taken out.");
    if (repair.before.nonManifoldEdges > 0)
        note(actions, dropRepeatedTriangles(work), "A repeated triangle was dropped.",
             "repeated triangles were dropped.");
    if (work.empty()) {
        actions.emplace_back("No triangle is left to repair; the mesh is as it was.");
        return repair;
    }

    const StitchedSurface surface = stitchSurface(work, maxHoleEdges);
    note(actions, surface.mergedVertices, "A vertex was merged with another at the same place.",
         "vertices were merged with others at the same place.");
    note(actions, surface.turnedTriangles, "A triangle was turned to face as its neighbours do.",
         "triangles were turned to face as their neighbours do.");
    note(actions, surface.filledHoles, "A hole was filled.", "holes were filled.");
    note(actions, surface.openHoles, "A hole was left open: it is too large, or its part is a flat sheet.",
         "holes were left open: they are too large, or their parts are flat sheets.");
    work = surface.mesh;
    // Filling a crack, where a corner of one side lies on an edge of the other, makes a flat triangle.
    dissolveFlatTriangles(work);
    note(actions, turnOutwards(work), "A piece that was inside out was turned outwards.",
         "pieces that were inside out were turned outwards.");
    repair.mesh = std::move(work);
    repair.after = checkMesh(repair.mesh);
    return repair;
}

} // namespace lumorph

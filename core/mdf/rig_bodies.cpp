#include "core/mdf/rig_bodies.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace lumorph {

namespace {

std::vector<std::uint32_t> componentOfVertices(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> parent(mesh.positions.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto find = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const glm::uvec3& t : mesh.triangles) {
        parent[find(t.y)] = find(t.x);
        parent[find(t.z)] = find(t.x);
    }
    for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = find(v);
    return parent;
}

struct Shell {
    std::uint32_t component = 0;
    Box box;
    double volume = 0.0;
};

bool contains(const Box& outer, const Box& inner) {
    return glm::all(glm::lessThanEqual(outer.min, inner.min)) && glm::all(glm::greaterThanEqual(outer.max, inner.max));
}

/// For each component the component of the body it belongs to: a cavity (inward-facing) belongs to
/// the smallest piece around it, everything else to itself.
std::map<std::uint32_t, std::uint32_t> bodyOfComponents(const TriangleMesh& mesh,
                                                        const std::vector<std::uint32_t>& component) {
    std::map<std::uint32_t, Shell> shells;
    for (const glm::uvec3& t : mesh.triangles) {
        Shell& shell = shells[component[t.x]];
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b(mesh.positions[t.y]);
        const glm::dvec3 c(mesh.positions[t.z]);
        shell.volume += glm::dot(a, glm::cross(b, c));
        for (const std::uint32_t v : {t.x, t.y, t.z}) shell.box.include(mesh.positions[v]);
    }
    std::map<std::uint32_t, std::uint32_t> body;
    for (const auto& [id, shell] : shells) {
        body[id] = id;
        if (shell.volume >= 0.0) continue;
        double smallest = INFINITY;
        for (const auto& [otherId, other] : shells)
            if (other.volume > 0.0 && other.volume < smallest && contains(other.box, shell.box)) {
                smallest = other.volume;
                body[id] = otherId;
            }
    }
    return body;
}

ColumnRange columnsOfBox(const VoxelFrame& frame, const Box& box) {
    // One column of slack on each side: snapping to the grid may move a vertex by a hair.
    const auto column = [&](float position, float origin) {
        const double index = (static_cast<double>(position) - static_cast<double>(origin)) / frame.voxelSize - 0.5;
        return std::clamp(index, -1e8, 1e8);
    };
    const ColumnRange range{static_cast<int>(std::floor(column(box.min.x, frame.origin.x))),
                            static_cast<int>(std::ceil(column(box.max.x, frame.origin.x))),
                            static_cast<int>(std::floor(column(box.min.z, frame.origin.z))),
                            static_cast<int>(std::ceil(column(box.max.z, frame.origin.z)))};
    return range.intersect(columnsOf(frame));
}

/// Longest way that a vertex of the rig travels, in metres, when this actuator alone makes its full
/// stroke; sampled, with a margin for the arcs between the samples.
double longestPath(const Rig& rig, std::size_t actuator) {
    constexpr int kSamples = 16;
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    std::vector<glm::vec3> before(rig.restMesh().positions.size());
    std::vector<glm::vec3> now(before.size());
    std::vector<double> length(before.size(), 0.0);
    rig.deform(strokes, before);
    for (int k = 1; k <= kSamples; ++k) {
        strokes[actuator] = static_cast<double>(k) / kSamples;
        rig.deform(strokes, now);
        for (std::size_t v = 0; v < now.size(); ++v) length[v] += static_cast<double>(glm::distance(before[v], now[v]));
        before.swap(now);
    }
    return length.empty() ? 0.0 : 1.05 * *std::max_element(length.begin(), length.end());
}

std::vector<RigBody> groupTriangles(const Rig& rig, const VoxelFrame& frame) {
    std::vector<RigBody> bodies;
    const TriangleMesh& mesh = rig.restMesh();
    const std::vector<std::uint32_t> component = componentOfVertices(mesh);
    const std::map<std::uint32_t, std::uint32_t> bodyOf = bodyOfComponents(mesh, component);
    std::map<std::uint32_t, std::map<std::vector<std::uint16_t>, std::vector<glm::uvec3>>> sorted;
    for (const auto& [shell, owner] : bodyOf) sorted[owner][{}];
    std::vector<std::uint16_t> actuators;
    for (const glm::uvec3& t : mesh.triangles) {
        actuators.clear();
        for (const std::uint32_t v : {t.x, t.y, t.z}) {
            const auto of = rig.actuatorsOf(v);
            actuators.insert(actuators.end(), of.begin(), of.end());
        }
        std::sort(actuators.begin(), actuators.end());
        actuators.erase(std::unique(actuators.begin(), actuators.end()), actuators.end());
        sorted[bodyOf.at(component[t.x])][actuators].push_back(t);
    }
    std::vector<std::uint32_t> local(mesh.positions.size());
    constexpr std::uint32_t kUnseen = ~0U;
    for (auto& [owner, groups] : sorted) {
        RigBody& made = bodies.emplace_back();
        for (auto& [key, triangles] : groups) { // the empty key comes first
            RigGroup& group = made.groups.emplace_back(RigGroup{key, std::nullopt, {}, std::move(triangles), {}});
            for (const glm::uvec3& t : group.triangles)
                for (const std::uint32_t v : {t.x, t.y, t.z}) local[v] = kUnseen;
            Box box;
            std::vector<std::uint32_t> vertices;
            const auto number = [&](std::uint32_t v) {
                if (local[v] == kUnseen) {
                    local[v] = static_cast<std::uint32_t>(vertices.size());
                    vertices.push_back(v);
                    box.include(rig.reachOf(v));
                }
                return local[v];
            };
            for (glm::uvec3& t : group.triangles) t = {number(t.x), number(t.y), number(t.z)};
            if (!vertices.empty()) {
                group.vertices = rig.subset(vertices);
                group.range = columnsOfBox(frame, box);
                group.listed = std::move(vertices);
            }
            made.range.include(group.range);
            made.actuators.insert(made.actuators.end(), key.begin(), key.end());
        }
        std::sort(made.actuators.begin(), made.actuators.end());
        made.actuators.erase(std::unique(made.actuators.begin(), made.actuators.end()), made.actuators.end());
    }
    return bodies;
}

} // namespace

int RigBody::stepsPerLevel(int levels) const noexcept {
    return std::max(1, static_cast<int>(std::ceil(fullStrokeSteps.front() / (levels - 1))));
}

std::vector<RigBody> bodiesOf(const Rig& rig, const VoxelFrame& frame) {
    std::vector<RigBody> bodies = groupTriangles(rig, frame);
    for (RigBody& b : bodies) {
        if (rig.pathInside() || b.actuators.empty()) continue;
        // A voxel's side between samples: what is thicker than that misses no centre on its way.
        for (const std::uint16_t actuator : b.actuators)
            b.fullStrokeSteps.push_back(longestPath(rig, actuator) / frame.voxelSize);
    }
    return bodies;
}

} // namespace lumorph

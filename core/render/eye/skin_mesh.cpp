#include "core/render/eye/skin_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

constexpr float kLongestEdge = 0.025F; // metres
constexpr int kMostRounds = 8;

enum class Side { top, left, right, back, front };

Side sideOf(const glm::vec3& normal) {
    const glm::vec3 size = glm::abs(normal);
    if (size.y >= size.x && size.y >= size.z) return Side::top;
    if (size.x >= size.z) return normal.x < 0.0F ? Side::left : Side::right;
    return normal.z < 0.0F ? Side::back : Side::front;
}

// The sides hang from the rim: the page goes on over the edge.
glm::vec2 placeOnPage(const glm::vec3& rest, Side side, const Box& box) {
    const float below = box.max.y - rest.y;
    switch (side) {
    case Side::left:
        return {box.min.x - below, rest.z};
    case Side::right:
        return {box.max.x + below, rest.z};
    case Side::back:
        return {rest.x, box.min.z - below};
    case Side::front:
        return {rest.x, box.max.z + below};
    case Side::top:
        break;
    }
    return {rest.x, rest.z};
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edgeOf(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

// A triangle whose edges are cut or not, turned so that one cut edge leads, in the pieces that keep its look.
void addPieces(const glm::uvec3& t, const std::array<std::uint32_t, 3>& middle, std::vector<glm::uvec3>& out) {
    constexpr std::uint32_t kWhole = UINT32_MAX;
    const auto cut = static_cast<int>(std::count_if(middle.begin(), middle.end(), [](auto m) { return m != kWhole; }));
    if (cut == 0) {
        out.push_back(t);
        return;
    }
    if (cut == 3) {
        out.insert(out.end(), {{t.x, middle[0], middle[2]},
                               {middle[0], t.y, middle[1]},
                               {middle[2], middle[1], t.z},
                               {middle[0], middle[1], middle[2]}});
        return;
    }
    // Turned so that edge 0 is cut, and edge 2 is not.
    int turn = 0;
    while (middle[static_cast<std::size_t>(turn)] == kWhole ||
           middle[static_cast<std::size_t>((turn + 2) % 3)] != kWhole)
        ++turn;
    const auto corner = [&](int k) { return t[(k + turn) % 3]; };
    const std::uint32_t first = middle[static_cast<std::size_t>(turn)];
    const std::uint32_t second = middle[static_cast<std::size_t>((turn + 1) % 3)];
    if (second == kWhole) {
        out.insert(out.end(), {{corner(0), first, corner(2)}, {first, corner(1), corner(2)}});
        return;
    }
    out.insert(out.end(), {{first, corner(1), second}, {corner(0), first, second}, {corner(0), second, corner(2)}});
}

} // namespace

// Edges are cut for both of their triangles at once, so that no cracks open.
TriangleMesh SkinMesh::refined(const TriangleMesh& rest, std::vector<Midpoint>& midpoints) {
    TriangleMesh mesh = rest;
    for (int round = 0; round < kMostRounds; ++round) {
        std::map<Edge, std::uint32_t> middles;
        std::vector<glm::uvec3> pieces;
        for (const glm::uvec3& t : mesh.triangles) {
            if (std::max({t.x, t.y, t.z}) >= mesh.positions.size()) return rest; // the shading names the fault
            std::array<std::uint32_t, 3> middle{UINT32_MAX, UINT32_MAX, UINT32_MAX};
            for (int k = 0; k < 3; ++k) {
                const auto [a, b] = edgeOf(t[k], t[(k + 1) % 3]);
                if (!(glm::distance(mesh.positions[a], mesh.positions[b]) > kLongestEdge)) continue;
                const auto [entry, added] =
                    middles.try_emplace({a, b}, static_cast<std::uint32_t>(mesh.positions.size()));
                if (added) {
                    mesh.positions.push_back(0.5F * (mesh.positions[a] + mesh.positions[b]));
                    midpoints.push_back({a, b});
                }
                middle[static_cast<std::size_t>(k)] = entry->second;
            }
            addPieces(t, middle, pieces);
        }
        mesh.triangles = std::move(pieces);
        if (middles.empty()) break;
    }
    return mesh;
}

SkinMesh::SkinMesh(const TriangleMesh& rest)
    : meshVertexCount_(rest.positions.size()), cut_(refined(rest, midpoints_)), shading_(cut_, Angle::degrees(30.0)) {
    split();
}

// A drawn vertex is one of the shading's on one side of the box.
void SkinMesh::split() {
    const Box box = boundingBox(cut_.positions);
    std::map<std::pair<std::uint32_t, Side>, std::uint32_t> numbers;
    for (const glm::uvec3& t : shading_.triangles()) {
        const auto at = [&](int k) { return cut_.positions[shading_.sources()[t[k]]]; };
        const Side side = sideOf(glm::cross(at(1) - at(0), at(2) - at(0)));
        glm::uvec3 drawn(0U);
        for (int k = 0; k < 3; ++k) {
            const auto [entry, added] = numbers.try_emplace({t[k], side}, static_cast<std::uint32_t>(sources_.size()));
            drawn[k] = entry->second;
            if (!added) continue;
            sources_.push_back(t[k]);
            coordinates_.push_back(placeOnPage(at(k), side, box));
            restPositions_.push_back(at(k));
        }
        triangles_.push_back(drawn);
    }
}

std::vector<glm::vec3> SkinMesh::cutPositions(std::span<const glm::vec3> positions) const {
    std::vector<glm::vec3> all(positions.begin(), positions.end());
    all.reserve(positions.size() + midpoints_.size());
    for (const auto& [a, b] : midpoints_) all.push_back(0.5F * (all[a] + all[b]));
    return all;
}

void SkinMesh::shade(std::span<const glm::vec3> cutPositions, std::span<const glm::vec3> soft, float share,
                     std::vector<glm::vec3>& outPositions, std::vector<glm::vec3>& outNormals) const {
    std::vector<ShadedMesh::Vertex> shaded(shading_.sources().size());
    shading_.shade(cutPositions, shaded);
    outPositions.resize(sources_.size());
    outNormals.resize(sources_.size());
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        outPositions[i] = shaded[sources_[i]].position;
        outNormals[i] = shaded[sources_[i]].normal;
        if (!soft.empty()) outNormals[i] = glm::mix(outNormals[i], soft[shading_.sources()[sources_[i]]], share);
    }
}

} // namespace lumorph

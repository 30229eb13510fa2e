#include "app/applications/ice/floe_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "core/scene/material_library.h"

namespace lumorph::ice {
namespace {

using Primitive = Model::Primitive;

constexpr double kBevelWide = 0.0009, kBevelDeep = 0.0006; ///< metres
constexpr double kFoot = 0.0007;                           ///< by which sides draw in down to the foot, metres

constexpr double kCloses = 0.55;      ///< growth at which cells meet
constexpr double kYoungDeep = 0.0030; ///< metres that ice lies lower when it begins: just under the water
constexpr double kShortEdge = 0.0008; ///< metres

/// A floe in the making.
class FloeMesh {
public:
    explicit FloeMesh(const glm::dvec2& middle) : middle_(middle) {}

    /// A cell whose k-th edge is free where `free[k]`; a smaller bevel and a top that is so much lower while it grows.
    void add(const Polygon& outline, const std::vector<bool>& free, double bevel, double lower) {
        lower_ = lower;
        Polygon inner = outline;
        for (std::size_t k = 0; k < outline.size(); ++k)
            if (free[k])
                inner = clipped(inner, insideOf(outline[k], outline[(k + 1) % outline.size()], bevel * kBevelWide));
        if (inner.size() < 3) return;
        addTop(inner);
        for (std::size_t k = 0; k < outline.size(); ++k)
            if (free[k]) addRim(outline[k], outline[(k + 1) % outline.size()], inner, bevel);
    }

    Primitive top, rim;

private:
    void vertex(Primitive& to, const glm::dvec2& place, double height, const glm::dvec3& normal,
                const glm::dvec2& picture) const {
        to.positions.emplace_back(glm::dvec3(place.x - middle_.x, height - lower_, place.y - middle_.y));
        to.normals.emplace_back(normal);
        to.texcoords.emplace_back(picture);
    }

    void addTop(const Polygon& inner) {
        const auto first = static_cast<std::uint32_t>(top.positions.size());
        for (const glm::dvec2& corner : inner) vertex(top, corner, 0.0, {0.0, 1.0, 0.0}, corner);
        // Counterclockwise in x and z is clockwise from above.
        for (std::uint32_t k = 1; k + 1 < inner.size(); ++k)
            top.triangles.emplace_back(first, first + k + 1, first + k);
    }

    /// The bevel of a free edge, and its side down to the foot.
    void addRim(const glm::dvec2& from, const glm::dvec2& to, const Polygon& inner, double bevel) {
        const HalfPlane edge = insideOf(from, to, 0.0);
        const glm::dvec2 nearFrom = nearestOnRim(inner, from), nearTo = nearestOnRim(inner, to);
        const glm::dvec3 out(edge.normal.x, 0.0, edge.normal.y);
        const glm::dvec3 slant = glm::normalize(out + glm::dvec3(0.0, kBevelWide / kBevelDeep, 0.0));
        const double shoulder = -bevel * kBevelDeep;
        addFace({nearFrom, nearTo, to, from}, {0.0, 0.0, shoulder, shoulder}, slant);
        const glm::dvec2 lean = kFoot * edge.normal;
        addFace({from, to, to - lean, from - lean}, {shoulder, shoulder, -kIceThickness, -kIceThickness}, out);
    }

    void addFace(const std::array<glm::dvec2, 4>& places, const std::array<double, 4>& heights,
                 const glm::dvec3& normal) {
        const auto first = static_cast<std::uint32_t>(rim.positions.size());
        for (std::size_t k = 0; k < 4; ++k)
            vertex(rim, places[k], heights[k], normal, {places[k].x + places[k].y, heights[k]});
        rim.triangles.emplace_back(first, first + 1, first + 2);
        rim.triangles.emplace_back(first, first + 2, first + 3);
    }

    glm::dvec2 middle_;
    double lower_ = 0.0; ///< metres
};

/// Which edges of a cell have no ice beyond. One that is too short for a bond is as its neighbours are.
std::vector<bool> freeEdges(const Sheet& sheet, int cell) {
    const Polygon& outline = sheet.cells()[static_cast<std::size_t>(cell)].outline;
    const std::size_t count = outline.size();
    std::vector<bool> free(count);
    for (std::size_t k = 0; k < count; ++k) free[k] = !sheet.isJoined(cell, k);
    for (std::size_t k = 0; k < count; ++k) {
        const bool isShort = glm::distance(outline[k], outline[(k + 1) % count]) < kShortEdge;
        if (isShort && !free[(k + 1) % count] && !free[(k + count - 1) % count]) free[k] = false;
    }
    return free;
}

/// Young ice closes under the surface, as a skin, and then comes up as it gets thicker: cells that met only when they
/// are done would be framed by dark water until then.
Polygon youngOutline(const Polygon& whole, double growth) {
    const double share = std::min(1.0, growth / kCloses);
    if (share <= 0.0 || whole.empty()) return {};
    const glm::dvec2 centre = centreOf(whole);
    Polygon outline = whole;
    for (glm::dvec2& corner : outline) corner = centre + share * (corner - centre);
    return outline;
}

} // namespace

const std::vector<Material>& iceMaterials() {
    static const std::vector<Material> materials = [] {
        Material top = readyMaterial("Ice");
        top.color = {0.97F, 0.99F, 1.0F};
        top.colorTexture.tile = glm::vec2(0.115F);
        top.normalMaps[0].tile = glm::vec2(0.115F);
        top.normalStrength = 0.7F;
        top.refraction = 0.0F;
        top.reflection = 0.06F;
        top.roughness = 0.30F;
        top.emission = {0.45F, 0.62F, 0.75F};
        top.emissionStrength = 0.16F;
        Material rim;
        rim.name = "Rim";
        rim.color = {0.80F, 0.93F, 1.0F};
        rim.roughness = 0.5F;
        rim.emission = {0.35F, 0.75F, 0.95F};
        rim.emissionStrength = 0.30F;
        return std::vector{top, rim};
    }();
    return materials;
}

SceneModel floeModel(const IceCover& ice, const Floe& floe) {
    FloeMesh mesh(floe.centre);
    for (const int k : floe.cells) {
        const double growth = ice.growth(k);
        const Polygon outline = youngOutline(ice.sheet().cells()[static_cast<std::size_t>(k)].outline, growth);
        if (outline.empty()) continue;
        mesh.add(outline, growth < 1.0 ? std::vector(outline.size(), true) : freeEdges(ice.sheet(), k),
                 growth < 1.0 ? 0.3 + 0.7 * (1.0 - growth) : 1.0, (1.0 - growth) * kYoungDeep);
    }
    SceneModel made;
    made.materials = iceMaterials();
    Model::Mesh parts;
    parts.name = "Floe";
    mesh.top.material = 0;
    mesh.rim.material = 1;
    for (Primitive* part : {&mesh.top, &mesh.rim})
        if (!part->triangles.empty()) parts.primitives.push_back(std::move(*part));
    made.model.name = "Floe";
    for (const Material& material : made.materials) made.model.materials.emplace_back().name = material.name;
    made.model.meshes.push_back(std::move(parts));
    Model::Node node;
    node.name = "Floe";
    node.mesh = 0;
    made.model.nodes.push_back(std::move(node));
    made.model.roots = {0};
    return made;
}

} // namespace lumorph::ice

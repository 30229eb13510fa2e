#include "app/applications/ice/floe_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "app/applications/ice/pond_bed.h"
#include "core/scene/material_library.h"

namespace lumorph::ice {
namespace {

using Primitive = Model::Primitive;

constexpr float kRim = 0.5F;                ///< of the field's shape
constexpr float kBevelDeep = 0.0011F;       ///< by which the top bends down to its rim, metres
constexpr float kHollow = 0.0011F;          ///< depth of ice that is about to be gone, metres
constexpr double kBulge = 0.0003;           ///< by which the shoulder stands out, metres
constexpr float kShoulder = 0.0009F;        ///< metres under the rim's edge
constexpr double kFoot = 0.0007;            ///< by which sides draw in down to the foot, metres
constexpr int kBlock = 16, kLeastBlock = 4; ///< squares of level ice that are drawn as one, along a side
constexpr double kCrackWide = 0.0004;       ///< of its dark half, metres
constexpr double kCrackRim = 0.00035;       ///< of its bright rim, metres
constexpr float kDeepInIce = 0.80F;         ///< of the shape: an edge there is a crack, no rim
constexpr double kOverTop = 0.00006;        ///< of what is drawn on the top, metres
constexpr double kDetail = 0.115;           ///< metres that one repeat of the fine normals covers
constexpr std::uint32_t kNone = 0xffffffff;

float heightOf(float shape, float thickness, float lower) {
    const float off = 1.0F - std::clamp((shape - kRim) / 0.45F, -0.1F, 1.0F);
    return -lower - kHollow * (1.0F - thickness) - kBevelDeep * off * off;
}

/// The mesh of a field, by marching squares.
class FloeMesh {
public:
    FloeMesh(const FloeField& field, const glm::dvec2& middle) : field_(field), middle_(middle) {
        heights_.resize(field.shape.size());
        for (std::size_t k = 0; k < heights_.size(); ++k)
            heights_[k] = heightOf(field.shape[k], field.thickness[k], field.lower[k]);
        inner_.assign(heights_.size(), kNone);
        for (auto& edges : crossings_) edges.assign(heights_.size(), kNone);
        for (auto& edges : walls_) edges.assign(heights_.size(), kNone);
        for (int j = 0; j + 1 < field.size.y; j += kBlock)
            for (int i = 0; i + 1 < field.size.x; i += kBlock) addBlock(i, j, kBlock);
    }

    Primitive top, rim;

private:
    struct Corner {
        std::uint32_t vertex; ///< of the top
        std::uint32_t wall;   ///< first of three of the rim; kNone: it is inside
        bool leaves = false;  ///< the outline of the square goes out of the ice here
    };

    void addBlock(int i, int j, int side) {
        const int right = std::min(i + side, field_.size.x - 1), far = std::min(j + side, field_.size.y - 1);
        if (right <= i || far <= j) return;
        if (isLevel(i, j, right, far)) return addLevel(i, j, right, far);
        if (side > kLeastBlock) {
            for (const int z : {j, j + side / 2})
                for (const int x : {i, i + side / 2}) addBlock(x, z, side / 2);
            return;
        }
        for (int z = j; z < far; ++z)
            for (int x = i; x < right; ++x) addSquare(x, z);
    }

    [[nodiscard]] bool isLevel(int left, int near, int right, int far) const {
        if (right - left < 2 || far - near < 2) return false;
        const float height = heights_[field_.at(left, near)];
        for (int j = near; j <= far; ++j)
            for (int i = left; i <= right; ++i) {
                const std::size_t k = field_.at(i, j);
                if (field_.shape[k] < 0.95F || std::abs(heights_[k] - height) > 2e-6F) return false;
            }
        return true;
    }

    /// A triangle fan about the middle with every vertex of the block's rim, so that neighbours share their vertices.
    void addLevel(int left, int near, int right, int far) {
        const std::uint32_t centre = vertexAt((left + right) / 2, (near + far) / 2);
        std::vector<std::uint32_t> around;
        for (int i = left; i < right; ++i) around.push_back(vertexAt(i, near));
        for (int j = near; j < far; ++j) around.push_back(vertexAt(right, j));
        for (int i = right; i > left; --i) around.push_back(vertexAt(i, far));
        for (int j = far; j > near; --j) around.push_back(vertexAt(left, j));
        for (std::size_t k = 0; k < around.size(); ++k)
            top.triangles.emplace_back(centre, around[(k + 1) % around.size()], around[k]);
    }

    void addSquare(int i, int j) {
        static constexpr std::array<glm::ivec2, 4> kAround{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        std::vector<Corner>& corners = corners_;
        corners.clear();
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::ivec2 a = glm::ivec2(i, j) + kAround[k], b = glm::ivec2(i, j) + kAround[(k + 1) % 4];
            const bool isIn = isIce(a);
            if (isIn) corners.push_back({vertexAt(a.x, a.y), kNone});
            if (isIn != isIce(b)) corners.push_back(crossing(a, b, isIn));
        }
        // Counterclockwise in x and z is clockwise from above.
        for (std::size_t k = 1; k + 1 < corners.size(); ++k)
            top.triangles.emplace_back(corners[0].vertex, corners[k + 1].vertex, corners[k].vertex);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Corner& next = corners[(k + 1) % corners.size()];
            if (corners[k].leaves && next.wall != kNone) addWall(corners[k].wall, next.wall);
        }
    }

    [[nodiscard]] bool isIce(const glm::ivec2& at) const { return field_.shape[field_.at(at.x, at.y)] >= kRim; }

    std::uint32_t add(Primitive& to, const glm::dvec2& place, double height, const glm::dvec3& normal,
                      const glm::dvec2& picture) const {
        to.positions.emplace_back(glm::dvec3(place.x - middle_.x, height, place.y - middle_.y));
        to.normals.emplace_back(normal);
        to.texcoords.emplace_back(picture);
        return static_cast<std::uint32_t>(to.positions.size() - 1);
    }

    static glm::dvec2 pictured(const glm::dvec2& home) { return 0.5 + 0.5 * home / kPondHalf; }

    [[nodiscard]] glm::dvec2 grows(const std::vector<float>& values, int i, int j) const {
        const int left = std::max(i - 1, 0), right = std::min(i + 1, field_.size.x - 1);
        const int near = std::max(j - 1, 0), far = std::min(j + 1, field_.size.y - 1);
        return glm::dvec2(static_cast<double>(values[field_.at(right, j)] - values[field_.at(left, j)]) /
                              std::max(right - left, 1),
                          static_cast<double>(values[field_.at(i, far)] - values[field_.at(i, near)]) /
                              std::max(far - near, 1)) /
               FloeField::kStep;
    }

    std::uint32_t vertexAt(int i, int j) {
        std::uint32_t& vertex = inner_[field_.at(i, j)];
        if (vertex != kNone) return vertex;
        const glm::dvec2 slope = grows(heights_, i, j), place = field_.place(i, j);
        return vertex = add(top, place, static_cast<double>(heights_[field_.at(i, j)]),
                            glm::normalize(glm::dvec3(-slope.x, 1.0, -slope.y)), pictured(place));
    }

    /// Where the rim passes between two samples.
    Corner crossing(const glm::ivec2& a, const glm::ivec2& b, bool leaves) {
        const glm::ivec2 first = glm::min(a, b), last = glm::max(a, b);
        const auto axis = static_cast<std::size_t>(first.x == last.x);
        const std::size_t k = field_.at(first.x, first.y), next = field_.at(last.x, last.y);
        std::uint32_t &vertex = crossings_[axis][k], &wall = walls_[axis][k];
        if (vertex == kNone) {
            const double share = static_cast<double>((kRim - field_.shape[k]) / (field_.shape[next] - field_.shape[k]));
            const auto between = [&](const auto& p, const auto& q) { return p + share * (q - p); };
            const glm::dvec2 place = between(field_.place(first.x, first.y), field_.place(last.x, last.y));
            const glm::dvec2 in = between(grows(field_.shape, first.x, first.y), grows(field_.shape, last.x, last.y));
            const glm::dvec2 out = -in / std::max(glm::length(in), 1e-9);
            const double height = between(static_cast<double>(heights_[k]), static_cast<double>(heights_[next]));
            vertex = add(top, place, height, glm::normalize(glm::dvec3(out.x, 0.9, out.y)), pictured(place));
            wall = addWallCorner(place, out, height);
        }
        return {vertex, wall, leaves};
    }

    std::uint32_t addWallCorner(const glm::dvec2& place, const glm::dvec2& out, double height) {
        const double along = (place.x + place.y) / 0.02;
        const glm::dvec3 level(out.x, 0.0, out.y);
        const double shoulder = height - static_cast<double>(kShoulder);
        // Off the picture's rims, which repeat.
        const auto depth = [&](double y) { return 0.03 + 0.94 * (height - y) / (height + kIceThickness); };
        const std::uint32_t first =
            add(rim, place, height, glm::normalize(level + glm::dvec3(0.0, 0.9, 0.0)), {along, depth(height)});
        add(rim, place + kBulge * out, shoulder, level, {along, depth(shoulder)});
        add(rim, place - kFoot * out, -kIceThickness, glm::normalize(level - glm::dvec3(0.0, 0.15, 0.0)),
            {along, depth(-kIceThickness)});
        return first;
    }

    void addWall(std::uint32_t from, std::uint32_t to) {
        for (std::uint32_t k = 0; k < 2; ++k) {
            rim.triangles.emplace_back(from + k, to + k, to + k + 1);
            rim.triangles.emplace_back(from + k, to + k + 1, from + k + 1);
        }
    }

    const FloeField& field_;
    glm::dvec2 middle_;
    std::vector<float> heights_;
    std::vector<std::uint32_t> inner_;                            ///< vertices by samples
    std::array<std::vector<std::uint32_t>, 2> crossings_, walls_; ///< by the edges from samples along x and z
    std::vector<Corner> corners_;
};

/// A strip on the top beside a straight line, from `near` to `far` metres on its right.
void addStrip(Primitive& to, const std::array<glm::dvec3, 2>& line, const glm::dvec3& right, double near, double far) {
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    for (const glm::dvec3& end : line)
        for (const double aside : {near, far}) {
            to.positions.emplace_back(end + aside * right);
            to.normals.emplace_back(0.0F, 1.0F, 0.0F);
            to.texcoords.emplace_back(0.0F);
        }
    to.triangles.emplace_back(first, first + 2, first + 1);
    to.triangles.emplace_back(first + 1, first + 2, first + 3);
}

/// Both sides of what has cracked and still hangs together elsewhere: a dark gap with bright rims.
void addCracks(const IceCover& ice, const Floe& floe, const FloeField& field, Primitive& dark, Primitive& bright) {
    for (const int cell : floe.cells) {
        const Polygon& outline = ice.sheet().cells()[static_cast<std::size_t>(cell)].outline;
        for (std::size_t k = 0; k < outline.size(); ++k) {
            const glm::dvec2 &from = outline[k], &to = outline[(k + 1) % outline.size()];
            const double length = glm::distance(from, to);
            if (length < 1e-4 || ice.sheet().isJoined(cell, k)) continue;
            if (field.between(field.shape, 0.5 * (from + to)) < kDeepInIce) continue;
            const glm::dvec2 along = (to - from) / length;
            const auto on = [&](const glm::dvec2& home) {
                return glm::dvec3(home.x - floe.centre.x, topAt(field, home) + kOverTop, home.y - floe.centre.y);
            };
            const glm::dvec3 out(along.y, 0.0, -along.x);
            addStrip(dark, {on(from), on(to)}, out, -0.3 * kCrackWide, kCrackWide);
            addStrip(bright, {on(from), on(to)}, out, -0.3 * kCrackWide - kCrackRim, -0.3 * kCrackWide);
        }
    }
}

Material crackMaterial(const char* name, const glm::vec3& color, float shines) {
    Material material;
    material.name = name;
    material.color = material.emission = color;
    material.emissionStrength = shines;
    return material;
}

} // namespace

double topAt(const FloeField& field, const glm::dvec2& home) noexcept {
    return static_cast<double>(heightOf(field.between(field.shape, home), field.between(field.thickness, home),
                                        field.between(field.lower, home)));
}

const std::vector<Material>& iceMaterials() {
    static const std::vector<Material> materials = [] {
        Material top = readyMaterial("Ice");
        top.color = glm::vec3(1.0F);
        top.colorTexture = {};
        top.colorTexture.image = kSheetPicture;
        top.colorTexture.tile = glm::vec2(1.0F);
        top.normalMaps[0].tile = glm::vec2(kDetail / (2.0 * kPondHalf));
        top.normalStrength = 0.45F;
        top.refraction = 0.0F;
        top.reflection = 0.05F;
        top.roughness = 0.34F;
        top.emission = {0.45F, 0.62F, 0.75F};
        top.emissionStrength = 0.08F;
        Material rim;
        rim.name = "Rim";
        rim.color = glm::vec3(1.0F);
        rim.colorTexture.image = kRimPicture;
        rim.colorTexture.tile = glm::vec2(1.0F);
        rim.roughness = 0.40F;
        rim.emission = {0.20F, 0.60F, 0.80F};
        rim.emissionStrength = 0.16F;
        return std::vector{top, rim, crackMaterial("Crack", {0.14F, 0.42F, 0.55F}, 0.04F),
                           crackMaterial("Crack's rim", {0.93F, 0.99F, 1.0F}, 0.10F)};
    }();
    return materials;
}

SceneModel floeModel(const IceCover& ice, const Floe& floe, const FloeField& field) {
    FloeMesh mesh(field, floe.centre);
    Primitive dark, bright;
    if (!ice.freezing()) addCracks(ice, floe, field, dark, bright);
    SceneModel made;
    made.materials = iceMaterials();
    Model::Mesh parts;
    parts.name = "Floe";
    int material = 0;
    for (Primitive* part : {&mesh.top, &mesh.rim, &dark, &bright}) {
        part->material = material++;
        if (!part->triangles.empty()) parts.primitives.push_back(std::move(*part));
    }
    made.model.name = "Floe";
    for (const Material& of : made.materials) made.model.materials.emplace_back().name = of.name;
    made.model.meshes.push_back(std::move(parts));
    Model::Node node;
    node.name = "Floe";
    node.mesh = 0;
    made.model.nodes.push_back(std::move(node));
    made.model.roots = {0};
    return made;
}

} // namespace lumorph::ice

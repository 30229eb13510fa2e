#include "app/applications/labyrinth/board_model.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/scene/material_library.h"

namespace lumorph::labyrinth {
namespace {

constexpr std::size_t kDepth = 5; ///< material below the holes, after those of the kinds of blocks
constexpr std::size_t kMiddleFloor = 6, kHighFloor = 7;
/// sRGB. A raised flap's wall meets the light from above so aslant that it cannot be made brighter than this: on a
/// white floor it would stand out as a grey wedge.
constexpr glm::vec3 kBrightestFloor{0.70F, 0.76F, 0.80F};
constexpr int kMiddle = 3, kHigh = 6; ///< from so many steps a floor is one of these
constexpr double kBevel = 0.0007;     ///< at the upper edges of walls, metres

using Primitive = Model::Primitive;

glm::vec3 at(const glm::dvec2& place, double y) { return {glm::dvec3(place.x, y, place.y)}; }

/// A flat quadrilateral whose corners go round counterclockwise, seen from outside.
void addFace(Primitive& primitive, const std::array<glm::vec3, 4>& corners) {
    const glm::vec3 normal = glm::cross(corners[2] - corners[0], corners[3] - corners[1]);
    if (glm::length(normal) < 1e-12F) return;
    const glm::vec3 unit = glm::normalize(normal);
    const auto first = static_cast<std::uint32_t>(primitive.positions.size());
    for (const glm::vec3& corner : corners) {
        primitive.positions.push_back(corner);
        primitive.normals.push_back(unit);
        // From above on what lies, from the side on what stands.
        primitive.texcoords.push_back(std::abs(unit.y) > 0.5F   ? glm::vec2(corner.x, corner.z)
                                      : std::abs(unit.x) > 0.5F ? glm::vec2(corner.z, -corner.y)
                                                                : glm::vec2(corner.x, -corner.y));
    }
    primitive.triangles.emplace_back(first, first + 1, first + 2);
    primitive.triangles.emplace_back(first, first + 2, first + 3);
}

/// The block's outline moved inwards; of rectangles alone.
std::array<glm::dvec2, 4> inset(const std::array<glm::dvec2, 4>& outline, double by) {
    const glm::dvec2 centre = 0.25 * (outline[0] + outline[1] + outline[2] + outline[3]);
    std::array<glm::dvec2, 4> inner = outline;
    for (glm::dvec2& corner : inner)
        for (int axis = 0; axis < 2; ++axis) corner[axis] -= std::copysign(by, corner[axis] - centre[axis]);
    return inner;
}

void addBlock(Primitive& primitive, const Block& block) {
    const bool wall = block.kind == Block::Kind::wall;
    const double bevel = wall ? kBevel : 0.0;
    const std::array<glm::dvec2, 4> upper = wall ? inset(block.outline, bevel) : block.outline;
    std::array<glm::vec3, 4> top{};
    for (std::size_t k = 0; k < 4; ++k) top[k] = at(upper[3 - k], block.tops[3 - k]);
    addFace(primitive, top);
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t n = (k + 1) % 4;
        const glm::vec3 low = at(block.outline[k], block.tops[k] - bevel);
        const glm::vec3 next = at(block.outline[n], block.tops[n] - bevel);
        addFace(primitive, {at(block.outline[n], block.bottom), at(block.outline[k], block.bottom), low, next});
        if (wall) addFace(primitive, {next, low, at(upper[k], block.tops[k]), at(upper[n], block.tops[n])});
    }
}

} // namespace

std::vector<Material> boardMaterials(const Level& level) {
    Material floor = readyMaterial(level.floorMaterial);
    floor.color = glm::min(floor.color, kBrightestFloor);
    Material wall = readyMaterial(level.wallMaterial);
    wall.color *= glm::vec3(0.98F, 0.93F, 0.86F);
    wall.colorTexture.tile *= 0.6F;
    wall.normalMaps[0].tile *= 0.6F;
    Material slope = floor;
    slope.name = "Slope";
    slope.color *= glm::vec3(1.0F, 0.86F, 0.62F);
    Material deck = readyMaterial("Wood");
    deck.name = "Deck";
    deck.color = {0.86F, 0.52F, 0.34F};
    deck.colorTexture.tile *= 0.5F;
    Material rail = deck;
    rail.name = "Rail";
    rail.color = {0.62F, 0.30F, 0.20F};
    Material depth;
    depth.name = "Depth";
    depth.color = glm::vec3(0.015F);
    depth.roughness = 1.0F;
    // The higher, the warmer: a glance tells terraces apart.
    Material low = floor, high = floor;
    const bool terraces =
        std::ranges::any_of(level.cells, [](const LevelCell& cell) { return cell.height >= kMiddle; });
    if (terraces) low.color *= glm::vec3(0.84F, 0.92F, 1.0F);
    high.color *= glm::vec3(1.0F, 0.90F, 0.66F);
    low.name = "Low floor";
    high.name = "High floor";
    return {low, wall, slope, deck, rail, depth, floor, high};
}

namespace {

std::size_t materialOf(const Level& level, const Block& block) {
    if (block.kind != Block::Kind::floor) return static_cast<std::size_t>(block.kind);
    const auto steps = std::lround(block.tops[0] / level.step);
    return steps >= kHigh ? kHighFloor : steps >= kMiddle ? kMiddleFloor : static_cast<std::size_t>(block.kind);
}

} // namespace

SceneModel boardModel(const Level& level, const std::vector<Block>& blocks) {
    SceneModel made;
    made.materials = boardMaterials(level);
    Model::Mesh mesh;
    mesh.primitives.resize(made.materials.size());
    for (std::size_t k = 0; k < mesh.primitives.size(); ++k) mesh.primitives[k].material = static_cast<int>(k);
    for (const Block& block : blocks) addBlock(mesh.primitives[materialOf(level, block)], block);
    const glm::dvec2 half = 0.5 * level.cell * glm::dvec2(level.columns, level.rows) - 1e-4;
    addFace(mesh.primitives[kDepth],
            {at({-half.x, half.y}, kGround), at(half, kGround), at({half.x, -half.y}, kGround), at(-half, kGround)});
    Model& model = made.model;
    model.name = level.name;
    for (const Material& material : made.materials) model.materials.emplace_back().name = material.name;
    std::erase_if(mesh.primitives, [](const Primitive& primitive) { return primitive.triangles.empty(); });
    model.meshes.push_back(std::move(mesh));
    Model::Node node;
    node.name = level.name;
    node.mesh = 0;
    model.nodes.push_back(std::move(node));
    model.roots = {0};
    return made;
}

} // namespace lumorph::labyrinth

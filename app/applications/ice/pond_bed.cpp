#include "app/applications/ice/pond_bed.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/ice/fracture.h"
#include "core/scene/material_library.h"

namespace lumorph::ice {
namespace {

using Primitive = Model::Primitive;

constexpr int kShoreCorners = 48;
constexpr glm::dvec2 kShoreHalf{0.0965, 0.0665};
constexpr double kRound = 0.58;     ///< exponent of the superellipse: 1 is an ellipse, 0 a rectangle
constexpr int kColumnsAround = 192; ///< columns of the bank
constexpr std::uint64_t kSeed = 20;
enum BedMaterial : std::uint8_t { kGround, kSnow, kPebble, kDarkPebble, kStone, kReed, kCattail, kEarth, kMaterials };

glm::dvec2 shoreAt(double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return kShoreHalf *
           glm::dvec2(std::copysign(std::pow(std::abs(c), kRound), c), std::copysign(std::pow(std::abs(s), kRound), s));
}

/// Where a ray from the middle through a place leaves the rectangle.
glm::dvec2 rimBehind(const glm::dvec2& place) {
    const glm::dvec2 share = glm::abs(place) / kPondHalf;
    return place / std::max(share.x, share.y);
}

std::uint32_t addVertex(Primitive& to, const glm::dvec3& place, const glm::dvec3& normal) {
    to.positions.emplace_back(place);
    to.normals.emplace_back(glm::normalize(normal));
    to.texcoords.emplace_back(place.x, place.z);
    return static_cast<std::uint32_t>(to.positions.size() - 1);
}

/// A grid of vertices that closes around: columns go round from x to z, rows from the inside out and up.
void addStrips(Primitive& to, const std::vector<std::vector<glm::dvec3>>& rows) {
    const auto columns = static_cast<std::uint32_t>(rows.front().size());
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    const auto at = [&](std::size_t row, std::size_t column) { return rows[row][(column + columns) % columns]; };
    for (std::size_t row = 0; row < rows.size(); ++row)
        for (std::size_t column = 0; column < columns; ++column) {
            const glm::dvec3 along = at(row, column + 1) - at(row, column + columns - 1);
            const glm::dvec3 up = at(std::min(row + 1, rows.size() - 1), column) - at(row > 0 ? row - 1 : 0, column);
            addVertex(to, at(row, column), glm::cross(along, up));
        }
    for (std::uint32_t row = 0; row + 1 < rows.size(); ++row)
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t a = first + row * columns + column, b = first + row * columns + (column + 1) % columns;
            to.triangles.emplace_back(a, b, a + columns);
            to.triangles.emplace_back(b, b + columns, a + columns);
        }
}

double bumps(const glm::dvec2& place) {
    return std::sin(140.0 * place.x + 2.0) * std::sin(170.0 * place.y + 0.7) +
           0.5 * std::sin(330.0 * place.x - 250.0 * place.y);
}

/// From the ground up the wall, over the drift to the rim, and down outside: nothing is seen through the bank.
void addBanks(Primitive& ground, Primitive& snow, Primitive& earth) {
    struct Knee {
        double outwards; ///< from the bank's line (0) to the rim (1)
        double height;
        double rough; ///< share of the snow's bumps
    };
    constexpr Knee kWall[]{{-0.9, kGroundLevel, 0.0}, {-0.35, 0.006, 0.3}, {0.0, kWaterLevel - 0.003, 0.0}};
    constexpr Knee kDrift[]{{0.0, kWaterLevel - 0.003, 0.0},
                            {0.03, 0.0195, 0.0},
                            {0.14, 0.0221, 0.5},
                            {0.32, 0.0236, 1.0},
                            {0.55, 0.0240, 1.0},
                            {0.8, 0.0230, 0.7},
                            {1.0, 0.0215, 0.3}};
    constexpr Knee kSide[]{{1.0, 0.0215, 0.3}, {1.0, 0.012, 0.0}, {1.0, 0.0, 0.0}};
    const auto rowOf = [](const Knee& knee) {
        std::vector<glm::dvec3> row;
        for (int k = 0; k < kColumnsAround; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / kColumnsAround;
            const glm::dvec2 from = shoreAt(angle), out = rimBehind(from) - from;
            const double wide = std::max(glm::length(out), 0.006);
            const glm::dvec2 at = from + knee.outwards * (knee.outwards < 0.0 ? 0.014 * glm::normalize(out) : out);
            const double rise = knee.rough * (0.0007 * bumps(at) + 0.0016 * std::min(1.0, (wide - 0.006) / 0.012));
            row.emplace_back(at.x, knee.height + rise, at.y);
        }
        return row;
    };
    const auto rowsOf = [&rowOf](std::span<const Knee> knees) {
        std::vector<std::vector<glm::dvec3>> rows;
        for (const Knee& knee : knees) rows.push_back(rowOf(knee));
        return rows;
    };
    const std::vector<std::vector<glm::dvec3>> wall = rowsOf(kWall);
    addStrips(ground, wall);
    addStrips(snow, rowsOf(kDrift));
    addStrips(earth, rowsOf(kSide));
    for (std::size_t k = 0; k < earth.positions.size(); ++k) // upright, and once around
        earth.texcoords[k] = {earth.positions[k].x + earth.positions[k].z, earth.positions[k].y};
    std::vector<std::vector<glm::dvec3>> floor{
        std::vector<glm::dvec3>(kColumnsAround, glm::dvec3(0.0, kGroundLevel, 0.0)), wall.front()};
    const auto first = static_cast<std::uint32_t>(ground.positions.size());
    for (const auto& row : floor)
        for (const glm::dvec3& place : row) addVertex(ground, place, {0.0, 1.0, 0.0});
    for (std::uint32_t k = 0; k < kColumnsAround; ++k)
        ground.triangles.emplace_back(first + k, first + kColumnsAround + (k + 1) % kColumnsAround,
                                      first + kColumnsAround + k);
}

/// A round stone, flatter than wide.
void addStone(Primitive& to, const glm::dvec3& place, double radius, double turn) {
    constexpr std::uint32_t kRows = 5, kColumns = 9;
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    for (std::uint32_t row = 0; row < kRows; ++row)
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            const double up = 0.5 * std::numbers::pi * (1.0 - static_cast<double>(row) / (kRows - 1)) * 1.0;
            const double around = 2.0 * std::numbers::pi * column / kColumns;
            const double wide = 1.0 + 0.25 * std::cos(2.0 * (around + turn));
            const glm::dvec3 out(std::cos(up) * std::cos(around) * wide, 0.62 * std::sin(up),
                                 std::cos(up) * std::sin(around) * wide);
            addVertex(to, place + radius * out, out * glm::dvec3(1.0, 2.0, 1.0) + glm::dvec3(0.0, 1e-3, 0.0));
        }
    for (std::uint32_t row = 0; row + 1 < kRows; ++row)
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            const std::uint32_t a = first + row * kColumns + column,
                                b = first + row * kColumns + (column + 1) % kColumns;
            to.triangles.emplace_back(a, b, a + kColumns);
            to.triangles.emplace_back(b, b + kColumns, a + kColumns);
        }
}

/// A stalk, or what grows at its end: a thin prism from a place to another.
void addStalk(Primitive& to, const glm::dvec3& from, const glm::dvec3& end, double radius, double endRadius) {
    constexpr std::uint32_t kSides = 5;
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    for (const bool upper : {false, true})
        for (std::uint32_t k = 0; k < kSides; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / kSides;
            const glm::dvec3 out(std::cos(angle), upper ? 0.4 : 0.0, std::sin(angle));
            const double wide = upper ? endRadius : radius;
            addVertex(to, (upper ? end : from) + wide * glm::dvec3(out.x, 0.0, out.z), out);
        }
    for (std::uint32_t k = 0; k < kSides; ++k) {
        const std::uint32_t a = first + k, b = first + (k + 1) % kSides;
        to.triangles.emplace_back(a, a + kSides, b);
        to.triangles.emplace_back(b, a + kSides, b + kSides);
    }
    for (std::uint32_t k = 1; k + 1 < kSides; ++k) // its end
        to.triangles.emplace_back(first + kSides, first + kSides + k + 1, first + kSides + k);
}

void addReeds(Primitive& reed, Primitive& cattail, const glm::dvec2& place, int count, std::mt19937_64& random) {
    for (int k = 0; k < count; ++k) {
        const double x = chance(random), z = chance(random);
        const glm::dvec3 foot(place.x + 0.010 * (x - 0.5), 0.0195, place.y + 0.007 * (z - 0.5));
        const double height = 0.012 + 0.012 * chance(random);
        const double leanX = chance(random), leanZ = chance(random);
        const glm::dvec3 end = foot + glm::dvec3(0.007 * (leanX - 0.5), height, 0.006 * (leanZ - 0.4));
        addStalk(reed, foot, end, 0.00035, 0.00025);
        const glm::dvec3 up = glm::normalize(end - foot);
        if (k % 2 == 0) addStalk(cattail, end - 0.0052 * up, end - 0.0008 * up, 0.0009, 0.0009);
    }
}

std::vector<Material> bedMaterials() {
    std::vector<Material> materials(kMaterials);
    const auto pictured = [](const char* ready, const char* name, const glm::vec3& color, float tile) {
        Material material = readyMaterial(ready);
        material.name = name;
        material.color = color;
        material.colorTexture.tile = material.normalMaps[0].tile = glm::vec2(tile);
        return material;
    };
    materials[kGround] = pictured("Stone", "Ground", {0.30F, 0.46F, 0.48F}, 0.05F);
    materials[kPebble] = pictured("Stone", "Pebble", {0.92F, 0.95F, 0.90F}, 0.06F);
    materials[kDarkPebble] = pictured("Stone", "Dark pebble", {0.55F, 0.62F, 0.66F}, 0.06F);
    materials[kStone] = pictured("Stone", "Stone", {0.72F, 0.72F, 0.76F}, 0.05F);
    Material& snow = materials[kSnow];
    snow.name = "Snow";
    snow.color = {0.95F, 0.97F, 1.0F};
    snow.roughness = 1.0F;
    snow.normalMaps[0].image = "resource:materials/paper_normal.png";
    snow.normalMaps[0].tile = glm::vec2(0.03F);
    snow.emission = {0.30F, 0.42F, 0.60F};
    snow.emissionStrength = 0.12F;
    // Light that has come through the ice.
    for (const BedMaterial deep : {kGround, kPebble, kDarkPebble}) {
        materials[deep].emission = {0.10F, 0.42F, 0.50F};
        materials[deep].emissionStrength = 0.10F;
    }
    materials[kEarth] = pictured("Stone", "Frozen earth", {0.86F, 0.84F, 0.84F}, 0.05F);
    materials[kReed].name = "Reed";
    materials[kReed].color = {0.80F, 0.66F, 0.36F};
    materials[kCattail].name = "Cattail";
    materials[kCattail].color = {0.36F, 0.20F, 0.10F};
    return materials;
}

} // namespace

Polygon pondShore() {
    Polygon shore;
    for (int k = 0; k < kShoreCorners; ++k)
        shore.push_back(shoreAt(2.0 * std::numbers::pi * (k + 0.5) / kShoreCorners));
    return shore;
}

SceneModel pondBed(const Polygon& shore) {
    SceneModel made;
    made.materials = bedMaterials();
    Model::Mesh bed;
    bed.name = "Pond";
    bed.primitives.resize(kMaterials);
    for (std::size_t k = 0; k < bed.primitives.size(); ++k) bed.primitives[k].material = static_cast<int>(k);
    addBanks(bed.primitives[kGround], bed.primitives[kSnow], bed.primitives[kEarth]);
    std::mt19937_64 random(kSeed);
    for (const glm::dvec2& site : evenSites(shore, 70, random)) {
        const double radius = 0.0014 + 0.0036 * std::pow(chance(random), 2.0);
        addStone(bed.primitives[chance(random) < 0.45 ? kPebble : kDarkPebble],
                 {0.93 * site.x, kGroundLevel, 0.93 * site.y}, radius, 6.0 * chance(random));
    }
    for (const glm::dvec3& stone : {glm::dvec3(-0.098, 0.0069, -0.064),
                                    {-0.089, 0.0045, -0.0685},
                                    {0.0985, 0.0055, 0.066},
                                    {0.092, 0.0038, 0.0705},
                                    {0.1, 0.0042, -0.062}})
        addStone(bed.primitives[kStone], {stone.x, 0.0205, stone.z}, stone.y, 3.0 * stone.x);
    addReeds(bed.primitives[kReed], bed.primitives[kCattail], {-0.094, 0.052}, 7, random);
    addReeds(bed.primitives[kReed], bed.primitives[kCattail], {-0.083, 0.0615}, 4, random);
    addReeds(bed.primitives[kReed], bed.primitives[kCattail], {0.096, -0.020}, 5, random);
    made.model.name = "Pond";
    for (const Material& material : made.materials) made.model.materials.emplace_back().name = material.name;
    made.model.meshes.push_back(std::move(bed));
    Model::Node node;
    node.name = "Pond";
    node.mesh = 0;
    made.model.nodes.push_back(std::move(node));
    made.model.roots = {0};
    return made;
}

} // namespace lumorph::ice

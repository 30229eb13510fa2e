#include "app/applications/navigation/map_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/palette.h"
#include "app/applications/navigation/shapes.h"
#include "app/applications/navigation/solid.h"
#include "core/scene/material_library.h"

namespace lumorph::navigation {
namespace {

using Primitive = Model::Primitive;
enum LandMaterial : int { kGround, kThings, kWater };

constexpr double kTreeCells = 52.0;                           ///< of trees along the device, when they stand closest
constexpr double kTreeHeight = 0.0034, kTreeRadius = 0.00115; ///< device metres
constexpr double kSymbolsFrom = 1700.0; ///< width of a view from which on houses are drawn larger than they are, metres
constexpr double kLargestSymbol = 2.4;

constexpr int kColumns = ViewGround::kColumns, kRows = ViewGround::kRows;

std::uint32_t cornerOf(int column, int row) { return static_cast<std::uint32_t>(row * kColumns + column); }

glm::vec3 onDevice(const glm::dvec2& point, double y) { return {glm::dvec3(point.x, y, point.y)}; }

/// `placeOf` says where on the palette a corner is.
template <typename PlaceOf>
void addPolygon(Primitive& primitive, std::span<const glm::vec3> corners, const PlaceOf& placeOf) {
    const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const float length = glm::length(normal);
    if (!(length > 1e-14F)) return;
    const auto first = static_cast<std::uint32_t>(primitive.positions.size());
    for (const glm::vec3& corner : corners) {
        primitive.positions.push_back(corner);
        primitive.normals.push_back(normal / length);
        primitive.texcoords.push_back(placeOf(corner));
    }
    for (std::uint32_t k = 2; k < corners.size(); ++k)
        primitive.triangles.emplace_back(first, first + k - 1, first + k);
}

void addFace(Primitive& primitive, std::span<const glm::vec3> corners, Paint paint) {
    const glm::vec2 place = paintPlace(paint);
    addPolygon(primitive, corners, [&](const glm::vec3&) { return place; });
}

void addFace(Primitive& primitive, const Face& face) {
    if (const auto& windows = face.windows)
        return addPolygon(primitive, face.corners, [&](const glm::vec3& corner) {
            const glm::vec3 off = corner - windows->foot;
            return facadePlace(face.paint, glm::dot(off, windows->bays), glm::dot(off, windows->storeys));
        });
    const glm::vec2 place = paintPlace(face.paint, face.shade);
    addPolygon(primitive, face.corners, [&](const glm::vec3&) { return place; });
}

/// The drawn surface: one square of two triangles between neighbouring samples.
Primitive groundOf(const ViewGround& ground, const PictureWindow& window) {
    Primitive primitive;
    primitive.material = kGround;
    const std::size_t samples = static_cast<std::size_t>(kColumns) * kRows;
    primitive.positions.reserve(samples);
    primitive.normals.reserve(samples);
    primitive.texcoords.reserve(samples);
    primitive.triangles.reserve(2 * samples);
    const glm::dvec2 step = 2.0 * kHalf / glm::dvec2(kColumns - 1, kRows - 1);
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i) {
            const glm::dvec2 point = ViewGround::pointAt(i, j);
            primitive.positions.push_back(onDevice(point, ground.lift(static_cast<double>(ground.height(i, j)))));
            const int west = std::max(i - 1, 0), east = std::min(i + 1, kColumns - 1);
            const int north = std::max(j - 1, 0), south = std::min(j + 1, kRows - 1);
            const double alongX = static_cast<double>(ground.height(east, j) - ground.height(west, j)) *
                                  ground.perMetre() / ((east - west) * step.x);
            const double alongZ = static_cast<double>(ground.height(i, south) - ground.height(i, north)) *
                                  ground.perMetre() / ((south - north) * step.y);
            primitive.normals.emplace_back(glm::normalize(glm::dvec3(-alongX, 1.0, -alongZ)));
            primitive.texcoords.emplace_back((ground.view().placeAt(point) - window.corner) / window.side);
        }
    for (int j = 0; j + 1 < kRows; ++j)
        for (int i = 0; i + 1 < kColumns; ++i) {
            primitive.triangles.emplace_back(cornerOf(i, j), cornerOf(i, j + 1), cornerOf(i + 1, j));
            primitive.triangles.emplace_back(cornerOf(i + 1, j), cornerOf(i, j + 1), cornerOf(i + 1, j + 1));
        }
    return primitive;
}

/// Lifted surface of the water at every sample; NaN where none is near.
std::vector<float> waterOf(const Map& map, const ViewGround& ground, double swell) {
    std::vector<float> water;
    if (map.water.empty()) return water;
    water.reserve(static_cast<std::size_t>(kColumns) * kRows);
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i) {
            const double level = map.waterAt(ground.view().placeAt(ViewGround::pointAt(i, j)));
            water.push_back(static_cast<float>(ground.lift(level + swell)));
        }
    return water;
}

Primitive waterSurface(const ViewGround& ground, const std::vector<float>& water) {
    Primitive primitive;
    primitive.material = kWater;
    if (water.empty()) return primitive;
    const auto wet = [&](int i, int j) {
        return static_cast<double>(water[cornerOf(i, j)]) > ground.lift(static_cast<double>(ground.height(i, j)));
    };
    for (int j = 0; j + 1 < kRows; ++j)
        for (int i = 0; i + 1 < kColumns; ++i) {
            const std::array<glm::ivec2, 4> around{{{i, j}, {i, j + 1}, {i + 1, j + 1}, {i + 1, j}}};
            float level = 0.0F;
            int known = 0;
            bool any = false;
            for (const glm::ivec2& c : around) {
                const float here = water[cornerOf(c.x, c.y)];
                any = any || wet(c.x, c.y);
                if (std::isnan(here)) continue;
                level += here;
                ++known;
            }
            if (!any) continue;
            const auto first = static_cast<std::uint32_t>(primitive.positions.size());
            for (const glm::ivec2& c : around) {
                const float here = water[cornerOf(c.x, c.y)];
                const glm::dvec2 point = ViewGround::pointAt(c.x, c.y);
                primitive.positions.push_back(
                    onDevice(point, static_cast<double>(std::isnan(here) ? level / static_cast<float>(known) : here)));
                primitive.normals.emplace_back(0.0F, 1.0F, 0.0F);
                primitive.texcoords.emplace_back(point);
            }
            primitive.triangles.emplace_back(first, first + 1, first + 2);
            primitive.triangles.emplace_back(first, first + 2, first + 3);
        }
    return primitive;
}

/// The four sides of the block, in layers as they lie in the ground, and of the water that is cut.
class Walls {
public:
    Walls(const ViewGround& ground, const std::vector<float>& water, Primitive& primitive)
        : ground_(ground), water_(water), primitive_(primitive) {}

    void add() {
        for (int i = 0; i + 1 < kColumns; ++i) {
            addPiece({i + 1, 0}, {i, 0});
            addPiece({i, kRows - 1}, {i + 1, kRows - 1});
        }
        for (int j = 0; j + 1 < kRows; ++j) {
            addPiece({0, j}, {0, j + 1});
            addPiece({kColumns - 1, j + 1}, {kColumns - 1, j});
        }
    }

private:
    /// From left to right, seen from outside.
    void addPiece(const glm::ivec2& left, const glm::ivec2& right) {
        constexpr struct {
            double depth; ///< below the surface, metres
            Paint paint;
        } kLayers[] = {{0.0012, Paint::earth}, {0.0050, Paint::clay}, {1.0, Paint::rock}};
        const double topLeft = surface(left), topRight = surface(right);
        double aboveLeft = topLeft, aboveRight = topRight;
        for (const auto& layer : kLayers) {
            const double belowLeft = std::max(topLeft - layer.depth, kFloor),
                         belowRight = std::max(topRight - layer.depth, kFloor);
            addQuad(left, right, belowLeft, belowRight, aboveLeft, aboveRight, layer.paint);
            aboveLeft = belowLeft;
            aboveRight = belowRight;
        }
        if (water_.empty()) return;
        const auto waterLeft = static_cast<double>(water_[cornerOf(left.x, left.y)]);
        const auto waterRight = static_cast<double>(water_[cornerOf(right.x, right.y)]);
        if (!(waterLeft > topLeft) && !(waterRight > topRight)) return;
        if (std::isnan(waterLeft) || std::isnan(waterRight)) return;
        addQuad(left, right, topLeft, topRight, std::max(waterLeft, topLeft), std::max(waterRight, topRight),
                Paint::deepWater);
    }
    [[nodiscard]] double surface(const glm::ivec2& at) const {
        return ground_.lift(static_cast<double>(ground_.height(at.x, at.y)));
    }
    void addQuad(const glm::ivec2& left, const glm::ivec2& right, double lowLeft, double lowRight, double highLeft,
                 double highRight, Paint paint) {
        const glm::dvec2 a = ViewGround::pointAt(left.x, left.y), b = ViewGround::pointAt(right.x, right.y);
        const std::array<glm::vec3, 4> quad{onDevice(a, lowLeft), onDevice(b, lowRight), onDevice(b, highRight),
                                            onDevice(a, highLeft)};
        addFace(primitive_, quad, paint);
    }

    const ViewGround& ground_;
    const std::vector<float>& water_;
    Primitive& primitive_;
};

/// From afar fewer houses stand, each the larger: as on a drawn map.
double sizeOf(const Building& building, std::size_t number, double symbol) {
    if (building.landmark) return symbol;
    const double left = 1.0 / (symbol * symbol); // share of the houses that stay
    const glm::ivec2 cell = building.whole ? glm::ivec2(*building.whole) : glm::ivec2(static_cast<int>(number), 3);
    const double chance = chanceOf(cell, 11);
    return symbol * smoothStep(-0.12, 0.0, left - chance);
}

void addBuildings(const Map& map, const ViewGround& ground, Primitive& primitive) {
    const double symbol = std::clamp(ground.view().width / kSymbolsFrom, 1.0, kLargestSymbol);
    const double reach = symbol * 60.0 / ground.view().scale();
    for (std::size_t k = 0; k < map.buildings.size(); ++k) {
        const Building& building = map.buildings[k];
        const glm::dvec2 off = glm::abs(ground.view().pointAt(building.outline.front())) - kHalf;
        if (std::max(off.x, off.y) > reach) continue;
        const double size = building.grounded ? sizeOf(building, k, symbol) : 1.0;
        if (size < 0.05) continue;
        for (const Face& face : cutAtRim(solidOf(building, ground, size))) addFace(primitive, face);
    }
}

glm::vec2 leavesPlace(bool fir, double shade) {
    const Paint paint = fir ? (shade < 0.5 ? Paint::fir : Paint::spruce) : (shade < 0.5 ? Paint::leaf : Paint::moss);
    return paintPlace(paint, static_cast<int>(997.0 * shade));
}

/// A cone for a fir, a lump for a tree with leaves; light as if they were round.
void addTree(Primitive& primitive, const glm::vec3& foot, float size, bool fir, double shade) {
    constexpr int kSides = 5;
    const auto first = static_cast<std::uint32_t>(primitive.positions.size());
    const float height = size * static_cast<float>(fir ? kTreeHeight : 0.8 * kTreeHeight);
    const float radius = size * static_cast<float>(fir ? kTreeRadius : 1.25 * kTreeRadius);
    const glm::vec2 leaves = leavesPlace(fir, shade);
    const auto add = [&](const glm::vec3& at, const glm::vec3& normal) {
        primitive.positions.push_back(foot + at);
        primitive.normals.push_back(glm::normalize(normal));
        primitive.texcoords.push_back(leaves);
    };
    add({0.0F, height, 0.0F}, {0.0F, 1.0F, 0.0F});
    constexpr std::array<glm::vec2, kSides> kRound{
        {{1.0F, 0.0F}, {0.309F, 0.951F}, {-0.809F, 0.588F}, {-0.809F, -0.588F}, {0.309F, -0.951F}}};
    const float belt = fir ? 0.1F * height : 0.55F * height;
    for (const glm::vec2& way : kRound) add({radius * way.x, belt, radius * way.y}, {way.x, 0.55F, way.y});
    if (!fir)
        for (const glm::vec2& way : kRound)
            add({0.35F * radius * way.x, 0.0F, 0.35F * radius * way.y}, {way.x, -0.3F, way.y});
    for (std::uint32_t k = 0; k < kSides; ++k) {
        const std::uint32_t a = first + 1 + k, b = first + 1 + (k + 1) % kSides;
        primitive.triangles.emplace_back(first, b, a);
        if (fir) continue;
        primitive.triangles.emplace_back(a, b, b + kSides);
        primitive.triangles.emplace_back(a, b + kSides, a + kSides);
    }
}

/// Trees stand in a grid of cells of the map, a little off its middle. While one comes closer, those of the next finer
/// grid grow in between.
void addTrees(const Map& map, const ViewGround& ground, Primitive& primitive) {
    if (map.woods.empty()) return;
    const MapView& view = ground.view();
    const double closest = std::log2(view.width / kTreeCells);
    glm::dvec2 min = view.placeAt(-kHalf), max = min;
    for (const glm::dvec2& way : {glm::dvec2(1, -1), {1, 1}, {-1, 1}}) {
        min = glm::min(min, view.placeAt(way * kHalf));
        max = glm::max(max, view.placeAt(way * kHalf));
    }
    constexpr double kRim = 0.0012; // device metres within which none stands, so that none is cut
    for (int octave = static_cast<int>(std::floor(closest)); octave <= static_cast<int>(std::floor(closest)) + 2;
         ++octave) {
        const double grown = smoothStep(-0.55, 0.0, octave - closest);
        if (grown < 0.05) continue;
        const double cell = std::exp2(octave);
        const glm::ivec2 from(glm::floor(min / cell)), to(glm::floor(max / cell));
        for (int j = from.y; j <= to.y; ++j)
            for (int i = from.x; i <= to.x; ++i) {
                const auto seed = static_cast<std::uint64_t>(octave) + 64;
                const double chance = chanceOf({i, j}, seed);
                const glm::dvec2 place = cell * (glm::dvec2(i, j) + glm::dvec2(chance, chanceOf({j, i}, seed + 1)));
                const glm::dvec2 point = view.pointAt(place);
                const glm::dvec2 inside = kHalf - glm::abs(point);
                if (std::min(inside.x, inside.y) < kRim) continue;
                const double woods = map.woodsAt(place);
                const double shade = chanceOf({i, j}, seed + 2);
                if (woods <= 0.02 || woods < shade) continue;
                const bool fir = noiseAt(place / 260.0, 91) + 0.6 * (chance - 0.5) > -0.1;
                addTree(primitive, onDevice(point, ground.surfaceAt(point) - 0.0002),
                        static_cast<float>(grown * (0.75 + 0.45 * shade)), fir, chance);
            }
    }
}

/// Those of gardens and avenues are as large as they are, and left out where they would be specks.
void addSolitaryTrees(const Map& map, const ViewGround& ground, Primitive& primitive) {
    constexpr double kRim = 0.0008, kSmallestTree = 0.16, kLargestTree = 1.1; // the latter of a tree of the woods
    const MapView& view = ground.view();
    for (std::size_t k = 0; k < map.trees.size(); ++k) {
        const Tree& tree = map.trees[k];
        const glm::dvec2 point = view.pointAt(tree.at);
        const glm::dvec2 inside = kHalf - glm::abs(point);
        if (std::min(inside.x, inside.y) < kRim) continue;
        const double size = std::min(kLargestTree, tree.height / view.scale() / kTreeHeight);
        if (size < kSmallestTree) continue;
        addTree(primitive, onDevice(point, ground.surfaceAt(point) - 0.0002), static_cast<float>(size), false,
                chanceOf({static_cast<int>(k), 5}, 17));
    }
}

Material thingsMaterial() {
    Material material;
    material.name = "Things";
    material.color = glm::vec3(1.0F);
    material.colorTexture.image = kPaletteImage;
    material.colorTexture.tile = glm::vec2(1.0F);
    material.roughness = 0.8F;
    return material;
}

Material groundMaterial(double exaggeration) {
    Material material = thingsMaterial();
    material.name = "Ground";
    material.colorTexture.image = kGroundImage;
    material.normalMaps[0].image = kReliefImage;
    material.normalMaps[0].tile = glm::vec2(1.0F);
    material.normalStrength = static_cast<float>(std::clamp(exaggeration, 0.0, 4.0));
    material.roughness = 0.95F;
    return material;
}

} // namespace

Material waterMaterial() {
    Material material = readyMaterial("Water");
    material.color = {0.10F, 0.36F, 0.46F};
    material.refraction = 0.0F;
    material.reflection = 0.22F;
    material.normalStrength = 0.18F;
    for (SceneTexture& map : material.normalMaps) {
        map.tile *= 0.3F;
        map.velocity *= 0.25F;
    }
    return material;
}

SceneModel landModel(const Map& map, const ViewGround& ground, const PictureWindow& window, double swell) {
    SceneModel made;
    made.materials = {groundMaterial(ground.exaggeration()), thingsMaterial(), waterMaterial()};
    const std::vector<float> water = waterOf(map, ground, swell);
    Primitive things;
    things.material = kThings;
    Walls(ground, water, things).add();
    addBuildings(map, ground, things);
    addTrees(map, ground, things);
    addSolitaryTrees(map, ground, things);
    Model::Mesh mesh;
    mesh.primitives.push_back(groundOf(ground, window));
    mesh.primitives.push_back(std::move(things));
    Primitive surface = waterSurface(ground, water);
    if (!surface.triangles.empty()) mesh.primitives.push_back(std::move(surface));
    Model& model = made.model;
    model.name = map.title;
    for (const Material& material : made.materials) model.materials.emplace_back().name = material.name;
    model.meshes.push_back(std::move(mesh));
    Model::Node node;
    node.name = map.title;
    node.mesh = 0;
    model.nodes.push_back(std::move(node));
    model.roots = {0};
    return made;
}

} // namespace lumorph::navigation

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/gtc/matrix_transform.hpp>

#include "core/base/error.h"
#include "core/rig/templates/bundled_rigs.h"

namespace lumorph {
namespace {

// A ribbon along x, metres.
constexpr int kRings = 41;
constexpr double kRibbonLength = 0.2;
constexpr double kRibbonWidth = 0.04;
constexpr double kRibbonThickness = 0.006;
constexpr double kLink = 0.05;
constexpr double kBlend = 0.015; ///< on either side of a joint

/// Joint and share of the later joint at a place along the ribbon.
std::pair<int, double> jointsAt(double way) {
    for (int joint = 1; joint <= 3; ++joint) {
        const double from = joint * kLink - kBlend;
        if (way < from) return {joint - 1, 0.0};
        const double t = (way - from) / (2.0 * kBlend);
        if (t < 1.0) return {joint - 1, t * t * (3.0 - 2.0 * t)};
    }
    return {3, 0.0};
}

void addRing(int ring, RigParts& parts) {
    const double way = kRibbonLength * ring / (kRings - 1);
    const auto [joint, share] = jointsAt(way);
    for (const auto& [y, z] : {std::pair(0.0, 0.5), std::pair(0.0, -0.5), std::pair(1.0, -0.5), std::pair(1.0, 0.5)}) {
        parts.restMesh.positions.emplace_back(way - 0.5 * kRibbonLength, y * kRibbonThickness, z * kRibbonWidth);
        parts.skeleton->vertexJoints.emplace_back(joint, share > 0.0 ? joint + 1 : 0, 0, 0);
        const auto later = static_cast<float>(share);
        parts.skeleton->vertexWeights.emplace_back(1.0F - later, later, 0.0F, 0.0F);
    }
}

constexpr int kGrid = 25;
constexpr double kSlab = 0.12;
constexpr double kSlabHeight = 0.012;

struct Hill {
    const char* name;
    double x;
    double z;
    double widthX;
    double widthZ;
    double height;
};

/// Zero at the slab's border, so that its sides stay where they are.
double heightOf(const Hill& hill, double x, double z) {
    const auto fade = [](double v) { return std::clamp((0.5 * kSlab - std::abs(v)) / 0.015, 0.0, 1.0); };
    const double dx = (x - hill.x) / hill.widthX;
    const double dz = (z - hill.z) / hill.widthZ;
    return hill.height * std::exp(-dx * dx - dz * dz) * fade(x) * fade(z);
}

/// A slab with a grid of points on its top, `columns` x `rows` of them, row by row.
TriangleMesh slab(int columns, int rows, double width, double depth, double thickness) {
    TriangleMesh mesh;
    const auto at = [](double size, int k, int count) { return size * (static_cast<double>(k) / (count - 1) - 0.5); };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            mesh.positions.emplace_back(at(width, i, columns), thickness, at(depth, j, rows));
    const auto top = [&](int i, int j) { return static_cast<std::uint32_t>(j * columns + i); };
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.emplace_back(a, b, c);
        mesh.triangles.emplace_back(a, c, d);
    };
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i + 1 < columns; ++i) quad(top(i, j + 1), top(i + 1, j + 1), top(i + 1, j), top(i, j));
    std::vector<std::uint32_t> rim;
    const int lastX = columns - 1;
    const int lastZ = rows - 1;
    for (int k = 0; k < lastX; ++k) rim.push_back(top(k, lastZ));
    for (int k = 0; k < lastZ; ++k) rim.push_back(top(lastX, lastZ - k));
    for (int k = 0; k < lastX; ++k) rim.push_back(top(lastX - k, 0));
    for (int k = 0; k < lastZ; ++k) rim.push_back(top(0, k));
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const std::uint32_t v : rim) mesh.positions.push_back(mesh.positions[v] * glm::vec3(1.0F, 0.0F, 1.0F));
    mesh.positions.emplace_back(0.0F, 0.0F, 0.0F);
    const auto centre = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    for (std::uint32_t k = 0; k < rim.size(); ++k) {
        const auto next = static_cast<std::uint32_t>((k + 1) % rim.size());
        quad(first + k, first + next, rim[next], rim[k]);
        mesh.triangles.emplace_back(first + next, first + k, centre);
    }
    return mesh;
}

/// An actuator that lifts the slab's top by `height(x, z)` metres.
template <typename Height>
Actuator lift(const std::string& name, const TriangleMesh& mesh, std::uint32_t top, int channel, const Height& height) {
    Actuator actuator;
    actuator.name = name;
    MorphTarget morph{name, {1.0F}, {{}}};
    for (std::uint32_t v = 0; v < top; ++v) {
        const glm::vec3& p = mesh.positions[v];
        const auto lifted = static_cast<float>(height(p.x, p.z));
        if (lifted < 1e-5F) continue;
        actuator.influences.push_back({v, 1.0F});
        morph.displacements.front().emplace_back(0.0F, lifted, 0.0F);
    }
    actuator.deformer = std::move(morph);
    actuator.drive.channel = channel;
    return actuator;
}

constexpr int kChamberSteps = 12; ///< of the grid, across a chamber
constexpr int kMaxChambers = 100;

void requireCushion(bool good, const char* parameter, const char* why, const char* remedy) {
    if (!good) throw InvalidInput(std::string("cushion: ") + parameter, why, remedy);
}

void checkCushion(const CushionSize& size) {
    requireCushion(size.columns >= 1 && size.rows >= 1, "columns, rows", "no chamber would be left",
                   "choose 1 or more");
    requireCushion(size.columns * static_cast<long long>(size.rows) <= kMaxChambers, "columns, rows",
                   "so many chambers are too many", "choose at most 100 in all");
    requireCushion(size.width / size.columns >= 1.0 && size.depth / size.rows >= 1.0, "width, depth",
                   "the chambers would vanish", "leave 1 cm or more for each");
    requireCushion(size.height >= 0.1, "height", "the cushion would vanish", "choose 0.1 cm or more");
    requireCushion(size.swell >= 0.1, "swell", "the chambers would not move", "choose 0.1 cm or more");
}

} // namespace

Rig ribbonRig() {
    RigParts parts;
    parts.name = "ribbon";
    parts.skeleton.emplace();
    for (int joint = 0; joint < 4; ++joint) {
        const glm::vec3 step =
            joint == 0 ? glm::vec3(-0.5 * kRibbonLength, 0.5 * kRibbonThickness, 0.0) : glm::vec3(kLink, 0.0F, 0.0F);
        parts.skeleton->joints.push_back({joint - 1, glm::translate(glm::mat4(1.0F), step)});
    }
    for (int ring = 0; ring < kRings; ++ring) addRing(ring, parts);
    auto& triangles = parts.restMesh.triangles;
    for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring)
        for (std::uint32_t k = 0; k < 4; ++k) {
            const std::uint32_t a = 4 * ring + k;
            const std::uint32_t b = 4 * ring + (k + 1) % 4;
            triangles.emplace_back(a, b, b + 4);
            triangles.emplace_back(a, b + 4, a + 4);
        }
    const std::uint32_t end = 4 * (kRings - 1);
    for (const glm::uvec3& t : {glm::uvec3(0, 2, 1), glm::uvec3(0, 3, 2)}) triangles.push_back(t);
    for (const glm::uvec3& t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) triangles.push_back(t + end);
    for (int joint = 1; joint <= 3; ++joint) {
        Actuator actuator;
        actuator.name = "joint " + std::to_string(joint);
        actuator.deformer =
            SkinJoint{joint, SkinJoint::Motion::rotate, {0.0F, 0.0F, 1.0F}, 0.0, Angle::degrees(50.0).inRadians()};
        actuator.drive.channel = joint - 1;
        parts.actuators.push_back(std::move(actuator));
    }
    return Rig(std::move(parts));
}

Rig hillsRig() {
    constexpr std::array kHills{Hill{"left hill", -0.025, 0.012, 0.022, 0.022, 0.03},
                                Hill{"right hill", 0.028, 0.012, 0.02, 0.02, 0.025},
                                Hill{"ridge", 0.0, -0.025, 0.05, 0.012, 0.02}};
    RigParts parts;
    parts.name = "hills";
    parts.restMesh = slab(kGrid, kGrid, kSlab, kSlab, kSlabHeight);
    parts.pathInside = true; // every height only grows, so that each solid holds the ones before
    for (const Hill& hill : kHills)
        parts.actuators.push_back(lift(hill.name, parts.restMesh, kGrid * kGrid,
                                       static_cast<int>(parts.actuators.size()),
                                       [&](double x, double z) { return heightOf(hill, x, z); }));
    return Rig(std::move(parts));
}

Rig cushionRig(const CushionSize& size) {
    checkCushion(size);
    const int columns = size.columns * kChamberSteps + 1;
    const int rows = size.rows * kChamberSteps + 1;
    const double width = 0.01 * size.width;
    const double depth = 0.01 * size.depth;
    RigParts parts;
    parts.name = "cushion";
    parts.restMesh = slab(columns, rows, width, depth, 0.01 * size.height);
    parts.pathInside = true; // as above
    for (int row = 0; row < size.rows; ++row)
        for (int column = 0; column < size.columns; ++column) {
            const auto bump = [](double place, double extent, int chamber, int chambers) {
                const double share = (place / extent + 0.5) * chambers - chamber; // 0 to 1 across the chamber
                const double sine = share > 0.0 && share < 1.0 ? std::sin(std::numbers::pi * share) : 0.0;
                return sine * sine;
            };
            parts.actuators.push_back(lift(
                "chamber " + std::to_string(row + 1) + "." + std::to_string(column + 1), parts.restMesh,
                static_cast<std::uint32_t>(columns * rows), row * size.columns + column, [&](double x, double z) {
                    return 0.01 * size.swell * bump(x, width, column, size.columns) * bump(z, depth, row, size.rows);
                }));
        }
    return Rig(std::move(parts));
}

} // namespace lumorph

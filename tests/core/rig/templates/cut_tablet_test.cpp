#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/geometry/mesh_check.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/voxels/voxel_frame.h"
#include "tests/support/cgal_oracle.h"

namespace lumorph {
namespace {

const Rig& theCutOne() {
    static const Rig rig = cutTabletRig();
    return rig;
}

std::vector<std::vector<double>> randomStates(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<std::vector<double>> states(static_cast<std::size_t>(count), std::vector<double>(6));
    for (auto& state : states)
        for (double& stroke : state) stroke = uniform(random);
    return states;
}

std::vector<std::vector<double>> cornerStates() {
    std::vector<std::vector<double>> states;
    for (int bits = 0; bits < 64; ++bits) {
        states.emplace_back();
        for (int a = 0; a < 6; ++a) states.back().push_back((bits >> a) & 1);
    }
    return states;
}

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

glm::dvec3 crossOf(const std::vector<glm::vec3>& p, const glm::uvec3& t) {
    return glm::cross(glm::dvec3(p[t.y]) - glm::dvec3(p[t.x]), glm::dvec3(p[t.z]) - glm::dvec3(p[t.x]));
}

TEST(CutTablet, HasSixFlapsThatStandUpright) {
    const glm::dvec3 size(boundingBox(theCutOne().restMesh().positions).size());
    EXPECT_NEAR(size.x, 0.21, 1e-6);
    EXPECT_NEAR(size.y, 0.02, 1e-6);
    EXPECT_NEAR(size.z, 0.15, 1e-6);
    EXPECT_NEAR(boundingBox(theCutOne().restMesh().positions).min.y, 0.0, 1e-9);
    std::set<std::string> names;
    std::set<int> channels;
    for (const Actuator& actuator : theCutOne().actuators()) {
        names.insert(actuator.name);
        channels.insert(actuator.drive.channel);
        EXPECT_EQ(actuator.levels, 33);
        const auto& bend = std::get<Bend>(actuator.deformer);
        EXPECT_DOUBLE_EQ(bend.max.inDegrees(), 90.0);
        EXPECT_NEAR(actuator.maxVelocity * bend.max.inDegrees(), 120.0, 1e-9);
    }
    EXPECT_EQ(names, (std::set<std::string>{"corner front left", "corner front right", "corner back left",
                                            "corner back right", "edge front", "edge back"}));
    EXPECT_EQ(channels, (std::set<int>{0, 1, 2, 3, 4, 5}));
    // Front is towards the user (+z), left is -x.
    const auto lifted = deformed(theCutOne(), std::vector<double>{1, 0, 0, 0, 0, 0});
    for (std::size_t v = 0; v < lifted.positions.size(); ++v) {
        if (lifted.positions[v] == theCutOne().restMesh().positions[v]) continue;
        EXPECT_LT(theCutOne().restMesh().positions[v].x, 0.0F);
        EXPECT_GT(theCutOne().restMesh().positions[v].z, 0.0F);
    }
    EXPECT_EQ(theCutOne().actuators()[0].name, "corner front left");
}

TEST(CutTablet, IsOneFineClosedSolid) {
    const MeshReport report = checkMesh(theCutOne().restMesh());
    EXPECT_GE(report.triangles, 5000U);
    EXPECT_EQ(report.components, 1U);
    EXPECT_TRUE(report.solid());
    EXPECT_EQ(report.degenerateTriangles, 0U);
}

// R7
TEST(CutTablet, HasTheFrameOfThePaper) {
    const Box reach = theCutOne().reach();
    EXPECT_GT(reach.size().y, 0.08395F);
    EXPECT_LT(reach.size().y, 0.08445F);
    const VoxelFrame frame = frameOf(reach, 33);
    EXPECT_EQ(frame.dimensions, glm::ivec3(83, 33, 59));
    EXPECT_EQ(frame.voxelCount(), 161'601U);
    EXPECT_NEAR(frame.voxelSize, 0.00253, 0.00003);
}

TEST(CutTablet, ReachIsTightToOnePercent) {
    std::vector<Box> seen(theCutOne().restMesh().positions.size());
    std::vector<glm::vec3> positions(seen.size());
    for (int step = 0; step <= 256; ++step) {
        theCutOne().deform(std::vector<double>(6, step / 256.0), positions);
        for (std::size_t v = 0; v < seen.size(); ++v) seen[v].include(positions[v]);
    }
    for (std::uint32_t v = 0; v < seen.size(); ++v) {
        const glm::vec3 slack =
            glm::max(seen[v].min - theCutOne().reachOf(v).min, theCutOne().reachOf(v).max - seen[v].max);
        const glm::vec3 size = seen[v].size();
        const float largest = std::max({size.x, size.y, size.z});
        for (int axis = 0; axis < 3; ++axis) EXPECT_LE(slack[axis], 0.01F * largest + 1e-6F) << v;
    }
}

// R3, R5: a sound solid in every joint state.
TEST(CutTablet, StaysSoundInManyStatesAndAllCorners) {
    auto states = randomStates(200, 1);
    const auto corners = cornerStates();
    states.insert(states.end(), corners.begin(), corners.end());
    TriangleMesh mesh = theCutOne().restMesh();
    for (const auto& state : states) {
        theCutOne().deform(state, mesh.positions);
        ASSERT_EQ(countSelfIntersections(mesh), 0U);
        ASSERT_GT(signedVolume(mesh), 0.0);
        for (const glm::uvec3& t : mesh.triangles) ASSERT_GT(glm::length(crossOf(mesh.positions, t)), 1e-11);
    }
}

/// How far the sheet has turned at a point, and about what: from the bend alone.
glm::dvec3 sheetNormal(const Bend& bend, const glm::dvec3& rest, double stroke) {
    const double u = glm::dot(rest - glm::dvec3(bend.origin), glm::dvec3(bend.direction));
    const double turned = stroke * bend.max.inRadians() * std::clamp(u / bend.length, 0.0, 1.0);
    return std::cos(turned) * glm::dvec3(0, 1, 0) - std::sin(turned) * glm::dvec3(bend.direction);
}

TEST(CutTablet, NoTriangleOfTheSheetIsTurnedOver) {
    const TriangleMesh& rest = theCutOne().restMesh();
    std::vector<glm::uvec3> top;
    for (const glm::uvec3& t : rest.triangles)
        if (rest.positions[t.x].y > 0.0199F && rest.positions[t.y].y > 0.0199F && rest.positions[t.z].y > 0.0199F)
            top.push_back(t);
    double area = 0.0;
    for (const glm::uvec3& t : top) area += 0.5 * glm::length(crossOf(rest.positions, t));
    EXPECT_NEAR(area, 0.209 * 0.149, 0.0006); // the whole sheet but the slits
    std::vector<glm::vec3> positions(rest.positions.size());
    for (const auto& state : randomStates(50, 2)) {
        theCutOne().deform(state, positions);
        for (const glm::uvec3& t : top) {
            const glm::dvec3 centre = glm::dvec3(rest.positions[t.x] + rest.positions[t.y] + rest.positions[t.z]) / 3.0;
            glm::dvec3 expected(0, 1, 0);
            for (int k = 0; k < 3; ++k)
                for (const std::uint16_t a : theCutOne().actuatorsOf(t[k]))
                    expected = sheetNormal(std::get<Bend>(theCutOne().actuators()[a].deformer), centre, state[a]);
            ASSERT_LT(degreesBetween(crossOf(positions, t), expected), 8.0);
        }
    }
}

/// Points of the sheet's rim with the points right below them: top and bottom of the sheet.
std::map<std::uint32_t, std::uint32_t> rimPairs() {
    std::map<std::pair<float, float>, std::uint32_t> below;
    const auto& positions = theCutOne().restMesh().positions;
    for (std::uint32_t v = 0; v < positions.size(); ++v)
        if (std::abs(positions[v].y - 0.018F) < 1e-6F) below[{positions[v].x, positions[v].z}] = v;
    std::map<std::uint32_t, std::uint32_t> pairs;
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        const auto found = below.find({positions[v].x, positions[v].z});
        if (std::abs(positions[v].y - 0.02F) < 1e-6F && found != below.end()) pairs[v] = found->second;
    }
    return pairs;
}

// R3: the sheet bends as a flexible sheet does, measured on the mesh.
TEST(CutTablet, BendsKeepLengthAndThicknessAndReachNinetyDegrees) {
    const auto& rest = theCutOne().restMesh().positions;
    const auto pairs = rimPairs();
    EXPECT_GT(pairs.size(), 150U);
    for (std::size_t a = 0; a < 6; ++a) {
        const auto& bend = std::get<Bend>(theCutOne().actuators()[a].deformer);
        const auto distanceOf = [&](const glm::vec3& p) { return glm::dot(p - bend.origin, bend.direction); };
        for (const double stroke : {0.3, 0.7, 1.0}) {
            std::vector<double> state(6, 0.0);
            state[a] = stroke;
            const auto bent = deformed(theCutOne(), state).positions;
            int spans = 0;
            for (const glm::uvec3& t : theCutOne().restMesh().triangles)
                for (int k = 0; k < 3; ++k) { // rim edges of the sheet's top, neighbours along the outline
                    const auto from = pairs.find(t[k]);
                    const auto to = pairs.find(t[(k + 1) % 3]);
                    if (from == pairs.end() || to == pairs.end() || rest[t[(k + 2) % 3]].y > 0.0199F) continue;
                    const auto middle = [&](const std::vector<glm::vec3>& p, const auto& pair) {
                        return 0.5F * (p[pair->first] + p[pair->second]);
                    };
                    const double before = glm::distance(middle(rest, from), middle(rest, to));
                    EXPECT_NEAR(glm::distance(middle(bent, from), middle(bent, to)), before, 0.02 * before);
                    spans += rest[from->first] != bent[from->first];
                }
            EXPECT_GT(spans, 20);
            for (const auto& [top, bottom] : pairs)
                EXPECT_NEAR(glm::distance(bent[top], bent[bottom]), 0.002, 0.02 * 0.002);
        }
        std::vector<double> full(6, 0.0);
        full[a] = 1.0;
        const auto bent = deformed(theCutOne(), full).positions;
        int straight = 0;
        for (const glm::uvec3& t : theCutOne().restMesh().triangles) {
            bool beyond = true;
            for (int k = 0; k < 3; ++k)
                beyond = beyond && rest[t[k]].y > 0.0199F &&
                         std::ranges::binary_search(theCutOne().verticesOf(a), t[k]) &&
                         distanceOf(rest[t[k]]) > bend.length - 1e-6;
            if (!beyond) continue;
            ++straight;
            EXPECT_NEAR(degreesBetween(crossOf(rest, t), crossOf(bent, t)), 90.0, 0.1);
        }
        EXPECT_GE(straight, 3);
    }
}

TEST(CutTablet, TheHousingStays) {
    for (const auto& state : cornerStates()) {
        const auto positions = deformed(theCutOne(), state).positions;
        std::size_t housing = 0;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            if (theCutOne().restMesh().positions[v].y > 0.01601F) continue;
            ++housing;
            ASSERT_EQ(positions[v], theCutOne().restMesh().positions[v]);
        }
        ASSERT_GT(housing, 8U);
    }
}

// R6: what the surface has passed on its way is inside.
TEST(CutTablet, HoldsItsOwnPath) {
    ASSERT_TRUE(theCutOne().pathInside());
    std::mt19937 random(9);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const Box reach = theCutOne().reach();
    int tried = 0;
    for (const auto& state : randomStates(20, 4)) {
        const test::InsideOracle now(deformed(theCutOne(), state));
        auto earlier = state;
        const double share = uniform(random);
        for (double& stroke : earlier) stroke *= share;
        const test::InsideOracle then(deformed(theCutOne(), earlier));
        for (int k = 0; k < 3000; ++k) {
            const glm::dvec3 p = glm::dvec3(reach.min) + glm::dvec3(uniform(random), uniform(random), uniform(random)) *
                                                             glm::dvec3(reach.size());
            if (p.y < 0.016 || !then(p)) continue;
            ++tried;
            // The skirt's rows are chords of the rim's way: up to 0.2 mm may be missing between two rows.
            bool held = now(p);
            for (int side = 0; side < 6 && !held; ++side) {
                glm::dvec3 near = p;
                near[side / 2] += side % 2 == 0 ? 2e-4 : -2e-4;
                held = now(near);
            }
            EXPECT_TRUE(held) << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
    EXPECT_GT(tried, 5000);
}

} // namespace
} // namespace lumorph

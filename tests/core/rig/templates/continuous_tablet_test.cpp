#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_check.h"
#include "core/rig/servo_types.h"
#include "core/rig/sheet/levered_sheet.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/continuous_sheet.h"
#include "core/rig/templates/sheet_file.h"
#include "core/rig/templates/sheet_outline.h"
#include "tests/support/cgal_oracle.h"
#include "tests/support/long_tests.h"

namespace lumorph {
namespace {

const Rig& tablet() {
    static const Rig rig = bakedTablet();
    return rig;
}

std::vector<std::vector<double>> statesOfTablet(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<std::vector<double>> states(static_cast<std::size_t>(count), std::vector<double>(6));
    for (auto& state : states)
        for (double& stroke : state) stroke = uniform(random);
    return states;
}

bool onTop(const glm::vec3& rest) { return rest.y > 0.02F - 1e-6F; }

// R1, R3
TEST(Tablet, IsTheOneOfThePaper) {
    const glm::dvec3 size(boundingBox(tablet().restMesh().positions).size());
    EXPECT_NEAR(size.x, 0.21, 1e-6);
    EXPECT_NEAR(size.y, 0.02, 1e-6);
    EXPECT_NEAR(size.z, 0.15, 1e-6);
    constexpr std::array kNames{"corner front left", "corner front right", "corner back left",
                                "corner back right", "edge front",         "edge back"};
    ASSERT_EQ(tablet().actuatorCount(), kNames.size());
    for (std::size_t a = 0; a < kNames.size(); ++a) {
        const Actuator& actuator = tablet().actuators()[a];
        EXPECT_EQ(actuator.name, kNames[a]);
        EXPECT_EQ(actuator.levels, 33);
        EXPECT_EQ(actuator.drive.channel, static_cast<int>(a));
        EXPECT_TRUE(std::holds_alternative<SheetLift>(actuator.deformer));
    }
    EXPECT_EQ(parseSheetDevice(tablet().parts().drawing, "tablet"),
              parseSheetDevice(writeSheetDevice(tabletDrawing()), "drawing"));
}

TEST(Tablet, TopIsOneSheetWithoutSlits) {
    const TriangleMesh& rest = tablet().restMesh();
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double area = 0.0;
    for (const glm::uvec3& t : rest.triangles) {
        if (!onTop(rest.positions[t.x]) || !onTop(rest.positions[t.y]) || !onTop(rest.positions[t.z])) continue;
        for (int k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
        area += 0.5 * glm::length(glm::cross(glm::dvec3(rest.positions[t.y] - rest.positions[t.x]),
                                             glm::dvec3(rest.positions[t.z] - rest.positions[t.x])));
    }
    EXPECT_NEAR(area, 0.209 * 0.149, 1e-6);
    for (const auto& [edge, triangles] : edges) {
        if (triangles == 2) continue;
        const glm::vec3 middle = 0.5F * (rest.positions[edge.first] + rest.positions[edge.second]);
        EXPECT_TRUE(std::abs(std::abs(middle.x) - 0.1045F) < 1e-6F || std::abs(std::abs(middle.z) - 0.0745F) < 1e-6F);
    }
}

// R8: actuators share what they move.
TEST(Tablet, LeversOverlap) {
    for (std::size_t a = 0; a < 6; ++a)
        for (std::size_t b = 0; b < a; ++b) {
            std::vector<std::uint32_t> both;
            std::ranges::set_intersection(tablet().verticesOf(a), tablet().verticesOf(b), std::back_inserter(both));
            EXPECT_GT(both.size(), tablet().verticesOf(a).size() / 3) << a << ' ' << b;
        }
}

TEST(Tablet, LeversLiftByFortyMillimetresAndNeedHalfOfWhatStallsTheirServos) {
    for (std::size_t a = 0; a < 6; ++a) {
        std::vector<double> strokes(6, 0.0);
        strokes[a] = 1.0;
        float highest = 0.0F;
        for (const glm::vec3& p : deformed(tablet(), strokes).positions) highest = std::max(highest, p.y);
        EXPECT_GE(highest, 0.06F) << a;
        const Actuator& actuator = tablet().actuators()[a];
        const auto& lever = std::get<SheetLift>(actuator.deformer);
        const ServoType& servo = servoType(actuator.drive.servo);
        std::printf("%s lifts %.1f mm, holds %.0f mN m: %.0f %% of what stalls its %s\n", actuator.name.c_str(),
                    1e3 * (highest - 0.02F), 1e3 * lever.torque, 100.0 * lever.torque / servo.stallTorque,
                    actuator.drive.servo.c_str());
        EXPECT_GT(lever.torque, 0.0);
        EXPECT_LE(lever.torque, servo.usableTorque());
        // The pulses turn the servo by the lever's angle.
        const double turned = (actuator.drive.pulseMax - actuator.drive.pulseMin) / (servo.pulseMax - servo.pulseMin) *
                              servo.travel.inDegrees();
        EXPECT_NEAR(turned, lever.max.inDegrees() - lever.min.inDegrees(), 0.2);
    }
}

// R3, R5: a sound solid in every joint state.
TEST(Tablet, StaysSoundInThousandStatesAndAllCorners) {
    auto states = statesOfTablet(1000, 11);
    for (int bits = 0; bits < 64; ++bits) {
        states.emplace_back();
        for (int a = 0; a < 6; ++a) states.back().push_back((bits >> a) & 1);
    }
    TriangleMesh mesh = tablet().restMesh();
    const std::vector<glm::vec3> rest = mesh.positions;
    double stretch = 0.0;
    for (const auto& state : states) {
        tablet().deform(state, mesh.positions);
        ASSERT_EQ(countSelfIntersections(mesh), 0U) << testing::PrintToString(state);
        ASSERT_GT(signedVolume(mesh), 0.0);
        for (const glm::uvec3& t : mesh.triangles)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                if (!onTop(rest[a]) || !onTop(rest[b])) continue;
                const double before = glm::distance(rest[a], rest[b]);
                stretch = std::max(stretch, glm::distance(mesh.positions[a], mesh.positions[b]) / before - 1.0);
            }
    }
    std::printf("the top stretches by at most %.1f %%\n", 100.0 * stretch);
    EXPECT_LE(stretch, 0.10);
}

// R6: what the surface has passed on its way is inside.
TEST(Tablet, HoldsItsOwnPath) {
    ASSERT_TRUE(tablet().pathInside());
    std::mt19937 random(9);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const Box reach = tablet().reach();
    int tried = 0, lost = 0;
    for (const auto& state : statesOfTablet(20, 4)) {
        const test::InsideOracle now(deformed(tablet(), state));
        auto earlier = state;
        const double share = uniform(random);
        for (double& stroke : earlier) stroke *= share;
        const test::InsideOracle then(deformed(tablet(), earlier));
        for (int k = 0; k < 3000; ++k) {
            const glm::dvec3 p = glm::dvec3(reach.min) + glm::dvec3(uniform(random), uniform(random), uniform(random)) *
                                                             glm::dvec3(reach.size());
            if (!then(p)) continue;
            ++tried;
            lost += now(p) ? 0 : 1;
        }
    }
    std::printf("%.2f %% of what was passed lies outside\n", 100.0 * lost / tried);
    EXPECT_GT(tried, 5000);
    EXPECT_LE(lost, 0.01 * tried);
}

/// Where a point of the flat sheet is, by the triangle of the mesh that holds it.
glm::dvec3 placeIn(const SheetMesh& mesh, const std::vector<glm::dvec3>& positions, const glm::dvec2& p) {
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec2 a = mesh.points[t.x], b = mesh.points[t.y] - a, c = mesh.points[t.z] - a, q = p - a;
        const double det = b.x * c.y - b.y * c.x;
        const double u = (q.x * c.y - q.y * c.x) / det;
        const double v = (b.x * q.y - b.y * q.x) / det;
        if (u >= -1e-4 && v >= -1e-4 && u + v <= 1.0 + 1e-4) // the rig has floats
            return (1.0 - u - v) * positions[t.x] + u * positions[t.y] + v * positions[t.z];
    }
    ADD_FAILURE() << p.x << ' ' << p.y << " is in no triangle";
    return {};
}

// What the file holds is what the drawing gives today: equilibria of the grid, but for the modes that are left out.
TEST(Tablet, FileHoldsTheEquilibriaOfItsDrawing) {
    const ElasticSheet sheet = elasticSheetOf(tabletDrawing());
    const SheetMesh mesh = meshSheet(sheet, std::sqrt(0.209 * 0.149) / 17.6);
    LeveredSheet levered(sheet, mesh);
    const std::vector<glm::vec3>& rest = tablet().restMesh().positions;
    for (const std::vector<double>& state :
         {std::vector{1.0, 0.0, 0.5, 0.0, 0.0, 1.0}, {0.0, 0.5, 1.0, 1.0, 0.5, 0.0}, {0.5, 1.0, 0.0, 0.5, 1.0, 0.5}}) {
        const SheetPose pose = levered.followed(state, 3);
        const auto moved = deformed(tablet(), state).positions;
        for (std::size_t v = 0; v < mesh.points.size(); ++v) {
            ASSERT_NEAR(mesh.points[v].x, rest[v].x, 1e-7);
            ASSERT_NEAR(mesh.points[v].y, rest[v].z, 1e-7);
            EXPECT_LT(glm::distance(glm::dvec3(moved[v]) - glm::dvec3(0.0, 0.02, 0.0), pose.state.positions[v]),
                      2.5e-4);
        }
    }
}

// Against equilibria on a mesh of half the edge length.
TEST(Tablet, UnseenStatesAreThoseOfAFinerSheet) {
    const int count = test::longTests() ? 200 : 6;
    const ElasticSheet sheet = elasticSheetOf(tabletDrawing());
    LeveredSheet fine(sheet, meshSheet(sheet, 0.005));
    const std::vector<glm::vec3>& rest = tablet().restMesh().positions;
    std::vector<double> errors;
    for (const auto& state : statesOfTablet(count, 1234)) {
        const SheetPose pose = fine.followed(state);
        const auto moved = deformed(tablet(), state).positions;
        for (std::size_t v = 0; v < rest.size(); ++v) {
            if (!onTop(rest[v])) continue;
            const glm::dvec3 place = placeIn(fine.mesh(), pose.state.positions, {rest[v].x, rest[v].z});
            errors.push_back(1e3 * glm::distance(place, glm::dvec3(moved[v]) - glm::dvec3(0.0, 0.02, 0.0)));
        }
    }
    std::ranges::sort(errors);
    const double within = static_cast<double>(std::ranges::upper_bound(errors, 2.0) - errors.begin()) / errors.size();
    std::printf("%d unseen states: %.1f %% of the top within 2 mm, 95 %% within %.2f mm, worst %.2f mm\n", count,
                100.0 * within, errors[errors.size() * 95 / 100], errors.back());
    EXPECT_GE(within, 0.95);
    EXPECT_LE(errors.back(), 5.0);
}

SheetDevice leaf() {
    SheetDevice device;
    device.name = "leaf";
    device.top = SheetTop::continuous;
    device.outline = rectangleOutline(0.2, 0.14);
    device.bends.push_back({"tip", {0.04, -0.08}, {0.04, 0.08}});
    return device;
}

TEST(ContinuousSheet, DrawingComesBack) {
    SheetDevice device = leaf();
    device.material = "sintered TPU";
    device.pad = {{-0.09, -0.05}, {0.0, -0.05}, {0.0, 0.05}, {-0.09, 0.05}};
    EXPECT_EQ(parseSheetDevice(writeSheetDevice(device), "leaf"), device);
}

// Without a drawn pad the sheet is clamped behind the bend line; one lever lifts what lies beyond.
TEST(ContinuousSheet, IsClampedBehindItsLines) {
    const Rig rig = sheetRig(leaf(), {}, SheetQuality::preview);
    ASSERT_EQ(rig.actuatorCount(), 1U);
    EXPECT_EQ(rig.actuators()[0].name, "tip");
    const auto& rest = rig.restMesh().positions;
    const auto up = deformed(rig, std::vector{1.0}).positions;
    float highest = 0.0F;
    for (std::size_t v = 0; v < rest.size(); ++v) {
        const bool clamped = rest[v].x < 0.036F && rest[v].x > -0.09F && std::abs(rest[v].z) < 0.066F;
        EXPECT_TRUE(up[v] == rest[v] || !clamped);
        highest = std::max(highest, up[v].y - rest[v].y);
    }
    EXPECT_GT(highest, 0.03F);
    EXPECT_LT(highest, 0.05F);
}

// Twice as thick needs about eight times the torque, as the bending of a thin plate does; nothing is painted by hand.
TEST(ContinuousSheet, ThicknessChangesTorqueAsThatOfAPlate) {
    const auto torque = [](double thickness) {
        SheetDevice device = leaf();
        device.thickness = thickness;
        const Rig rig = sheetRig(device, {}, SheetQuality::preview);
        return std::get<SheetLift>(rig.actuators()[0].deformer).torque;
    };
    const double ratio = torque(0.001) / torque(0.0005);
    EXPECT_NEAR(ratio, 8.0, 0.8);
}

TEST(ContinuousSheet, WrongOnesAreRefusedByName) {
    const auto refused = [](auto change, const char* subject, const char* why) {
        SheetDevice device = leaf();
        change(device);
        try {
            (void)sheetRig(device, {}, SheetQuality::preview);
            ADD_FAILURE() << why;
        } catch (const InvalidInput& error) {
            EXPECT_NE(error.subject().find(subject), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
        }
    };
    refused([](auto& d) { d.material = "granite"; }, "granite", "no such material");
    refused([](auto& d) { d.material = "Mylar"; }, "tip", "no servo of the table");
    refused([](auto& d) { d.pad = rectangleOutline(0.2, 0.14); }, "pad", "reaches the sheet's rim");
    refused([](auto& d) { d.pad = rectangleOutline(0.19, 0.13); }, "tip", "touches the clamped pad");
    refused(
        [](auto& d) {
            for (int k = 0; k < 9; ++k)
                d.bends.push_back({"line " + std::to_string(k), {-0.01 * k, -0.08}, {-0.01 * k, 0.08}});
        },
        "", "");
    refused([](auto& d) { d.bends[0].from.x = d.bends[0].to.x = 0.092; }, "tip", "no room for a lever's slot");
}

} // namespace
} // namespace lumorph

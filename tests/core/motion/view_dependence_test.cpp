#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/motion/view_dependence.h"
#include "core/rig/templates/rig_templates.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/not_a_number.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

const Rig& tabletRig() {
    static const Rig rig = test::cutTablet();
    return rig;
}

/// An eye around the middle of the tablet's top; azimuth 0 is in front of it (+z), 90 degrees at its right (+x).
glm::dvec3 eyeAt(double azimuth, double elevation, double distance = 0.6) {
    const double a = azimuth * std::numbers::pi / 180.0;
    const double e = elevation * std::numbers::pi / 180.0;
    return glm::dvec3(0.0, 0.02, 0.0) +
           distance * glm::dvec3(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
}

std::map<std::string, double> strokesAt(const glm::dvec3& eye, Angle theta = Angle::degrees(90.0)) {
    static const ViewRule rule(tabletRig());
    const std::vector<double> strokes = rule.strokes(eye, theta);
    std::map<std::string, double> named;
    for (std::size_t i = 0; i < strokes.size(); ++i) named[tabletRig().actuators()[i].name] = strokes[i];
    return named;
}

// R20, R21
TEST(ViewBend, IsTheTableOfThePaper) {
    struct Row {
        double alpha, theta, beta;
    };
    const Row rows[] = {
        {30.0, 90.0, 80.0}, {45.0, 90.0, 67.5},  {60.0, 90.0, 50.0}, {90.0, 90.0, 0.0},
        {0.0, 90.0, 90.0},  {-20.0, 90.0, 90.0}, {120.0, 90.0, 0.0}, {0.0, 60.0, 60.0},
        {30.0, 60.0, 45.0}, {60.0, 60.0, 0.0},   {75.0, 60.0, 0.0},  {89.0, 90.0, 1.9889},
    };
    for (const Row& row : rows)
        EXPECT_NEAR(viewBend(Angle::degrees(row.alpha), Angle::degrees(row.theta)).inDegrees(), row.beta, 1e-4)
            << row.alpha << " of " << row.theta;
    for (const double wrong : {kNan, HUGE_VAL}) EXPECT_THROW((void)viewBend(Angle::radians(wrong)), InvalidInput);
    for (const double wrong : {kNan, HUGE_VAL, 0.0, -1.0})
        EXPECT_THROW((void)viewBend(Angle::radians(0.5), Angle::radians(wrong)), InvalidInput);
}

// R22, Fig. 9: who looks from the front sees the back rise.
TEST(ViewRule, WhatIsFurthestFromTheUserBends) {
    const auto front = strokesAt(eyeAt(0.0, 30.0));
    EXPECT_NEAR(front.at("edge back"), 80.0 / 90.0, 1e-6);
    for (const char* name : {"corner back left", "corner back right"}) EXPECT_GT(front.at(name), 0.85 * 80.0 / 90.0);
    for (const char* name : {"edge front", "corner front left", "corner front right"}) EXPECT_EQ(front.at(name), 0.0);

    const auto right = strokesAt(eyeAt(90.0, 0.0));
    for (const char* name : {"corner front left", "corner back left"}) EXPECT_NEAR(right.at(name), 1.0, 1e-6);
    for (const char* name : {"corner front right", "corner back right"}) EXPECT_EQ(right.at(name), 0.0);
    for (const char* name : {"edge front", "edge back"}) EXPECT_LT(right.at(name), 0.15);

    for (const auto& [name, stroke] : strokesAt({0.0, 0.7, 0.0})) EXPECT_EQ(stroke, 0.0) << name;
    for (const auto& [name, stroke] : strokesAt(eyeAt(10.0, 60.0), Angle::degrees(60.0))) EXPECT_EQ(stroke, 0.0);
    EXPECT_NEAR(strokesAt(eyeAt(0.0, 0.0), Angle::degrees(45.0)).at("edge back"), 0.5, 1e-6);
    EXPECT_EQ(strokesAt(eyeAt(20.0, -30.0)), strokesAt(eyeAt(20.0, 0.0, 0.6 * std::cos(std::numbers::pi / 6.0))))
        << "from below as from the side";
    EXPECT_EQ(strokesAt(eyeAt(33.0, 89.9), Angle::degrees(150.0)), strokesAt(eyeAt(33.0, 89.9)));
}

TEST(ViewRule, MirroredUsersSeeMirroredDevices) {
    for (int azimuth = 0; azimuth < 360; azimuth += 7)
        for (const double elevation : {5.0, 40.0, 75.0}) {
            const glm::dvec3 eye = eyeAt(azimuth, elevation);
            const auto here = strokesAt(eye);
            const auto across = strokesAt({-eye.x, eye.y, eye.z});
            const auto behind = strokesAt({eye.x, eye.y, -eye.z});
            for (const auto& [name, stroke] : here) {
                const auto swapped = [name = name](const std::string& a, const std::string& b) {
                    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
                        if (const std::size_t at = name.find(from); at != std::string::npos)
                            return std::string(name).replace(at, from.size(), to);
                    return name;
                };
                EXPECT_NEAR(across.at(swapped("left", "right")), stroke, 1e-4);
                EXPECT_NEAR(behind.at(swapped("front", "back")), stroke, 1e-4);
            }
        }
}

// R22
TEST(ViewRule, NobodyWhoWalksAroundMakesAnActuatorJump) {
    double most = 0.0;
    double fullest = 0.0;
    for (const double distance : {0.3, 0.6, 2.0})
        for (int elevation = 0; elevation <= 90; elevation += 5) {
            auto before = strokesAt(eyeAt(359.0, elevation, distance));
            for (int azimuth = 0; azimuth < 360; ++azimuth) {
                const auto now = strokesAt(eyeAt(azimuth, elevation, distance));
                for (const auto& [name, stroke] : now) {
                    const double change = std::abs(stroke - before.at(name));
                    EXPECT_LE(std::abs(std::lround(32.0 * stroke) - std::lround(32.0 * before.at(name))), 1);
                    most = std::max(most, change);
                    fullest = std::max(fullest, stroke);
                }
                before = now;
            }
        }
    EXPECT_LE(most, 1.0 / 32.0);
    EXPECT_NEAR(fullest, 1.0, 1e-6);
    // Up and over the device: to overhead, and down on the other side.
    for (const double azimuth : {0.0, 20.0, 57.0, 90.0}) {
        auto before = strokesAt(eyeAt(azimuth, 0.0));
        for (int up = 1; up <= 180; ++up) {
            const auto now = strokesAt(eyeAt(azimuth, up));
            for (const auto& [name, stroke] : now) EXPECT_LE(std::abs(stroke - before.at(name)), 1.0 / 32.0);
            before = now;
        }
    }
}

/// Every bundled rig and every template as it comes.
std::vector<std::pair<std::string, Rig>> rigsToWalkAround() {
    std::vector<std::pair<std::string, Rig>> rigs{{"tablet", bakedTablet()}, {"cut tablet", test::cutTablet()}};
    for (const auto& entry : std::filesystem::directory_iterator(resourceFile("models/tablet.glb").parent_path()))
        if (entry.path().extension() == ".glb") rigs.emplace_back(entry.path().filename(), readRig(entry.path()));
    for (const RigTemplate& kind : rigTemplates())
        if (kind.name != "tablet") rigs.emplace_back(kind.name, rigOf(kind, {}, {}, SheetQuality::preview));
    // Half of the angle, three times the levels.
    RigParts narrow = test::cutTablet().parts();
    for (std::size_t k = 0; k < narrow.actuators.size(); ++k) {
        auto& bend = std::get<Bend>(narrow.actuators[k].deformer);
        bend.max = Angle::degrees(45.0);
        if (k % 2 == 1) narrow.actuators[k].levels = 101;
    }
    rigs.emplace_back("narrow", Rig(narrow));
    return rigs;
}

// R22
TEST(ViewRule, NobodyWhoWalksAroundAnyDeviceMakesItJump) {
    int bending = 0;
    for (const auto& [name, rig] : rigsToWalkAround()) {
        const ViewRule rule(rig);
        double most = 0.0, fullest = 0.0;
        for (const double elevation : {0.0, 20.0, 45.0, 70.0}) {
            std::vector<double> before = rule.strokes(eyeAt(359.0, elevation, 1.0));
            for (int azimuth = 0; azimuth < 360; ++azimuth) {
                const std::vector<double> now = rule.strokes(eyeAt(azimuth, elevation, 1.0));
                for (std::size_t k = 0; k < now.size(); ++k) {
                    most = std::max(most, (rig.actuators()[k].levels - 1) * std::abs(now[k] - before[k]));
                    fullest = std::max(fullest, now[k]);
                }
                before = now;
            }
        }
        EXPECT_LE(most, 1.0) << name << ": levels a degree";
        bending += fullest > 0.5 ? 1 : 0;
    }
    EXPECT_GE(bending, 5);
}

TEST(ViewRule, WhatBendsBothWaysRestsFlat) {
    RigParts parts = test::cutTablet().parts();
    const auto bend = std::get<Bend>(parts.actuators[0].deformer);
    Hinge hinge;
    hinge.origin = bend.origin;
    hinge.axis = bend.axis;
    hinge.min = Angle::degrees(-30.0);
    hinge.max = Angle::degrees(60.0);
    parts.actuators[0].deformer = hinge;
    const ViewRule rule{Rig(parts)};
    double least = 1.0, most = 0.0;
    for (int azimuth = 0; azimuth < 360; azimuth += 5) {
        const double stroke = rule.strokes(eyeAt(azimuth, 10.0))[0];
        least = std::min(least, stroke);
        most = std::max(most, stroke);
    }
    EXPECT_NEAR(least, 1.0 / 3.0, 1e-9) << "0 degrees";
    EXPECT_NEAR(most, 1.0, 1e-6);
    EXPECT_NEAR(rule.strokes({0.0, 0.7, 0.0})[0], 1.0 / 3.0, 1e-9);
}

TEST(ViewRule, SlidesUseTheirStrokeAsNinetyDegreesAndInnerPartsStay) {
    // Lifts at the left and right rim, one in the middle, and one that sinks at the left.
    RigParts parts;
    parts.restMesh = test::boxMesh({-0.1F, 0.0F, -0.1F}, {0.1F, 0.02F, 0.1F}, 20);
    const auto add = [&](const char* name, float low, float high, float way) {
        Actuator actuator;
        actuator.name = name;
        actuator.deformer = Slide{{0.0F, way, 0.0F}, 0.0, 0.05};
        for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v) {
            const glm::vec3& p = parts.restMesh.positions[v];
            if (p.y > 0.01F && p.x > low && p.x < high && std::abs(p.z) < 0.04F)
                actuator.influences.push_back({v, 1.0F});
        }
        parts.actuators.push_back(actuator);
    };
    add("left", -0.11F, -0.06F, 1.0F);
    add("right", 0.06F, 0.11F, 1.0F);
    add("middle", -0.03F, 0.04F, 1.0F);
    add("sinking", -0.11F, -0.06F, -0.1F);
    const ViewRule rule{Rig(parts)};
    const std::vector<double> strokes = rule.strokes(eyeAt(90.0, 45.0));
    EXPECT_NEAR(strokes[0], 67.5 / 90.0, 1e-6);
    EXPECT_EQ(strokes[1], 0.0);
    EXPECT_EQ(strokes[2], 0.0);
    EXPECT_EQ(strokes[3], 0.0);
}

TEST(ViewRule, RefusesAnEyeThatIsNowhere) {
    const ViewRule rule(tabletRig());
    for (const glm::dvec3& eye : {glm::dvec3(kNan, 1, 1), glm::dvec3(1, kNan, 1), glm::dvec3(1, 1, HUGE_VAL)})
        EXPECT_THROW((void)rule.strokes(eye), InvalidInput);
    EXPECT_THROW((void)rule.strokes({0, 1, 1}, Angle{}), InvalidInput);
}

} // namespace
} // namespace lumorph

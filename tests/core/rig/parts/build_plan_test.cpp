#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/plane_mesh.h"
#include "core/rig/parts/build_files.h"
#include "core/rig/parts/build_plan.h"
#include "core/rig/rig_file.h"
#include "core/rig/servo_types.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/rig_templates.h"
#include "core/rig/templates/sheet_device.h"
#include "core/rig/templates/sheet_outline.h"
#include "tests/core/file_size_limit.h"
#include "tests/core/rig/parts/zip_reader.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cgal_oracle.h"
#include "tests/support/long_tests.h"

namespace lumorph {
namespace {

const Rig& templateRig(const std::string& name) {
    static std::map<std::string, Rig> rigs;
    const auto found = rigs.find(name);
    if (found != rigs.end()) return found->second;
    return rigs.emplace(name, name == "cut_tablet" ? cutTabletRig() : rigOf(rigTemplate(name), {})).first->second;
}

/// With the options that come without a choice.
const BuildPlan& templatePlan(const std::string& name) {
    static std::map<std::string, BuildPlan> plans;
    const auto found = plans.find(name);
    if (found != plans.end()) return found->second;
    return plans.emplace(name, buildPlanOf(templateRig(name))).first->second;
}

const PrintPart& partOf(const BuildPlan& plan, const std::string& name) {
    const auto found = std::ranges::find(plan.parts, name, &PrintPart::name);
    if (found == plan.parts.end()) throw std::runtime_error("no part " + name);
    return *found;
}

std::map<std::string, int> countsOf(const BuildPlan& plan) {
    std::map<std::string, int> counts;
    for (const PrintPart& part : plan.parts) counts[part.name.substr(0, part.name.find('-'))] += part.count;
    return counts;
}

/// Summed up here, from the pyramids to the origin.
double volumeOf(const std::vector<glm::dvec3>& corners) {
    double volume = 0.0;
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3)
        volume += glm::dot(corners[k], glm::cross(corners[k + 1], corners[k + 2])) / 6.0;
    return volume;
}

std::vector<glm::dvec3> cornersOfStl(const std::vector<std::byte>& stl) {
    std::uint32_t count = 0;
    std::memcpy(&count, &stl[80], 4);
    EXPECT_EQ(stl.size(), 84 + 50 * std::size_t{count});
    std::vector<glm::dvec3> corners;
    for (std::uint32_t t = 0; t < count; ++t)
        for (int k = 0; k < 3; ++k) {
            float xyz[3];
            std::memcpy(xyz, &stl[84 + 50 * std::size_t{t} + 12 + 12 * static_cast<std::size_t>(k)], 12);
            corners.emplace_back(xyz[0], xyz[1], xyz[2]);
        }
    return corners;
}

double attribute(const std::string& element, const std::string& name) {
    const std::size_t at = element.find(" " + name + "=\"");
    if (at == std::string::npos) throw std::runtime_error("no attribute " + name);
    return std::stod(element.substr(at + name.size() + 3));
}

std::vector<glm::dvec3> cornersOf3mf(const std::vector<std::byte>& file) {
    const std::string model = test::unzipped(file).at("3D/3dmodel.model");
    EXPECT_NE(model.find("unit=\"millimeter\""), std::string::npos);
    std::vector<glm::dvec3> vertices;
    std::vector<glm::dvec3> corners;
    for (std::size_t at = model.find('<'); at != std::string::npos; at = model.find('<', at + 1)) {
        const std::string element = model.substr(at, model.find('>', at) - at);
        if (element.starts_with("<vertex "))
            vertices.emplace_back(attribute(element, "x"), attribute(element, "y"), attribute(element, "z"));
        if (element.starts_with("<triangle "))
            for (const char* corner : {"v1", "v2", "v3"})
                corners.push_back(vertices.at(static_cast<std::size_t>(attribute(element, corner))));
    }
    return corners;
}

class TemplateParts : public testing::TestWithParam<const char*> {};

TEST_P(TemplateParts, AreClosedSolidsThatLieOnTheBed) {
    const BuildPlan& plan = templatePlan(GetParam());
    ASSERT_FALSE(plan.parts.empty());
    for (const PrintPart& part : plan.parts) {
        SCOPED_TRACE(part.name);
        const Box box = boundingBox(part.solid.mesh.positions);
        EXPECT_FALSE(test::crossesItself(part.solid.mesh)); // and is closed and manifold
        EXPECT_GT(signedVolume(part.solid.mesh), 10.0);
        EXPECT_GE(part.count, 1);
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(box.min[axis], 0.0, 1e-4);
        EXPECT_LE(box.max.x, 220.0 + 1e-3);
        EXPECT_LE(box.max.y, 220.0 + 1e-3);
        // It stands on faces, not on an edge.
        double foot = 0.0;
        for (const glm::uvec3& t : part.solid.mesh.triangles) {
            const glm::dvec3 a(part.solid.mesh.positions[t.x]);
            const glm::dvec3 b(part.solid.mesh.positions[t.y]);
            const glm::dvec3 c(part.solid.mesh.positions[t.z]);
            if (a.z + b.z + c.z == 0.0) foot -= 0.5 * glm::cross(b - a, c - a).z;
        }
        EXPECT_GT(foot, 10.0);
    }
}

TEST_P(TemplateParts, AreTheSameSolidIn3mfAsInStl) {
    const BuildPlan& plan = templatePlan(GetParam());
    const auto files = buildFiles(plan);
    for (const PrintPart& part : plan.parts) {
        SCOPED_TRACE(part.name);
        const double stl = volumeOf(cornersOfStl(files.at(part.name + ".stl")));
        EXPECT_NEAR(stl, signedVolume(part.solid.mesh), 1e-4 * stl);
        EXPECT_NEAR(volumeOf(cornersOf3mf(files.at(part.name + ".3mf"))), stl, 1e-4 * stl);
    }
}

TEST_P(TemplateParts, GiveEachActuatorOneServoInASeat) {
    const BuildPlan& plan = templatePlan(GetParam());
    const Rig& rig = templateRig(GetParam());
    ASSERT_EQ(plan.wiring.size(), rig.actuatorCount());
    int seats = 0;
    for (const PrintPart& part : plan.parts)
        if (part.name.starts_with("seat") && part.name != "seat-cap")
            seats += part.count * (part.use.find(" servo seats") != std::string::npos ? std::stoi(part.use) : 1);
    EXPECT_EQ(static_cast<std::size_t>(seats), rig.actuatorCount());
    for (std::size_t k = 0; k < plan.wiring.size(); ++k) {
        EXPECT_EQ(plan.wiring[k].actuator, rig.actuators()[k].name);
        EXPECT_GE(plan.wiring[k].pulseMin, rig.actuators()[k].drive.pulseMin);
        EXPECT_LE(plan.wiring[k].pulseMax, rig.actuators()[k].drive.pulseMax);
        EXPECT_LT(plan.wiring[k].pulseMin, plan.wiring[k].pulseMax);
        EXPECT_FALSE(plan.wiring[k].seat.empty());
    }
}

/// Where a line from inside first leaves the solid or the room, to 0.005 mm.
double wayToChange(const test::InsideOracle& inside, const glm::dvec3& from, const glm::dvec3& way) {
    const bool start = inside(from);
    double near = 0.0;
    while (inside(from + (near + 0.05) * way) == start && near < 100.0) near += 0.05;
    double far = near + 0.05;
    while (far - near > 0.005) {
        const double middle = 0.5 * (near + far);
        (inside(from + middle * way) == start ? near : far) = middle;
    }
    return 0.5 * (near + far);
}

/// Where a line from outside is in the room between two walls, and how wide that is, to 0.01 mm.
struct Gap {
    double middle = 0.0;
    double width = 0.0;
};
std::vector<Gap> gapsAlong(const test::InsideOracle& inside, const glm::dvec3& from, double length) {
    constexpr double kStep = 0.5; // walls are 2 mm
    const auto in = [&](double x) { return inside(from + glm::dvec3(x, 0.0, 0.0)); };
    const auto edge = [&](double low, double high) {
        const bool start = in(low);
        while (high - low > 0.005) (in(0.5 * (low + high)) == start ? low : high) = 0.5 * (low + high);
        return 0.5 * (low + high);
    };
    std::vector<Gap> gaps;
    double opened = -1.0; // where the last wall ended
    for (double x = 0.0; x < length; x += kStep) {
        if (in(x) && !in(x + kStep)) opened = edge(x, x + kStep);
        if (!in(x) && in(x + kStep) && opened >= 0.0) {
            const double closed = edge(x, x + kStep);
            gaps.push_back({from.x + 0.5 * (opened + closed), closed - opened});
        }
    }
    return gaps;
}

/// A servo's case and tabs by the drawing of an SG90, in the seat whose slots have their middle in `slot`.
void expectHoldsAnSg90(const test::InsideOracle& inside, const glm::dvec3& slot, double tolerance) {
    const glm::dvec3 right(1, 0, 0);
    const glm::dvec3 back(0, 1, 0);
    const glm::dvec3 tab = slot - (11.4 + 2.3) * right;
    const double below = wayToChange(inside, tab, -back);
    EXPECT_NEAR(below + wayToChange(inside, tab, back), 2.5 + 2.0 * tolerance, 0.1);
    const double bottom = wayToChange(inside, slot, -back);
    EXPECT_NEAR(bottom - below, 15.9, 0.1);
    const glm::dvec3 casing = slot - (bottom - 12.0) * back; // in front of the notch for the cable
    EXPECT_NEAR(wayToChange(inside, casing, right) + wayToChange(inside, casing, -right), 22.8 + 2.0 * tolerance, 0.1);
    // Down to the seat's floor, or to that of the housing on which it stands.
    const double floor = std::min(wayToChange(inside, casing, glm::dvec3(0, 0, -1)), casing.z);
    EXPECT_NEAR(floor + 2.0, 12.2 + tolerance, 0.1);
    for (const double side : {-1.0, 1.0}) // nothing before the whole breadth of the case, up to where it ends
        EXPECT_GT(wayToChange(inside, slot + side * 11.0 * right, back), 22.7 - 15.9 - 1.25);
}

TEST_P(TemplateParts, HoldAnSg90InEverySeat) {
    const BuildPlan& plan = templatePlan(GetParam());
    const double tolerance = PartOptions{}.tolerance;
    for (const PrintPart& part : plan.parts) {
        if (!part.name.starts_with("seat") || part.name == "seat-cap") continue;
        SCOPED_TRACE(part.name);
        const test::InsideOracle inside(part.solid.mesh);
        const glm::dvec3 size(boundingBox(part.solid.mesh.positions).max);
        int seats = 0;
        std::size_t before = 0;
        for (double y = 0.25; y < size.y; y += 0.7) { // slots are 2.9 mm
            std::vector<Gap> slots;
            for (const Gap& gap : gapsAlong(inside, {-0.1, y, size.z - 2.0}, size.x + 1.0))
                if (std::abs(gap.width - (32.2 + 2.0 * tolerance)) < 0.1) slots.push_back(gap);
            if (before == 0)
                for (const Gap& gap : slots) expectHoldsAnSg90(inside, {gap.middle, y + 0.1, size.z - 2.0}, tolerance);
            if (before == 0) seats += static_cast<int>(slots.size());
            before = slots.size();
        }
        EXPECT_EQ(seats, part.use.find(" servo seats") != std::string::npos ? std::stoi(part.use) : 1);
    }
}

INSTANTIATE_TEST_SUITE_P(BuildPlan, TemplateParts,
                         testing::Values("tablet", "cut_tablet", "phone", "pins", "flower", "book", "cushion", "sheet"),
                         [](const auto& name) { return std::string(name.param); });

TEST(BuildPlan, GivesEachKindItsParts) {
    using Counts = std::map<std::string, int>;
    EXPECT_EQ(countsOf(templatePlan("tablet")),
              (Counts{{"housing", 1}, {"lid", 1}, {"sheet", 1}, {"seat", 6}, {"lever", 6}}));
    EXPECT_EQ(countsOf(templatePlan("cut_tablet")), countsOf(templatePlan("tablet")));
    EXPECT_EQ(countsOf(templatePlan("sheet")), (Counts{{"housing", 1}, {"lid", 1}, {"sheet", 1}}));
    EXPECT_EQ(countsOf(templatePlan("pins")), (Counts{{"pin", 900}, {"guide", 1}, {"base", 1}, {"seat", 36}}));
    EXPECT_EQ(countsOf(templatePlan("cushion")), (Counts{{"seat", 8}})); // four, and their caps
    EXPECT_THAT(templatePlan("cushion").notes, testing::Contains(testing::HasSubstr("There is no housing")));
    EXPECT_GE(countsOf(templatePlan("book"))["housing"], 2);
    EXPECT_EQ(countsOf(templatePlan("book"))["lever"], 2);
    EXPECT_EQ(countsOf(templatePlan("flower"))["lever"], 5);
}

/// The tablet's housing is as wide and deep as the tablet (R1), and with lid and sheet as high.
TEST(BuildPlan, TabletKeepsItsMeasures) {
    for (const char* name : {"tablet", "cut_tablet"}) {
        const BuildPlan& plan = templatePlan(name);
        const auto sizeOf = [&](const char* part) {
            return boundingBox(partOf(plan, part).solid.mesh.positions).size();
        };
        EXPECT_NEAR(sizeOf("housing").x, 210.0, 0.05);
        EXPECT_NEAR(sizeOf("housing").y, 150.0, 0.05);
        EXPECT_NEAR(sizeOf("housing").z + sizeOf("lid").z + sizeOf("sheet").z, 20.0, 0.01);
        // The sheet is the rig's: as much area as its top has.
        double top = 0.0;
        const TriangleMesh& mesh = templateRig(name).restMesh();
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::dvec3 a(mesh.positions[t.x]);
            const glm::dvec3 n = glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
            const bool high =
                std::min({mesh.positions[t.x].y, mesh.positions[t.y].y, mesh.positions[t.z].y}) > 0.01999F;
            if (high && n.y > 0.0) top += 0.5e6 * n.y;
        }
        // The continuous one is in one piece, and has a slot for each lever.
        double slots = 0.0;
        if (name == std::string("tablet")) {
            ASSERT_EQ(plan.sheet.size(), 7U);
            for (std::size_t k = 1; k < plan.sheet.size(); ++k) slots += std::abs(signedArea(plan.sheet[k]));
            EXPECT_GT(slots, 6 * 5.0 * 10.0);
            EXPECT_LT(slots, 6 * 6.0 * 40.0);
        }
        EXPECT_NEAR(signedVolume(partOf(plan, "sheet").solid.mesh), 2.0 * (top - slots), 2e-3 * top);
    }
}

// Case 22.8 x 12.2 x 22.7, tabs 32.2 x 2.5 whose underside is 15.9 above the bottom.
TEST(ServoSeats, FitTheDrawingOfAnSg90) {
    for (const double tolerance : {0.0, 0.2, 0.35}) {
        SCOPED_TRACE(tolerance);
        PartOptions options;
        options.tolerance = tolerance;
        const BuildPlan plan = buildPlanOf(templateRig("cushion"), options);
        const TriangleMesh& mesh = partOf(plan, "seat").solid.mesh;
        const test::InsideOracle inside(mesh);
        const glm::dvec3 right(1, 0, 0);
        const glm::dvec3 back(0, 1, 0);
        const glm::dvec3 up(0, 0, 1);
        const double height = boundingBox(mesh.positions).max.z;
        // The trough, high above its floor and in front of the cable's notch.
        const glm::dvec3 middle(0.5 * boundingBox(mesh.positions).max.x, 12.0, height - 2.0);
        ASSERT_FALSE(inside(middle));
        const auto width = [&](const glm::dvec3& at) {
            return wayToChange(inside, at, right) + wayToChange(inside, at, -right);
        };
        EXPECT_NEAR(width(middle), 22.8 + 2.0 * tolerance, 0.1);
        const double bottom =
            middle.y - wayToChange(inside, middle, -back); // where the case's bottom lies, less the tolerance
        const double floor = wayToChange(inside, middle, -up);
        EXPECT_NEAR(floor + 2.0, 12.2 + tolerance, 0.1);
        // The slots: beyond the case, halfway into a tab.
        const glm::dvec3 slot(middle.x - 11.4 - 2.3, bottom + tolerance + 15.9 + 1.25, middle.z);
        ASSERT_FALSE(inside(slot));
        EXPECT_NEAR(width({middle.x, slot.y, slot.z}), 32.2 + 2.0 * tolerance, 0.1);
        EXPECT_NEAR(wayToChange(inside, slot, back) + wayToChange(inside, slot, -back), 2.5 + 2.0 * tolerance, 0.1);
        EXPECT_NEAR(slot.y - wayToChange(inside, slot, -back) - bottom, 15.9, 0.1);
        // Nothing before the shaft.
        EXPECT_GT(wayToChange(inside, middle, back), 50.0);
    }
}

TEST(ServoSeats, AreForTheServoThatIsAskedFor) {
    PartOptions options;
    options.servo = servoBody("mg996r");
    const BuildPlan plan = buildPlanOf(templateRig("cushion"), options);
    EXPECT_NEAR(boundingBox(partOf(plan, "seat").solid.mesh.positions).size().x, 54.5 + 2.0 * 0.2 + 2.0 * 2.0, 0.1);
    EXPECT_THROW(static_cast<void>(servoBody("SG9000")), InvalidInput);
}

/// Underside of a bent flap at an arc length, by the rig's own deformer: the neutral line lies half a thickness above.
std::vector<glm::dvec2> bentUnderside(const Bend& bend, double angle, double thickness) {
    RigParts parts;
    parts.restMesh.positions.clear();
    const glm::vec3 direction = glm::normalize(bend.direction);
    for (int k = 0; k <= 600; ++k)
        parts.restMesh.positions.push_back(bend.origin + 1e-4F * static_cast<float>(k) * direction -
                                           glm::vec3(0.0F, static_cast<float>(0.0005 * thickness), 0.0F));
    for (std::uint32_t k = 0; k + 2 < parts.restMesh.positions.size(); ++k)
        parts.restMesh.triangles.emplace_back(k, k + 1, k + 2);
    Actuator actuator;
    actuator.name = "flap";
    actuator.deformer = bend;
    for (std::uint32_t k = 0; k < parts.restMesh.positions.size(); ++k) actuator.influences.push_back({k, 1.0F});
    parts.actuators.push_back(actuator);
    const Rig rig(parts);
    const std::vector<double> strokes{angle / bend.max.inRadians()};
    std::vector<glm::dvec2> line;
    for (const glm::vec3& p : deformed(rig, strokes).positions)
        line.emplace_back(1e3 * glm::dot(p - bend.origin, direction), 1e3 * (p.y - bend.origin.y) + 0.5 * thickness);
    return line;
}

double distanceTo(const std::vector<glm::dvec2>& line, const glm::dvec2& p) {
    double least = std::numeric_limits<double>::max();
    for (const glm::dvec2& q : line) least = std::min(least, glm::distance(p, q));
    return least;
}

TEST(Levers, TouchTheFlapAtRestAndAtTheEndAndNothingBetween) {
    for (const char* name : {"cut_tablet", "flower", "book"}) {
        const Rig& rig = templateRig(name);
        const BuildPlan& plan = templatePlan(name);
        for (std::size_t k = 0; k < plan.wiring.size(); ++k) {
            SCOPED_TRACE(plan.wiring[k].actuator);
            ASSERT_TRUE(plan.wiring[k].lever.has_value());
            const Lever& lever = *plan.wiring[k].lever;
            const auto& bend = std::get<Bend>(rig.actuators()[k].deformer);
            const double thickness = 2.0;
            const glm::dvec2 shaft(lever.pivot, -lever.below);
            const auto nose = [&](Angle angle) {
                return shaft + lever.length * glm::dvec2(std::cos(angle.inRadians()), std::sin(angle.inRadians()));
            };
            EXPECT_NEAR(nose(lever.rest).y, -Lever::kNose, 1e-6);
            const std::vector<glm::dvec2> up = bentUnderside(bend, lever.lifted.inRadians(), thickness);
            EXPECT_NEAR(distanceTo(up, nose(lever.end)), Lever::kNose, 0.02);
            for (int s = 0; s <= 50; ++s) {
                const glm::dvec2 onArm = shaft + (nose(lever.end) - shaft) * (s / 50.0);
                EXPECT_GT(distanceTo(up, onArm), 0.3);
            }
            for (PlanePolygon& shape : leverShapes(lever, servoBodies().front(), 0.2))
                for (const glm::dvec2& p : shape) {
                    const glm::dvec2 way = (nose(lever.end) - shaft) / lever.length;
                    const glm::dvec2 place = shaft + p.x * way + p.y * glm::dvec2(-way.y, way.x);
                    EXPECT_GT(distanceTo(up, place), glm::distance(p, {lever.length, 0.0}) < 1.6 ? 0.0 : 0.15);
                }
            // The turn is within what the rig's pulses allow, and is what the pulses say.
            EXPECT_NEAR(0.09 * (plan.wiring[k].pulseMax - plan.wiring[k].pulseMin), lever.turn().inDegrees(), 0.1);
        }
    }
}

/// The angle of a flap that lies on a nose at this place: the least at which it is clear of it.
Angle liftedBy(const Bend& bend, const glm::dvec2& nose, double thickness) {
    double low = 1e-4, high = bend.max.inRadians();
    for (int step = 0; step < 24; ++step) {
        const double angle = 0.5 * (low + high);
        const std::vector<glm::dvec2> line = bentUnderside(bend, angle, thickness);
        // The nose is above the line's nearest part, or cuts it.
        double least = std::numeric_limits<double>::max(), side = 0.0;
        for (std::size_t k = 0; k + 1 < line.size(); ++k) {
            const glm::dvec2 way = line[k + 1] - line[k], to = nose - line[k];
            const double share = std::clamp(glm::dot(to, way) / glm::dot(way, way), 0.0, 1.0);
            const double distance = glm::length(to - share * way);
            if (distance >= least) continue;
            least = distance;
            side = way.x * to.y - way.y * to.x;
        }
        (side < 0.0 && least >= Lever::kNose ? high : low) = angle;
    }
    return Angle::radians(high);
}

TEST(Levers, HalfAPulseIsNotHalfAnAngleAndTheirCurveSaysWhatItIs) {
    double worst = 0.0, straight = 0.0;
    for (const char* name : {"cut_tablet", "flower", "book"}) {
        const Rig& rig = templateRig(name);
        const BuildPlan& plan = templatePlan(name);
        const Rig fitted(withLevers(rig, plan));
        for (std::size_t k = 0; k < plan.wiring.size(); ++k) {
            SCOPED_TRACE(plan.wiring[k].actuator);
            const Lever& lever = *plan.wiring[k].lever;
            const auto& bend = std::get<Bend>(fitted.actuators()[k].deformer);
            EXPECT_NEAR(bend.max.inDegrees(), lever.lifted.inDegrees(), 1e-6);
            const ActuatorDrive& drive = fitted.actuators()[k].drive;
            for (const double stroke : {0.13, 0.29, 0.5, 0.61, 0.83, 1.0}) {
                // 0.09 degrees a microsecond: what the servo's table says of an SG90.
                const double turned = 0.09 * std::abs(drive.pulseMax - drive.pulseMin) * turnedAt(drive.curve, stroke);
                const auto nose = [&](double degrees) {
                    const double at = lever.rest.inRadians() + Angle::degrees(degrees).inRadians();
                    return glm::dvec2(lever.pivot, -lever.below) +
                           lever.length * glm::dvec2(std::cos(at), std::sin(at));
                };
                const double wanted = stroke * bend.max.inDegrees();
                worst = std::max(worst, std::abs(liftedBy(bend, nose(turned), 2.0).inDegrees() - wanted));
                const double evenly = stroke * lever.turn().inDegrees();
                straight = std::max(straight, std::abs(liftedBy(bend, nose(evenly), 2.0).inDegrees() - wanted));
            }
        }
    }
    EXPECT_LT(worst, 1.0) << "degrees";
    EXPECT_GT(straight, 5.0) << "degrees; what it was without the curve";
    std::printf("flaps on their levers: at most %.2f degrees off, %.1f without the curve\n", worst, straight);
}

TEST(Levers, FittedTheRigPlansTheSameLeversAgain) {
    const Rig& rig = templateRig("cut_tablet");
    const BuildPlan& plan = templatePlan("cut_tablet");
    const Rig fitted(withLevers(rig, plan));
    const BuildPlan again = buildPlanOf(fitted);
    for (std::size_t k = 0; k < plan.wiring.size(); ++k) {
        EXPECT_NEAR(again.wiring[k].lever->length, plan.wiring[k].lever->length, 1e-6);
        EXPECT_NEAR(again.wiring[k].pulseMax - again.wiring[k].pulseMin,
                    plan.wiring[k].pulseMax - plan.wiring[k].pulseMin, 1e-6);
        // No stroke asks more of the servo than its speed without load.
        const double turn = plan.wiring[k].lever->turn().inRadians();
        EXPECT_LE(fitted.actuators()[k].maxVelocity * turn * steepest(fitted.actuators()[k].drive.curve),
                  servoType("SG90").speed * (1.0 + 1e-9));
    }
    EXPECT_EQ(withLevers(fitted, again), fitted.parts());
    EXPECT_TRUE(readRigGlb(writeRigGlb(fitted), "fitted.glb").parts().actuators == fitted.parts().actuators);
}

TEST(BuildPlan, CutsPartsToASmallBed) {
    PartOptions options;
    options.bed = 130.0;
    const BuildPlan plan = buildPlanOf(templateRig("tablet"), options);
    double lid = 0.0;
    int pieces = 0;
    for (const PrintPart& part : plan.parts) {
        SCOPED_TRACE(part.name);
        const Box box = boundingBox(part.solid.mesh.positions);
        EXPECT_LE(std::max(box.max.x, box.max.y), 130.0 + 1e-3);
        EXPECT_FALSE(test::crossesItself(part.solid.mesh));
        if (!part.name.starts_with("lid")) continue;
        lid += signedVolume(part.solid.mesh);
        ++pieces;
    }
    EXPECT_EQ(pieces, 4);
    // All but the clearance of the seams is there, whatever the arrangement of slots.
    const double whole = signedVolume(partOf(templatePlan("tablet"), "lid").solid.mesh);
    EXPECT_NEAR(lid, whole, 0.03 * whole);
}

TEST(BuildPlan, RefusesWhatCannotBeBuilt) {
    const Rig& tablet = templateRig("tablet");
    const auto refusal = [&](const Rig& rig, const PartOptions& options) -> std::string {
        try {
            static_cast<void>(buildPlanOf(rig, options));
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "none";
    };
    PartOptions options;
    for (const double tolerance : {-0.1, 1.5, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
        options.tolerance = tolerance;
        EXPECT_THAT(refusal(tablet, options), testing::HasSubstr("tolerance"));
    }
    options = {};
    for (const double bed : {0.0, 20.0, 1e6, std::numeric_limits<double>::quiet_NaN()}) {
        options.bed = bed;
        EXPECT_THAT(refusal(tablet, options), testing::HasSubstr("print bed"));
    }
    options.bed = 100.0; // pins of 150 mm
    EXPECT_THAT(refusal(templateRig("pins"), options), testing::HasSubstr("pin"));
    options = {};
    options.servo = servoBody("MG996R");
    EXPECT_THAT(refusal(templateRig("phone"), options), testing::HasSubstr("no room"));
    RigParts still;
    still.name = "thing";
    still.restMesh = templateRig("cushion").restMesh();
    EXPECT_THAT(refusal(Rig(std::move(still)), {}), testing::HasSubstr("no actuator"));
}

TEST(BuildPlan, NamesTheActuatorOfManyThatHasNoRoom) {
    const int teeth = test::longTests() ? 64 : 20;
    SheetDevice device;
    device.name = "comb";
    device.outline = rectangleOutline(0.01 * teeth + 0.02, 0.14);
    for (int k = 0; k < teeth; ++k) {
        const double x = 0.02 * (k / 2 - 0.25 * (teeth - 2));
        const double z = k % 2 == 0 ? 0.03 : -0.03;
        BendLine bend;
        bend.name = "tooth " + std::to_string(k + 1);
        bend.from = {x - 0.008, z};
        bend.to = {x + 0.008, z};
        bend.ends = BendLine::Ends::free;
        device.bends.push_back(bend);
    }
    const Rig rig = sheetRig(device);
    ASSERT_EQ(rig.actuatorCount(), static_cast<std::size_t>(teeth));
    try {
        static_cast<void>(buildPlanOf(rig));
        FAIL() << teeth << " servos in a comb";
    } catch (const InvalidInput& error) {
        EXPECT_THAT(error.subject(), testing::StartsWith("tooth "));
        EXPECT_THAT(error.why(), testing::HasSubstr("no room"));
    }
}

TEST(BuildFiles, NameEveryPartInListAndPage) {
    const BuildPlan& plan = templatePlan("tablet");
    const auto files = buildFiles(plan);
    const auto text = [&](const char* name) {
        return std::string(reinterpret_cast<const char*>(files.at(name).data()), files.at(name).size());
    };
    for (const PrintPart& part : plan.parts) {
        EXPECT_THAT(text("parts.csv"), testing::HasSubstr(part.name + ".stl"));
        EXPECT_THAT(text("assembly.html"), testing::HasSubstr("<td>" + part.name + "</td>"));
    }
    for (const WiringRow& row : plan.wiring) {
        EXPECT_THAT(text("wiring.csv"), testing::HasSubstr("\n" + row.actuator + "," + std::to_string(row.channel) +
                                                           "," + std::to_string(row.pin)));
        EXPECT_THAT(text("assembly.html"), testing::HasSubstr(row.actuator));
    }
    EXPECT_THAT(text("assembly.html"), testing::Not(testing::HasSubstr("http://"))); // it needs nothing else
    EXPECT_THAT(text("sheet.svg"), testing::HasSubstr("width=\"213.00mm\""));        // 209 and a margin
}

TEST(BuildFolder, IsWrittenWholeOrNotAtAll) {
    const auto files = buildFiles(templatePlan("cushion"));
    const auto inside = [](const std::filesystem::path& folder) {
        return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
    };
    const TemporaryFolder folder;
    writeBuildFolder(files, folder / "out");
    EXPECT_EQ(static_cast<std::size_t>(inside(folder / "out")), files.size());
    // Nothing that is there is replaced.
    EXPECT_THROW(writeBuildFolder(files, folder / "out"), InvalidInput);
    EXPECT_EQ(static_cast<std::size_t>(inside(folder / "out")), files.size());
    // An empty folder is taken.
    std::filesystem::create_directory(folder / "empty");
    writeBuildFolder(files, folder / "empty/");
    EXPECT_EQ(static_cast<std::size_t>(inside(folder / "empty")), files.size());
    const auto before = inside(folder.path());
    {
        const FileSizeLimit disk(20'000);
        EXPECT_THROW(writeBuildFolder(files, folder / "full"), DeviceError);
    }
    EXPECT_THROW(writeBuildFolder(files, folder / "missing" / "out"), DeviceError);
    EXPECT_THROW(
        writeBuildFolder(files, folder / "late", [](const auto&) { throw DataError("sketch", "gone", "look"); }),
        DataError);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(writeBuildFolder(files, folder / "stopped", {}, Progress({}, stop.get_token())), Cancelled);
    EXPECT_EQ(inside(folder.path()), before);
}

} // namespace
} // namespace lumorph

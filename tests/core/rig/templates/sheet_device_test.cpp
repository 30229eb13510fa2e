#include "core/rig/templates/sheet_device.h"

#include <limits>
#include <optional>
#include <random>
#include <stop_token>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/geometry/mesh_check.h"
#include "tests/core/rig/templates/random_drawing.h"
#include "tests/support/cgal_oracle.h"
#include "tests/support/long_tests.h"

namespace lumorph {
namespace {

std::vector<double> randomStrokes(std::size_t count, std::mt19937& random) {
    std::vector<double> strokes(count);
    for (double& stroke : strokes) stroke = static_cast<double>(random()) / 4294967296.0;
    return strokes;
}

/// Triangles of the sheet's top, which a flap carries and never turns over: at rest they look up.
double topArea(const Rig& rig, double top) {
    double area = 0.0;
    const auto& p = rig.restMesh().positions;
    for (const glm::uvec3& t : rig.restMesh().triangles)
        if (std::min({p[t.x].y, p[t.y].y, p[t.z].y}) > top - 1e-5)
            area += 0.5 * glm::cross(glm::dvec3(p[t.y] - p[t.x]), glm::dvec3(p[t.z] - p[t.x])).y;
    return area;
}

/// Drawings from here on; sheets were made to work on those below 100,000.
constexpr unsigned kFirstDrawing = 100'000;

class RandomSheets : public testing::TestWithParam<unsigned> {};

// Every drawing that is accepted is a closed solid that neither crosses itself nor turns inside out; every one that is
// refused says which line or measure stands in the way.
TEST_P(RandomSheets, AreSoundInEveryStateOrRefusedWithAReason) {
    const unsigned count = test::longTests() ? 100 : 4;
    const int states = test::longTests() ? 100 : 6;
    unsigned accepted = 0;
    const unsigned first = kFirstDrawing + 1000 * GetParam();
    for (unsigned seed = first; seed < first + count; ++seed) {
        const SheetDevice device = test::RandomDrawing(seed).draw();
        try {
            const Rig rig = sheetRig(device);
            ++accepted;
            ASSERT_EQ(rig.actuatorCount(), device.bends.size());
            std::mt19937 random(seed);
            for (int k = 0; k < states; ++k) {
                const TriangleMesh mesh = deformed(rig, randomStrokes(rig.actuatorCount(), random));
                ASSERT_FALSE(test::crossesItself(mesh)) << "drawing " << seed << ", state " << k;
                ASSERT_GT(signedVolume(mesh), 0.0) << "drawing " << seed << ", state " << k;
            }
        } catch (const InvalidInput& refused) {
            EXPECT_TRUE(refused.subject().find("'line ") != std::string::npos || refused.subject() == "sheet")
                << refused.what();
            EXPECT_FALSE(refused.why().empty() || refused.remedy().empty()) << refused.what();
        }
    }
    EXPECT_GE(10 * accepted, (test::longTests() ? 8 : 5) * count);
    std::printf("%u of %u drawings accepted\n", accepted, count);
}

INSTANTIATE_TEST_SUITE_P(Parts, RandomSheets, testing::Range(0U, 10U));

BendLine lineAt(const char* name, glm::dvec2 from, glm::dvec2 to, BendLine::Ends ends = BendLine::Ends::joined) {
    BendLine bend;
    bend.name = name;
    bend.from = from;
    bend.to = to;
    bend.ends = ends;
    return bend;
}

SheetDevice rectangle(std::vector<BendLine> bends) {
    SheetDevice device;
    device.outline = rectangleOutline(0.2, 0.15);
    device.bends = std::move(bends);
    return device;
}

TEST(SheetDevice, JoinedCornerIsCutNowhere) {
    const Rig rig = sheetRig(rectangle({lineAt("corner", {0.04, -0.075}, {0.1, -0.015})}));
    EXPECT_TRUE(rig.pathInside());
    EXPECT_NEAR(topArea(rig, 0.02), 0.2 * 0.15, 1e-6); // no slit
    const auto& bend = std::get<Bend>(rig.actuators()[0].deformer);
    EXPECT_NEAR(bend.direction.x, std::sqrt(0.5), 1e-6); // towards the corner, the smaller part
    EXPECT_NEAR(bend.direction.z, -std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(bend.origin.y, 0.019, 1e-6);
    // At full stroke the corner's tip is where an arc of 2 cm and a straight rest end.
    const double altitude = 0.06 * std::sqrt(0.5);
    const double height = 0.019 + 0.02 * 2.0 / std::numbers::pi + altitude - 0.02;
    EXPECT_NEAR(rig.reach().max.y, height, 1e-4);
}

TEST(SheetDevice, FreeLineIsCutAtBothEnds) {
    const Rig rig = sheetRig(rectangle({lineAt("tongue", {-0.03, 0.0}, {0.03, 0.0}, BendLine::Ends::free)}));
    const double lost = 0.2 * 0.15 - topArea(rig, 0.02);
    EXPECT_GT(lost, 2 * 0.075 * 0.0004); // two slits, each 0.4 to 2 mm wide
    EXPECT_LT(lost, 2 * 0.075 * 0.002);
    for (const std::uint32_t v : rig.verticesOf(0)) EXPECT_LE(std::abs(rig.restMesh().positions[v].x), 0.0301F);
}

TEST(SheetDevice, LineBesideAnotherBendsAwayFromIt) {
    const Rig rig = sheetRig(
        rectangle({lineAt("left", {-0.01, -0.075}, {-0.01, 0.075}), lineAt("right", {0.01, -0.075}, {0.01, 0.075})}));
    EXPECT_LT(std::get<Bend>(rig.actuators()[0].deformer).direction.x, -0.99F);
    EXPECT_GT(std::get<Bend>(rig.actuators()[1].deformer).direction.x, 0.99F);
}

TEST(SheetDevice, LineThatCrossesAnotherEndsBeforeIt) {
    const Rig rig = sheetRig(rectangle({lineAt("first", {0.0, -0.075}, {0.0, 0.075}),
                                        lineAt("second", {-0.09, 0.02}, {0.02, 0.02}, BendLine::Ends::free)}));
    for (const std::uint32_t v : rig.verticesOf(1)) EXPECT_LT(rig.restMesh().positions[v].x, 0.0F);
}

// What the surface has passed on its way is inside, judged by CGAL.
TEST(SheetDevice, HoldsItsOwnPath) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    int tried = 0;
    int made = 0;
    for (unsigned seed = kFirstDrawing + 50'000; made < 3; ++seed) {
        const SheetDevice drawn = test::RandomDrawing(seed).draw();
        std::optional<Rig> accepted;
        try {
            accepted = sheetRig(drawn);
        } catch (const InvalidInput&) {
            continue; // judged by RandomSheets
        }
        ++made;
        const Rig& rig = *accepted;
        const Box reach = rig.reach();
        for (int state = 0; state < 4; ++state) {
            const auto strokes = randomStrokes(rig.actuatorCount(), random);
            auto earlier = strokes;
            const double share = uniform(random);
            for (double& stroke : earlier) stroke *= share;
            const test::InsideOracle now(deformed(rig, strokes));
            const test::InsideOracle then(deformed(rig, earlier));
            for (int k = 0; k < 2000; ++k) {
                const glm::dvec3 p =
                    glm::dvec3(reach.min) +
                    glm::dvec3(uniform(random), uniform(random), uniform(random)) * glm::dvec3(reach.size());
                if (!then(p)) continue;
                ++tried;
                // The skirt's rows are chords of the rim's way: a little may be missing between two rows.
                bool held = now(p);
                for (int side = 0; side < 6 && !held; ++side) {
                    glm::dvec3 near = p;
                    near[side / 2] += side % 2 == 0 ? 4e-4 : -4e-4;
                    held = now(near);
                }
                EXPECT_TRUE(held) << seed << ": " << p.x << ' ' << p.y << ' ' << p.z;
            }
        }
    }
    EXPECT_GT(tried, 2000);
}

void expectSheetRefused(const SheetDevice& device, const std::string& subject, const std::string& why) {
    try {
        (void)sheetRig(device);
        ADD_FAILURE() << "accepted; expected " << subject << ": " << why;
    } catch (const InvalidInput& refused) {
        EXPECT_NE(refused.subject().find(subject), std::string::npos) << refused.what();
        EXPECT_NE(refused.why().find(why), std::string::npos) << refused.what();
    }
}

TEST(SheetDevice, WrongDrawingsAreRefusedByName) {
    const auto good = lineAt("fold", {0.05, -0.08}, {0.05, 0.08});
    const auto with = [&](auto change) {
        SheetDevice device = rectangle({good});
        change(device);
        return device;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expectSheetRefused(with([](auto& d) { d.thickness = 0.0; }), "thickness", "0 cm cannot be built");
    expectSheetRefused(with([&](auto& d) { d.thickness = nan; }), "thickness", "no finite number");
    expectSheetRefused(with([](auto& d) { d.thickness = 0.02; }), "'fold'", "so thick");
    expectSheetRefused(with([](auto& d) { d.housing = -0.01; }), "housing", "cannot be built");
    expectSheetRefused(with([](auto& d) { d.arc = 1.0; }), "arc", "cannot be built");
    expectSheetRefused(with([](auto& d) { d.outline.clear(); }), "sheet", "encloses nothing");
    expectSheetRefused(with([](auto& d) { std::swap(d.outline[1], d.outline[2]); }), "sheet", "crosses itself");
    expectSheetRefused(with([&](auto& d) { d.outline[1].x = nan; }), "sheet", "no finite number");
    expectSheetRefused(with([](auto& d) { d.outline = rectangleOutline(0.01, 0.01); }), "sheet", "large");
    expectSheetRefused(with([&](auto& d) { d.bends[0].to.y = nan; }), "'fold'", "no finite number");
    expectSheetRefused(with([](auto& d) { d.bends[0].angle = Angle::degrees(120.0); }), "'fold'", "0 and 90 degrees");
    expectSheetRefused(with([](auto& d) { d.bends[0].angle = Angle::degrees(0.0); }), "'fold'", "0 and 90 degrees");
    expectSheetRefused(with([](auto& d) { d.bends[0].to = d.bends[0].from; }), "'fold'", "shorter");
    expectSheetRefused(with([&](auto& d) { d.bends.push_back(good); }), "'fold'", "two bend lines have this name");
    expectSheetRefused(with([](auto& d) { d.bends.assign(500, d.bends[0]); }), "sheet", "500 bend lines are too many");
    expectSheetRefused(with([](auto& d) { d.bends[0].from.x = d.bends[0].to.x = 0.15; }), "'fold'",
                       "does not cross the sheet");
    expectSheetRefused(rectangle({lineAt("one", {0.0, -0.07}, {0.05, 0.1}), lineAt("two", {0.09, -0.07}, {0.04, 0.1})}),
                       "'two'", "meets bend line 'one' outside the sheet");
    expectSheetRefused(rectangle({good, lineAt("beside", {0.051, -0.08}, {0.051, 0.08})}), "'fold'",
                       "bend line 'beside'");
}

TEST(SheetDevice, CanBeCancelled) {
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)sheetRig(rectangle({}), Progress({}, stop.get_token())), Cancelled);
}

} // namespace
} // namespace lumorph

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/ice/ice.h"
#include "app/applications/ice/pond_bed.h"
#include "core/motion/causal_split.h"
#include "core/motion/surface_heights.h"
#include "tests/support/long_tests.h"
#include "tests/support/program_visit.h"

// R32, R34, R40: the frozen pond as visitors meet it: what is seen and heard, what servos carry, what a frame costs.

namespace lumorph::ice {
namespace {

using test::kFrame;
using test::tabletRig;
using Visit = test::ProgramVisit;

/// Free floes of the moment.
int freeFloes(const IceProgram& program) {
    return static_cast<int>(std::ranges::count_if(program.ice().floes(), [](const Floe& floe) { return !floe.fixed; }));
}

TEST(IceProgram, ShowsAllByItselfWithinAMinuteAndFreezesOverAgain) {
    IceProgram program(1);
    Visit visit(program);
    bool wasClosed = false;
    int most = 0;
    double least = 1.0;
    for (int k = 0; k < 60 * 60; ++k) {
        visit.frame();
        if (k % 30 == 0) {
            ASSERT_NO_THROW(checkScene(*visit.content().scene)) << k;
        }
        const double share = program.ice().iceArea() / program.ice().sheet().area();
        wasClosed = wasClosed || share > 0.999;
        if (wasClosed && program.ice().winter() == 1) least = std::min(least, share);
        most = std::max(most, freeFloes(program));
    }
    EXPECT_TRUE(program.playsItself());
    EXPECT_TRUE(wasClosed);
    EXPECT_GE(most, 8) << "floes drift";
    EXPECT_LT(least, 0.2) << "it thaws";
    EXPECT_EQ(program.ice().winter(), 2U) << "and freezes over again";
    EXPECT_GT(program.ice().iceArea(), 0.5 * program.ice().sheet().area());
    for (const char* sound : {"ice.crack", "ice.bump", "ice.drip", "ice.splash"})
        EXPECT_GE(visit.heard(sound), 2) << sound;
}

TEST(IceProgram, APointerMeltsWhereItIsAndCracksWhereItRests) {
    IceProgram program(1);
    Visit visit(program);
    visit.frames(5.0);
    visit.frame({{"pointer.x", 0.5}, {"pointer.y", -0.4}});
    EXPECT_FALSE(program.playsItself());
    const glm::dvec2 place = glm::dvec2(0.5, -0.4) * kPondHalf;
    ASSERT_EQ(program.warmths().size(), 1U);
    EXPECT_LT(glm::distance(program.warmths().front().place, place), 1e-9);
    const int cracks = visit.heard("ice.crack");
    visit.frames(1.5);
    EXPECT_EQ(visit.heard("ice.crack"), cracks + 1) << "after a second of rest";
    visit.frames(3.0);
    EXPECT_LT(program.ice().iceArea(), program.ice().sheet().area() - 5e-5) << "a hole of 8 mm";
    // It lies on the bank, or over no view: nothing melts.
    visit.frame({{"pointer.x", 1.0}, {"pointer.y", 1.0}});
    EXPECT_TRUE(program.warmths().empty());
    visit.frame({{"pointer.x", NAN}, {"pointer.y", INFINITY}});
    visit.frame({{"pointer.over", 0.0}});
    EXPECT_TRUE(program.warmths().empty());
}

TEST(IceProgram, KeysCrackItAndFreezeItOver) {
    IceProgram program(2);
    Visit visit(program);
    visit.frames(5.0);
    for (int k = 0; k < 3; ++k) {
        visit.frame({{"key.next", 1.0}});
        visit.frame({{"key.next", 0.0}});
        visit.frames(1.0);
    }
    EXPECT_GE(visit.heard("ice.crack"), 3);
    EXPECT_LT(program.ice().iceArea(), program.ice().sheet().area() - 1e-6);
    const auto winter = program.ice().winter();
    visit.frame({{"key.restart", 1.0}});
    visit.frames(IceCover::kLeaving + IceCover::kFreezing + 0.2);
    EXPECT_EQ(program.ice().winter(), winter + 1);
    EXPECT_NEAR(program.ice().iceArea(), program.ice().sheet().area(), 1e-9);
    EXPECT_FALSE(program.playsItself());
    visit.frames(Visitor::kSilence);
    EXPECT_TRUE(program.playsItself());
}

TEST(IceProgram, ATrackedHandMeltsAndALostOneDoesNothing) {
    IceProgram program(1);
    ShowMoment moment;
    moment.rig = tabletRig();
    moment.step = kFrame;
    ShowBody hand{"Hand", PoseRole::pointer, {{-0.04, 0.05, 0.02}, {1.0, 0.0, 0.0, 0.0}}};
    const auto play = [&](double seconds) {
        for (int k = 0; k < std::lround(seconds / kFrame); ++k) {
            moment.bodies = std::span(&hand, 1);
            (void)program.frame(moment);
            moment.seconds += kFrame;
        }
    };
    play(8.0);
    ASSERT_EQ(program.warmths().size(), 1U);
    EXPECT_FALSE(program.playsItself());
    const double area = program.ice().iceArea();
    EXPECT_LT(area, program.ice().sheet().area() - 2e-5);
    for (const glm::dvec3& nowhere : {glm::dvec3(NAN), {0.0, INFINITY, 0.0}, {0.0, 0.5, 0.0}, {3.0, 0.03, 0.0}}) {
        hand.pose.position = nowhere;
        play(kFrame);
        EXPECT_TRUE(program.playsItself());
    }
    moment.worldFromDevice = glm::mat4(NAN);
    play(0.1);
    EXPECT_TRUE(std::isfinite(program.ice().iceArea()));
}

TEST(IceProgram, FishFleeFromWarmth) {
    School school(pondShore(), 7, 3);
    for (int k = 0; k < 600; ++k) school.advance(kFrame, {});
    const glm::dvec2 warm = school.fish().front().place + glm::dvec2(0.004, 0.003);
    const std::vector<Warmth> warmths{{warm, 0.018, 1.0}};
    for (int k = 0; k < 240; ++k) school.advance(kFrame, warmths);
    for (const Fish& fish : school.fish()) {
        EXPECT_GT(glm::distance(fish.place, warm), 0.02);
        EXPECT_LT(std::abs(fish.place.x), kPondHalf.x);
        EXPECT_LT(std::abs(fish.place.y), kPondHalf.y);
    }
}

TEST(IceProgram, IsTheSameBitForBitForTheSameSeedAndInputs) {
    IceProgram one(7), other(7);
    Visit a(one), b(other);
    for (int k = 0; k < 60 * 20; ++k) {
        std::vector<ShowInput> inputs;
        if (k % 50 == 0) inputs = {{"pointer.x", std::sin(0.01 * k)}, {"pointer.y", std::cos(0.013 * k)}};
        if (k % 200 == 7) inputs.push_back({"key.next", 1.0});
        a.frame(inputs);
        b.frame(inputs);
        ASSERT_TRUE(*a.content().scene == *b.content().scene) << k;
        ASSERT_EQ(std::get<HeightGrid>(a.content().target).heights, std::get<HeightGrid>(b.content().target).heights);
        ASSERT_EQ(a.content().sounds, b.content().sounds);
    }
    EXPECT_GT(one.ice().floes().size(), 2U);
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// How alike two series are, -1 to 1.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const double meanA = mean(a), meanB = mean(b);
    double ab = 0.0, aa = 0.0, bb = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        ab += (a[k] - meanA) * (b[k] - meanB);
        aa += (a[k] - meanA) * (a[k] - meanA);
        bb += (b[k] - meanB) * (b[k] - meanB);
    }
    return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

// What hands feel without light: floes as mounds, where the device can rise at all.
TEST(IceProgram, TheTabletLiftsTheFloes) {
    CausalSplit split(*tabletRig());
    const std::vector<double> all(tabletRig()->actuatorCount(), 1.0);
    std::vector<float> most(split.points().size());
    heightsOfMesh(deformed(*tabletRig(), std::vector(all.size(), 0.2)), split.points(), most);
    IceProgram program(1);
    Visit visit(program);
    std::vector<double> wanted, carried;
    std::vector<double> strokes;
    double highest = 0.0, fastest = 0.0;
    for (int k = 0; k < 60 * 40; ++k) {
        visit.frame();
        if (k % 3 != 0) continue;
        const auto& grid = std::get<HeightGrid>(visit.content().target);
        ASSERT_NO_THROW(checkHeightGrid(grid));
        std::vector<float> heights;
        for (const glm::vec2& point : split.points())
            heights.push_back(static_cast<float>(heightAt(grid, glm::dvec2(point))));
        const std::vector<double> next = split.strokes(heights, 3.0 * kFrame);
        for (std::size_t s = 0; s < next.size(); ++s) {
            ASSERT_GE(next[s], 0.0);
            ASSERT_LE(next[s], 1.0);
            if (!strokes.empty())
                fastest = std::max(fastest, std::abs(next[s] - strokes[s]) / (3.0 * kFrame) /
                                                tabletRig()->actuators()[s].maxVelocity);
        }
        strokes = next;
        if (k % 60 != 0 || k < 60 * 15) continue;
        std::vector<float> top(split.restHeights().begin(), split.restHeights().end());
        heightsOfMesh(deformed(*tabletRig(), strokes), split.points(), top);
        for (std::size_t p = 0; p < top.size(); ++p) {
            const double rest = static_cast<double>(split.restHeights()[p]);
            if (!(static_cast<double>(most[p]) - rest > 0.002) || !std::isfinite(heights[p])) continue;
            wanted.push_back(static_cast<double>(heights[p]) - 0.02);
            carried.push_back(static_cast<double>(top[p]) - rest);
            highest = std::max(highest, carried.back());
        }
    }
    const double figure = correlation(wanted, carried);
    RecordProperty("heightCorrelation", std::to_string(figure));
    std::printf("servos carry the floes: height correlation %.2f where the tablet moves, highest %.1f mm, fastest %.2f "
                "of the limit\n",
                figure, 1e3 * highest, fastest);
    EXPECT_GT(figure, 0.6);
    EXPECT_GT(highest, 0.004) << "a millimetre is felt";
    EXPECT_LE(fastest, 1.0 + 1e-6);
}

// Scripted visitors come and go, half an hour among the long tests; frames are longer than in a show, steps are not.
TEST(IceProgram, VisitorsForLongLeaveTheMemoryAsItIs) {
    const int minutes = test::longTests() ? 30 : 8;
    IceProgram program(1);
    const test::LongVisit visit =
        test::visitForLong(program, 60.0 * minutes, 1.0 / 20.0, [](int k, double, ShowInputs& inputs) {
            const bool somebody = k / (20 * 90) % 2 == 1; // a minute and a half each, of which 45 s are silent
            if (somebody && k % 25 == 0) {
                inputs.push({"pointer.x", 0.9 * std::sin(0.003 * k)});
                inputs.push({"pointer.y", 0.9 * std::cos(0.0047 * k)});
            }
            if (somebody && k % 130 == 0) inputs.push({"key.next", 1.0});
            if (k % (20 * 90) == 20 * 89) inputs.push({"pointer.over", 0.0});
        });
    test::expectSteady(visit);
    EXPECT_LT(visit.grown(&test::LongVisit::Memory::resident, 60.0), 5.0) << "megabytes";
    EXPECT_GE(static_cast<int>(program.ice().winter()), minutes / 2);
}

} // namespace
} // namespace lumorph::ice

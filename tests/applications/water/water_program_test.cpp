#include "app/applications/water/water_program.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/scene/posed_scene.h"
#include "tests/support/program_visit.h"

// The sea as visitors meet it: who leans it lets the water run, and what floats with it; storms, calms and what is
// thrown in.

namespace lumorph::test {
namespace {

class WaterProgramTest : public ::testing::Test {
protected:
    [[nodiscard]] const SceneItem& item(const std::string& name) {
        return *std::ranges::find(visit.content().scene->items, name, &SceneItem::name);
    }
    [[nodiscard]] const HeightGrid& felt() { return std::get<HeightGrid>(visit.content().target); }
    /// From the lowest to the highest, metres.
    [[nodiscard]] double swell() {
        double most = 0.0;
        for (int k = 0; k < 8 * 60; ++k) {
            visit.frame();
            const auto [low, high] = std::ranges::minmax(felt().heights);
            most = std::max(most, double{high} - double{low});
        }
        return most;
    }
    [[nodiscard]] double sideways() { // by how much the right side is higher than the left
        const HeightGrid& grid = felt();
        double sum = 0.0;
        for (int j = 0; j < grid.rows; ++j)
            sum += grid.heights[static_cast<std::size_t>((j + 1) * grid.columns - 1)] -
                   grid.heights[static_cast<std::size_t>(j * grid.columns)];
        return sum / grid.rows;
    }

    WaterProgram program;
    ProgramVisit visit{program};
};

TEST_F(WaterProgramTest, BuoyAndCrateFloatOnTheWaterThatIsFelt) {
    for (int k = 0; k < 600; ++k) {
        visit.frame();
        if (k % 60 == 0) {
            ASSERT_NO_THROW(checkScene(*visit.content().scene));
        }
        for (const char* name : {"Buoy", "Crate"}) {
            const glm::vec3 at = item(name).position;
            const HeightGrid& grid = felt();
            const glm::dvec2 share = (glm::dvec2(at.x, at.z) - grid.min) / (grid.max - grid.min);
            const auto column = static_cast<int>(std::lround(share.x * (grid.columns - 1)));
            const auto row = static_cast<int>(std::lround(share.y * (grid.rows - 1)));
            const float water = grid.heights[static_cast<std::size_t>(row * grid.columns + column)];
            ASSERT_NEAR(at.y, water + 0.003, 0.003) << name << " in frame " << k;
        }
    }
    EXPECT_EQ(visit.content().following, Following::split);
}

TEST_F(WaterProgramTest, WhoLeansItLetsTheWaterRunAndWhatFloatsToo) {
    visit.frame();
    const float from = item("Buoy").position.x;
    visit.frame({{"key.right", 1.0}});
    visit.frame({{"key.out", 1.0}}); // flat, so that the slope is all
    visit.frames(3.0);
    EXPECT_GT(sideways(), 0.02) << "metres: the right side is down, so water stands higher there over the device";
    EXPECT_GT(item("Buoy").position.x, from + 0.01F) << "to the low side";
    visit.frame({{"key.right", 0.0}});
    visit.frames(8.0);
    EXPECT_LT(std::abs(sideways()), 0.004) << "it has settled";
}

TEST_F(WaterProgramTest, TheWheelMakesStormAndCalm) {
    const double usual = swell();
    visit.frame({{"wheel", -8.0}});
    visit.frame({{"wheel", -8.0}});
    visit.frames(4.0);
    EXPECT_NEAR(program.storm(), WaterProgram::kCalmest, 0.01);
    EXPECT_LT(swell(), 0.35 * usual);
    for (int k = 0; k < 4; ++k) visit.frame({{"wheel", 8.0}});
    visit.frames(4.0);
    EXPECT_NEAR(program.storm(), WaterProgram::kStormiest, 0.01);
    EXPECT_GT(swell(), 1.15 * usual);
    visit.frame({{"key.restart", 1.0}});
    visit.frames(4.0);
    EXPECT_NEAR(program.storm(), 1.0, 0.02);
}

TEST_F(WaterProgramTest, ThingsAreThrownInAndStayApartOnTheWater) {
    for (int k = 0; k < 12; ++k) {
        visit.frame({{"key.next", 1.0}, {"key.left", k % 2 == 0 ? 1.0 : 0.0}});
        visit.frames(1.0);
        ASSERT_NO_THROW(checkScene(*visit.content().scene));
        std::vector<glm::vec3> places;
        for (const SceneItem& one : visit.content().scene->items)
            if (std::holds_alternative<ShapeItem>(one.kind)) places.push_back(one.position);
        for (std::size_t i = 0; i < places.size(); ++i) {
            EXPECT_LT(std::abs(places[i].x), 0.105F);
            EXPECT_LT(std::abs(places[i].z), 0.075F);
            for (std::size_t j = i + 1; j < places.size(); ++j)
                EXPECT_GT(glm::distance(places[i], places[j]), 0.008F) << k;
        }
    }
    EXPECT_EQ(program.floats(), WaterProgram::kMostFloats);
    visit.frame({{"key.restart", 1.0}});
    EXPECT_EQ(program.floats(), 2U);
}

TEST_F(WaterProgramTest, APressMakesARingThatIsFeltAndPushesTheBuoy) {
    WaterProgram still;
    ProgramVisit other{still};
    const std::vector<ShowInput> there{{"pointer.x", -0.25}, {"pointer.y", 0.2}, {"key.out", 1.0}};
    visit.frame(there);
    other.frame(there); // the same, without the press
    const glm::dvec2 pressed(-0.25 * 0.105, 0.2 * 0.075);
    visit.frame({{"pointer.held", 1.0}});
    visit.frame({{"pointer.held", 0.0}});
    other.frame();
    other.frame();
    EXPECT_EQ(visit.heard("water.drop"), 1);
    double most = 0.0;
    for (int k = 0; k < 90; ++k) {
        visit.frame();
        other.frame();
        const HeightGrid& calm = std::get<HeightGrid>(other.content().target);
        for (std::size_t i = 0; i < calm.heights.size(); ++i)
            most = std::max(most, std::abs(double{felt().heights[i]} - double{calm.heights[i]}));
    }
    EXPECT_GT(most, 0.003) << "metres, of what servos are to follow";
    EXPECT_LT(most, 0.020);
    const auto far = [&](const ShowContent& content) {
        const glm::vec3& at = std::ranges::find(content.scene->items, std::string("Buoy"), &SceneItem::name)->position;
        return glm::distance(glm::dvec2(at.x, at.z), pressed);
    };
    EXPECT_GT(far(visit.content()), far(other.content()) + 0.004);
    EXPECT_EQ(other.heard("water.drop"), 0);
}

TEST_F(WaterProgramTest, WhatIsThrownInFallsAndSplashes) {
    visit.frame({{"key.next", 1.0}});
    const float above = item("Thrown in 1").position.y;
    const glm::dvec2 place(item("Thrown in 1").position.x, item("Thrown in 1").position.z);
    EXPECT_EQ(visit.heard("water.splash"), 0);
    visit.frames(0.6);
    EXPECT_EQ(visit.heard("water.splash"), 1);
    EXPECT_LT(item("Thrown in 1").position.y, above - 0.04F);
    EXPECT_GT(program.water().foamAt(place), 0.3);
}

TEST_F(WaterProgramTest, TheBoatIsLeantIntoTheRingAndTheLightComesUpElsewhere) {
    visit.frame({{"key.out", 1.0}});
    const glm::dvec2 light = program.harbour().place();
    for (int k = 0; k < 40 * 60 && program.harbour().visits() == 0; ++k) {
        // Full lean towards the light, as one who watches the boat would.
        const glm::dvec2 way = 0.06 * glm::normalize(light - program.boat());
        visit.lean(static_cast<float>(way.y), static_cast<float>(-way.x));
        visit.frame();
    }
    EXPECT_EQ(program.harbour().visits(), 1);
    EXPECT_LT(glm::distance(program.boat(), light), sea::Harbour::kReach);
    EXPECT_EQ(visit.heard("water.harbour"), 1);
    EXPECT_TRUE(program.harbour().shining());
    EXPECT_NE(visit.content().caption->sentence.english.find("Safe"), std::string::npos);
    visit.lean(0.0F, 0.0F);
    visit.frames(sea::Harbour::kShines + 0.1);
    EXPECT_FALSE(program.harbour().shining());
    EXPECT_GT(glm::distance(program.harbour().place(), light), 0.05);
    EXPECT_EQ(visit.content().caption->sentence.english.find("Safe"), std::string::npos);
}

TEST_F(WaterProgramTest, ByItselfItShowsWhatCanBeDoneAndAlwaysTheSame) {
    WaterProgram first, again;
    ProgramVisit one{first, 1.0 / 30.0}, second{again, 1.0 / 30.0};
    one.frames(22.0);
    second.frames(22.0);
    EXPECT_GE(one.heard("water.drop"), 3);
    EXPECT_GE(one.heard("water.splash"), 1);
    EXPECT_GE(first.harbour().visits(), 1);
    EXPECT_EQ(std::get<HeightGrid>(one.content().target).heights,
              std::get<HeightGrid>(second.content().target).heights);
    EXPECT_EQ(one.content().scene->items, second.content().scene->items);
}

TEST_F(WaterProgramTest, FoamLiesAlongThingsAndTheOpenWaterIsClear) {
    visit.frame({{"key.out", 1.0}});
    visit.frames(4.0);
    const glm::vec3 buoy = item("Buoy").position;
    EXPECT_GT(program.water().foamAt({buoy.x + 0.0125F, buoy.z}), 0.4);
    EXPECT_LT(program.water().foamAt({buoy.x + 0.026F, buoy.z}), 0.1);
    EXPECT_GT(program.water().foamAt({0.105, 0.01}), 0.4) << "the rim";
}

TEST_F(WaterProgramTest, TheSurfaceIsTheWaterThatIsFelt) {
    visit.frames(1.0);
    const SceneModel& model = *visit.content().assets->models.at("sea surface");
    const Model::Primitive& top = model.model.meshes.front().primitives.front();
    ASSERT_EQ(top.positions.size(), std::size_t{sea::SeaSurface::kColumns * sea::SeaSurface::kRows});
    for (std::size_t k = 0; k < top.positions.size(); k += 37) {
        const glm::vec3& at = top.positions[k];
        const double water = heightAt(felt(), glm::clamp(glm::dvec2(at.x, at.z), felt().min, felt().max - 1e-9));
        ASSERT_NEAR(at.y, water, 0.0008) << k;
    }
    // Normals against the slope of what is felt.
    const auto middle = static_cast<std::size_t>(40 * sea::SeaSurface::kColumns + 56);
    const glm::vec3 normal = top.normals[middle];
    const double slope = (heightAt(felt(), {0.00375, 0.0}) - heightAt(felt(), {-0.00375, 0.0})) / 0.0075;
    EXPECT_NEAR(-normal.x / normal.y, slope, 0.08);
}

} // namespace
} // namespace lumorph::test

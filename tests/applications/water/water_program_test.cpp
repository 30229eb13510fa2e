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

} // namespace
} // namespace lumorph::test

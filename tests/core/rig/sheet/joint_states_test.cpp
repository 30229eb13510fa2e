#include "core/rig/sheet/joint_states.h"

#include <algorithm>
#include <array>
#include <mutex>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/rig/sheet/small_sheet.h"

namespace lumorph {
namespace {

constexpr BakeSettings kCoarse{0.01, 3, 1e-4};

double farthest(const JointStates& baked, const SheetPose& pose) {
    double largest = 0.0;
    for (std::size_t k = 0; k < baked.mesh.points.size(); ++k) {
        const glm::dvec2 rest = baked.mesh.points[k];
        const glm::dvec3 moved(rowDisplacement(baked.modes, k, pose.strokes));
        largest = std::max(largest, glm::distance(glm::dvec3(rest.x, 0.0, rest.y) + moved, pose.state.positions[k]));
    }
    return largest;
}

TEST(JointStates, ModesGiveTheGridsStatesAndThoseBetween) {
    const ElasticSheet sheet = smallSheet();
    const JointStates baked = bakeJointStates(sheet, kCoarse);
    LeveredSheet levered(sheet, baked.mesh);
    for (const auto& strokes : {std::array{0.0, 0.5}, {0.5, 1.0}, {1.0, 1.0}})
        EXPECT_LT(farthest(baked, levered.followed(strokes)), 1.1 * kCoarse.truncation);
    for (const auto& strokes : {std::array{0.25, 0.75}, {0.1, 0.9}, {0.73, 0.31}})
        EXPECT_LT(farthest(baked, levered.followed(strokes)), 5e-4);
    EXPECT_EQ(baked.solved, 6); // of 9: the others are mirror images
    EXPECT_TRUE(baked.seconds.empty());
    EXPECT_EQ(baked.modes.secondStates, 0U);
}

TEST(JointStates, LoadsAreTheLargestOfTheGrid) {
    const ElasticSheet sheet = smallSheet();
    const JointStates baked = bakeJointStates(sheet, kCoarse);
    LeveredSheet levered(sheet, baked.mesh);
    const double alone = levered.followed(std::array{1.0, 0.0}).loads[0].force;
    ASSERT_EQ(baked.largestLoads.size(), 2U);
    EXPECT_NEAR(baked.largestLoads[0].force, baked.largestLoads[1].force, 1e-9);
    EXPECT_GE(baked.largestLoads[0].force, 0.999 * alone);
    EXPECT_GT(baked.largestFaceStrain, baked.largestStretch);
}

TEST(JointStates, ReportProgressAndStopWhenAsked) {
    std::stop_source stop;
    std::mutex guard;
    std::vector<double> fractions;
    const Progress progress(
        [&](double fraction, std::string_view) {
            const std::lock_guard lock(guard);
            fractions.push_back(fraction);
        },
        stop.get_token());
    (void)bakeJointStates(smallSheet(), kCoarse, progress);
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    EXPECT_GE(fractions.size(), 6U);
    stop.request_stop();
    EXPECT_THROW((void)bakeJointStates(smallSheet(), kCoarse, progress), Cancelled);
}

TEST(JointStates, SheetsWithoutLeversAreRefused) {
    ElasticSheet sheet = smallSheet();
    sheet.levers.clear();
    EXPECT_THROW((void)bakeJointStates(sheet, kCoarse), InvalidInput);
    EXPECT_THROW((void)bakeJointStates(smallSheet(), {0.01, 9, 1e-4}), InvalidInput);
}

} // namespace
} // namespace lumorph

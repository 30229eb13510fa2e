#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "core/mdf/builder.h"
#include "core/mdf/coverage.h"
#include "core/voxels/solid.h"
#include "tests/support/lifted_sheet.h"

namespace lumorph {
namespace {

constexpr int kSheetLevels = 9;
constexpr int kPathStates = 48;

// R6: the skirt holds what the rim passed, so that the solid at s alone is V(s): against the union over the path.
TEST(SheetCoverage, TheSolidHoldsItsPath) {
    const Rig rig(test::liftedSheetParts());
    const Coverage coverage(rig, frameOf(rig.reach(), 24), kSheetLevels);
    CoverageScratch scratch;
    SolidVoxelizer voxelizer;
    std::mt19937 random(2);
    std::vector<glm::vec3> positions(rig.restMesh().positions.size());
    std::size_t passed = 0;
    std::size_t uncovered = 0;
    for (int k = 0; k < 12; ++k) {
        State state(rig.actuatorCount());
        for (Level& level : state) level.index = k == 0 ? kSheetLevels - 1 : static_cast<int>(random() % kSheetLevels);
        const std::vector<double> strokes = strokesOf(rig, state, kSheetLevels);
        BitColumns onTheWay(coverage.frame().dimensions);
        BitColumns solid;
        for (int step = 1; step <= kPathStates; ++step) {
            std::vector<double> along = strokes;
            for (double& stroke : along) stroke *= static_cast<double>(step) / kPathStates;
            rig.deform(along, positions);
            voxelizer.voxelize(coverage.frame(), positions, rig.restMesh().triangles, solid);
            onTheWay |= solid;
        }
        onTheWay -= coverage.body();
        BitColumns covered;
        coverage.covered(state, covered, scratch);
        BitColumns afresh;
        coverage.coveredAt(strokes, afresh, scratch);
        EXPECT_EQ(covered, afresh) << "kept pieces against all anew";
        passed += onTheWay.count();
        onTheWay -= covered;
        uncovered += onTheWay.count();
    }
    const double share = static_cast<double>(uncovered) / static_cast<double>(passed);
    std::cout << "[ figures  ] uncovered again: " << 100.0 * share << " % of " << passed << " voxels\n";
    EXPECT_GT(passed, 10'000U);
    EXPECT_LT(share, 0.005);
}

TEST(SheetCoverage, FieldOfOverlappingLeversIsBuilt) {
    const Rig rig(test::liftedSheetParts());
    const Field field = buildField(rig, {.resolution = 10, .levels = 5, .samples = 8});
    ASSERT_EQ(field.actuators.size(), 6U);
    EXPECT_EQ(Coverage(rig, field.frame, 5).coupledPairs().size(), 15U);
    EXPECT_GT(reachableVoxels(field).count(), 500U);
}

} // namespace
} // namespace lumorph

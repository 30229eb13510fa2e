#include "core/rig/templates/bundled_rigs.h"

#include <gtest/gtest.h>

#include "core/base/file.h"
#include "core/geometry/mesh_check.h"
#include "core/rig/rig_file.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {
namespace {

struct Bundled {
    const char* file;
    Rig (*make)();
};

class BundledModels : public testing::TestWithParam<Bundled> {};

TEST_P(BundledModels, AreWhatTheGeneratorWrites) {
    const auto committed = readFile(std::string(LUMORPH_SOURCE_DIR "/resources/models/") + GetParam().file, 1 << 24);
    EXPECT_EQ(writeRigGlb(GetParam().make()), committed);
}

TEST_P(BundledModels, AreClosedSolidsInEveryCorner) {
    const Rig rig = GetParam().make();
    for (int corner = 0; corner < (rig.actuatorCount() > 6 ? 2 : 1 << rig.actuatorCount()); ++corner) {
        std::vector<double> strokes(rig.actuatorCount(), corner);
        if (rig.actuatorCount() <= 6)
            for (std::size_t a = 0; a < strokes.size(); ++a) strokes[a] = (corner >> a) & 1;
        const MeshReport report = checkMesh(deformed(rig, strokes));
        EXPECT_TRUE(report.solid()) << testing::PrintToString(report.findings());
        EXPECT_EQ(report.components, 1U);
        EXPECT_EQ(report.degenerateTriangles, 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(Models, BundledModels,
                         testing::Values(Bundled{"pin_display.glb", [] { return pinDisplayRig(); }},
                                         Bundled{"ribbon.glb", ribbonRig}, Bundled{"hills.glb", hillsRig}),
                         [](const auto& kind) {
                             const std::string file = kind.param.file;
                             return file.substr(0, file.find('.'));
                         });

// R4, R5: many actuators.
TEST(PinDisplay, HasNineHundredSlidersAndAMillionVoxels) {
    const Rig rig = pinDisplayRig();
    EXPECT_EQ(rig.actuatorCount(), 900U);
    EXPECT_TRUE(rig.pathInside());
    for (const Actuator& actuator : rig.actuators()) {
        EXPECT_TRUE(std::holds_alternative<Slide>(actuator.deformer));
        EXPECT_EQ(actuator.levels, 101);
    }
    for (std::uint32_t v = 0; v < rig.restMesh().positions.size(); ++v) EXPECT_LE(rig.actuatorsOf(v).size(), 1U);
    const VoxelFrame frame = frameOf(rig.reach(), 100);
    EXPECT_EQ(frame.dimensions, glm::ivec3(102, 100, 102));
    EXPECT_GE(frame.voxelCount(), 1'000'000U);
}

TEST(PinDisplay, AnyMixOfPinsIsASolid) {
    const Rig rig = pinDisplayRig();
    std::vector<double> strokes(900);
    for (std::size_t a = 0; a < strokes.size(); ++a) strokes[a] = static_cast<double>(a * 37 % 101) / 100.0;
    EXPECT_TRUE(checkMesh(deformed(rig, strokes)).solid());
}

} // namespace
} // namespace lumorph

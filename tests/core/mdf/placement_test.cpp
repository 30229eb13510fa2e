#include "core/mdf/placement.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/auto_place.h"
#include "core/mdf/builder.h"
#include "core/mdf/clip.h"
#include "core/mdf/refine.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

class PlacementTest : public testing::Test {
protected:
    PlacementTest()
        : rig_(test::cushionRig()), field_(buildField(rig_, options())), coverage_(rig_, field_.frame, field_.levels),
          voting_(field_) {}
    static BuildOptions options() {
        BuildOptions o;
        o.resolution = 14;
        o.levels = 11;
        o.samples = 30;
        return o;
    }
    Rig rig_;
    Field field_;
    Coverage coverage_;
    Voting voting_;
};

TEST_F(PlacementTest, FitIsTheLargestScaleThatStandsOnTheRestSurface) {
    const Box frame = field_.frame.box();
    const float room = frame.max.y - field_.restSurface;
    struct Case {
        glm::vec3 low, high;
        Angle yaw;
    };
    for (const Case& c :
         {Case{{-3, 5, 2}, {1, 6, 3}, {}}, Case{{0, 0, 0}, {0.001F, 0.2F, 0.001F}, {}},
          Case{{0, 0, 0}, {4, 1, 1}, Angle::degrees(90)}, Case{{-1, -1, -1}, {1, 1, 1}, Angle::degrees(45)}}) {
        const TriangleMesh mesh = test::boxMesh(c.low, c.high);
        const Placement placement = fitPlacement(field_, boundingBox(mesh.positions), c.yaw);
        const Box box = boundingBox(placed(mesh, placement).positions);
        EXPECT_NEAR(box.min.y, field_.restSurface, 1e-6);
        EXPECT_NEAR(box.centre().x, frame.centre().x, 1e-6);
        EXPECT_NEAR(box.centre().z, frame.centre().z, 1e-6);
        const glm::vec3 share = box.size() / glm::vec3(frame.size().x, room, frame.size().z);
        EXPECT_NEAR(std::max({share.x, share.y, share.z}), 1.0, 1e-4) << "it could be larger, or sticks out";
    }
    EXPECT_THROW((void)fitPlacement(field_, Box{}), InvalidInput);
}

TEST_F(PlacementTest, AMeshWithASmallHoleIsRepairedAndSaysSo) {
    TriangleMesh mesh = test::boxMesh({0.011F, 0.021F, 0.012F}, {0.073F, 0.041F, 0.061F}, 8);
    SolidVoxelizer voxelizer;
    BitColumns whole;
    const Target closed = makeTarget(mesh);
    EXPECT_TRUE(closed.closed);
    EXPECT_TRUE(closed.warnings.empty());
    voxelizeTarget(field_.frame, closed, voxelizer, whole);
    mesh.triangles.erase(mesh.triangles.begin() + 30, mesh.triangles.begin() + 34); // in the flat top
    const Target repaired = makeTarget(mesh);
    EXPECT_TRUE(repaired.closed);
    ASSERT_GE(repaired.warnings.size(), 2U);
    EXPECT_NE(repaired.warnings.front().find("repaired"), std::string::npos);
    BitColumns again;
    voxelizeTarget(field_.frame, repaired, voxelizer, again);
    EXPECT_EQ(again, whole);
}

TEST_F(PlacementTest, AMeshWithALargeHoleIsMatchedWithAWarningAndNearlyTheSameVoxels) {
    TriangleMesh mesh = test::boxMesh({0.011F, 0.021F, 0.012F}, {0.073F, 0.041F, 0.061F}, 20);
    SolidVoxelizer voxelizer;
    BitColumns whole;
    voxelizeTarget(field_.frame, makeTarget(mesh), voxelizer, whole);
    std::erase_if(mesh.triangles, [&](const glm::uvec3& t) { // the whole bottom: 80 edges around it
        return std::max({mesh.positions[t.x].y, mesh.positions[t.y].y, mesh.positions[t.z].y}) < 0.022F;
    });
    const Target open = makeTarget(mesh);
    EXPECT_FALSE(open.closed);
    ASSERT_FALSE(open.warnings.empty());
    EXPECT_NE(open.warnings.back().find("winding"), std::string::npos);
    BitColumns nearly;
    voxelizeTarget(field_.frame, open, voxelizer, nearly);
    EXPECT_GT(intersectionOverUnion(whole, nearly), 0.7);
}

// A device shape moved away, turned and shrunk is found again.
TEST_F(PlacementTest, AutoPlaceFindsAMatchAtLeastAsGoodAsTheFit) {
    const std::vector<double> strokes{1.0, 0.2, 0.5};
    TriangleMesh mesh = deformed(rig_, strokes);
    for (glm::vec3& p : mesh.positions) p = glm::vec3(3.0F * p.z + 1.0F, 3.0F * p.y, -3.0F * p.x);
    const AutoPlacement found = autoPlace(field_, coverage_, voting_, makeTarget(mesh), {.minInside = 0.2});
    EXPECT_GE(found.iou, found.iouAtFit);
    EXPECT_GT(found.iou, 0.75);
    // The reported figure is that of the reported placement and state.
    SolidVoxelizer voxelizer;
    BitColumns target;
    voxelizeTarget(field_.frame, {placed(mesh, found.placement), true, {}}, voxelizer, target);
    EXPECT_NEAR(Refiner(coverage_).qualityOf(target, found.state).iou(), found.iou, 1e-12);
    EXPECT_GT(found.placementsSeen, 36);
}

TEST_F(PlacementTest, AutoPlaceKeepsTheScaleAndTheShareThatItIsGiven) {
    const Target target = makeTarget(test::boxMesh({0, 0, 0}, {1.0F, 0.8F, 0.9F}));
    const double volume = 1.0 * 0.8 * 0.9;
    const double fit = fitPlacement(field_, boundingBox(target.mesh.positions)).scale;
    struct Case {
        double minScale, maxScale, minInside;
    };
    for (const Case& c : {Case{0.6, 1.0, 0.9}, Case{0.6, 1.05, 0.5}, Case{1.0, 3.0, 0.97}}) {
        AutoPlaceOptions options;
        options.minScale = c.minScale;
        options.maxScale = c.maxScale;
        options.minInside = c.minInside;
        const AutoPlacement found = autoPlace(field_, coverage_, voting_, target, options);
        EXPECT_GE(found.placement.scale / fit, c.minScale - 1e-9);
        EXPECT_LE(found.placement.scale / fit, c.maxScale + 1e-9);
        SolidVoxelizer voxelizer;
        BitColumns bits;
        voxelizeTarget(field_.frame, {placed(target.mesh, found.placement), true, {}}, voxelizer, bits);
        bits &= coverage_.domain();
        const double inside = static_cast<double>(bits.count()) * field_.frame.voxelVolume();
        EXPECT_GE(inside, c.minInside * volume * std::pow(found.placement.scale, 3.0)) << c.maxScale;
    }
}

TEST_F(PlacementTest, AutoPlaceRefusesATargetThinnerThanAVoxel) {
    const Target sliver = makeTarget(test::boxMesh({0, 0, 0}, {1.0F, 0.0005F, 1.0F}));
    EXPECT_THROW((void)autoPlace(field_, coverage_, voting_, sliver), InvalidInput);
}

TEST_F(PlacementTest, AutoPlaceCanBeStopped) {
    std::stop_source stop;
    int reports = 0;
    const Progress progress(
        [&](double, std::string_view) {
            if (++reports == 3) stop.request_stop();
        },
        stop.get_token());
    const Target target = makeTarget(test::boxMesh({0, 0, 0}, {1, 1, 1}));
    EXPECT_THROW((void)autoPlace(field_, coverage_, voting_, target, {}, progress), Cancelled);
    EXPECT_EQ(reports, 3);
}

/// A box that grows from low to high within a second.
Model growingBox() {
    Model model = modelOf(test::boxMesh({0.01F, 0.0F, 0.01F}, {0.09F, 0.03F, 0.07F}), "box");
    Model::Animation animation;
    animation.name = "grow";
    animation.channels.push_back(
        {0, Model::Path::scale, Model::Interpolation::linear, {0.0F, 1.0F}, {1, 0.1F, 1, 1, 1, 1}});
    model.animations.push_back(animation);
    return model;
}

// R19: the device follows an animation under its velocity limits.
TEST_F(PlacementTest, AClipFollowsItsAnimationUnderTheVelocityLimits) {
    const Model model = growingBox();
    const auto frames = matchClip(field_, coverage_, voting_, model, model.animations.front(),
                                  {.framesPerSecond = 20.0, .placement = {}});
    ASSERT_EQ(frames.size(), 21U);
    for (std::size_t k = 1; k < frames.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_LE(std::abs(frames[k].strokes[i] - frames[k - 1].strokes[i]),
                      rig_.actuators()[i].maxVelocity / 20.0 + 1e-9);
    int rising = 0;
    for (std::size_t i = 0; i < 3; ++i) rising += frames.back().strokes[i] > frames.front().strokes[i] + 0.2;
    EXPECT_GE(rising, 2);
    const std::string csv = clipCsv(field_, frames);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 22);
    EXPECT_NE(csv.find(",lift 0 level,lift 0 stroke,"), std::string::npos);
    EXPECT_THROW((void)matchClip(field_, coverage_, voting_, model, model.animations.front(),
                                 {.framesPerSecond = 0.0, .placement = {}}),
                 InvalidInput);
    EXPECT_THROW((void)matchClip(field_, coverage_, voting_, model, Model::Animation{}), InvalidInput);
}

// R19: the last frame shows the end, not a time before it nor the beginning again.
TEST_F(PlacementTest, AClipWhoseLengthIsNoWholeNumberOfFramesEndsAtItsEnd) {
    Model model = growingBox(); // here it shrinks to half its height
    model.animations.front().channels.front().values = {1, 1, 1, 1, 0.5F, 1};
    Placement placement = fitPlacement(field_, Box{{0.01F, 0.0F, 0.01F}, {0.09F, 0.03F, 0.07F}});
    placement.translation.y -= 0.006F; // its foot lies in the body, which does not count
    for (const double fps : {2.4, 3.7, 7.01}) {
        const auto frames = matchClip(field_, coverage_, voting_, model, model.animations.front(),
                                      {.framesPerSecond = fps, .placement = placement});
        ASSERT_EQ(frames.size(), static_cast<std::size_t>(std::ceil(fps)) + 1) << fps;
        EXPECT_NE(frames.front().wanted, State(3));
        EXPECT_EQ(frames.front().strokes, std::vector<double>(3, 0.0)) << "it begins at rest";
        EXPECT_LT(frames[frames.size() - 2].seconds, 1.0);
        EXPECT_GE(frames.back().seconds, 1.0);
        const TriangleMesh end = test::boxMesh({0.01F, 0.0F, 0.01F}, {0.09F, 0.015F, 0.07F});
        BitColumns target = voxelizeSolid(field_.frame, placed(end, placement));
        target &= coverage_.domain();
        BitColumns covered;
        CoverageScratch scratch;
        coverage_.covered(frames.back().wanted, covered, scratch);
        EXPECT_NEAR(frames.back().iouWanted, intersectionOverUnion(covered, target), 1e-12) << fps;
        coverage_.coveredAt(frames.back().strokes, covered, scratch);
        EXPECT_NEAR(frames.back().iouReached, intersectionOverUnion(covered, target), 1e-12) << fps;
    }
}

// R42
TEST_F(PlacementTest, TheShareBeyondTheFrameIsToldOfClosedTargetsAlone) {
    const Box frame = field_.frame.box();
    const float width = frame.max.x - frame.min.x;
    const glm::vec3 low(frame.max.x - 0.25F * width, field_.restSurface, 0.02F);
    const glm::vec3 high(frame.max.x + 0.75F * width, field_.restSurface + 0.01F, 0.06F);
    SolidVoxelizer voxelizer;
    BitColumns bits;
    Target box{test::boxMesh(low, high, 6), true, {}};
    voxelizeTarget(field_.frame, box, voxelizer, bits);
    EXPECT_NEAR(shareBeyondFrame(field_.frame, box, bits), 0.75, 0.06) << "three quarters hang out";
    std::erase_if(box.mesh.triangles, [&](const glm::uvec3& t) { // no bottom
        const auto& p = box.mesh.positions;
        return std::max({p[t.x].y, p[t.y].y, p[t.z].y}) <= low.y;
    });
    box.closed = false;
    voxelizeTarget(field_.frame, box, voxelizer, bits);
    EXPECT_EQ(shareBeyondFrame(field_.frame, box, bits), 0.0) << "nobody knows its volume";
    const Target inside{
        test::boxMesh({0.02F, field_.restSurface, 0.02F}, {0.06F, field_.restSurface + 0.01F, 0.06F}), true, {}};
    EXPECT_EQ(shareBeyondFrame(field_.frame, inside, BitColumns(field_.frame.dimensions)), 0.0)
        << "thin things lose voxels, but not beyond the frame";
}

} // namespace
} // namespace lumorph

#include "core/mdf/placement.h"

#include <atomic>
#include <cmath>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/auto_place.h"
#include "core/mdf/builder.h"
#include "core/mdf/clip.h"
#include "core/mdf/placement_scorer.h"
#include "core/mdf/refine.h"
#include "core/motion/rig_motion.h"
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
    EXPECT_EQ(repaired.warnings, std::vector<std::string>{"It was no closed solid and has been repaired for matching: "
                                                          "2 holes were filled."});
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

// In the middle, where a target fits, nothing of this device moves.
TEST(AutoPlace, FindsThePlaceWhereADeviceMoves) {
    const Rig rig = test::cornersRig();
    BuildOptions built;
    built.resolution = 28;
    built.levels = 9;
    built.samples = 30;
    const Field field = buildField(rig, built);
    const Coverage coverage(rig, field.frame, field.levels);
    const Voting voting(field);
    Refiner refiner(coverage);
    SolidVoxelizer voxelizer;
    const SteadyClock clock;
    for (const glm::vec3 size : {glm::vec3(1.0F, 0.8F, 1.1F), glm::vec3(2.0F, 1.0F, 1.0F)}) {
        const Target target = makeTarget(test::boxMesh({0, 0, 0}, size));
        const AutoPlacement found = autoPlace(field, coverage, voting, target);
        EXPECT_LT(found.iouAtFit, 0.2);
        // Every place and size of a grid, turned by nothing and by a right angle.
        double best = 0.0;
        const Placement fit = fitPlacement(field, boundingBox(target.mesh.positions));
        for (const double yaw : {0.0, 90.0})
            for (const double share : {1.0, 0.7, 0.5, 0.35, 0.25, 0.18})
                for (float x = -0.11F; x < 0.1F; x += 0.012F)
                    for (float z = -0.11F; z < 0.1F; z += 0.012F) {
                        const Placement at{share * fit.scale, Angle::degrees(yaw), {x, field.restSurface, z}};
                        BitColumns bits;
                        voxelizeTarget(field.frame, {placed(target.mesh, at), true, {}}, voxelizer, bits);
                        bits &= coverage.domain();
                        const double whole = size.x * size.y * size.z * std::pow(at.scale, 3.0);
                        if (static_cast<double>(bits.count()) * field.frame.voxelVolume() < 0.9 * whole) continue;
                        const Refinement refined =
                            refiner.refine(bits, voting.match(bits).state(), Microseconds{0}, clock);
                        best = std::max(best, refined.after.iou());
                    }
        std::printf("auto-place %.3f, the best of the grid %.3f, in the middle %.3f\n", found.iou, best,
                    found.iouAtFit);
        EXPECT_GT(best, 0.4);
        EXPECT_GE(found.iou, 0.98 * best);
        // Different places, the best first.
        ASSERT_GE(found.alternatives.size(), 2U);
        EXPECT_EQ(found.alternatives[0].placement, found.placement);
        EXPECT_EQ(found.alternatives[0].iou, found.iou);
        for (std::size_t k = 1; k < found.alternatives.size(); ++k) {
            EXPECT_LE(found.alternatives[k].iou, found.alternatives[k - 1].iou);
            EXPECT_NE(found.alternatives[k].placement, found.placement);
        }
    }
}

// An open one has no volume of its own that would have to stay inside.
TEST_F(PlacementTest, AutoPlaceDoesNotTakeAnOpenTargetOutOfTheDevice) {
    TriangleMesh mesh = test::boxMesh({0, 0, 0}, {1.0F, 0.8F, 0.9F}, 20);
    std::erase_if(mesh.triangles, [&](const glm::uvec3& t) { // the whole bottom
        return std::max({mesh.positions[t.x].y, mesh.positions[t.y].y, mesh.positions[t.z].y}) < 0.01F;
    });
    const Target open = makeTarget(mesh);
    ASSERT_FALSE(open.closed);
    const AutoPlacement found = autoPlace(field_, coverage_, voting_, open);
    EXPECT_LT(found.iou, 0.999);
    EXPECT_GE(found.iou, found.iouAtFit);
    SolidVoxelizer voxelizer;
    BitColumns bits;
    voxelizeTarget(field_.frame, {placed(open.mesh, found.placement), false, {}}, voxelizer, bits);
    bits &= coverage_.domain();
    EXPECT_GT(static_cast<double>(bits.count()) * field_.frame.voxelVolume(),
              0.5 * 1.0 * 0.8 * 0.9 * std::pow(found.placement.scale, 3.0));
    EXPECT_EQ(compareVolumes(BitColumns(field_.frame.dimensions), BitColumns(field_.frame.dimensions)).iou(), 0.0);
}

TEST_F(PlacementTest, AutoPlaceKeepsTheScaleAndTheSharesThatItIsGiven) {
    const Target target = makeTarget(test::boxMesh({0, 0, 0}, {1.0F, 0.8F, 0.9F}));
    const double volume = 1.0 * 0.8 * 0.9;
    struct Case {
        double minScale, maxScale, minInside, minInFrame;
    };
    for (const Case& c : {Case{0.6, 1.0, 0.9, 0.95}, Case{0.6, 1.05, 0.5, 0.5}, Case{1.0, 3.0, 0.8, 0.99}}) {
        AutoPlaceOptions options;
        options.minScale = c.minScale;
        options.maxScale = c.maxScale;
        options.minInside = c.minInside;
        options.minInFrame = c.minInFrame;
        const AutoPlacement found = autoPlace(field_, coverage_, voting_, target, options);
        const TriangleMesh mesh = placed(target.mesh, found.placement);
        const Box frame = field_.frame.box();
        const glm::vec3 room(frame.size().x, frame.max.y - field_.restSurface, frame.size().z);
        const glm::vec3 share = boundingBox(mesh.positions).size() / room;
        const auto largest = static_cast<double>(std::max({share.x, share.y, share.z}));
        EXPECT_GE(largest, c.minScale - 1e-3);
        EXPECT_LE(largest, c.maxScale + 1e-3);
        SolidVoxelizer voxelizer;
        BitColumns bits;
        voxelizeTarget(field_.frame, {mesh, true, {}}, voxelizer, bits);
        const double whole = volume * std::pow(found.placement.scale, 3.0);
        // Above and beside the frame nothing counts; below it the target is sunk in.
        VoxelFrame around = field_.frame;
        const int more = 40;
        around.origin -= static_cast<float>(more * around.voxelSize) * glm::vec3(1.0F);
        around.dimensions += 2 * more;
        std::size_t inFrame = 0, all = 0;
        const BitColumns wide = voxelizeSolid(around, mesh);
        for (int z = 0; z < around.dimensions.z; ++z)
            for (int x = 0; x < around.dimensions.x; ++x)
                for (int y = 0; y < around.dimensions.y; ++y) {
                    if (!wide.test(x, y, z)) continue;
                    ++all;
                    inFrame += x >= more && z >= more && x < around.dimensions.x - more &&
                               z < around.dimensions.z - more && y < around.dimensions.y - more;
                }
        EXPECT_GE(static_cast<double>(inFrame), (c.minInFrame - 0.02) * static_cast<double>(all));
        bits &= coverage_.domain();
        EXPECT_GE(static_cast<double>(bits.count()) * field_.frame.voxelVolume(), c.minInside * whole) << c.maxScale;
    }
}

TEST_F(PlacementTest, AutoPlaceRefusesATargetThinnerThanAVoxel) {
    const Target sliver = makeTarget(test::boxMesh({0, 0, 0}, {1.0F, 0.0005F, 1.0F}));
    EXPECT_THROW((void)autoPlace(field_, coverage_, voting_, sliver), InvalidInput);
}

TEST_F(PlacementTest, AutoPlaceCanBeStopped) {
    std::stop_source stop;
    std::atomic<int> reports{0}; // from several threads
    const Progress progress(
        [&](double, std::string_view) {
            if (++reports == 3) stop.request_stop();
        },
        stop.get_token());
    const Target target = makeTarget(test::boxMesh({0, 0, 0}, {1, 1, 1}));
    EXPECT_THROW((void)autoPlace(field_, coverage_, voting_, target, {}, progress), Cancelled);
    EXPECT_GE(reports, 3);
    EXPECT_LT(reports, 40) << "it went on";
}

// A slab that stands on its edge must be laid down: upright it is many times higher than the device rises.
TEST_F(PlacementTest, AutoPlaceLaysDownWhatStands) {
    for (const glm::vec3 size : {glm::vec3(1.0F, 0.9F, 0.22F), glm::vec3(0.2F, 1.0F, 0.8F)}) {
        const Target target = makeTarget(test::boxMesh({0, 0, 0}, size));
        const AutoPlacement found = autoPlace(field_, coverage_, voting_, target);
        const glm::vec3 thin = size.x < size.z ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
        EXPECT_GT(std::abs((found.placement.rotation() * thin).y), 0.9F);
        EXPECT_GT(found.iou, 1.5 * found.iouAtFit);
    }
}

TEST_F(PlacementTest, RotationIsOrientationThenHeading) {
    const Placement placement{2.0,
                              Angle::degrees(90.0),
                              {1.0F, 2.0F, 3.0F},
                              glm::angleAxis(glm::radians(90.0F), glm::vec3(1.0F, 0.0F, 0.0F))};
    // Upwards is tipped to the front (+Z), then the heading takes the front to the right (+X).
    const glm::vec3 point(placement.deviceFromTarget() * glm::vec4(0.0F, 1.0F, 0.0F, 1.0F));
    EXPECT_LT(glm::distance(point, glm::vec3(3.0F, 2.0F, 3.0F)), 1e-5F);
    EXPECT_LT(glm::distance(placement.rotation() * glm::vec3(0, 1, 0), glm::vec3(1, 0, 0)), 1e-6F);
}

// What is looked up is what scan conversion of the placed mesh finds, but for the rim.
TEST_F(PlacementTest, TargetGridLooksUpWhatVoxelisationFinds) {
    std::mt19937 random(77);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    const TriangleMesh shape = deformed(rig_, std::vector<double>{0.9, 0.1, 0.6});
    for (const bool closed : {true, false}) {
        const Target target{shape, closed, {}};
        const TargetGrid grid(target);
        EXPECT_NEAR(grid.volume() / std::abs(signedVolume(shape)), 1.0, 0.05);
        for (int k = 0; k < 12; ++k) {
            const Placement at{
                1.3 + 0.5 * static_cast<double>(unit(random)), Angle::radians(3.0 * static_cast<double>(unit(random))),
                field_.frame.box().centre() + 0.02F * glm::vec3(unit(random), unit(random), unit(random)),
                glm::normalize(glm::quat(unit(random), unit(random), unit(random), unit(random)))};
            BitColumns looked, exact;
            grid.lookUp(field_.frame, at.deviceFromTarget(), looked);
            SolidVoxelizer voxelizer;
            voxelizeTarget(field_.frame, {placed(shape, at), true, {}}, voxelizer, exact);
            if (exact.count() < 300) continue;
            EXPECT_GT(intersectionOverUnion(looked, exact), closed ? 0.93 : 0.85) << k;
        }
    }
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

// R19: looking ahead, it moves before the target does; without, after it.
TEST_F(PlacementTest, AClipThatLooksAheadReachesMoreThanOneThatFollows) {
    const Model model = growingBox();
    const Model::Animation& animation = model.animations.front();
    ClipOptions options;
    options.framesPerSecond = 20.0;
    const auto reachedWith = [&](double lookAhead) {
        options.lookAhead = lookAhead;
        const auto frames = matchClip(field_, coverage_, voting_, model, animation, options);
        EXPECT_EQ(frames.size(), 21U) << lookAhead;
        MotionModel motion(motionLimits(rig_)); // the strokes are what the commands lead to
        double sum = 0.0;
        for (std::size_t k = 0; k < frames.size(); ++k) {
            const auto strokes = motion.step(frames[k].commands, k == 0 ? 0.0 : 1.0 / 20.0);
            EXPECT_EQ(std::vector<double>(strokes.begin(), strokes.end()), frames[k].strokes) << k;
            if (lookAhead == 0.0 && k > 0) {
                EXPECT_EQ(frames[k].commands, strokesOf(rig_, frames[k].wanted, coverage_.levels())) << k;
            }
            sum += frames[k].iouReached / 21.0;
        }
        return sum;
    };
    const double alone = reachedWith(0.0);
    for (const double lookAhead : {0.1, 0.5, 10.0}) EXPECT_GT(reachedWith(lookAhead), alone) << lookAhead;
    EXPECT_GE(reachedWith(1.0), alone + 0.03);
    for (const double wrong : {-0.1, 10.1, std::nan("")}) {
        options.lookAhead = wrong;
        EXPECT_THROW((void)matchClip(field_, coverage_, voting_, model, animation, options), InvalidInput) << wrong;
    }
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

TEST_F(PlacementTest, AClipOfMoreFramesThanAnyoneWaitsForIsRefused) {
    Model model = growingBox();
    Model::Animation& animation = model.animations.front();
    // The last would not even count in whole numbers of 32 bits.
    for (const auto& [seconds, rate, frames] : {std::tuple(10'000.0F, 240.0, "2400000 frames at 240 a second"),
                                                std::tuple(4'001.0F, 30.0, "120030 frames at 30 a second"),
                                                std::tuple(1e12F, 1.0, "more than the limit of 120000")}) {
        animation.channels.front().times.back() = seconds;
        try {
            (void)matchClip(field_, coverage_, voting_, model, animation, {.framesPerSecond = rate, .placement = {}});
            ADD_FAILURE() << frames << " were matched";
        } catch (const InvalidInput& error) {
            EXPECT_EQ(error.subject(), "animation 'grow'");
            EXPECT_NE(error.why().find(frames), std::string::npos) << error.why();
            EXPECT_FALSE(error.remedy().empty());
        }
    }
}

} // namespace
} // namespace lumorph

#include "app/workspaces/common/field_scene.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/workspaces/common/field_cloud.h"
#include "core/base/resources.h"
#include "core/mdf/builder.h"
#include "core/rig/rig_file.h"
#include "tests/support/small_rigs.h"

namespace lumorph::studio {
namespace {

std::shared_ptr<const MatchField> armField() {
    static const auto field = [] {
        BuildOptions options;
        options.resolution = 12;
        options.levels = 9;
        options.samples = 8;
        return std::make_shared<const MatchField>(buildField(test::lifterRig(), options));
    }();
    return field;
}

std::shared_ptr<const MatchTarget> boxTarget() {
    auto target = std::make_shared<MatchTarget>();
    target->name = "box";
    target->solid = makeTarget(test::boxMesh({-0.02F, 0.0F, -0.02F}, {0.02F, 0.03F, 0.02F}, 4));
    target->box = boundingBox(target->solid.mesh.positions);
    return target;
}

/// A frame as the loop hands it over, with the rig at rest and a target that is matched nowhere.
MatchFrame matchedFrame() {
    MatchFrame frame;
    frame.field = armField();
    frame.rig = std::shared_ptr<const Rig>(frame.field, &frame.field->rig);
    frame.target = boxTarget();
    frame.matched = true;
    frame.targetPositions = std::make_shared<std::vector<glm::vec3>>(frame.target->solid.mesh.positions);
    frame.devicePositions = std::make_shared<std::vector<glm::vec3>>(frame.rig->restMesh().positions);
    frame.deviceFromTarget = glm::translate(glm::mat4(1.0F), glm::vec3(0.01F, 0.02F, 0.0F));
    frame.wantedStrokes.assign(frame.rig->actuatorCount(), 0.0);
    frame.estimatedStrokes = frame.wantedStrokes;
    frame.classes = std::make_shared<std::vector<std::uint8_t>>(frame.field->field.frame.voxelCount(), kVoxelUnmatched);
    return frame;
}

/// A builder whose colours are told apart.
class FieldScene : public testing::Test {
protected:
    FieldScene() {
        FieldSceneColors colors;
        colors.unmatched = {1.0F, 0.5F, 0.0F};
        colors.overfilled = {0.6F, 0.0F, 1.0F};
        colors.levelLow = {0.7F, 0.95F, 0.7F};
        colors.levelHigh = {0.0F, 0.3F, 0.1F};
        builder.setColors(colors);
    }
    FieldSceneBuilder builder;
};

const ViewportSurface* surfaceOf(const ViewportScene& scene, std::uint32_t id) {
    const auto found = std::find_if(scene.surfaces.begin(), scene.surfaces.end(),
                                    [id](const ViewportSurface& surface) { return surface.id == id; });
    return found == scene.surfaces.end() ? nullptr : &*found;
}

FieldDisplay showing(FieldDisplay::Show show) {
    FieldDisplay display;
    display.show = show;
    return display;
}

TEST_F(FieldScene, ShowsDeviceAsPaperAndTargetSeeThroughWhereTheFrameSays) {
    const MatchFrame frame = matchedFrame();
    const auto scene = builder.build(frame, {}, true);

    const ViewportSurface* device = surfaceOf(*scene, kDeviceId);
    ASSERT_TRUE(device);
    EXPECT_EQ(device->positions, frame.devicePositions) << "no copy of what the loop made";
    EXPECT_EQ(device->opacity, 1.0F);
    EXPECT_EQ(device->paper, 1.0F);
    EXPECT_FALSE(device->outlined);

    const ViewportSurface* target = surfaceOf(*scene, kTargetId);
    ASSERT_TRUE(target);
    EXPECT_EQ(target->positions, frame.targetPositions);
    EXPECT_EQ(target->worldFromSurface, frame.deviceFromTarget);
    EXPECT_GT(target->opacity, 0.3F);
    EXPECT_LT(target->opacity, 0.6F) << "the device behind it must be seen";
    EXPECT_TRUE(target->outlined) << "it is selected";

    FieldDisplay hidden;
    hidden.showTarget = false;
    EXPECT_FALSE(surfaceOf(*builder.build(frame, hidden, false), kTargetId));
}

// In motion the pins of the pin display, which are one mesh with its plate, must not be seen as walls.
TEST_F(FieldScene, TheCoarseFormKeepsRigidPartsApart) {
    const auto rig = std::make_shared<const Rig>(readRig(resourceFile("models/pin_display.glb")));
    MatchFrame frame;
    frame.rig = rig;
    frame.devicePositions = std::make_shared<std::vector<glm::vec3>>(rig->restMesh().positions);
    frame.wantedStrokes.assign(rig->actuatorCount(), 0.0);
    frame.estimatedStrokes = frame.wantedStrokes;
    const auto scene = builder.build(frame, {}, false);
    const ViewportSurface* device = surfaceOf(*scene, kDeviceId);
    ASSERT_NE(device, nullptr);
    constexpr auto kCoarse = SurfaceShading::Detail::coarse;
    ASSERT_TRUE(device->shading->hasCoarse());

    std::vector<double> strokes(rig->actuatorCount(), 0.0);
    for (std::size_t i = 0; i < strokes.size(); ++i) strokes[i] = (i + i / 30) % 2 == 0 ? 1.0 : 0.0; // a chessboard
    std::vector<glm::vec3> moved(rig->restMesh().positions.size());
    rig->deform(strokes, moved);
    double raised = 0.0; // square metres that look up
    for (const glm::uvec3& t : device->shading->triangles(kCoarse)) {
        const auto at = [&](int k) { return moved[device->shading->sources(kCoarse)[t[k]]]; };
        const glm::vec3 a = at(0), b = at(1), c = at(2);
        if (std::min({a.y, b.y, c.y}) < 0.08F) continue;
        EXPECT_LT(std::max({a.x, b.x, c.x}) - std::min({a.x, b.x, c.x}), 0.0048F) << "wider than a pin";
        EXPECT_LT(std::max({a.z, b.z, c.z}) - std::min({a.z, b.z, c.z}), 0.0048F) << "wider than a pin";
        raised += 0.5 * std::max(0.0F, glm::cross(b - a, c - a).y);
    }
    EXPECT_NEAR(raised, 450 * 0.0047 * 0.0047, 1e-5) << "the tops of the pins that rose";
}

TEST_F(FieldScene, BoundsHoldFrameAndTargetAndDoNotFollowTheMotion) {
    MatchFrame frame = matchedFrame();
    frame.deviceFromTarget = glm::translate(glm::mat4(1.0F), glm::vec3(0.5F, 0.0F, 0.0F));
    const auto scene = builder.build(frame, {}, false);
    EXPECT_FLOAT_EQ(scene->bounds.max.x, 0.52F);
    EXPECT_LE(scene->bounds.min.x, frame.field->field.frame.box().min.x);

    auto moved = std::make_shared<std::vector<glm::vec3>>(*frame.devicePositions);
    for (glm::vec3& position : *moved) position.y *= 1.5F;
    frame.devicePositions = moved;
    EXPECT_EQ(builder.build(frame, {}, false)->bounds.max, scene->bounds.max) << "shadows would swim";
}

TEST_F(FieldScene, LayersOneVoxelThinAreNotTinted) {
    VoxelFrame frame;
    frame.dimensions = {6, 5, 4};
    std::vector<std::uint8_t> classes(frame.voxelCount(), 0);
    const auto at = [&](int x, int y, int z) -> std::uint8_t& {
        return classes[static_cast<std::size_t>(x + 6 * (y + 5 * z))];
    };
    for (int z = 0; z < 4; ++z)
        for (int x = 0; x < 6; ++x) at(x, 4, z) = kVoxelUnmatched; // a lid
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) at(x, y, z) = kVoxelOverfilled; // a block
    at(5, 0, 3) = kVoxelMatched;
    const auto thick = thickClasses(frame, classes);
    EXPECT_EQ(std::count(thick.begin(), thick.end(), kVoxelUnmatched), 0);
    EXPECT_EQ(std::count(thick.begin(), thick.end(), kVoxelOverfilled), 8);
    EXPECT_EQ(std::count(thick.begin(), thick.end(), kVoxelMatched), 0);
    EXPECT_EQ(thick[0], kVoxelOverfilled);
}

TEST_F(FieldScene, TintsUnmatchedAndOverfilledOnlyWhileTheyAreShown) {
    MatchFrame frame = matchedFrame();
    const auto scene = builder.build(frame, {}, false);
    ASSERT_TRUE(scene->tint);
    EXPECT_EQ(*scene->tint->classes, *frame.classes); // all of one class: thick everywhere
    EXPECT_EQ(builder.build(frame, {}, false)->tint->classes, scene->tint->classes) << "worked out again";
    EXPECT_EQ(scene->tint->frame, frame.field->field.frame);
    EXPECT_EQ(glm::vec3(scene->tint->colors[kVoxelUnmatched]), glm::vec3(1.0F, 0.5F, 0.0F));
    EXPECT_EQ(glm::vec3(scene->tint->colors[kVoxelOverfilled]), glm::vec3(0.6F, 0.0F, 1.0F));
    EXPECT_EQ(scene->tint->colors[kVoxelMatched].a, 0.0F);
    EXPECT_EQ(scene->tint->colors[0].a, 0.0F);
    EXPECT_TRUE(surfaceOf(*scene, kDeviceId)->tinted);
    EXPECT_TRUE(surfaceOf(*scene, kTargetId)->tinted);

    FieldDisplay plain;
    plain.showMismatch = false;
    EXPECT_FALSE(builder.build(frame, plain, false)->tint);

    // Classes of another field are of no use: they must not be read beyond their end.
    frame.classes = std::make_shared<std::vector<std::uint8_t>>(7, kVoxelUnmatched);
    EXPECT_FALSE(builder.build(frame, {}, false)->tint);
}

TEST_F(FieldScene, KeepsWhatComesFromTheSameObjects) {
    MatchFrame frame = matchedFrame();
    const FieldDisplay voxels = showing(FieldDisplay::Show::voxels);
    const auto first = builder.build(frame, voxels, false);
    frame.number = 2;
    frame.devicePositions = std::make_shared<std::vector<glm::vec3>>(frame.rig->restMesh().positions);
    frame.classes = std::make_shared<std::vector<std::uint8_t>>(*frame.classes);
    const auto second = builder.build(frame, voxels, false);
    EXPECT_EQ(surfaceOf(*first, kDeviceId)->shading, surfaceOf(*second, kDeviceId)->shading);
    EXPECT_EQ(surfaceOf(*first, kTargetId)->shading, surfaceOf(*second, kTargetId)->shading);
    ASSERT_EQ(first->voxels.size(), 1U);
    EXPECT_EQ(first->voxels[0].voxels, second->voxels[0].voxels);

    const FieldDisplay level = showing(FieldDisplay::Show::surface);
    const auto third = builder.build(frame, level, false), fourth = builder.build(frame, level, true);
    EXPECT_EQ(surfaceOf(*third, kFieldId)->shading, surfaceOf(*fourth, kFieldId)->shading);
    FieldDisplay lower = level;
    lower.surfaceLevel = 2;
    EXPECT_NE(surfaceOf(*builder.build(frame, lower, false), kFieldId)->shading, surfaceOf(*fourth, kFieldId)->shading);

    frame.target = boxTarget();
    EXPECT_NE(surfaceOf(*builder.build(frame, level, false), kTargetId)->shading,
              surfaceOf(*first, kTargetId)->shading);
}

TEST_F(FieldScene, HigherLevelsAreDarkerGreen) {
    FieldDisplay display = showing(FieldDisplay::Show::voxels);
    std::map<int, int> brightness; // by level: of the voxels that are first covered there
    for (int level = 1; level < 9; ++level) {
        display.lowestLevel = display.highestLevel = level;
        const auto scene = builder.build(matchedFrame(), display, false);
        if (scene->voxels[0].voxels->empty()) continue;
        const auto& color = scene->voxels[0].voxels->front().color;
        for (const ViewportVoxel& voxel : *scene->voxels[0].voxels) EXPECT_EQ(voxel.color, color);
        EXPECT_GT(color[1], color[0]) << "green";
        EXPECT_GT(color[1], color[2]);
        brightness[level] = color[0] + color[1] + color[2];
    }
    ASSERT_GE(brightness.size(), 4U);
    for (auto at = std::next(brightness.begin()); at != brightness.end(); ++at)
        EXPECT_LT(at->second, std::prev(at)->second) << "level " << at->first;
}

TEST_F(FieldScene, TouchedOnlyFollowsTheTargetAndNothingElse) {
    MatchFrame frame = matchedFrame();
    FieldDisplay display = showing(FieldDisplay::Show::voxels);
    display.touchedOnly = true;
    const auto with = [&](std::uint8_t inside) {
        auto classes =
            std::make_shared<std::vector<std::uint8_t>>(frame.field->field.frame.voxelCount(), std::uint8_t{0});
        std::fill(classes->begin() + static_cast<std::ptrdiff_t>(classes->size() / 2), classes->end(), inside);
        frame.classes = classes;
        return builder.build(frame, display, false)->voxels[0].voxels;
    };
    const auto matched = with(kVoxelMatched);
    EXPECT_FALSE(matched->empty());
    EXPECT_EQ(with(kVoxelUnmatched), matched) << "the target stands where it stood";
    EXPECT_TRUE(with(kVoxelOverfilled)->empty()) << "overfilled volume is none of the target's";
    display.touchedOnly = false;
    EXPECT_GT(with(kVoxelMatched)->size(), matched->size());
}

TEST_F(FieldScene, GhostShowsTheWishOnlyWhereItDiffers) {
    MatchFrame frame = matchedFrame();
    FieldDisplay display;
    display.showWish = true;
    EXPECT_FALSE(surfaceOf(*builder.build(frame, display, false), 0));
    frame.wantedStrokes.assign(frame.rig->actuatorCount(), 1.0);
    const auto scene = builder.build(frame, display, false);
    const ViewportSurface* ghost = surfaceOf(*scene, 0);
    ASSERT_TRUE(ghost);
    EXPECT_LT(ghost->opacity, 0.5F);
    std::vector<glm::vec3> asked(frame.rig->restMesh().positions.size());
    frame.rig->deform(frame.wantedStrokes, asked);
    EXPECT_EQ(*ghost->positions, asked);
    EXPECT_EQ(surfaceOf(*builder.build(frame, display, false), 0)->positions, ghost->positions);
}

TEST_F(FieldScene, MarksTheVoxelThatWasClicked) {
    const MatchFrame frame = matchedFrame();
    FieldDisplay display;
    const std::size_t before = builder.build(frame, display, false)->lines.size();
    EXPECT_EQ(before, 12U) << "the edges of the frame";
    display.voxel = glm::ivec3(1, 2, 3);
    const auto scene = builder.build(frame, display, false);
    ASSERT_EQ(scene->lines.size(), 24U);
    Box marked;
    for (std::size_t i = before; i < scene->lines.size(); ++i) {
        marked.include(scene->lines[i].from);
        marked.include(scene->lines[i].to);
    }
    const glm::vec3 centre(frame.field->field.frame.centre(1, 2, 3));
    EXPECT_LT(glm::length(marked.centre() - centre), 1e-6F);
}

TEST_F(FieldScene, LeavesALargeTargetOutUntilItIsReadyWhenItMustNotWait) {
    builder.setPatient(false);
    MatchFrame frame = matchedFrame();
    auto large = std::make_shared<MatchTarget>(*frame.target);
    large->solid = makeTarget(test::boxMesh({-0.02F, 0.0F, -0.02F}, {0.02F, 0.03F, 0.02F}, 120));
    ASSERT_GT(large->solid.mesh.triangles.size(), 20'000U);
    frame.target = large;
    frame.targetPositions = std::make_shared<std::vector<glm::vec3>>(large->solid.mesh.positions);
    auto scene = builder.build(frame, {}, false);
    EXPECT_TRUE(surfaceOf(*scene, kDeviceId)) << "a small device is there at once";
    while (builder.pending()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        scene = builder.build(frame, {}, false);
    }
    ASSERT_TRUE(surfaceOf(*scene, kTargetId));
    EXPECT_EQ(surfaceOf(*scene, kTargetId)->positions, frame.targetPositions);
}

} // namespace
} // namespace lumorph::studio

#include "core/scene/posed_scene.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/scene/scene_assets.h"
#include "tests/core/scene/scenes.h"
#include "tests/support/animated_target.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using test::itemOf;

constexpr double kPi = std::numbers::pi;

PosedScene posed(const Scene& scene, double seconds = 0.0, const SceneAssets& assets = {}) {
    PoseInput input;
    input.seconds = seconds;
    return ScenePoser().pose(scene, assets, input);
}

Scene sceneOf(std::vector<SceneItem> items) {
    Scene scene;
    scene.items = std::move(items);
    return scene;
}

double distance(const glm::vec3& a, const glm::vec3& b) { return static_cast<double>(glm::distance(a, b)); }

/// Every triangle looks where its vertices' normals do, normals have length 1, and indices are in range.
void expectSound(const PosedSurface& surface) {
    const auto& positions = *surface.positions;
    const auto& normals = *surface.normals;
    ASSERT_EQ(positions.size(), normals.size());
    ASSERT_EQ(positions.size(), surface.topology->coordinates.size());
    for (const glm::vec3& normal : normals) ASSERT_NEAR(glm::length(normal), 1.0F, 1e-4F);
    for (const glm::uvec3& t : surface.topology->triangles) {
        ASSERT_LT(std::max({t.x, t.y, t.z}), positions.size());
        const glm::vec3 area = glm::cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]);
        if (glm::length(area) < 1e-12F) continue;
        ASSERT_GT(glm::dot(area, normals[t.x] + normals[t.y] + normals[t.z]), 0.0F);
    }
}

TEST(ScenePoser, ABobbingSpinningCubeIsWhereItsFormulaSays) {
    SceneItem cube = itemOf(1, ShapeItem{ShapeItem::Form::box, {0.04F, 0.02F, 0.06F}});
    cube.position = {0.1F, 0.05F, 0.0F};
    cube.motion = {kPi / 2.0, 0.01, 4.0};
    PoseInput input;
    input.worldFromDevice = glm::translate(glm::mat4(1.0F), {0.0F, 0.5F, 0.0F});
    ScenePoser poser;
    for (const double seconds : {0.0, 0.37, 1.0, 2.5, 1e6 + 1.0}) {
        input.seconds = seconds;
        const PosedScene scene = poser.pose(sceneOf({cube}), {}, input);
        ASSERT_EQ(scene.surfaces.size(), 1U);
        const PosedSurface& surface = scene.surfaces.front();
        expectSound(surface);
        EXPECT_EQ(boundingBox(*surface.positions).size(), glm::vec3(0.04F, 0.02F, 0.06F));
        const double angle = std::fmod(seconds * kPi / 2.0, 2.0 * kPi);
        const double height = 0.55 + 0.01 * std::sin(2.0 * kPi * seconds / 4.0);
        // The corner (0.02, 0, 0) of the cube's frame, turned about +Y.
        const glm::vec3 expected(0.1 + 0.02 * std::cos(angle), height, -0.02 * std::sin(angle));
        const glm::vec3 found(surface.worldFromSurface * glm::vec4(0.02F, 0.0F, 0.0F, 1.0F));
        EXPECT_LT(distance(found, expected), 1e-6) << seconds;
    }
}

TEST(ScenePoser, ShapesAreClosedAndAsLargeAsTheySay) {
    using Form = ShapeItem::Form;
    const glm::vec3 size(0.04F, 0.03F, 0.05F);
    const double box = 0.04 * 0.03 * 0.05;
    for (const auto& [form, volume, tolerance] : {std::tuple{Form::box, box, 1e-9},
                                                  {Form::sphere, box * kPi / 6.0, 0.01 * box},
                                                  {Form::cylinder, box * kPi / 4.0, 0.01 * box}}) {
        const PosedSurface surface = posed(sceneOf({itemOf(1, ShapeItem{form, size})})).surfaces.at(0);
        expectSound(surface);
        EXPECT_NEAR(signedVolume({*surface.positions, surface.topology->triangles}), volume, tolerance);
        EXPECT_LT(distance(boundingBox(*surface.positions).size(), size), 1e-6);
    }
    const PosedSurface plane = posed(sceneOf({itemOf(1, ShapeItem{Form::plane, size})})).surfaces.at(0);
    expectSound(plane);
    for (const glm::vec3& normal : *plane.normals) EXPECT_EQ(normal, glm::vec3(0.0F, 1.0F, 0.0F));
    EXPECT_EQ(boundingBox(*plane.positions).size(), glm::vec3(0.04F, 0.0F, 0.05F));
}

TEST(ScenePoser, ShapesAreMappedInMetres) {
    for (const ShapeItem::Form form : {ShapeItem::Form::box, ShapeItem::Form::cylinder, ShapeItem::Form::plane}) {
        const PosedSurface surface = posed(sceneOf({itemOf(1, ShapeItem{form, glm::vec3(0.1F)})})).surfaces.at(0);
        for (const glm::uvec3& t : surface.topology->triangles) {
            const auto& p = *surface.positions;
            const auto& c = surface.topology->coordinates;
            ASSERT_NEAR(distance(p[t.x], p[t.y]), static_cast<double>(glm::distance(c[t.x], c[t.y])), 1e-4);
        }
    }
}

TEST(ScenePoser, MembersHaveTheirGroupsPlaceOpacityAndVisibility) {
    SceneItem outer = itemOf(1, GroupItem{});
    outer.position = {0.0F, 1.0F, 0.0F};
    outer.opacity = 0.5F;
    outer.anchor = Anchor::world;
    outer.scale = glm::vec3(2.0F);
    SceneItem inner = itemOf(2, GroupItem{}, 1);
    inner.rotation = glm::angleAxis(static_cast<float>(kPi / 2.0), glm::vec3(0.0F, 1.0F, 0.0F));
    inner.opacity = 0.5F;
    SceneItem cube = itemOf(3, ShapeItem{}, 2);
    cube.position = {0.1F, 0.0F, 0.0F};
    cube.opacity = 0.8F;
    SceneItem other = itemOf(4, ShapeItem{}, 1);
    other.visible = false;
    const PosedScene scene = posed(sceneOf({outer, inner, cube, other}));
    ASSERT_EQ(scene.surfaces.size(), 1U);
    EXPECT_EQ(scene.surfaces[0].item, 3);
    EXPECT_FLOAT_EQ(scene.surfaces[0].opacity, 0.2F);
    EXPECT_LT(distance(glm::vec3(scene.surfaces[0].worldFromSurface[3]), {0.0F, 1.0F, -0.2F}), 1e-6);
    outer.visible = false;
    EXPECT_TRUE(posed(sceneOf({outer, inner, cube, other})).surfaces.empty());
    const Scene whole = sceneOf({outer, inner, cube, other});
    EXPECT_LT(distance(glm::vec3(anchorFromItem(whole, whole.items[2], 0.0)[3]), {0.0F, 1.0F, -0.2F}), 1e-6);
}

TEST(ScenePoser, ItemsRideOnTheDeviceOrStayOnTheTable) {
    PoseInput input;
    input.worldFromDevice = glm::translate(glm::mat4(1.0F), {1.0F, 2.0F, 3.0F});
    SceneItem onTable = itemOf(2, ShapeItem{});
    onTable.anchor = Anchor::world;
    const PosedScene scene = ScenePoser().pose(sceneOf({itemOf(1, ShapeItem{}), onTable}), {}, input);
    EXPECT_EQ(glm::vec3(scene.surfaces.at(0).worldFromSurface[3]), glm::vec3(1.0F, 2.0F, 3.0F));
    EXPECT_EQ(glm::vec3(scene.surfaces.at(1).worldFromSurface[3]), glm::vec3(0.0F));
}

HeightItem sea() {
    HeightItem item;
    item.waves = {{0.004, 0.08, 1.7, Angle::degrees(20.0), Angle::degrees(50.0)},
                  {0.002, 0.03, 0.9, Angle::degrees(-75.0), {}},
                  {0.001, 0.05, 0.0, Angle::degrees(100.0), {}}};
    return item;
}

/// Straight from the words of the header.
double waveHeight(const HeightItem& item, double x, double z, double t) {
    double sum = 0.0;
    for (const Wave& w : item.waves) {
        const double along = x * std::cos(w.direction.inRadians()) + z * std::sin(w.direction.inRadians());
        const double cycles = along / w.length - (w.period > 0.0 ? t / w.period : 0.0);
        sum += w.amplitude * std::sin(2.0 * kPi * cycles + w.phase.inRadians());
    }
    return sum;
}

TEST(HeightField, FollowsThePlainFormula) {
    const HeightItem item = sea();
    const std::vector<glm::vec2> points = {
        {0.0F, 0.0F}, {0.1F, -0.07F}, {-0.105F, 0.075F}, {0.1051F, 0.0F}, {0.0F, 9.0F}};
    std::vector<float> heights(points.size());
    ScenePoser poser;
    for (const double t : {0.0, 0.3, 1000.7}) {
        sampleHeights(item, nullptr, t, points, heights);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(static_cast<double>(heights[i]), waveHeight(item, points[i].x, points[i].y, t), 1e-7);
        EXPECT_EQ(heights[3], 0.0F) << "beside it";
        EXPECT_EQ(heights[4], 0.0F) << "beside it";
        PoseInput input;
        input.seconds = t;
        const PosedScene scene = poser.pose(sceneOf({itemOf(1, item)}), {}, input);
        const auto& positions = *scene.surfaces.at(0).positions;
        for (std::size_t i = 0; i < positions.size(); i += 97) {
            const glm::dvec3 p(positions[i]);
            if ((*scene.surfaces[0].normals)[i].y <= 0.0F) continue; // of a wall
            EXPECT_NEAR(p.y, waveHeight(item, p.x, p.z, t), 1e-6);
        }
    }
}

TEST(HeightField, ATravellingWaveMovesInItsDirection) {
    HeightItem item;
    item.waves = {{0.01, 0.1, 2.0, Angle::degrees(0.0), {}}};
    // A quarter of a period on, all is a quarter of a length further along +X.
    const std::vector<glm::vec2> here = {{0.01F, 0.0F}};
    const std::vector<glm::vec2> there = {{0.035F, 0.0F}};
    std::vector<float> before(1);
    std::vector<float> after(1);
    sampleHeights(item, nullptr, 5.0, here, before);
    sampleHeights(item, nullptr, 5.5, there, after);
    EXPECT_NEAR(before[0], after[0], 1e-7F);
    EXPECT_GT(std::abs(before[0]), 1e-3F);
}

TEST(HeightField, NormalsAreThoseOfItsSlope) {
    const HeightItem item = sea();
    const PosedSurface surface = posed(sceneOf({itemOf(1, item)}), 0.4).surfaces.at(0);
    expectSound(surface);
    constexpr double h = 1e-6;
    double worst = 0.0;
    for (std::size_t i = 0; i < surface.positions->size(); ++i) {
        const glm::vec3& normal = (*surface.normals)[i];
        const glm::dvec3 p((*surface.positions)[i]);
        if (normal.y <= 0.0F || std::abs(p.x) > 0.1 || std::abs(p.z) > 0.07) continue;
        const double dx = (waveHeight(item, p.x + h, p.z, 0.4) - waveHeight(item, p.x - h, p.z, 0.4)) / (2.0 * h);
        const double dz = (waveHeight(item, p.x, p.z + h, 0.4) - waveHeight(item, p.x, p.z - h, 0.4)) / (2.0 * h);
        worst = std::max(
            worst, std::acos(std::min(1.0, glm::dot(glm::normalize(glm::dvec3(-dx, 1.0, -dz)), glm::dvec3(normal)))));
    }
    EXPECT_LT(worst, 0.02) << "radians";
}

TEST(HeightField, HasWallsDownToItsFloor) {
    HeightItem item = sea();
    item.floor = -0.01;
    const PosedSurface surface = posed(sceneOf({itemOf(1, item)}), 0.4).surfaces.at(0);
    const Box box = boundingBox(*surface.positions);
    EXPECT_FLOAT_EQ(box.min.y, -0.01F);
    EXPECT_NEAR(box.size().x, 0.21F, 1e-6F);
    EXPECT_NEAR(box.size().z, 0.15F, 1e-6F);
    // Surface and walls enclose the water above the floor but for the open bottom: the area of the walls, projected,
    // is that of the rim's profile.
    double front = 0.0;
    for (const glm::uvec3& t : surface.topology->triangles) {
        const auto& p = *surface.positions;
        if ((*surface.normals)[t.x].z < 0.999F) continue; // not of the front wall
        front += 0.5 * static_cast<double>(glm::length(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x])));
    }
    double profile = 0.0;
    for (int i = 0; i < 2100; ++i) profile += 1e-4 * (0.01 + waveHeight(item, -0.105 + (i + 0.5) * 1e-4, 0.075, 0.4));
    EXPECT_NEAR(front, profile, 1e-3 * profile);
}

TEST(HeightField, ItsEdgeIsCalmWhereAskedFor) {
    HeightItem item = sea();
    item.calmEdge = 0.02;
    const std::vector<glm::vec2> points = {{0.105F, 0.01F}, {0.02F, 0.075F}, {0.01F, 0.02F}};
    std::vector<float> heights(3);
    sampleHeights(item, nullptr, 0.4, points, heights);
    EXPECT_EQ(heights[0], 0.0F);
    EXPECT_EQ(heights[1], 0.0F);
    EXPECT_NEAR(heights[2], waveHeight(item, 0.01, 0.02, 0.4), 1e-6);
    const PosedSurface surface = posed(sceneOf({itemOf(1, item)}), 0.4).surfaces.at(0);
    for (const glm::vec3& p : *surface.positions) {
        const bool onRim = std::abs(p.x) > 0.10499F && p.y > -0.019F;
        EXPECT_TRUE(!onRim || std::abs(p.y) < 1e-7F) << p.y;
    }
}

TEST(HeightField, APictureIsStretchedOverIt) {
    Image ramp({64, 2}); // black on the left, white on the right
    for (int x = 0; x < 64; ++x)
        for (int y = 0; y < 2; ++y) {
            const auto grey = static_cast<std::uint8_t>(x * 255 / 63);
            ramp.at(x, y) = {grey, grey, grey, 255};
        }
    HeightItem item;
    item.image = "ramp.png";
    item.imageHeight = 0.03;
    const std::vector<glm::vec2> points = {{-0.105F, 0.0F}, {0.0F, 0.03F}, {0.105F, -0.07F}};
    std::vector<float> heights(3);
    sampleHeights(item, &ramp, 0.0, points, heights);
    EXPECT_NEAR(heights[0], 0.0F, 1e-6F);
    EXPECT_NEAR(heights[1], 0.015F, 1e-4F);
    EXPECT_NEAR(heights[2], 0.03F, 1e-6F);
    SceneAssets assets;
    assets.images["ramp.png"] = std::make_shared<const Image>(ramp);
    const PosedSurface surface = posed(sceneOf({itemOf(1, item)}), 0.0, assets).surfaces.at(0);
    EXPECT_NEAR(boundingBox(*surface.positions).max.y, 0.03F, 1e-6F);
}

TEST(ScenePoser, WhatDoesNotDeformStaysTheSameObject) {
    HeightItem still;
    still.waves = {{0.003, 0.05, 0.0, {}, {}}};
    HeightItem moving;
    moving.waves = {{0.003, 0.05, 1.0, {}, {}}};
    SceneItem cube = itemOf(1, ShapeItem{});
    cube.motion = {1.0, 0.01, 1.0};
    Scene scene = sceneOf({cube, itemOf(2, still), itemOf(3, moving)});
    ScenePoser poser;
    PoseInput input;
    const PosedScene first = poser.pose(scene, {}, input);
    input.seconds = 0.3;
    scene.items[0].position.x = 0.2F;
    scene.items[0].material.color = {1.0F, 0.0F, 0.0F};
    const PosedScene second = poser.pose(scene, {}, input);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(first.surfaces[i].topology, second.surfaces[i].topology);
        EXPECT_EQ(first.surfaces[i].positions == second.surfaces[i].positions, i < 2);
        EXPECT_EQ(first.surfaces[i].normals == second.surfaces[i].normals, i < 2);
    }
    EXPECT_NE(first.surfaces[0].worldFromSurface, second.surfaces[0].worldFromSurface);
    std::get<ShapeItem>(scene.items[0].kind).size.x = 0.07F;
    EXPECT_NE(poser.pose(scene, {}, input).surfaces[0].positions, second.surfaces[0].positions);
}

// A program that changes its waves each frame pays for heights, not for a grid.
TEST(ScenePoser, OtherWavesKeepTheGridAndAnotherRectangleDoesNot) {
    HeightItem item = sea();
    for (Wave& wave : item.waves) wave.period = 0.0; // its phases say where they are
    item.calmEdge = 0.01;
    Scene scene = sceneOf({itemOf(1, item)});
    ScenePoser poser;
    const PosedScene first = poser.pose(scene, {}, {});
    auto& heights = std::get<HeightItem>(scene.items[0].kind);
    heights.waves[0].phase = Angle::degrees(170.0);
    heights.waves[1].amplitude = 0.003;
    heights.waves.push_back({0.001, 0.04, 0.0, {}, {}});
    const PosedScene second = poser.pose(scene, {}, {});
    EXPECT_EQ(first.surfaces[0].topology, second.surfaces[0].topology);
    EXPECT_NE(first.surfaces[0].positions, second.surfaces[0].positions);
    const PosedScene fresh = posed(scene);
    EXPECT_EQ(*second.surfaces[0].positions, *fresh.surfaces[0].positions) << "as of one that never was another";
    EXPECT_EQ(*second.surfaces[0].normals, *fresh.surfaces[0].normals);
    EXPECT_EQ(poser.pose(scene, {}, {}).surfaces[0].positions, second.surfaces[0].positions) << "the same waves rest";
    heights.waves[0].period = 2.0;
    PoseInput later;
    later.seconds = 0.5;
    EXPECT_NE(*poser.pose(scene, {}, later).surfaces[0].positions, *second.surfaces[0].positions)
        << "they travel again";
    heights.calmEdge = 0.02;
    EXPECT_NE(poser.pose(scene, {}, later).surfaces[0].topology, second.surfaces[0].topology);
}

TEST(ScenePoser, LightsShineFromWhereTheyStand) {
    SceneItem sun = itemOf(1, LightItem{LightItem::Kind::sun, {1.0F, 0.5F, 0.0F}, 2.0, 0.1, true});
    sun.position = {0.0F, 3.0F, 4.0F};
    SceneItem lamp = itemOf(2, LightItem{LightItem::Kind::lamp, {1.0F, 1.0F, 1.0F}, 0.5, 0.3, false});
    lamp.position = {0.1F, 0.2F, 0.3F};
    lamp.opacity = 0.5F;
    PoseInput input;
    input.worldFromDevice = glm::translate(glm::mat4(1.0F), {1.0F, 0.0F, 0.0F});
    const PosedScene scene = ScenePoser().pose(sceneOf({sun, lamp}), {}, input);
    ASSERT_EQ(scene.lights.size(), 2U);
    EXPECT_TRUE(scene.lights[0].parallel);
    EXPECT_LT(distance(scene.lights[0].position, {0.0F, 0.6F, 0.8F}), 1e-6);
    EXPECT_LT(distance(scene.lights[0].radiance, {2.0F, 2.0F * 0.21404F, 0.0F}), 1e-4) << "linear light";
    EXPECT_FALSE(scene.lights[1].parallel);
    EXPECT_LT(distance(scene.lights[1].position, {1.1F, 0.2F, 0.3F}), 1e-6);
    EXPECT_FLOAT_EQ(scene.lights[1].radiance.g, 0.25F);
    EXPECT_FALSE(scene.lights[1].shadows);
    sun.position = {0.0F, 0.0F, 0.0F};
    EXPECT_EQ(posed(sceneOf({sun})).lights.at(0).position, glm::vec3(0.0F, 1.0F, 0.0F));
}

TEST(ScenePoser, ASunInATurningGroupMoves) {
    SceneItem day = itemOf(1, GroupItem{});
    day.motion.spin = kPi / 2.0;
    SceneItem sun = itemOf(2, LightItem{}, 1);
    sun.position = {1.0F, 0.0F, 0.0F};
    EXPECT_LT(distance(posed(sceneOf({day, sun}), 1.0).lights.at(0).position, {0.0F, 0.0F, -1.0F}), 1e-6);
}

TEST(ScenePoser, FogDriftsWithTheWind) {
    SceneItem fog = itemOf(1, FogItem{{0.2F, 0.1F, 0.4F}, 10.0, {1.0F, 1.0F, 1.0F}, 0.05, {0.02F, -0.01F}});
    fog.position = {0.0F, 0.1F, 0.0F};
    fog.opacity = 0.5F;
    const PosedFog posedFog = posed(sceneOf({fog}), 3.0).fogs.at(0);
    EXPECT_LT(distance(glm::vec3(posedFog.worldFromBox * glm::vec4(0.5F, -0.5F, 0.5F, 1.0F)), {0.1F, 0.05F, 0.2F}),
              1e-6);
    EXPECT_FLOAT_EQ(posedFog.density, 5.0F);
    EXPECT_NEAR(posedFog.offset.x, 0.06F, 1e-6F);
    EXPECT_NEAR(posedFog.offset.y, -0.03F, 1e-6F);
}

TEST(ScenePoser, ShowingThePhysicalAloneLeavesOnlyLight) {
    Scene scene =
        sceneOf({itemOf(1, ShapeItem{}), itemOf(2, LightItem{}), itemOf(3, FogItem{}), itemOf(4, HeightItem{})});
    scene.items[1].position.y = 1.0F;
    scene.showing = Showing::physical;
    const PosedScene physical = posed(scene);
    EXPECT_TRUE(physical.surfaces.empty());
    EXPECT_TRUE(physical.fogs.empty());
    EXPECT_EQ(physical.lights.size(), 1U);
    scene.showing = Showing::virtualOnly;
    EXPECT_EQ(posed(scene).surfaces.size(), 2U);
}

TEST(ScenePoser, NothingThatIsNoNumberGetsThrough) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    SceneItem flat = itemOf(1, ShapeItem{});
    flat.scale.y = 0.0F;
    SceneItem nowhere = itemOf(2, LightItem{});
    nowhere.position.x = nan;
    SceneItem torn = itemOf(3, HeightItem{});
    torn.rotation.x = nan;
    EXPECT_TRUE(posed(sceneOf({flat, nowhere, torn})).surfaces.empty());
    EXPECT_TRUE(posed(sceneOf({flat, nowhere, torn})).lights.empty());
    const PosedScene noTime = posed(sceneOf({itemOf(1, sea())}), std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(noTime.seconds, 0.0);
    for (const glm::vec3& p : *noTime.surfaces.at(0).positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
    PoseInput input;
    input.worldFromDevice[3][1] = nan;
    EXPECT_TRUE(ScenePoser().pose(sceneOf({itemOf(1, ShapeItem{})}), {}, input).surfaces.empty());
}

TEST(ScenePoser, TheTargetStandsWhereTheMatcherHasIt) {
    auto mesh = std::make_shared<const TriangleMesh>(test::boxMesh({0, 0, 0}, {0.1F, 0.2F, 0.3F}));
    PoseInput input;
    SceneItem item = itemOf(1, TargetItem{});
    item.position = {5.0F, 5.0F, 5.0F};
    ScenePoser poser;
    EXPECT_TRUE(poser.pose(sceneOf({item}), {}, input).surfaces.empty()) << "none is there";
    input.targetMesh = mesh;
    input.deviceFromTarget = glm::translate(glm::mat4(1.0F), {0.0F, 0.02F, 0.0F});
    input.worldFromDevice = glm::translate(glm::mat4(1.0F), {1.0F, 0.0F, 0.0F});
    const PosedScene rest = poser.pose(sceneOf({item}), {}, input);
    ASSERT_EQ(rest.surfaces.size(), 1U);
    expectSound(rest.surfaces[0]);
    EXPECT_EQ(glm::vec3(rest.surfaces[0].worldFromSurface[3]), glm::vec3(1.0F, 0.02F, 0.0F));
    EXPECT_EQ(poser.pose(sceneOf({item}), {}, input).surfaces[0].positions, rest.surfaces[0].positions);
    auto moved = std::make_shared<std::vector<glm::vec3>>(mesh->positions);
    for (glm::vec3& p : *moved) p.y *= 2.0F;
    input.targetPositions = moved;
    const PosedScene later = poser.pose(sceneOf({item}), {}, input);
    EXPECT_EQ(later.surfaces[0].topology, rest.surfaces[0].topology);
    EXPECT_FLOAT_EQ(boundingBox(*later.surfaces[0].positions).size().y, 0.4F);
    moved = std::make_shared<std::vector<glm::vec3>>(3);
    input.targetPositions = moved;
    EXPECT_TRUE(poser.pose(sceneOf({item}), {}, input).surfaces.empty()) << "positions of another mesh";
}

TEST(ScenePoser, WhatIsHardlyThereThrowsNoShadow) {
    const auto casts = [](float opacity, Material::Alpha alpha, float ownOpacity) {
        SceneItem item = itemOf(1, ShapeItem{});
        item.opacity = opacity;
        item.material.alpha = alpha;
        item.material.opacity = ownOpacity;
        return posed(sceneOf({item})).surfaces.at(0).castsShadow;
    };
    EXPECT_TRUE(casts(1.0F, Material::Alpha::opaque, 0.1F)) << "an opaque material has no opacity of its own";
    EXPECT_TRUE(casts(0.9F, Material::Alpha::blend, 0.8F));
    EXPECT_FALSE(casts(0.0F, Material::Alpha::opaque, 1.0F));
    EXPECT_FALSE(casts(1.0F, Material::Alpha::blend, 0.3F));
}

TEST(ScenePoser, WhatIsGoneIsForgotten) {
    ScenePoser poser;
    const Scene scene = sceneOf({itemOf(1, ShapeItem{})});
    const auto before = poser.pose(scene, {}, {}).surfaces[0].positions;
    EXPECT_TRUE(poser.pose(Scene{}, {}, {}).surfaces.empty());
    EXPECT_EQ(before.use_count(), 1) << "the poser keeps what nobody shows";
}

} // namespace
} // namespace lumorph

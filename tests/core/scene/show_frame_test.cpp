#include "core/scene/show_frame.h"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/render/eye/lookup_region.h"
#include "tests/support/show_frames.h"

namespace lumorph {
namespace {

constexpr glm::ivec2 kSize(1280, 800);
const std::array<glm::vec3, 5> kEyes{
    {{0.0F, 0.45F, 0.55F}, {0.6F, 0.05F, 0.1F}, {0.0F, 0.9F, 0.0F}, {-0.4F, 0.3F, -0.5F}, {0.02F, 0.01F, 0.8F}}};

SceneInRoom plainScene() { return unlitScene(glm::vec3(0.5F), glm::vec3(0.5F), {}); }

SceneItem floating(float height) {
    SceneItem item;
    item.id = 1;
    item.name = "Cube";
    item.position = {0.0F, height, 0.0F};
    item.kind = ShapeItem{};
    item.motion = {.spin = 0.7, .bob = 0.004, .bobPeriod = 2.0};
    return item;
}

ShowFrame at(const SceneInRoom& scene, double stroke, double seconds) {
    ShowFrame frame = frameOf(scene, std::vector<double>(bundledTablet()->actuatorCount(), stroke));
    ScenePoser poser;
    PoseInput input;
    input.seconds = seconds;
    input.worldFromDevice = frame.worldFromDevice;
    frame.posed = poser.pose(scene, *frame.assets, input);
    return frame;
}

bool holds(const CalibratedCamera& camera, const glm::vec3& point) {
    const auto pixel = pixelOf(camera, glm::dvec3(point));
    return pixel && pixel->x > -0.5 && pixel->y > -0.5 && pixel->x < camera.size.x - 0.5 &&
           pixel->y < camera.size.y - 0.5;
}

TEST(DeviceView, HoldsEveryStateTightly) {
    for (const glm::vec3& eye : kEyes) {
        const CalibratedCamera view = deviceView(at(plainScene(), 0.0, 0.0), eye, kSize);
        EXPECT_LT(glm::distance(positionOf(view), glm::dvec3(eye)), 1e-9);
        EXPECT_EQ(view.size, kSize);
        for (const double stroke : {0.0, 0.5, 1.0}) {
            const ShowFrame frame = at(plainScene(), stroke, 0.0);
            for (const glm::vec3& point : *frame.devicePositions) ASSERT_TRUE(holds(view, point)) << stroke;
        }
        // Tight: the box of all states fills the frame in one direction.
        const Box& reach = bundledTablet()->reach();
        glm::dvec2 low(1e9);
        glm::dvec2 high(-1e9);
        for (unsigned i = 0; i < 8; ++i) {
            const auto pixel =
                pixelOf(view, {(i & 1U) != 0 ? reach.min.x : reach.max.x, (i & 2U) != 0 ? reach.min.y : reach.max.y,
                               (i & 4U) != 0 ? reach.min.z : reach.max.z});
            ASSERT_TRUE(pixel);
            low = glm::min(low, *pixel);
            high = glm::max(high, *pixel);
        }
        const glm::dvec2 share = (high - low) / glm::dvec2(kSize);
        EXPECT_GT(std::max(share.x, share.y), 0.9);
    }
}

TEST(DeviceView, DoesNotSwimWhileDeviceAndItemsMove) {
    SceneInRoom scene = plainScene();
    scene.items.push_back(floating(0.115F));
    for (const glm::vec3& eye : kEyes) {
        const CalibratedCamera first = deviceView(at(scene, 0.0, 0.0), eye, kSize);
        for (const double stroke : {0.3, 1.0})
            for (const double seconds : {0.4, 0.9, 17.3})
                EXPECT_EQ(deviceView(at(scene, stroke, seconds), eye, kSize), first);
    }
}

TEST(DeviceView, HoldsWhatFloatsAboveAndFollowsTheDevice) {
    SceneInRoom scene = plainScene();
    scene.items.push_back(floating(0.13F));
    scene.worldFromDevice[3] = glm::vec4(0.2F, 0.1F, -0.1F, 1.0F);
    const glm::vec3 eye(0.1F, 0.6F, 0.7F);
    const ShowFrame frame = at(scene, 1.0, 0.0);
    const CalibratedCamera view = deviceView(frame, eye, kSize);
    EXPECT_TRUE(holds(view, {0.2F, 0.1F + 0.145F, -0.1F}));
    for (const glm::vec3& point : *frame.devicePositions)
        ASSERT_TRUE(holds(view, glm::vec3(scene.worldFromDevice * glm::vec4(point, 1.0F))));
    EXPECT_THROW((void)deviceView(frame, {0.2F, 0.12F, -0.1F}, kSize), InvalidInput);
}

// A tower beside the device is no reason to look higher over it: the device would be drawn the coarser.
TEST(DeviceView, IsRaisedOnlyByWhatStandsOverTheDevice) {
    const glm::vec3 eye(0.0F, 0.45F, 0.55F);
    const CalibratedCamera plain = deviceView(at(plainScene(), 0.5, 0.0), eye, kSize);
    const auto withCube = [&](const glm::vec3& place) {
        SceneInRoom scene = plainScene();
        scene.items.push_back(floating(0.0F));
        scene.items.back().motion = {};
        scene.items.back().position = place;
        return deviceView(at(scene, 0.5, 0.0), eye, kSize);
    };
    EXPECT_EQ(withCube({0.4F, 0.25F, 0.0F}).focal, plain.focal);
    EXPECT_EQ(withCube({0.0F, 0.25F, -0.4F}).focal, plain.focal);
    EXPECT_LT(withCube({0.0F, 0.15F, 0.0F}).focal.x, plain.focal.x);
}

TEST(TableView, HoldsTheTableAsFarAsAnEyeCan) {
    const ShowFrame frame = at(plainScene(), 0.0, 0.0);
    const CalibratedCamera far = tableView(frame, {0.0F, 1.2F, 1.4F}, kSize);
    for (const glm::vec3& corner :
         {glm::vec3(-0.6F, 0.0F, -0.45F), {0.6F, 0.0F, -0.45F}, {-0.6F, 0.0F, 0.45F}, {0.6F, 0.0F, 0.45F}})
        EXPECT_TRUE(holds(far, corner * 0.999F));
    // An eye over the table sees what lies ahead; no wide angle eats up its pixels.
    const CalibratedCamera near = tableView(frame, {0.1F, 0.3F, 0.3F}, kSize);
    checkCamera(near);
    EXPECT_TRUE(holds(near, {0.0F, 0.0F, 0.0F}));
    EXPECT_TRUE(holds(near, {-0.3F, 0.0F, -0.4F}));
    EXPECT_GT(near.focal.x, 240.0);
}

TEST(LookupAreas, AreWhatAnEyeSeesDifferently) {
    const glm::vec3 eye(0.0F, 0.4F, 0.4F);
    EXPECT_TRUE(lookupAreas(at(plainScene(), 0.5, 0.0), eye).empty()) << "nothing but device and matt table";
    SceneInRoom scene = plainScene();
    scene.items.push_back(floating(0.1F));
    scene.items.back().motion = {};
    const auto areas = lookupAreas(at(scene, 0.5, 0.0), eye);
    ASSERT_EQ(areas.size(), 1U);
    // The cube, 3 cm wide around 10 cm up, seen from (0.4, 0.4): its upper edge falls on z = 0.4 - (0.4 + 0.015) * 0.4
    // / (0.4 - 0.115).
    EXPECT_NEAR(areas[0].low.y, 0.4 - 0.415 * 0.4 / 0.285, 1e-3);
    EXPECT_NEAR(areas[0].high.x, 0.015 * 0.4 / 0.285, 1e-3);
    EXPECT_LT(areas[0].high.y, 0.0F);
    scene.items.back().opacity = 0.0F;
    EXPECT_TRUE(lookupAreas(at(scene, 0.5, 0.0), eye).empty()) << "what only the servos follow is not seen";
    scene.table.material.reflection = 0.3F;
    const auto mirror = lookupAreas(at(scene, 0.5, 0.0), eye);
    ASSERT_EQ(mirror.size(), 1U);
    EXPECT_LE(mirror[0].low.x, -0.6F);
    EXPECT_GE(mirror[0].high.y, 0.45F);
}

// What reaches the height of the eye covers the table up to its horizon, or lies over it: no area is an end to it.
TEST(LookupAreas, AreAllOfTheTableWhereAThingReachesTheEye) {
    SceneInRoom scene = plainScene();
    scene.tableSize = {1.2F, 0.9F};
    scene.items.push_back(floating(0.1F));
    scene.items.back().motion = {};
    FogItem mist;
    mist.size = {0.05F, 0.05F, 0.05F};
    SceneInRoom foggy = plainScene();
    foggy.tableSize = scene.tableSize;
    foggy.items.push_back(floating(0.1F));
    foggy.items.back().motion = {};
    foggy.items.back().kind = mist;
    struct Case {
        float eye; ///< metres above the table
        bool all;
    };
    for (const SceneInRoom& one : {scene, foggy})
        for (const Case& c : {Case{0.35F, false}, Case{0.2F, false}, Case{0.11F, true}, Case{0.09F, true},
                              Case{0.06F, true}, Case{0.01F, true}}) {
            const auto areas = lookupAreas(at(one, 0.0, 0.0), {0.0F, c.eye, 0.4F});
            ASSERT_EQ(areas.size(), 1U) << c.eye;
            const bool all = areas[0].low.x <= -0.6F && areas[0].low.y <= -0.45F && areas[0].high.x >= 0.6F &&
                             areas[0].high.y >= 0.45F;
            EXPECT_EQ(all, c.all) << c.eye;
        }
}

TEST(LookupAreas, AreFewAndHoldEveryThing) {
    const glm::vec3 eye(0.0F, 0.7F, 0.5F);
    const auto row = [&](int count, float from, float step) {
        SceneInRoom scene = plainScene();
        for (int i = 0; i < count; ++i) {
            scene.items.push_back(floating(0.1F));
            scene.items.back().id = i + 1;
            scene.items.back().position.x = from + step * static_cast<float>(i);
        }
        return at(scene, 0.5, 0.0);
    };
    EXPECT_EQ(lookupAreas(row(2, -0.2F, 0.4F), eye).size(), 2U) << "far from each other";
    EXPECT_EQ(lookupAreas(row(4, -0.03F, 0.02F), eye).size(), 1U) << "one behind the other";
    const ShowFrame many = row(30, -0.4F, 0.027F);
    const auto areas = lookupAreas(many, eye);
    EXPECT_LE(areas.size(), 6U);
    for (const PosedSurface& surface : many.posed.surfaces)
        for (const glm::vec3& point : *surface.positions) {
            const glm::vec3 place(surface.worldFromSurface * glm::vec4(point, 1.0F));
            const glm::vec3 seen = eye + eye.y / (eye.y - place.y) * (place - eye);
            EXPECT_TRUE(std::ranges::any_of(areas,
                                            [&](const TableArea& area) {
                                                return seen.x > area.low.x - 1e-5F && seen.z > area.low.y - 1e-5F &&
                                                       seen.x < area.high.x + 1e-5F && seen.z < area.high.y + 1e-5F;
                                            }))
                << seen.x << ", " << seen.z;
        }
}

TEST(LookupAreas, NeedASecondPictureOnlyBeyondTheFirst) {
    const glm::vec3 eye(0.0F, 0.4F, 0.4F);
    const ShowFrame frame = at(plainScene(), 0.5, 0.0);
    const CalibratedCamera first = deviceView(frame, eye, kSize);
    const TableArea within{{-0.03F, -0.03F}, {0.03F, 0.03F}}, beyond{{0.3F, -0.2F}, {0.4F, -0.1F}};
    EXPECT_FALSE(tableLookup(frame, eye, std::array{within}, first, {640, 400}));
    const auto second = tableLookup(frame, eye, std::array{within, beyond}, first, {640, 400});
    ASSERT_TRUE(second);
    EXPECT_TRUE(holds(*second, {0.3F, 0.0F, -0.2F}));
    EXPECT_TRUE(holds(*second, {0.4F, 0.0F, -0.1F}));
    EXPECT_FALSE(holds(*second, {0.03F, 0.0F, 0.0F})) << "tight";
    EXPECT_GE(second->focal.x, 0.5 * first.focal.x) << "fine enough";
    EXPECT_LE(second->focal.x, first.focal.x) << "and no finer than that takes";
    EXPECT_LT(second->size.x, 640);
    // The size that is there is kept until another is clearly better.
    const auto again = tableLookup(frame, eye, std::array{beyond}, first, {640, 400}, second->size);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->size, second->size);
}

} // namespace
} // namespace lumorph

#include "app/studio/viewport/gizmo.h"

#include <cmath>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

const glm::vec2 kSize(1000.0F, 800.0F);
const glm::vec3 kCentre(0.03F, 0.02F, -0.04F);

ViewCamera cameraFrom(double yaw, double pitch, bool orthographic) {
    ViewCamera camera;
    camera.pivot = {0.01F, 0.05F, 0.0F};
    camera.yaw = Angle::degrees(yaw);
    camera.pitch = Angle::degrees(pitch);
    camera.distance = 0.5;
    camera.orthographic = orthographic;
    return camera;
}

// The object's own origin is not where the gizmo is: what turns and scales must heed that.
Gizmo someGizmo() { return {{0.8, Angle::degrees(20.0), {0.05F, 0.03F, -0.02F}}, kCentre}; }

glm::vec2 seen(const ViewCamera& camera, const glm::vec3& point) { return pixelOf(camera, point, kSize).value(); }

glm::vec3 axis(GizmoHandle handle) {
    return {handle == GizmoHandle::moveX ? 1 : 0, handle == GizmoHandle::moveY ? 1 : 0,
            handle == GizmoHandle::moveZ ? 1 : 0};
}

// Length of an arrow in metres, from what the header promises: 90 pixels.
float reach(const ViewCamera& camera) { return 90.0F * metresPerPixel(camera, kCentre, kSize); }

// Where a point of the object ends under a placement.
glm::vec3 placedPoint(const Placement& placement, const glm::vec3& point) {
    return glm::vec3(placement.deviceFromTarget() * glm::vec4(point, 1.0F));
}

struct View {
    double yaw, pitch;
    bool orthographic;
};
class GizmoFrom : public testing::TestWithParam<View> {
protected:
    ViewCamera camera = cameraFrom(GetParam().yaw, GetParam().pitch, GetParam().orthographic);
};
INSTANTIATE_TEST_SUITE_P(Views, GizmoFrom,
                         testing::Values(View{30, 25, false}, View{30, 25, true}, View{-130, 40, false},
                                         View{-130, 40, true}, View{200, 15, false}, View{75, -35, false},
                                         View{310, 60, true}));

TEST_P(GizmoFrom, AnArrowDraggedByThePictureOfTwoCentimetresMovesTwoCentimetres) {
    for (const auto handle : {GizmoHandle::moveX, GizmoHandle::moveY, GizmoHandle::moveZ}) {
        const glm::vec3 held = kCentre + 0.7F * reach(camera) * axis(handle);
        const glm::vec2 from = seen(camera, held);
        ASSERT_EQ(gizmoAt(someGizmo(), camera, from, kSize, 1.0), handle);
        for (const float by : {0.02F, -0.02F}) {
            const glm::vec2 to = seen(camera, held + by * axis(handle));
            const GizmoDrag drag = dragGizmo(someGizmo(), handle, camera, from, to, kSize, false);
            const glm::vec3 moved = drag.placement.translation - someGizmo().placement.translation;
            EXPECT_LT(glm::distance(moved, by * axis(handle)), 1e-4F);
            EXPECT_LT(glm::distance(drag.centre, kCentre + by * axis(handle)), 1e-4F);
            EXPECT_EQ(drag.placement.yaw, someGizmo().placement.yaw);
            EXPECT_EQ(drag.placement.scale, someGizmo().placement.scale);
            const char name = handle == GizmoHandle::moveX ? 'x' : handle == GizmoHandle::moveY ? 'y' : 'z';
            EXPECT_EQ(drag.label, std::string(1, name) + (by > 0 ? " 2.0 cm" : " -2.0 cm"));
        }
    }
}

TEST_P(GizmoFrom, TheGroundSquareMovesByWhatThePointerCrossesOnTheGround) {
    const float length = reach(camera);
    const glm::vec3 held = kCentre + 0.35F * length * glm::vec3(1, 0, 1);
    const glm::vec3 by(0.012F, 0.0F, -0.03F);
    ASSERT_EQ(gizmoAt(someGizmo(), camera, seen(camera, held), kSize, 1.0), GizmoHandle::moveGround);
    const GizmoDrag drag = dragGizmo(someGizmo(), GizmoHandle::moveGround, camera, seen(camera, held),
                                     seen(camera, held + by), kSize, false);
    EXPECT_LT(glm::distance(drag.placement.translation, someGizmo().placement.translation + by), 1e-4F);
    EXPECT_EQ(drag.label, "x 1.2 cm, z -3.0 cm");
}

TEST_P(GizmoFrom, TheRingTurnsByTheAngleThePointerGoesAroundIt) {
    const float radius = 0.74F * reach(camera);
    const auto onRing = [&](double degrees) {
        const auto angle = static_cast<float>(Angle::degrees(degrees).inRadians());
        return kCentre + radius * glm::vec3(std::sin(angle), 0.0F, std::cos(angle));
    };
    for (const double begin : {10.0, 100.0, 160.0, 215.0}) {
        ASSERT_TRUE(gizmoAt(someGizmo(), camera, seen(camera, onRing(begin)), kSize, 1.0)) << begin;
        const GizmoDrag drag = dragGizmo(someGizmo(), GizmoHandle::turn, camera, seen(camera, onRing(begin)),
                                         seen(camera, onRing(begin + 35.0)), kSize, false);
        if (std::abs(GetParam().pitch) > 12.0) {
            EXPECT_NEAR(drag.placement.yaw.inDegrees(), 55.0, 0.01);
            EXPECT_EQ(drag.label, "35 deg");
        }
        // The axis of the turn goes through the gizmo: what of the object is there stays there.
        const glm::mat4 before = glm::inverse(someGizmo().placement.deviceFromTarget());
        const auto atCentre = glm::vec3(before * glm::vec4(kCentre, 1.0F));
        EXPECT_LT(glm::distance(placedPoint(drag.placement, atCentre), kCentre), 1e-6F);
    }
}

TEST_P(GizmoFrom, TheSizeCubeScalesAboutTheGizmo) {
    const glm::vec2 centre = seen(camera, kCentre);
    const glm::vec2 held = centre + 0.95F * 90.0F * glm::normalize(glm::vec2(1, -1));
    ASSERT_EQ(gizmoAt(someGizmo(), camera, held, kSize, 1.0), GizmoHandle::size);
    const GizmoDrag drag =
        dragGizmo(someGizmo(), GizmoHandle::size, camera, held, centre + 1.2F * (held - centre), kSize, false);
    EXPECT_NEAR(drag.placement.scale, 0.8 * 1.2, 1e-4);
    EXPECT_EQ(drag.label, "120 %");
    const glm::mat4 before = glm::inverse(someGizmo().placement.deviceFromTarget());
    const auto atCentre = glm::vec3(before * glm::vec4(kCentre, 1.0F));
    EXPECT_LT(glm::distance(placedPoint(drag.placement, atCentre), kCentre), 1e-6F);
    // Pulled through the centre and out at the other side it is tiny, not inside out.
    const GizmoDrag through =
        dragGizmo(someGizmo(), GizmoHandle::size, camera, held, centre - 3.0F * (held - centre), kSize, false);
    EXPECT_GT(through.placement.scale, 0.0);
}

TEST_P(GizmoFrom, CoarseDragsSnap) {
    const glm::vec3 held = kCentre + 0.7F * reach(camera) * glm::vec3(0, 1, 0);
    const GizmoDrag up = dragGizmo(someGizmo(), GizmoHandle::moveY, camera, seen(camera, held),
                                   seen(camera, held + glm::vec3(0, 0.0131F, 0)), kSize, true);
    EXPECT_NEAR(up.placement.translation.y, someGizmo().placement.translation.y + 0.015F, 1e-6F);
    EXPECT_EQ(up.label, "y 1.5 cm");
    const glm::vec2 centre = seen(camera, kCentre);
    const glm::vec2 cube = centre + 0.95F * 90.0F * glm::normalize(glm::vec2(1, -1));
    const GizmoDrag larger =
        dragGizmo(someGizmo(), GizmoHandle::size, camera, cube, centre + 1.27F * (cube - centre), kSize, true);
    EXPECT_NEAR(larger.placement.scale, 0.8 * 1.3, 1e-6);
    EXPECT_EQ(larger.label, "130 %");
}

TEST_P(GizmoFrom, NoDragJumpsOrGivesNumbersThatAreNone) {
    for (const auto handle : {GizmoHandle::moveX, GizmoHandle::moveY, GizmoHandle::moveZ, GizmoHandle::moveGround,
                              GizmoHandle::turn, GizmoHandle::size}) {
        const glm::vec2 from = seen(camera, kCentre) + glm::vec2(40, -30);
        const GizmoDrag rests = dragGizmo(someGizmo(), handle, camera, from, from, kSize, false);
        EXPECT_LT(glm::distance(rests.placement.translation, someGizmo().placement.translation), 1e-6F);
        for (float x = -3000; x <= 4000; x += 97)
            for (float y = -3000; y <= 4000; y += 101) {
                const GizmoDrag drag = dragGizmo(someGizmo(), handle, camera, from, {x, y}, kSize, false);
                const glm::vec3 t = drag.placement.translation;
                ASSERT_TRUE(std::isfinite(t.x + t.y + t.z) && std::isfinite(drag.placement.scale) &&
                            std::isfinite(drag.placement.yaw.inRadians()));
                ASSERT_LT(glm::length(t), 100.0F);
            }
    }
}

TEST(Gizmo, AnArrowThatPointsAtTheCameraIsNeitherGrabbedNorMoved) {
    struct Case {
        double yaw, pitch;
        GizmoHandle handle;
    };
    for (const bool orthographic : {true, false})
        for (const Case& c : {Case{0, 0, GizmoHandle::moveZ}, Case{90, 0, GizmoHandle::moveX},
                              Case{0, 90, GizmoHandle::moveY}, Case{180, 0, GizmoHandle::moveZ}}) {
            ViewCamera camera = cameraFrom(c.yaw, c.pitch, orthographic);
            camera.pivot = kCentre;
            const glm::vec2 from = seen(camera, kCentre);
            EXPECT_NE(gizmoAt(someGizmo(), camera, from + glm::vec2(1, 1), kSize, 1.0), c.handle);
            for (const glm::vec2 by : {glm::vec2(1, 0), glm::vec2(200, 150), glm::vec2(-4000, 3)}) {
                const GizmoDrag drag = dragGizmo(someGizmo(), c.handle, camera, from, from + by, kSize, false);
                EXPECT_EQ(drag.placement.translation, someGizmo().placement.translation);
            }
            // Turning works from every side: a quarter of an arrow length is about a quarter of a radian.
            const GizmoDrag turn = dragGizmo(someGizmo(), GizmoHandle::turn, camera, from + glm::vec2(0, 66),
                                             from + glm::vec2(1, 66), kSize, false);
            EXPECT_LT(std::abs(turn.placement.yaw.inDegrees() - 20.0), 2.0);
            EXPECT_GT(std::abs(turn.placement.yaw.inDegrees() - 20.0), 0.1);
        }
}

TEST(Gizmo, GroundSeenFromTheSideMovesAcrossThePictureOnly) {
    ViewCamera camera = cameraFrom(0, 0, true);
    const glm::vec2 from = seen(camera, kCentre);
    const glm::vec2 to = seen(camera, kCentre + glm::vec3(0.02F, 0.05F, 0.0F));
    const GizmoDrag drag = dragGizmo(someGizmo(), GizmoHandle::moveGround, camera, from, to, kSize, false);
    EXPECT_LT(glm::distance(drag.placement.translation, someGizmo().placement.translation + glm::vec3(0.02F, 0, 0)),
              1e-4F);
}

TEST(Gizmo, HandlesKeepTheirSizeOnTheScreen) {
    for (const double distance : {0.1, 0.5, 5.0}) {
        ViewCamera camera = cameraFrom(30, 25, false);
        camera.pivot = kCentre;
        camera.distance = distance;
        glm::vec2 low(1e9F);
        glm::vec2 high(-1e9F);
        for (const ViewportLine& line : gizmoLines(someGizmo(), camera, kSize, 1.0, std::nullopt)) {
            EXPECT_TRUE(line.onTop);
            for (const glm::vec3& end : {line.from, line.to}) {
                low = glm::min(low, seen(camera, end));
                high = glm::max(high, seen(camera, end));
            }
        }
        // The upright arrow is foreshortened by the pitch of 25 degrees; nothing else is higher.
        EXPECT_NEAR(seen(camera, kCentre).y - low.y, 90.0 * std::cos(Angle::degrees(25).inRadians()), 2.0) << distance;
        EXPECT_LT(high.x - low.x, 190.0F);
    }
}

TEST(Gizmo, TheHandleUnderThePointerIsInTheAccentColour) {
    const ViewCamera camera = cameraFrom(30, 25, false);
    const glm::vec3 accent(0.1F, 0.2F, 0.3F);
    const auto count = [&](std::optional<GizmoHandle> hot) {
        int lines = 0;
        for (const ViewportLine& line : gizmoLines(someGizmo(), camera, kSize, 1.0, hot, accent))
            lines += line.color == accent ? 1 : 0;
        return lines;
    };
    EXPECT_EQ(count(std::nullopt), 0);
    EXPECT_EQ(count(GizmoHandle::moveGround), 4);
    EXPECT_GT(count(GizmoHandle::moveX), 1);
}

TEST(Gizmo, BehindTheEyeThereIsNothing) {
    ViewCamera camera = cameraFrom(0, 0, false);
    camera.pivot = kCentre - glm::vec3(0, 0, 3);
    EXPECT_TRUE(gizmoLines(someGizmo(), camera, kSize, 1.0, std::nullopt).empty());
    EXPECT_FALSE(gizmoAt(someGizmo(), camera, {500, 400}, kSize, 1.0));
    const GizmoDrag drag = dragGizmo(someGizmo(), GizmoHandle::moveX, camera, {500, 400}, {600, 400}, kSize, false);
    EXPECT_EQ(drag.placement.translation, someGizmo().placement.translation);
}

} // namespace
} // namespace lumorph::studio

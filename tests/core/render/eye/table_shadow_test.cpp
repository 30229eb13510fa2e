#include "core/render/eye/table_shadow.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/render/eye/device_surface.h"
#include "tests/support/show_frames.h"

namespace lumorph {
namespace {

SceneItem cube(const glm::vec3& position, float size) {
    SceneItem item;
    item.id = 1;
    item.name = "Cube";
    item.position = position;
    item.kind = ShapeItem{.form = ShapeItem::Form::box, .size = glm::vec3(size)};
    return item;
}

ShowFrame frameWith(const SceneItem& item) {
    SceneInRoom scene = unlitScene(glm::vec3(0.5F), glm::vec3(0.5F), {});
    scene.items = {item};
    ShowFrame frame = frameOf(scene, {0.7, 0.0, 0.2, 0.5, 0.0, 0.9});
    PoseInput input;
    input.worldFromDevice = frame.worldFromDevice;
    frame.posed = ScenePoser().pose(scene, *frame.assets, input);
    return frame;
}

/// How far, metres, the shadow that points throw in the light of a disc reaches out of an area. The sun's half shadow
/// is as wide as the disc over the way to the table, across the light (which is what the pass draws); a lamp's is that
/// of rays from its rim. `radius`: of the sun over its distance, of the lamp metres.
float beyond(const TableArea& area, const ShowFrame& frame, const PosedLight& light, float radius) {
    float most = -1.0F;
    const auto shine = [&](const glm::vec3& point) {
        const glm::vec3 towards = light.parallel ? light.position : light.position - point;
        const glm::vec3 right = glm::normalize(glm::cross(towards, glm::vec3(0.3F, 0.2F, 0.9F)));
        const glm::vec3 up = glm::normalize(glm::cross(right, towards));
        for (int i = 0; i < 16; ++i) {
            const float angle = 6.2831853F * static_cast<float>(i) / 16.0F;
            const glm::vec3 side = radius * (std::cos(angle) * right + std::sin(angle) * up);
            const float height = std::max(point.y, 0.0F);
            glm::vec3 at;
            if (light.parallel) {
                const glm::vec3 off = side * (height / towards.y);
                at = point - towards * (height / towards.y) + off - towards * (off.y / towards.y);
            } else {
                const glm::vec3 from = towards + side;
                if (!(from.y > 0.0F)) continue;
                at = point - from * (height / from.y);
            }
            most = std::max({most, area.low.x - at.x, at.x - area.high.x, area.low.y - at.z, at.z - area.high.y});
        }
    };
    for (const glm::vec3& point : *frame.devicePositions) shine(point);
    for (const PosedSurface& surface : frame.posed.surfaces)
        for (const glm::vec3& point : *surface.positions)
            shine(glm::vec3(surface.worldFromSurface * glm::vec4(point, 1.0F)));
    return most;
}

TEST(ShadowsOnTable, HoldAllThatSoftLightThrows) {
    const ShowFrame frame = frameWith(cube({0.05F, 0.12F, -0.04F}, 0.04F));
    for (const float softness : {0.0F, 0.1F, 0.4F})
        for (const glm::vec3& way : {glm::vec3(-0.5F, 0.8F, -0.4F), {0.9F, 0.4F, 0.1F}, {0.0F, 1.0F, 0.0F}}) {
            PosedLight light;
            light.position = glm::normalize(way);
            light.softness = softness;
            const auto area = shadowsOnTable(frame, light);
            ASSERT_TRUE(area);
            const float past = beyond(*area, frame, light, 0.5F * softness);
            EXPECT_LT(past, 0.0F) << softness << " sun " << way.x;
            EXPECT_GT(past, -0.035F) << softness << " sun " << way.x << ": needlessly wide";
        }
}

TEST(ShadowsOnTable, HoldThoseOfANearLampToo) {
    const ShowFrame frame = frameWith(cube({0.02F, 0.15F, 0.01F}, 0.03F));
    for (const float softness : {0.05F, 0.3F})
        for (const glm::vec3& place : {glm::vec3(0.05F, 0.4F, 0.0F), {-0.35F, 0.5F, 0.2F}}) {
            PosedLight light;
            light.parallel = false;
            light.position = place;
            light.softness = softness;
            const auto area = shadowsOnTable(frame, light);
            ASSERT_TRUE(area);
            // Its size is told as seen from the middle of what throws shadows.
            const float distance = glm::distance(place, deviceBounds(frame).centre());
            EXPECT_LT(beyond(*area, frame, light, 0.5F * softness * distance), 0.0F) << softness << " " << place.x;
        }
}

TEST(ShadowsOnTable, HaveNoEndUnderALowLightAndCountWhatIsSeenAlone) {
    ShowFrame frame = frameWith(cube({0.4F, 0.12F, 0.3F}, 0.04F));
    PosedLight light;
    light.position = glm::normalize(glm::vec3(1.0F, 0.001F, 0.0F));
    EXPECT_FALSE(shadowsOnTable(frame, light));
    light.position = {0.0F, 1.0F, 0.0F};
    EXPECT_GT(shadowsOnTable(frame, light)->high.x, 0.4F);
    PosedSurface& surface = frame.posed.surfaces.front();
    surface.worldFromSurface[3].x = std::nanf("");
    EXPECT_LT(shadowsOnTable(frame, light)->high.x, 0.2F) << "what is broken is not drawn";
    surface.worldFromSurface[3].x = 0.4F;
    surface.opacity = 0.0F;
    EXPECT_LT(shadowsOnTable(frame, light)->high.x, 0.2F) << "what the servos follow alone throws none";
    surface.opacity = 1.0F;
    surface.castsShadow = false;
    EXPECT_LT(shadowsOnTable(frame, light)->high.x, 0.2F);
    surface.positions.reset();
    EXPECT_TRUE(shadowsOnTable(frame, light));
}

} // namespace
} // namespace lumorph

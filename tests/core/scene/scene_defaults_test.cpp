#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/resources.h"
#include "core/rig/rig_file.h"
#include "core/scene/installation.h"
#include "core/scene/scene.h"

namespace lumorph {
namespace {

/// Where a projector's pixel falls on a horizontal plane.
glm::dvec3 landing(const CalibratedCamera& camera, const glm::dvec2& pixel, double height) {
    const glm::dvec3 from = positionOf(camera);
    const glm::dvec3 way = directionOf(camera, pixel);
    return from + way * ((height - from.y) / way.y);
}

TEST(DefaultInstallation, ItsProjectorLightsTheDeviceFromTwoMetresAbove) {
    const Installation installation = defaultInstallation();
    ASSERT_EQ(installation.projectors.size(), 1U);
    const CalibratedCamera& camera = installation.projectors[0].camera;
    checkCamera(camera);
    EXPECT_EQ(camera.size, glm::ivec2(1920, 1080));
    EXPECT_NEAR(positionOf(camera).y, 2.0, 0.2);
    EXPECT_GT(positionOf(camera).z, 0.0) << "on the viewer's side, to light what bends up for him";
    const glm::dvec3 left = landing(camera, {-0.5, 539.5}, 0.02);
    const glm::dvec3 right = landing(camera, {1919.5, 539.5}, 0.02);
    const glm::dvec3 upper = landing(camera, {959.5, -0.5}, 0.02);
    const glm::dvec3 lower = landing(camera, {959.5, 1079.5}, 0.02);
    EXPECT_NEAR(glm::distance(left, right), 0.62, 0.03);
    EXPECT_NEAR(glm::distance(upper, lower), 0.35, 0.03);
    const glm::dvec3 middle = landing(camera, {959.5, 539.5}, 0.02);
    EXPECT_LT(std::hypot(middle.x, middle.z), 0.01);
    // Lens shift: the axis leaves at the picture's edge or beyond.
    EXPECT_GT(camera.principal.y, 1079.0);
    EXPECT_GT(distortionLimit(camera), 0.2) << "the picture's corners lie within";
    EXPECT_NE(camera.distortion[0], 0.0);
}

TEST(DefaultInstallation, TheLiftedDeviceStaysInTheProjectorsPicture) {
    const CalibratedCamera camera = defaultInstallation().projectors[0].camera;
    const Rig rig = readRig(resourceFile("models/tablet.glb"));
    std::vector<glm::vec3> points(rig.restMesh().positions.size());
    for (const double stroke : {0.0, 0.5, 1.0}) {
        rig.deform(std::vector<double>(rig.actuatorCount(), stroke), points);
        for (const glm::vec3& point : points) {
            const auto pixel = pixelOf(camera, glm::dvec3(point));
            ASSERT_TRUE(pixel);
            ASSERT_TRUE(pixel->x > 0.0 && pixel->x < 1919.0 && pixel->y > 0.0 && pixel->y < 1079.0);
        }
    }
}

TEST(DefaultInstallation, AFarFlapThatStandsUpForTheViewerIsLitAndSoAreOthersLiftedHalfWay) {
    // A flap's upper side leans towards the device's middle by its lift.
    const glm::dvec3 from = positionOf(defaultInstallation().projectors[0].camera);
    const auto incidence = [&](const glm::dvec3& outwards, double degrees) {
        const double lift = Angle::degrees(degrees).inRadians();
        const glm::dvec3 normal = glm::dvec3(0.0, std::cos(lift), 0.0) - outwards * std::sin(lift);
        const glm::dvec3 towards = glm::normalize(from - 0.08 * outwards - glm::dvec3(0.0, 0.05, 0.0));
        return Angle::radians(std::acos(glm::dot(normal, towards))).inDegrees();
    };
    EXPECT_LT(incidence({0, 0, -1}, 80.0), 70.0) << "80 degrees: what view dependence asks for at 30 degrees";
    for (const glm::dvec3 outwards : {glm::dvec3(1, 0, 0), {-1, 0, 0}, {0, 0, 1}})
        EXPECT_LT(incidence(outwards, 55.0), 70.0) << outwards.x << ", " << outwards.z;
}

TEST(DefaultInstallation, HasATableBeforeWhichAViewerStandsAndNothingIsMeasured) {
    const Installation installation = defaultInstallation();
    EXPECT_EQ(installation.tableSize, glm::vec2(1.2F, 0.9F));
    EXPECT_GT(installation.eye.y, 0.3F);
    EXPECT_EQ(installation.origins, Installation::Origins());
    EXPECT_EQ(installation.projectors[0].pose.way, Origin::Way::assumed);
    EXPECT_NO_THROW(checkInstallation(installation));
}

TEST(DefaultScene, HasOneSunFromTheUpperLeftAndAPaperDeviceOnWood) {
    const Scene scene = defaultScene();
    ASSERT_EQ(scene.items.size(), 1U);
    const auto* sun = std::get_if<LightItem>(&scene.items[0].kind);
    ASSERT_TRUE(sun);
    EXPECT_EQ(sun->kind, LightItem::Kind::sun);
    EXPECT_TRUE(sun->shadows);
    EXPECT_LT(scene.items[0].position.x, 0.0F) << "left";
    EXPECT_LT(scene.items[0].position.z, 0.0F) << "upper, on the viewer's page";
    const glm::vec3 paper = scene.device.material.color;
    EXPECT_GT(std::min({paper.r, paper.g, paper.b}), 0.85F);
    EXPECT_EQ(drivingItem(scene), nullptr);
}

} // namespace
} // namespace lumorph

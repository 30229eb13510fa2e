#include "core/render/viewport/view_camera.h"

#include <array>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace lumorph {
namespace {

const glm::vec2 kViewSize(1000.0F, 700.0F);

class Cameras {
public:
    ViewCamera next() {
        ViewCamera camera;
        camera.pivot = {between(-0.2, 0.2), between(0.0, 0.3), between(-0.2, 0.2)};
        camera.yaw = Angle::degrees(between(-180.0, 180.0));
        camera.pitch = Angle::degrees(between(-88.0, 88.0));
        camera.distance = std::pow(10.0, static_cast<double>(between(-1.5, 0.5)));
        camera.orthographic = between(0.0, 1.0) < 0.5F;
        return camera;
    }
    glm::vec2 pixel() { return {between(0.0, 1000.0), between(0.0, 700.0)}; }
    float between(double low, double high) {
        return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random_));
    }

private:
    std::mt19937 random_{7};
};

glm::vec3 at(const Ray& ray, float distance) { return ray.origin + distance * ray.direction; }

// Where a ray meets the plane through the pivot that faces the camera.
glm::vec3 atPivotDepth(const ViewCamera& camera, const Ray& ray) {
    const glm::vec3 back = glm::normalize(eyeOf(camera) - camera.pivot);
    return at(ray, glm::dot(camera.pivot - ray.origin, back) / glm::dot(ray.direction, back));
}

TEST(ViewCamera, ARayThroughAPixelComesBackToThePixel) {
    Cameras cameras;
    for (int i = 0; i < 300; ++i) {
        const ViewCamera camera = cameras.next();
        const glm::vec2 pixel = cameras.pixel();
        const Ray ray = rayThrough(camera, pixel, kViewSize);
        EXPECT_NEAR(glm::length(ray.direction), 1.0F, 1e-5F);
        const auto back = pixelOf(camera, atPivotDepth(camera, ray), kViewSize);
        ASSERT_TRUE(back);
        EXPECT_LT(glm::distance(*back, pixel), 0.1F) << i;
    }
}

TEST(ViewCamera, TheMatrixPutsPointsWherePixelOfSays) {
    Cameras cameras;
    for (int i = 0; i < 300; ++i) {
        const ViewCamera camera = cameras.next();
        const glm::vec3 point = atPivotDepth(camera, rayThrough(camera, cameras.pixel(), kViewSize));
        Box scene{camera.pivot - 0.1F, camera.pivot + 0.1F};
        scene.include(point);
        const glm::vec4 clip = clipFromWorld(camera, kViewSize.x / kViewSize.y, scene) * glm::vec4(point, 1.0F);
        const glm::vec2 pixel = (0.5F * glm::vec2(clip.x, -clip.y) / clip.w + 0.5F) * kViewSize;
        EXPECT_LT(glm::distance(pixel, pixelOf(camera, point, kViewSize).value()), 0.2F) << i;
        EXPECT_LE(std::abs(clip.z / clip.w), 1.0F) << i;
    }
}

TEST(ViewCamera, YawAndPitchTurnAsTheySay) {
    ViewCamera camera;
    camera.distance = 2.0;
    EXPECT_LT(glm::distance(eyeOf(camera), glm::vec3(0, 0, 2)), 1e-5F);
    camera.yaw = Angle::degrees(90.0); // from the right
    EXPECT_LT(glm::distance(eyeOf(camera), glm::vec3(2, 0, 0)), 1e-5F);
    EXPECT_LT(pixelOf(camera, {0, 0, 0.1F}, kViewSize)->x, 500.0F); // the front is on the left
    camera.pitch = Angle::degrees(90.0);
    EXPECT_LT(glm::distance(eyeOf(camera), glm::vec3(0, 2, 0)), 1e-5F);
}

TEST(ViewCamera, BothProjectionsShowTheSameAtThePivot) {
    Cameras cameras;
    for (int i = 0; i < 100; ++i) {
        ViewCamera camera = cameras.next();
        const glm::vec3 point = atPivotDepth(camera, rayThrough(camera, cameras.pixel(), kViewSize));
        const auto one = pixelOf(camera, point, kViewSize);
        const float metres = metresPerPixel(camera, camera.pivot, kViewSize);
        camera.orthographic = !camera.orthographic;
        EXPECT_LT(glm::distance(*one, *pixelOf(camera, point, kViewSize)), 0.1F);
        EXPECT_NEAR(metresPerPixel(camera, camera.pivot, kViewSize) / metres, 1.0F, 1e-4F);
    }
}

TEST(ViewCamera, ZoomAndPanHoldThePointUnderTheCursor) {
    Cameras cameras;
    for (int i = 0; i < 300; ++i) {
        const ViewCamera camera = cameras.next();
        const glm::vec2 pixel = cameras.pixel();
        const glm::vec2 drag(cameras.between(-200, 200), cameras.between(-200, 200));
        const glm::vec3 held = atPivotDepth(camera, rayThrough(camera, pixel, kViewSize));
        const double factor = std::pow(2.0, static_cast<double>(cameras.between(-1.0, 1.0)));
        const ViewCamera nearer = zoomed(camera, factor, pixel, kViewSize);
        EXPECT_NEAR(nearer.distance * factor / camera.distance, 1.0, 1e-9);
        EXPECT_LT(glm::distance(*pixelOf(nearer, held, kViewSize), pixel), 0.5F) << i;
        EXPECT_LT(glm::distance(*pixelOf(panned(camera, drag, kViewSize), held, kViewSize), pixel + drag), 0.5F) << i;
    }
}

TEST(ViewCamera, ZoomStaysWithinItsLimits) {
    ViewCamera camera;
    camera = zoomed(camera, 1e9, {10, 10}, kViewSize);
    EXPECT_DOUBLE_EQ(camera.distance, 1e-3);
    camera = zoomed(camera, 1e-12, {10, 10}, kViewSize);
    EXPECT_DOUBLE_EQ(camera.distance, 100.0);
    EXPECT_TRUE(std::isfinite(glm::length(camera.pivot)));
}

TEST(ViewCamera, OrbitKeepsPivotAndDistanceAndStopsAtThePoles) {
    const ViewCamera camera;
    const ViewCamera turned = orbited(camera, {350.0F, 70.0F}, kViewSize);
    EXPECT_EQ(turned.pivot, camera.pivot);
    EXPECT_NEAR(glm::distance(eyeOf(turned), turned.pivot), 0.6F, 1e-5F);
    EXPECT_NEAR(turned.yaw.inDegrees(), -90.0, 1e-9); // half the height is a quarter turn
    EXPECT_NEAR(turned.pitch.inDegrees(), 18.0, 1e-9);
    EXPECT_NEAR(orbited(camera, {0, 9999}, kViewSize).pitch.inDegrees(), 90.0, 1e-9);
    EXPECT_NEAR(orbited(camera, {0, -9999}, kViewSize).pitch.inDegrees(), -90.0, 1e-9);
}

TEST(ViewCamera, AFramedBoxFillsTheViewAndNoCornerLeavesIt) {
    Cameras cameras;
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 low(cameras.between(-1, 1), cameras.between(-1, 1), cameras.between(-1, 1));
        const Box box{low, low + glm::vec3(cameras.between(0.01, 1), cameras.between(0.01, 1), cameras.between(0, 1))};
        const ViewCamera before = cameras.next();
        const ViewCamera camera = framed(before, box, kViewSize.x / kViewSize.y, 0.8F);
        EXPECT_EQ(camera.yaw, before.yaw);
        EXPECT_EQ(camera.pitch, before.pitch);
        glm::vec2 least(1e9F);
        glm::vec2 most(-1e9F);
        for (unsigned k = 0; k < 8; ++k) {
            const glm::vec3 corner(k & 1U ? box.max.x : box.min.x, k & 2U ? box.max.y : box.min.y,
                                   k & 4U ? box.max.z : box.min.z);
            const auto pixel = pixelOf(camera, corner, kViewSize);
            ASSERT_TRUE(pixel) << i;
            least = glm::min(least, *pixel / kViewSize);
            most = glm::max(most, *pixel / kViewSize);
        }
        EXPECT_NEAR(std::max(most.x - least.x, most.y - least.y), 0.8F, 0.01F) << i;
        EXPECT_LT(glm::length(most + least - 1.0F), 0.02F) << i; // centred
    }
    const ViewCamera camera = cameras.next();
    EXPECT_EQ(framed(camera, Box(), 1.5F), camera);
}

TEST(ViewCamera, LooksFromAllSides) {
    const std::array<glm::vec3, 7> sides{
        {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 2, 3}}};
    ViewCamera camera;
    camera.yaw = Angle::degrees(33.0);
    camera.pitch = Angle::degrees(20.0);
    for (const glm::vec3& side : sides) {
        const ViewCamera turned = lookingFrom(camera, side);
        EXPECT_LT(glm::distance(glm::normalize(eyeOf(turned) - turned.pivot), glm::normalize(side)), 1e-5F);
        const auto middle = pixelOf(turned, turned.pivot, kViewSize);
        ASSERT_TRUE(middle);
        EXPECT_LT(glm::distance(*middle, 0.5F * kViewSize), 1e-2F);
        EXPECT_TRUE(std::isfinite(pixelOf(turned, {0.1F, 0.1F, 0.1F}, kViewSize)->x));
    }
    // From above, right is right and the front is at the bottom.
    const ViewCamera above = lookingFrom(camera, {0, 1, 0});
    EXPECT_GT(pixelOf(above, {0.1F, 0, 0}, kViewSize)->x, 510.0F);
    EXPECT_GT(pixelOf(above, {0, 0, 0.1F}, kViewSize)->y, 360.0F);
}

TEST(ViewCamera, GlidesTheShorterWayFromEndToEnd) {
    ViewCamera from;
    from.yaw = Angle::degrees(170.0);
    ViewCamera to = from;
    to.yaw = Angle::degrees(-170.0);
    to.distance = 2.4;
    to.orthographic = true;
    EXPECT_EQ(between(from, to, 0.0), from);
    EXPECT_EQ(between(from, to, 1.0), to);
    const ViewCamera half = between(from, to, 0.5);
    EXPECT_NEAR(half.yaw.inDegrees(), 180.0, 1e-9);
    EXPECT_NEAR(half.distance, 1.2, 1e-9); // equal steps of zoom
}

TEST(ViewCamera, WhatIsBehindTheEyeHasNoPixel) {
    ViewCamera camera;
    EXPECT_FALSE(pixelOf(camera, {0, 0, 1.0F}, kViewSize));
    EXPECT_TRUE(pixelOf(camera, {0, 0, 0.5F}, kViewSize));
}

} // namespace
} // namespace lumorph

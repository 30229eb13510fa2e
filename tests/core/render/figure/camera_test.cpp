#include "core/render/figure/camera.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

// The pinhole camera by similar triangles, without matrices.
glm::dvec2 pinhole(const Camera& camera, const glm::dvec3& point, glm::dvec2 size) {
    const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.centre) - glm::dvec3(camera.eye));
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
    const glm::dvec3 down = glm::cross(forward, right);
    const glm::dvec3 to = point - glm::dvec3(camera.eye);
    const double focal = 0.5 * size.y / std::tan(0.5 * camera.fieldOfView.inRadians());
    return 0.5 * size + focal * glm::dvec2(glm::dot(to, right), glm::dot(to, down)) / glm::dot(to, forward);
}

TEST(Camera, ProjectsLikeAPinhole) {
    Camera camera;
    camera.eye = {0.4F, 0.5F, 0.7F};
    camera.centre = {0.05F, -0.02F, 0.1F};
    camera.aspect = 800.0F / 500.0F;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> around(-0.15F, 0.15F);
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 point(around(random), around(random), around(random));
        const glm::dvec2 expected = pinhole(camera, point, {800.0, 500.0});
        const glm::vec2 pixel = pixelOf(camera, point, {800.0F, 500.0F});
        EXPECT_NEAR(pixel.x, expected.x, 0.01);
        EXPECT_NEAR(pixel.y, expected.y, 0.01);
    }
}

TEST(Camera, FramesABoxCentredAndAsLargeAsAsked) {
    const Box boxes[] = {{{-0.1F, 0.0F, -0.1F}, {0.1F, 0.05F, 0.1F}},
                         {{2.0F, 0.0F, 1.0F}, {2.1F, 0.9F, 1.1F}},
                         {{-3.0F, -1.0F, -0.1F}, {3.0F, 1.0F, 0.1F}}};
    for (const Box& box : boxes)
        for (const float aspect : {0.5F, 1.0F, 2.2F}) {
            const Camera camera = frameBox(box, {0.5F, 0.5F, 0.8F}, aspect, 0.8F);
            Box pixels; // in a view of 2 x 2, so that its half sides are 1
            for (unsigned i = 0; i < 8; ++i) {
                const glm::vec3 corner(i & 1U ? box.max.x : box.min.x, i & 2U ? box.max.y : box.min.y,
                                       i & 4U ? box.max.z : box.min.z);
                pixels.include(glm::vec3(pixelOf(camera, corner, {2.0F, 2.0F}) - 1.0F, 0.0F));
            }
            const glm::vec3 half = glm::max(glm::abs(pixels.min), glm::abs(pixels.max));
            EXPECT_NEAR(std::max(half.x, half.y), 0.8F, 1e-3F); // the binding side touches its margin
            EXPECT_LE(std::min(half.x, half.y), 0.8F + 1e-3F);
        }
}

TEST(Camera, RefusesToFrameNothing) {
    EXPECT_THROW((void)frameBox(Box(), {0.0F, 0.0F, 1.0F}, 1.0F, 0.8F), InvalidInput);
    const Box endless{glm::vec3(0.0F), glm::vec3(std::numeric_limits<float>::infinity())};
    EXPECT_THROW((void)frameBox(endless, {0.0F, 0.0F, 1.0F}, 1.0F, 0.8F), InvalidInput);
}

} // namespace
} // namespace lumorph

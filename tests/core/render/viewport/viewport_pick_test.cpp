#include <cmath>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/core/render/viewport/viewport_scenes.h"

namespace lumorph {
namespace {

TEST(ViewportPick, ASphereIsHitWhereTheEquationSaysSo) {
    ViewportScene scene;
    scene.surfaces = {surfaceOf(sphereMesh(0.05F, 5), glm::vec3(0.8F), 9)};
    const glm::vec3 centre(0.1F, 0.2F, -0.3F);
    scene.surfaces[0].worldFromSurface =
        glm::scale(glm::translate(glm::mat4(1.0F), centre), glm::vec3(2.0F)); // radius 0.1
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-1.0F, 1.0F);
    int hits = 0;
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 origin = centre + 2.0F * glm::normalize(glm::vec3(any(random), any(random), any(random)));
        const glm::vec3 aim = centre + 0.12F * glm::vec3(any(random), any(random), any(random));
        const Ray ray{origin, glm::normalize(aim - origin)};
        const float along = glm::dot(centre - origin, ray.direction);
        const float aside = glm::distance(origin + along * ray.direction, centre);
        if (std::abs(aside - 0.1F) < 5e-4F) continue;
        const auto hit = pick(scene, ray);
        ASSERT_EQ(hit.has_value(), aside < 0.1F) << i;
        if (!hit) continue;
        ++hits;
        EXPECT_EQ(hit->id, 9U);
        EXPECT_NEAR(glm::distance(hit->point, centre), 0.1F, 5e-4F);
        EXPECT_NEAR(hit->distance, glm::distance(hit->point, origin), 1e-5F);
        EXPECT_LT(hit->distance, along);
    }
    EXPECT_GT(hits, 50);
}

TEST(ViewportPick, TheNearestPickableThingWins) {
    ViewportScene scene;
    const TriangleMesh box = boxMesh(glm::vec3(-0.1F), glm::vec3(0.1F));
    for (std::uint32_t id : {3U, 0U, 5U}) {
        scene.surfaces.push_back(surfaceOf(box, glm::vec3(0.5F), id));
        scene.surfaces.back().worldFromSurface =
            glm::translate(glm::mat4(1.0F), glm::vec3(0, 0, id == 0 ? 0.8F : 0.1F * static_cast<float>(id)));
    }
    const Ray ray{{0.01F, 0.02F, 5.0F}, {0, 0, -1}};
    const auto hit = pick(scene, ray);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->id, 5U); // the nearer one with id 0 does not count
    EXPECT_NEAR(hit->point.z, 0.6F, 1e-5F);
    EXPECT_FALSE(hit->voxel);
    EXPECT_FALSE(pick(scene, {{0, 0, 5}, {0, 0, 1}}));
}

TEST(ViewportPick, AVoxelIsHitWhereAFineWalkAlongTheRayMeetsItFirst) {
    ViewportScene scene;
    ViewportVoxels cloud;
    cloud.id = 4;
    cloud.frame = {{-0.05F, 0.0F, -0.05F}, 0.01, {10, 8, 10}};
    cloud.side = 1.0F;
    std::vector<ViewportVoxel> voxels;
    std::vector<bool> filled(800, false);
    std::mt19937 random(11);
    for (int i = 0; i < 800; ++i)
        if (random() % 9 == 0) {
            filled[static_cast<std::size_t>(i)] = true;
            voxels.push_back({static_cast<std::uint16_t>(i % 10),
                              static_cast<std::uint16_t>(i / 10 % 8),
                              static_cast<std::uint16_t>(i / 80),
                              0,
                              {200, 100, 50, 255}});
        }
    cloud.voxels = std::make_shared<const std::vector<ViewportVoxel>>(voxels);
    scene.voxels = {cloud};
    std::uniform_real_distribution<float> any(-1.0F, 1.0F);
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 origin =
            glm::vec3(0, 0.04F, 0) + 0.5F * glm::normalize(glm::vec3(any(random), any(random), any(random)));
        const glm::vec3 aim = glm::vec3(0, 0.04F, 0) + 0.04F * glm::vec3(any(random), any(random), any(random));
        const Ray ray{origin, glm::normalize(aim - origin)};
        std::optional<glm::ivec3> first;
        for (float t = 0.0F; t < 1.0F && !first; t += 2e-6F * 10.0F) {
            const glm::ivec3 at(glm::floor((origin + t * ray.direction - cloud.frame.origin) / 0.01F));
            if (glm::any(glm::lessThan(at, glm::ivec3(0))) ||
                glm::any(glm::greaterThanEqual(at, cloud.frame.dimensions)))
                continue;
            if (filled[static_cast<std::size_t>(at.x + 10 * (at.y + 8 * at.z))]) first = at;
        }
        const auto hit = pick(scene, ray);
        ASSERT_EQ(hit.has_value(), first.has_value()) << i;
        if (!hit) continue;
        ++hits;
        EXPECT_EQ(hit->voxel, first) << i;
        EXPECT_EQ(hit->id, 4U);
    }
    EXPECT_GT(hits, 100);
}

} // namespace
} // namespace lumorph

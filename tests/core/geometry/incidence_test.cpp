#include "core/geometry/incidence.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/geometry/triangle_mesh.h"

namespace lumorph {
namespace {

// A roof: two square metres that lean away from the ridge along x, `lean` from level; closed below by nothing.
TriangleMesh roof(double lean) {
    const auto c = static_cast<float>(0.1 * std::cos(lean));
    const auto s = static_cast<float>(0.1 * std::sin(lean));
    return {{{-0.1F, 0.0F, 0.0F},
             {0.1F, 0.0F, 0.0F},
             {0.1F, -s, c},
             {-0.1F, -s, c},
             {0.1F, 0.0F, -0.1F},
             {-0.1F, 0.0F, -0.1F}},
            {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {0, 4, 5}}};
}

double shareOf(const TriangleMesh& mesh, const CalibratedCamera& projector, const glm::mat4& world = glm::mat4(1.0F)) {
    return shareBeyondIncidence(mesh.positions, mesh.triangles, world, projector, Angle::degrees(70.0));
}

const CalibratedCamera kAbove = cameraLookingAt({0.0, 20.0, 0.0}, {0.0, 0.0, 0.0}, {1280, 800}, 60'000.0);

TEST(Incidence, SteepSideCountsByItsArea) {
    EXPECT_NEAR(shareOf(roof(75.0 * M_PI / 180.0), kAbove), 0.5, 0.02);
    EXPECT_NEAR(shareOf(roof(65.0 * M_PI / 180.0), kAbove), 0.0, 1e-9);
}

TEST(Incidence, WhatIsTurnedAwayShadowedOrOutsideDoesNotCount) {
    EXPECT_EQ(shareOf(roof(100.0 * M_PI / 180.0), kAbove), 0.0) << "the leaning side looks down";
    TriangleMesh covered = roof(75.0 * M_PI / 180.0);
    append(covered, {{{-1.0F, 0.1F, 0.0005F}, {1.0F, 0.1F, 0.0005F}, {1.0F, 0.1F, 1.0F}, {-1.0F, 0.1F, 1.0F}},
                     {{0, 2, 1}, {0, 3, 2}}});
    EXPECT_LT(shareOf(covered, kAbove), 0.01) << "a roof over the steep side";
    CalibratedCamera aside = kAbove;
    aside.principal.x = 5000.0;
    EXPECT_EQ(shareOf(roof(75.0 * M_PI / 180.0), aside), 0.0) << "outside its image";
    const glm::mat4 behind = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 30.0F, 0.0F));
    EXPECT_EQ(shareOf(roof(75.0 * M_PI / 180.0), kAbove, behind), 0.0);
    EXPECT_EQ(shareOf({}, kAbove), 0.0);
}

} // namespace
} // namespace lumorph

#include "core/geometry/rigid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace lumorph::test {
namespace {

constexpr double kPi = std::numbers::pi;

double largest(const glm::dmat3& m) { return std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])}); }

/// Turns around any axis by angles that are hard to tell from 0 and from pi, and others.
std::vector<glm::dvec3> turns() {
    std::vector<glm::dvec3> all = {glm::dvec3(0.0)};
    std::mt19937 random(1);
    std::normal_distribution<double> any;
    for (const double angle :
         {1e-300, 1e-16, 1e-12, 1e-9, 1e-6, 0.99e-4, 1.01e-4, 0.01, 1.0, 2.5, kPi - 1e-3, kPi - 1e-7, kPi - 1e-10})
        for (int i = 0; i < 20; ++i) {
            glm::dvec3 axis(any(random), any(random), any(random));
            if (i < 3) axis = glm::dmat3(1.0)[i];
            if (i == 3) axis.x = 0.0;
            all.push_back(angle * glm::normalize(axis));
        }
    return all;
}

PoseVector vectorOf(const glm::dvec3& turn, double x = 0.0, double y = 0.0, double z = 0.0) {
    return {turn.x, turn.y, turn.z, x, y, z};
}

TEST(Rigid, ExpTurnsByAngleAroundAxis) {
    for (const glm::dvec3& turn : turns()) {
        const double angle = glm::length(turn);
        const glm::dvec3 axis = angle > 1e-100 ? turn / angle : glm::dvec3(1.0, 0.0, 0.0);
        const glm::dmat3 expected(glm::rotate(glm::dmat4(1.0), angle, axis));
        EXPECT_LT(largest(Rigid::exp(vectorOf(turn)).rotation - expected), 4e-15) << angle;
    }
}

TEST(Rigid, LogIsTheInverseOfExp) {
    for (const glm::dvec3& turn : turns()) {
        const PoseVector vector = vectorOf(turn, 0.1, -2e3, 5e-7);
        const PoseVector back = Rigid::exp(vector).log();
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(back[i], vector[i], 1e-14) << glm::length(turn);
            EXPECT_EQ(back[3 + i], vector[3 + i]);
        }
    }
    // Small turns keep their digits.
    EXPECT_NEAR(Rigid::exp({3e-20, 0, 0, 0, 0, 0}).log()[0], 3e-20, 1e-35);
    // By pi either direction of the axis is right.
    const PoseVector half = Rigid::exp({0.6 * kPi, 0.0, 0.8 * kPi, 0, 0, 0}).log();
    EXPECT_NEAR(std::hypot(half[0], half[1], half[2]), kPi, 1e-15 * 4.0);
    EXPECT_NEAR(std::abs(half[0]), 0.6 * kPi, 1e-14);
    EXPECT_NEAR(half[0] / half[2], 0.75, 1e-14);
    // Beyond pi it is the shorter way round.
    EXPECT_NEAR(Rigid::exp({0, 1.5 * kPi, 0, 0, 0, 0}).log()[1], -0.5 * kPi, 1e-14);
}

TEST(Rigid, ProductAndInverseAreThoseOfMatrices) {
    const std::vector<glm::dvec3> all = turns();
    for (std::size_t i = 1; i < all.size(); ++i) {
        const Rigid a = Rigid::exp(vectorOf(all[i], 1.0, -3.0, 0.5)),
                    b = Rigid::exp(vectorOf(all[i - 1], -2.0, 0.1, 4.0));
        const glm::dvec3 point(0.3, -7.0, 2.0);
        EXPECT_LT(glm::length(a * b * point - glm::dvec3(a.matrix() * b.matrix() * glm::dvec4(point, 1.0))),
                  1e-14 * 4.0);
        EXPECT_LT(glm::length(a.inverse() * (a * point) - point), 1e-14);
        EXPECT_EQ(Rigid(a.matrix()).log(), a.log());
    }
    // A quarter turn around z: x becomes y.
    const Rigid quarter = Rigid::exp({0.0, 0.0, 0.5 * kPi, 10.0, 0.0, 0.0});
    EXPECT_LT(glm::length(quarter * glm::dvec3(1.0, 2.0, 3.0) - glm::dvec3(8.0, 1.0, 3.0)), 1e-15 * 4.0);
    EXPECT_LT(glm::length(quarter.inverse() * glm::dvec3(8.0, 1.0, 3.0) - glm::dvec3(1.0, 2.0, 3.0)), 1e-15 * 4.0);
}

} // namespace
} // namespace lumorph::test

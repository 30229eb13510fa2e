#include "app/applications/water/ripples.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

// Rings on the water, against what the wave equation says of them: their speed, their water, their end.

namespace lumorph::sea::test {
namespace {

constexpr double kFrame = 1.0 / 60.0;

/// Seconds until the water first moves by a tenth of a millimetre.
double arrival(const glm::dvec2& from, const glm::dvec2& at) {
    Ripples ripples;
    ripples.touch(from, 1.0);
    for (int k = 1; k < 240; ++k) {
        ripples.advance(kFrame);
        if (std::abs(ripples.heightAt(at)) > 1e-4) return k * kFrame;
    }
    return 1e9;
}

double sum(const Ripples& ripples, bool square) {
    double sum = 0.0;
    for (double x = -0.10; x <= 0.1001; x += 0.005)
        for (double z = -0.07; z <= 0.0701; z += 0.005) {
            const double height = ripples.heightAt({x, z});
            sum += square ? height * height : height;
        }
    return sum;
}

TEST(Ripples, RunOutAsFastAsTheySay) {
    const glm::dvec2 from(-0.08, 0.0);
    const double near = arrival(from, {-0.01, 0.0}), far = arrival(from, {0.06, 0.0});
    EXPECT_NEAR(0.07 / (far - near), Ripples::kSpeed, 0.02);
    EXPECT_NEAR(arrival({0.0, 0.0}, {0.05, 0.0}), arrival({0.0, 0.0}, {0.03, 0.04}), 0.05) << "rings are round";
}

TEST(Ripples, MoveWaterAsideAndComeToRest) {
    Ripples ripples;
    EXPECT_EQ(sum(ripples, true), 0.0);
    ripples.touch({0.01, -0.01}, 1.0);
    for (int k = 0; k < 20; ++k) ripples.advance(kFrame);
    EXPECT_GT(sum(ripples, true), 1e-5);
    EXPECT_LT(std::abs(sum(ripples, false)), 0.1 * std::sqrt(sum(ripples, true) * 41.0 * 29.0))
        << "what goes down here comes up there";
    for (int k = 0; k < 12 * 60; ++k) ripples.advance(kFrame);
    EXPECT_LT(sum(ripples, true), 1e-8);
    ripples.touch({NAN, 0.0}, 1.0);
    ripples.advance(NAN);
    EXPECT_LT(sum(ripples, true), 1e-8);
}

TEST(Ripples, PushAwayWhatTheyPass) {
    Ripples ripples;
    ripples.touch({0.0, 0.0}, 1.0);
    const glm::dvec2 place(0.03, 0.02);
    double along = 0.0;
    for (int k = 0; k < 60; ++k) {
        ripples.advance(kFrame);
        const glm::dvec2 push = ripples.pushAt(place);
        EXPECT_NEAR(push.x * place.y - push.y * place.x, 0.0, 1e-12);
        along += kFrame * glm::dot(push, glm::normalize(place));
    }
    EXPECT_GT(along, 0.02) << "metres a second";
}

} // namespace
} // namespace lumorph::sea::test

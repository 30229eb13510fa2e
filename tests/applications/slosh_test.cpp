#include "app/applications/slosh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace lumorph {
namespace {

constexpr double kFrame = 1.0 / 60.0;
constexpr double kShare = 0.5;

TEST(Slosh, RunsToTheLowSideAndSettlesLevelInTheRoom) {
    for (const glm::dvec2& lean : {glm::dvec2(0.2, 0.0), {0.0, -0.12}, {-0.1, 0.15}}) {
        Slosh water(kShare);
        for (int k = 0; k < 60 * 8; ++k) water.advance(kFrame, lean);
        EXPECT_NEAR(water.slope().x, kShare * std::tan(lean.x), 1e-4);
        EXPECT_NEAR(water.slope().y, kShare * std::tan(lean.y), 1e-4);
        EXPECT_NEAR(water.heightAt({0.1, 0.05}), 0.1 * water.slope().x + 0.05 * water.slope().y, 1e-12);
        EXPECT_FALSE(water.rests());
        for (int k = 0; k < 60 * 20; ++k) water.advance(kFrame, {});
        EXPECT_TRUE(water.rests());
        EXPECT_EQ(water.slope(), glm::dvec2(0.0));
    }
}

// The answer of a damped oscillator to a step, as textbooks have it.
TEST(Slosh, SwingsAsADampedOscillatorDoes) {
    const double omega = 2.0 * std::numbers::pi * Slosh::kSwings, damping = Slosh::kDamping;
    const double damped = omega * std::sqrt(1.0 - damping * damping);
    for (const double frame : {1.0 / 120.0, 1.0 / 60.0, 1.0 / 24.0}) {
        Slosh water(kShare);
        const double level = kShare * std::tan(0.1);
        double worst = 0.0;
        for (int k = 1; k * frame < 4.0; ++k) {
            water.advance(frame, {0.1, 0.0});
            const double t = k * frame, fade = std::exp(-damping * omega * t);
            const double truth =
                level * (1.0 - fade * (std::cos(damped * t) + damping * omega / damped * std::sin(damped * t)));
            worst = std::max(worst, std::abs(water.slope().x - truth));
        }
        EXPECT_LT(worst, 0.06 * level) << frame;
    }
}

TEST(Slosh, StaysWithinItsBoundsWhateverComes) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                     kEndless = std::numeric_limits<double>::infinity();
    Slosh water(kShare);
    for (const glm::dvec2& lean : {glm::dvec2(9.0, -9.0), {kNone, 0.1}, {kEndless, 0.0}, {-9.0, 9.0}, {0.1, kNone}})
        for (const double seconds : {kFrame, 1e9, -1.0, kNone, kEndless}) {
            water.advance(seconds, lean);
            ASSERT_LE(std::abs(water.slope().x), kShare * Slosh::kMostSlope);
            ASSERT_LE(std::abs(water.slope().y), kShare * Slosh::kMostSlope);
        }
}

} // namespace
} // namespace lumorph

#include "core/rig/pulse_curve.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace lumorph {
namespace {

/// A lever that turns by a quarter to lift along a sine: share = asin(stroke) by a right angle.
PulseCurve arcsine(int steps) {
    PulseCurve curve;
    for (int k = 0; k <= steps; ++k)
        curve.push_back(std::asin(static_cast<double>(k) / steps) / (0.5 * std::numbers::pi));
    return curve;
}

TEST(PulseCurve, EmptyGoesEvenly) {
    for (const double stroke : {-0.5, 0.0, 0.3, 1.0, 1.7}) {
        EXPECT_EQ(turnedAt({}, stroke), stroke);
        EXPECT_EQ(strokeWhereTurned({}, stroke), stroke);
    }
    EXPECT_EQ(steepest({}), 1.0);
    EXPECT_TRUE(upTo({}, 0.4).empty());
}

TEST(PulseCurve, IsTheFunctionThatItWasMadeFrom) {
    const PulseCurve curve = arcsine(64);
    ASSERT_TRUE(isPulseCurve(curve));
    for (double stroke = 0.0; stroke < 0.9; stroke += 0.013)
        EXPECT_NEAR(turnedAt(curve, stroke), std::asin(stroke) / (0.5 * std::numbers::pi), 5e-4) << stroke;
    EXPECT_NEAR(steepest(curve), 64.0 * (1.0 - curve[63]), 1e-12);
}

TEST(PulseCurve, ItsInverseLeadsBackAlsoBeyondTheEnds) {
    const PulseCurve curve = arcsine(16);
    std::mt19937 random(41);
    std::uniform_real_distribution<double> strokes(-0.4, 1.4);
    for (int k = 0; k < 500; ++k) {
        const double stroke = strokes(random);
        EXPECT_NEAR(strokeWhereTurned(curve, turnedAt(curve, stroke)), stroke, 1e-12);
    }
    EXPECT_NEAR(turnedAt(curve, -0.5), 0.5 * -16.0 * curve[1], 1e-12) << "straight on";
    EXPECT_EQ(turnedAt(curve, 0.0), 0.0);
    EXPECT_EQ(turnedAt(curve, 1.0), 1.0);
}

TEST(PulseCurve, CutShorterItIsItsBeginning) {
    const PulseCurve curve = arcsine(60), part = upTo(curve, 0.5);
    ASSERT_TRUE(isPulseCurve(part));
    for (double stroke = 0.0; stroke <= 1.0; stroke += 0.05)
        EXPECT_NEAR(turnedAt(part, stroke) * turnedAt(curve, 0.5), turnedAt(curve, 0.5 * stroke), 2e-4) << stroke;
}

TEST(PulseCurve, RisesFromZeroToOneOrIsNone) {
    EXPECT_TRUE(isPulseCurve(PulseCurve{}));
    EXPECT_TRUE(isPulseCurve(PulseCurve{0.0, 1.0}));
    for (const PulseCurve& wrong :
         {PulseCurve{0.0}, PulseCurve{1.0}, PulseCurve{0.0, 0.5}, PulseCurve{0.1, 1.0}, PulseCurve{0.0, 0.5, 0.5, 1.0},
          PulseCurve{0.0, 0.7, 0.6, 1.0}, PulseCurve{0.0, std::nan(""), 1.0}})
        EXPECT_FALSE(isPulseCurve(wrong));
    PulseCurve long_;
    for (std::size_t k = 0; k <= kMostCurvePoints; ++k) long_.push_back(static_cast<double>(k) / kMostCurvePoints);
    EXPECT_FALSE(isPulseCurve(long_));
}

} // namespace
} // namespace lumorph

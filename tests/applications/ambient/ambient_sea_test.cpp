#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "app/applications/ambient/anticipation.h"
#include "app/applications/ambient/sea.h"
#include "core/base/error.h"

// Waves of the ambient display by wind, and what servos are given of them.

namespace lumorph::ambient {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

SeaState blowing(double wind, double degrees = 0.0) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return {wind, {std::cos(angle), std::sin(angle)}};
}

// The significant height is four standard deviations: of many heights far apart in place and time.
TEST(AmbientSea, IsAsHighAsItsWindMakesIt) {
    const Sea sea(1);
    for (const double wind : {1.0, 5.0, 10.0, 20.0, 40.0}) {
        double square = 0.0;
        int count = 0;
        for (int k = 0; k < 4000; ++k) {
            const auto waves = sea.waves(blowing(wind), 13.7 * k);
            const double height = heightOf(waves, {0.37 * (k % 83), 0.41 * (k % 61)});
            square += height * height;
            ++count;
        }
        const double significant = 4.0 * std::sqrt(square / count);
        EXPECT_NEAR(significant, Sea::significantHeight(wind), 0.1 * Sea::significantHeight(wind)) << wind;
        EXPECT_LE(significant, 1.1 * Sea::kMostHeight);
    }
}

/// Energy-weighted mean of the lengths.
double meanLength(const std::vector<Wave>& waves) {
    double sum = 0.0, energy = 0.0;
    for (const Wave& wave : waves) {
        sum += wave.amplitude * wave.amplitude * wave.length;
        energy += wave.amplitude * wave.amplitude;
    }
    return sum / energy;
}

TEST(AmbientSea, MoreWindMakesWavesLongerSlowerAndHigher) {
    const Sea sea(1);
    double before = 0.0, heightBefore = 0.0;
    for (const double wind : {1.0, 4.0, 8.0, 12.0, 16.0}) {
        const double length = meanLength(sea.waves(blowing(wind), 0.0));
        EXPECT_GT(length, before) << wind;
        EXPECT_GT(Sea::significantHeight(wind), heightBefore) << wind;
        // JONSWAP's mean lies a little below its peak.
        EXPECT_NEAR(length, Sea::peakLength(wind), 0.45 * Sea::peakLength(wind)) << wind;
        before = length;
        heightBefore = Sea::significantHeight(wind);
    }
    EXPECT_GT(Sea::periodOf(0.3), Sea::periodOf(0.1));
    EXPECT_NEAR(Sea::periodOf(0.4) / Sea::periodOf(0.1), 2.0, 1e-9) << "as in deep water, by the root of the length";
}

TEST(AmbientSea, WavesTravelWithTheWind) {
    const Sea sea(3);
    for (const double degrees : {0.0, 90.0, -135.0}) {
        const SeaState state = blowing(10.0, degrees);
        glm::dvec2 mean(0.0);
        for (const Wave& wave : sea.waves(state, 0.0)) {
            const glm::dvec2 way(std::cos(wave.direction.inRadians()), std::sin(wave.direction.inRadians()));
            mean += wave.amplitude * wave.amplitude * way;
        }
        EXPECT_GT((mean.x * state.towards.x + mean.y * state.towards.y) / std::hypot(mean.x, mean.y), 0.93) << degrees;
    }
    // And a crest is further along a moment later.
    const auto now = sea.waves(blowing(10.0), 5.0), then = sea.waves(blowing(10.0), 5.1);
    for (std::size_t k = 0; k < now.size(); ++k)
        EXPECT_NEAR(std::remainder(then[k].phase.inRadians() - now[k].phase.inRadians() +
                                       kTurn * 0.1 / Sea::periodOf(now[k].length),
                                   kTurn),
                    0.0, 1e-9);
}

// Twice through a first-order low-pass of half the lag, stepped finely, comes what light shows.
TEST(AmbientSea, WhatServosAreGivenComesOutOfTheirLowPassesAsLightShowsIt) {
    const Sea sea(2);
    const SeaState state = blowing(12.0, 30.0);
    constexpr double kLag = 0.375, kStep = 0.001;
    const glm::dvec2 place(0.06, -0.03);
    double once = 0.0, twice = 0.0, worst = 0.0, highest = 0.0;
    for (int k = 0; k < 12'000; ++k) {
        const double t = kStep * k;
        const double keeps = std::exp(-kStep / (0.5 * kLag));
        once = keeps * once + (1.0 - keeps) * heightOf(sea.slowWaves(state, t, kLag), place);
        twice = keeps * twice + (1.0 - keeps) * once;
        if (t < 4.0 || k % 10 != 0) continue;
        double shown = 0.0;
        for (const Wave& wave : sea.waves(state, t))
            if (wave.length >= Sea::kServoLength) shown += heightOf({wave}, place);
        worst = std::max(worst, std::abs(twice - shown));
        highest = std::max(highest, std::abs(shown));
    }
    EXPECT_GT(highest, 0.003);
    EXPECT_LT(worst, 0.02 * highest);
}

TEST(AmbientSea, ServosGetTheLongWavesAlone) {
    const Sea sea(2);
    const auto slow = sea.slowWaves(blowing(8.0), 1.0, 0.0);
    ASSERT_FALSE(slow.empty());
    EXPECT_LT(slow.size(), static_cast<std::size_t>(Sea::kWaves));
    for (const Wave& wave : slow) EXPECT_GE(wave.length, Sea::kServoLength);
}

TEST(AmbientAnticipation, GivesWhatWasShownASetTimeBefore) {
    Anticipation anticipation(1.5);
    for (int k = 0; k <= 600; ++k) {
        const double t = k / 60.0;
        anticipation.note(t, blowing(3.0 * t, 10.0 * t));
        const SeaState followed = anticipation.followed();
        const double then = std::max(0.0, t - 1.5);
        ASSERT_NEAR(followed.wind, 3.0 * then, 1e-9) << t;
        ASSERT_NEAR(std::atan2(followed.towards.y, followed.towards.x), 10.0 * then * std::numbers::pi / 180.0, 1e-9);
    }
    Anticipation none(0.0);
    none.note(0.0, blowing(1.0));
    none.note(0.1, blowing(2.0));
    EXPECT_EQ(none.followed().wind, 2.0);
    EXPECT_THROW(Anticipation(-1.0), InvalidInput);
    EXPECT_THROW(Anticipation(std::nan("")), InvalidInput);
}

} // namespace
} // namespace lumorph::ambient

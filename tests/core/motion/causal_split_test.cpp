#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/motion/causal_split.h"
#include "core/motion/frequency_split.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kCausalStep = 1.0 / 60.0;

const Rig& causalTablet() {
    static const Rig rig = test::cutTablet();
    return rig;
}

/// A wish over the split's points: heights over rest by place and time, metres.
using Lift = std::function<double(const glm::vec2& at, double t)>;

std::vector<float> heightsOf(const CausalSplit& split, const Lift& lift, double t) {
    std::vector<float> heights;
    for (std::size_t p = 0; p < split.points().size(); ++p)
        heights.push_back(static_cast<float>(static_cast<double>(split.restHeights()[p]) + lift(split.points()[p], t)));
    return heights;
}

/// Two low-passes in a row for one point, literally: many small steps of x' = (input - x) / time constant.
class LiteralFilter {
public:
    LiteralFilter(double lag, double wish) : tau_(0.5 * lag), wish_(wish), once_(wish), twice_(wish) {}
    double step(double wish, double seconds) {
        constexpr int kSteps = 4000;
        for (int k = 0; k < kSteps; ++k) {
            const double input = wish_ + (wish - wish_) * (k + 0.5) / kSteps;
            const double before = once_;
            once_ += seconds / kSteps * (input - once_) / tau_;
            twice_ += seconds / kSteps * (0.5 * (before + once_) - twice_) / tau_;
        }
        wish_ = wish;
        return twice_;
    }

private:
    double tau_, wish_, once_, twice_;
};

TEST(CausalSplit, SmoothsAsALiteralFilterDoes) {
    CausalSplit split(causalTablet(), 0.03);
    const Lift lift = [](const glm::vec2& at, double t) {
        return 0.02 * std::sin(3.0 * t + 20.0 * static_cast<double>(at.x)) + (t > 1.0 ? 0.03 : 0.0);
    };
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<LiteralFilter> filters;
    double t = 0.0;
    double step = 0.0;
    for (int k = 0; k < 60; ++k, t += step = 0.09 * uniform(random)) {
        const std::vector<float> heights = heightsOf(split, lift, t);
        (void)split.strokes(heights, step);
        for (std::size_t p = 0; p < heights.size(); p += 7) {
            const double wish = static_cast<double>(heights[p]) - static_cast<double>(split.restHeights()[p]);
            if (k == 0) filters.emplace_back(split.lagSeconds(), wish);
            const double expected = k == 0 ? wish : filters[p / 7].step(wish, step);
            ASSERT_NEAR(split.smoothed()[p], expected, 2e-6) << "step " << k;
        }
    }
}

TEST(CausalSplit, LongAndShortStepsOfOneWayAgree) {
    CausalSplit fine(causalTablet(), 0.03);
    CausalSplit coarse(causalTablet(), 0.03);
    const Lift rising = [](const glm::vec2&, double t) { return 0.04 * t; };
    (void)fine.strokes(heightsOf(fine, rising, 0.0), 0.0);
    (void)coarse.strokes(heightsOf(coarse, rising, 0.0), 0.0);
    for (int k = 1; k <= 1000; ++k) (void)fine.strokes(heightsOf(fine, rising, 0.001 * k), 0.001);
    (void)coarse.strokes(heightsOf(coarse, rising, 1.0), 1.0);
    for (std::size_t p = 0; p < fine.smoothed().size(); ++p)
        EXPECT_NEAR(fine.smoothed()[p], coarse.smoothed()[p], 1e-7);
}

TEST(CausalSplit, WhatComesLaterChangesNothingBefore) {
    CausalSplit one(causalTablet(), 0.02);
    CausalSplit other(causalTablet(), 0.02);
    const auto wishAt = [&](int k, bool different) {
        return heightsOf(
            one,
            [&](const glm::vec2& at, double t) {
                return different && k >= 60 ? 0.08 : 0.02 * std::sin(2.0 * t + 15.0 * static_cast<double>(at.x));
            },
            k * kCausalStep);
    };
    bool differs = false;
    for (int k = 0; k < 90; ++k) {
        const auto first = one.strokes(wishAt(k, false), kCausalStep);
        const auto second = other.strokes(wishAt(k, true), kCausalStep);
        if (k < 60) {
            ASSERT_EQ(first, second) << "bit for bit, step " << k;
        }
        differs |= first != second;
    }
    EXPECT_TRUE(differs);
}

// The lag is what the header says, by the smoothed wish and by the strokes that carry it.
TEST(CausalSplit, LagsByWhatItSays) {
    CausalSplit split(causalTablet(), 0.02);
    FrequencySplit still(causalTablet(), 0.02);
    EXPECT_NEAR(split.lagSeconds(), 0.5 * 90.0 / 120.0, 1e-6) << "an SG90 under load takes 0.75 s for its stroke";
    EXPECT_LE(split.lagSeconds(), CausalSplit::kMostLag);

    const Lift ramp = [](const glm::vec2&, double t) { return 0.004 * t; };
    for (int k = 0; k <= 600; ++k) (void)split.strokes(heightsOf(split, ramp, k * kCausalStep), kCausalStep);
    for (const double lift : split.smoothed()) EXPECT_NEAR(10.0 - lift / 0.004, split.lagSeconds(), 1e-3);

    // A slow sine within the device's reach: the strokes are those of the wish so many seconds ago.
    split.restart();
    const double period = 12.0;
    const Lift sine = [&](const glm::vec2& at, double t) {
        return 0.01 + 0.005 * std::sin(2.0 * std::numbers::pi * t / period) + 0.02 * static_cast<double>(at.x);
    };
    std::vector<std::vector<double>> now;
    std::vector<std::vector<double>> best; // for the wish as it is
    for (int k = 0; k < static_cast<int>(2 * period * 60); ++k) {
        const std::vector<float> heights = heightsOf(split, sine, k * kCausalStep);
        const std::vector<double> strokes = split.strokes(heights, kCausalStep);
        if (k < static_cast<int>(period * 60)) continue;
        now.push_back(strokes);
        best.push_back(still.fit(heights));
    }
    for (std::size_t i = 0; i < causalTablet().actuatorCount(); ++i) {
        const auto phaseOf = [&](const std::vector<std::vector<double>>& strokes) {
            double real = 0.0;
            double imaginary = 0.0;
            for (std::size_t k = 0; k < strokes.size(); ++k) {
                const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) * kCausalStep / period;
                real += strokes[k][i] * std::sin(angle);
                imaginary += strokes[k][i] * std::cos(angle);
            }
            return std::atan2(imaginary, real);
        };
        const double lag = (phaseOf(best) - phaseOf(now)) / (2.0 * std::numbers::pi) * period;
        EXPECT_NEAR(lag, split.lagSeconds(), 0.02) << "actuator " << i;
    }
}

TEST(CausalSplit, LagIsBoundedForSlowActuators) {
    for (const double velocity : {0.01, 0.4, 0.5, 1.0, 50.0}) {
        const Rig rig = test::cushionRig();
        RigParts slow;
        slow.name = rig.name();
        slow.restMesh = rig.restMesh();
        slow.actuators.assign(rig.actuators().begin(), rig.actuators().end());
        slow.actuators[1].maxVelocity = velocity;
        double slowest = velocity;
        for (const Actuator& actuator : slow.actuators) slowest = std::min(slowest, actuator.maxVelocity);
        EXPECT_DOUBLE_EQ(CausalSplit(Rig(std::move(slow)), 0.02).lagSeconds(), std::min(0.5 / slowest, 1.0));
    }
}

// R19
TEST(CausalSplit, NeverMovesFasterThanTheLimits) {
    CausalSplit split(causalTablet(), 0.03);
    std::mt19937 random(17);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    float wild = 0.0F;
    double most = 0.0;
    std::vector<double> last;
    for (int k = 0; k < 20'000; ++k) {
        if (random() % 40 == 0) wild = static_cast<float>(uniform(random) - 0.3);
        std::vector<float> heights(split.restHeights().begin(), split.restHeights().end());
        for (std::size_t p = 0; p < heights.size(); ++p)
            heights[p] = p % 5 == 1   ? std::numeric_limits<float>::quiet_NaN()
                         : p % 5 == 2 ? std::copysign(HUGE_VALF, wild)
                                      : heights[p] + wild;
        const double step = random() % 10 == 0 ? 0.0 : 0.1 * uniform(random) * uniform(random);
        const std::vector<double> now = split.strokes(heights, step);
        for (std::size_t i = 0; i < now.size() && !last.empty(); ++i) {
            ASSERT_TRUE(now[i] >= 0.0 && now[i] <= 1.0);
            const double limit = causalTablet().actuators()[i].maxVelocity * step;
            ASSERT_LE(std::abs(now[i] - last[i]), limit + 1e-12) << k;
            most = std::max(most, std::abs(now[i] - last[i]) / std::max(limit, 1e-9));
        }
        last = now;
    }
    EXPECT_GT(most, 0.999) << "the limit was met";
}

// R33: what servos carry is the smooth part, late by the lag; all the rest is left to light, which adds it to what
// stands.
TEST(CausalSplit, ServosCarryTheSmoothPartAndLightTheRest) {
    CausalSplit split(causalTablet(), 0.012);
    FrequencySplit surface(causalTablet(), 0.012);
    const Lift slow = [](const glm::vec2& at, double t) {
        return 0.015 + 0.012 * std::sin(2.0 * std::numbers::pi * (static_cast<double>(at.x) / 0.4 - t / 8.0));
    };
    const Lift fast = [](const glm::vec2& at, double t) {
        return 0.012 * std::sin(2.0 * std::numbers::pi * (static_cast<double>(at.x) / 0.4 - t / 0.35));
    };
    const auto run = [&](const Lift& wish, const std::function<void(double, const std::vector<float>&)>& judge) {
        split.restart();
        std::vector<float> reached(split.points().size());
        for (int k = 0; k < 20 * 60; ++k) {
            const std::vector<double> strokes = split.strokes(heightsOf(split, wish, k * kCausalStep), kCausalStep);
            if (k < 240 || k % 6 != 0) continue;
            surface.heights(strokes, reached);
            judge(k * kCausalStep, reached);
        }
    };
    std::vector<std::vector<float>> alone;
    run(slow, [&](double, const std::vector<float>& reached) { alone.push_back(reached); });

    double disturbed = 0.0; // by the fast wave, of what servos do
    double whole = 0.0;     // the fast wave itself
    double missed = 0.0;    // of the best for the slow wave, late by the lag
    double carried = 0.0;
    std::size_t moment = 0;
    const auto square = [](double x) { return x * x; };
    std::vector<float> best(split.points().size());
    run([&](const glm::vec2& at, double t) { return slow(at, t) + fast(at, t); },
        [&](double t, const std::vector<float>& reached) {
            surface.heights(surface.fit(heightsOf(split, slow, t - split.lagSeconds())), best);
            for (std::size_t p = 0; p < reached.size(); ++p) {
                const auto rest = static_cast<double>(split.restHeights()[p]);
                disturbed += square(static_cast<double>(reached[p]) - static_cast<double>(alone[moment][p]));
                whole += square(fast(split.points()[p], t));
                missed += square(static_cast<double>(reached[p]) - static_cast<double>(best[p]));
                carried += square(static_cast<double>(best[p]) - rest);
            }
            ++moment;
        });
    EXPECT_LE(disturbed, 0.05 * whole) << "the fast wave is light's";
    EXPECT_LE(missed, 0.03 * carried) << "the slow wave is the servos'";
}

TEST(CausalSplit, RefusesWhatIsNoWish) {
    CausalSplit split(causalTablet(), 0.02);
    const std::vector<float> rest(split.restHeights().begin(), split.restHeights().end());
    EXPECT_THROW((void)split.strokes(std::span(rest).first(3), 0.1), InvalidInput);
    for (const double wrong : {-0.1, kNan, HUGE_VAL}) EXPECT_THROW((void)split.strokes(rest, wrong), InvalidInput);
    EXPECT_TRUE(split.smoothed().empty());
    const std::vector<float> nothing(rest.size(), std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(split.strokes(nothing, 0.0), std::vector<double>(6, 0.0));
    std::vector<float> high = rest;
    for (float& height : high) height += 0.04F;
    const std::vector<double> soon = split.strokes(high, kCausalStep);
    split.restart();
    EXPECT_LT(soon[0], 0.05);
    EXPECT_GT(split.strokes(high, kCausalStep)[0], 0.2) << "begun anew";
}

/// Its low-passes are through long before a servo this slow has come where they lead it: until then it is not at rest.
TEST(CausalSplit, IsNotAtRestWhileSlowServosAreOnTheirWay) {
    RigParts parts = test::cushionRig().parts();
    for (Actuator& actuator : parts.actuators) actuator.maxVelocity = 0.01;
    const Rig rig(std::move(parts));
    CausalSplit split(rig);
    std::vector<float> heights(split.restHeights().begin(), split.restHeights().end());
    (void)split.strokes(heights, 0.0);
    for (float& height : heights) height += 0.015F;
    std::vector<double> atRest;
    std::vector<double> now;
    for (int k = 0; k < 6000; ++k) {
        now = split.strokes(heights, 0.05);
        if (atRest.empty() && split.atRest()) atRest = now;
    }
    ASSERT_FALSE(atRest.empty());
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NEAR(atRest[i], now[i], 0.01) << "it went on after that";
    EXPECT_GT(*std::ranges::max_element(now), 0.1);
}

} // namespace
} // namespace lumorph

#include "calibration/registration/clock_offset.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <stop_token>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace lumorph {
namespace {

/// A body that turns about one axis, now fast, now slowly: its angle is known at any time.
class Turning {
public:
    explicit Turning(unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> period(1.3, 11.0), phase(0.0, 6.28), size(0.2, 0.5);
        for (Wave& wave : waves_) wave = {6.283 / period(random), phase(random), size(random)};
    }
    [[nodiscard]] double angle(double t) const {
        double sum = 0.0;
        for (const Wave& wave : waves_) sum += wave.size * std::sin(wave.rate * t + wave.phase);
        return sum;
    }
    /// `rate` poses a second from `first` to `last` by the true clock; the track's own clock is `ahead` of it at time
    /// 0, and gains `drift` a second.
    [[nodiscard]] PoseTrack track(double first, double last, double rate, double ahead, double drift = 0.0) const {
        PoseTrack made;
        const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 2.0, -0.5));
        for (double t = first; t < last; t += 1.0 / rate)
            made.poses.push_back({t + ahead + drift * t, {{}, glm::angleAxis(angle(t), axis)}});
        return made;
    }

private:
    struct Wave {
        double rate = 0.0, phase = 0.0, size = 0.0;
    };
    std::array<Wave, 6> waves_{};
};

/// Pearson's correlation of the true speeds at one shift, with a loop.
double literalCorrelation(const std::vector<double>& a, const std::vector<double>& b, std::ptrdiff_t shift) {
    std::vector<double> x, y;
    for (std::ptrdiff_t i = 0; i < std::ssize(a); ++i)
        if (i + shift >= 0 && i + shift < std::ssize(b)) {
            x.push_back(a[static_cast<std::size_t>(i)]);
            y.push_back(b[static_cast<std::size_t>(i + shift)]);
        }
    const auto n = static_cast<double>(x.size());
    double meanX = 0.0, meanY = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) meanX += x[i] / n, meanY += y[i] / n;
    double xx = 0.0, yy = 0.0, xy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - meanX) * (x[i] - meanX);
        yy += (y[i] - meanY) * (y[i] - meanY);
        xy += (x[i] - meanX) * (y[i] - meanY);
    }
    return xy / std::sqrt(xx * yy);
}

TEST(ClockOffset, TwentyMinutesAtDifferentRatesAreFoundWithinFiveMilliseconds) {
    for (const unsigned seed : {71U, 72U}) {
        const Turning body(seed);
        const ClockOffset found =
            clockOffset(body.track(0.0, 1200.0, 100.0, 0.0), body.track(37.0, 1190.0, 60.0, 86400.25));
        EXPECT_NEAR(found.seconds, 86400.25, 0.005) << seed;
        EXPECT_GT(found.correlation, 0.99) << seed;
        EXPECT_LT(found.runnerUp, 0.9) << seed;
    }
}

// Two clocks that differ by 50 ppm are 60 ms apart after twenty minutes.
TEST(ClockOffset, ADriftIsFoundWithTheOffset) {
    for (const unsigned seed : {171U, 172U, 173U})
        for (const double drift : {50e-6, seed % 2 == 0 ? -50e-6 : 200e-6}) {
            const Turning body(seed);
            const auto since = std::chrono::steady_clock::now();
            const ClockOffset found =
                clockOffset(body.track(0.0, 1200.0, 100.0, 0.0), body.track(37.0, 1190.0, 60.0, 86400.25, drift));
            const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
            double worst = 0.0;
            for (double t = 37.0; t < 1190.0; t += 10.0)
                worst = std::max(worst, std::abs(found.toA(t + 86400.25 + drift * t) - t));
            std::printf("drift %.0f ppm: found %.2f, clocks within %.2f ms, %.2f s\n", 1e6 * drift, 1e6 * found.drift,
                        1e3 * worst, took);
            EXPECT_LT(worst, 0.004) << seed;
            EXPECT_NEAR(found.drift, drift, 4e-6) << seed;
            EXPECT_GT(found.correlation, 0.99) << seed;
            EXPECT_LT(found.runnerUp, 0.9) << seed;
        }
}

TEST(ClockOffset, AClockThatJumpsHasNoDrift) {
    const Turning body(181);
    PoseTrack jumped = body.track(0.0, 600.0, 60.0, 0.0);
    for (std::size_t i = jumped.poses.size() / 2; i < jumped.poses.size(); ++i) jumped.poses[i].seconds += 0.1;
    EXPECT_EQ(clockOffset(body.track(0.0, 600.0, 100.0, 0.0), jumped).drift, 0.0);
}

TEST(ClockOffset, ReportsItsProgressAndCanBeCancelled) {
    const Turning body(191);
    const PoseTrack a = body.track(0.0, 1200.0, 100.0, 0.0), b = body.track(0.0, 1200.0, 60.0, 1.0, 50e-6);
    std::vector<double> reported;
    std::stop_source stop;
    (void)clockOffset(a, b, Progress([&](double fraction, std::string_view) { reported.push_back(fraction); }));
    EXPECT_TRUE(std::ranges::is_sorted(reported));
    EXPECT_GT(reported.size(), 20U);
    EXPECT_GT(reported.back(), 0.9);
    const std::size_t whole = reported.size();
    reported.clear();
    const Progress half(
        [&](double fraction, std::string_view) {
            reported.push_back(fraction);
            if (fraction > 0.3) stop.request_stop();
        },
        stop.get_token());
    EXPECT_THROW((void)clockOffset(a, b, half), Cancelled);
    EXPECT_LT(reported.size(), whole / 2);
}

TEST(ClockOffset, CorrelatesAsALoopOverTheTrueSpeedsDoes) {
    const Turning body(81), other(82);
    constexpr double kWindow = 0.16;
    const auto speeds = [&](const Turning& of, double first, double last) {
        std::vector<double> all;
        for (double t = first; t + kWindow < last; t += kSpeedStep)
            all.push_back(std::abs(of.angle(t + 0.5 * kWindow) - of.angle(t - 0.5 * kWindow)) / kWindow);
        return all;
    };
    // Unlike motions, so that the correlation is far from 1, where a wrong sum would not show.
    const std::vector<double> a = speeds(body, 0.0, 30.0), b = speeds(other, 0.0, 24.0);
    const ClockOffset found = clockOffset(body.track(0.0, 30.0, 200.0, 0.0), other.track(0.0, 24.0, 200.0, 0.0));
    const auto shift = static_cast<std::ptrdiff_t>(std::lround(found.seconds / kSpeedStep));
    EXPECT_NEAR(found.correlation, literalCorrelation(a, b, shift), 0.02);
    EXPECT_LT(found.correlation, 0.9);
}

TEST(ClockOffset, WhatDoesNotTurnHasNone) {
    PoseTrack still;
    for (int i = 0; i < 500; ++i) still.poses.push_back({0.02 * i, {}});
    EXPECT_LT(clockOffset(still, Turning(3).track(0.0, 10.0, 50.0, 0.0)).correlation, 0.3);
    EXPECT_EQ(clockOffset(still, still).correlation, 0.0);
}

} // namespace
} // namespace lumorph

#include "calibration/registration/clock_offset.h"

#include <array>
#include <cmath>
#include <random>
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
    /// `rate` poses a second from `first` to `last` by the true clock; the track's own clock is `ahead` of it.
    [[nodiscard]] PoseTrack track(double first, double last, double rate, double ahead) const {
        PoseTrack made;
        const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, 2.0, -0.5));
        for (double t = first; t < last; t += 1.0 / rate)
            made.poses.push_back({t + ahead, {{}, glm::angleAxis(angle(t), axis)}});
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

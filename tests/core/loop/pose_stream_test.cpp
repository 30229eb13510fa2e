#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/loop/pose_stream.h"
#include "tests/support/not_a_number.h"

namespace lumorph {
namespace {

constexpr double kRate = 120.0;
constexpr double kDelay = 0.06;

Microseconds at(double seconds) { return Microseconds(std::llround(1e6 * seconds)); }

PoseSample sampleAt(double seconds, const glm::dvec3& position, const glm::dquat& rotation = {1.0, 0.0, 0.0, 0.0}) {
    return {at(seconds), true, {position, rotation}};
}

glm::dquat aboutUp(double angle) { return glm::angleAxis(angle, glm::normalize(glm::dvec3(0.2, 1.0, 0.1))); }

double angleBetween(const glm::dquat& a, const glm::dquat& b) {
    return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

struct Errors {
    std::vector<double> values;
    void add(double value) { values.push_back(value); }
    [[nodiscard]] double mean() const {
        double sum = 0.0;
        for (const double value : values) sum += value;
        return sum / static_cast<double>(values.size());
    }
    [[nodiscard]] double most(double share = 0.95) const {
        std::vector<double> sorted = values;
        std::ranges::sort(sorted);
        return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
    }
};

using Path = std::function<glm::dvec3(double)>;

double topSpeed(const Path& path) {
    double most = 0.0;
    for (double t = 0.0; t < 30.0; t += 0.001) most = std::max(most, glm::distance(path(t + 1e-4), path(t)) / 1e-4);
    return most;
}

/// A hand that moves freely: sines up to 2 Hz in all directions.
glm::dvec3 freely(double t) {
    const double hertz[] = {0.25, 0.6, 1.1, 1.6, 2.0};
    glm::dvec3 p(0.0);
    for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < 5; ++k)
            p[axis] += std::sin(2.0 * std::numbers::pi * hertz[k] * t + 1.7 * axis + 2.1 * k) / hertz[k];
    return p;
}

/// To and fro between two places, as people reach: with the least jerk, 0.8 s each way.
glm::dvec3 reaching(double t) {
    const double way = t / 0.8;
    const double s = way - std::floor(way);
    const double done = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    return {static_cast<int>(way) % 2 == 0 ? done : 1.0 - done, 0.0, 0.0};
}

/// To and fro at one speed, turning on the spot after two seconds.
glm::dvec3 sharply(double t) {
    const double way = t / 2.0;
    const double s = way - std::floor(way);
    return {0.0, 0.0, static_cast<int>(way) % 2 == 0 ? s : 1.0 - s};
}

// R25, prediction
TEST(PoseStream, PredictionTakesAwayTwoThirdsOfTheErrorOfADelay) {
    struct Case {
        const char* name;
        Path path;
    };
    for (const Case& c : {Case{"freely", freely}, Case{"reaching", reaching}, Case{"sharply", sharply}}) {
        const double scale = 0.3 / topSpeed(c.path);
        std::mt19937 random(11);
        std::normal_distribution<double> noise(0.0, 0.2e-3);
        PoseStream stream;
        Errors plain;
        Errors predicted;
        for (int k = 0; k < 60 * static_cast<int>(kRate); ++k) {
            const double t = k / kRate;
            ASSERT_TRUE(
                stream.push(sampleAt(t, scale * c.path(t) + glm::dvec3(noise(random), noise(random), noise(random)))));
            if (t < 0.5) continue;
            const glm::dvec3 truth = scale * c.path(t + kDelay);
            plain.add(glm::distance(stream.at(at(t), at(t))->position, truth));
            predicted.add(glm::distance(stream.at(at(t + kDelay), at(t))->position, truth));
        }
        EXPECT_GT(plain.mean(), 0.006) << c.name << " is a real test";
        EXPECT_LE(predicted.mean(), plain.mean() / 3.0) << c.name;
        EXPECT_LE(predicted.most(), plain.most() / 3.0) << c.name;
        RecordProperty(std::string(c.name) + "_mean_mm_e2", static_cast<int>(1e5 * predicted.mean()));
    }
}

TEST(PoseStream, TurnsArePredictedToo) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 1e-3);
    const auto truth = [](double t) { return aboutUp(0.6 * std::sin(2.0 * std::numbers::pi * 0.7 * t)); };
    PoseStream stream;
    Errors plain;
    Errors predicted;
    for (int k = 0; k < 20 * static_cast<int>(kRate); ++k) {
        const double t = k / kRate;
        const glm::dquat wobble =
            glm::normalize(glm::dquat(1.0, 0.5 * noise(random), 0.5 * noise(random), 0.5 * noise(random)));
        const double sign = k % 2 == 0 ? 1.0 : -1.0; // the same rotation
        (void)stream.push(sampleAt(t, {}, sign * (wobble * truth(t))));
        if (t < 0.5) continue;
        plain.add(angleBetween(stream.at(at(t), at(t))->rotation, truth(t + kDelay)));
        const glm::dquat found = stream.at(at(t + kDelay), at(t))->rotation;
        EXPECT_NEAR(glm::length(found), 1.0, 1e-9);
        predicted.add(angleBetween(found, truth(t + kDelay)));
    }
    EXPECT_GT(plain.mean(), 0.05);
    EXPECT_LE(predicted.mean(), plain.mean() / 3.0);
    EXPECT_LE(predicted.most(), plain.most() / 3.0);
}

TEST(PoseStream, WhatRestsIsStill) {
    for (const bool movedBefore : {false, true}) {
        std::mt19937 random(7);
        std::normal_distribution<double> noise(0.0, 0.25e-3);
        PoseStream stream;
        const double rests = movedBefore ? 2.0 : 0.0;
        std::vector<glm::dvec3> seen;
        Errors turns;
        for (int k = 0; k < 60 * static_cast<int>(kRate); ++k) {
            const double t = k / kRate;
            const glm::dvec3 place(0.3 * std::min(t, rests), 0.8, -0.2);
            (void)stream.push(sampleAt(t, place + glm::dvec3(noise(random), noise(random), noise(random)),
                                       aboutUp(4.0 * noise(random))));
            if (t < rests + 1.0) continue;
            const Pose pose = *stream.at(at(t + kDelay), at(t));
            seen.push_back(pose.position);
            turns.add(angleBetween(pose.rotation, aboutUp(0.0)));
        }
        glm::dvec3 mean(0.0);
        for (const glm::dvec3& p : seen) mean += p / static_cast<double>(seen.size());
        Errors off;
        double squares = 0.0;
        for (const glm::dvec3& p : seen) {
            off.add(glm::distance(p, mean));
            squares += glm::dot(p - mean, p - mean);
        }
        EXPECT_LE(std::sqrt(squares / static_cast<double>(seen.size())), 0.3e-3);
        EXPECT_LE(off.most(), 0.3e-3);
        EXPECT_LE(off.most(0.999), 0.5e-3);
        EXPECT_LE(turns.most(), 1.2e-3);
    }
}

// A tracker four times as noisy as the best: what rests does not swim, and what sets out is followed all the same.
TEST(PoseStream, WhatRestsBeforeANoisyTrackerIsStillToo) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 1e-3);
    const auto dice = [&] { return glm::dvec3(noise(random), noise(random), noise(random)); };
    const auto path = [](double t) { return glm::dvec3(0.3 * (t - std::min(t, 5.0 * std::ceil(t / 10.0))), 0.8, 0.0); };
    PoseStream stream;
    double squares = 0.0, rested = 0.0;
    Errors plain, predicted;
    for (int k = 0; k < 20 * static_cast<int>(kRate); ++k) {
        const double t = k / kRate;
        const double setOut = std::fmod(t, 10.0) - 5.0;
        (void)stream.push(sampleAt(t, path(t) + dice(), aboutUp(3.5 * noise(random))));
        const Pose told = *stream.at(at(t + kDelay), at(t));
        if (t > 1.0 && t < 5.0) {
            squares += std::pow(glm::distance(told.position, path(t)), 2);
            rested += 1.0;
        }
        if (setOut < 0.1 || setOut > 0.5) continue;
        plain.add(glm::distance(path(t), path(t + kDelay)));
        predicted.add(glm::distance(told.position, path(t + kDelay)));
    }
    EXPECT_LE(std::sqrt(squares / rested), 0.6e-3);
    EXPECT_LE(predicted.mean(), plain.mean() / 2.0);
}

TEST(PoseStream, FollowsASlowDriftWithinAMillimetreOrTwo) {
    std::mt19937 random(9);
    std::normal_distribution<double> noise(0.0, 0.2e-3);
    for (const double speed : {0.002, 0.005, 0.01, 0.02, 0.05}) {
        PoseStream stream;
        Errors off;
        for (int k = 0; k < 20 * static_cast<int>(kRate); ++k) {
            const double t = k / kRate;
            (void)stream.push(sampleAt(t, {speed * t + noise(random), noise(random), noise(random)}));
            if (t > 1.0)
                off.add(glm::distance(stream.at(at(t + kDelay), at(t))->position, {speed * (t + kDelay), 0, 0}));
        }
        EXPECT_LE(off.most(0.99), 2.5e-3) << speed;
    }
}

TEST(PoseStream, LostOrStaleIsEmpty) {
    PoseStream stream(Microseconds{200'000});
    EXPECT_FALSE(stream.at(at(0.0), at(0.0)));
    EXPECT_FALSE(stream.latest());
    ASSERT_TRUE(stream.push(sampleAt(1.0, {1, 2, 3})));
    EXPECT_TRUE(stream.at(at(1.25), at(1.2)));
    EXPECT_FALSE(stream.at(at(1.25), at(1.21)));
    ASSERT_TRUE(stream.push(sampleAt(1.3, {1, 2, 3})));
    EXPECT_TRUE(stream.at(at(1.3), at(1.3)));
    PoseSample lost = sampleAt(1.31, {kNan, 0, 0});
    lost.valid = false;
    EXPECT_TRUE(stream.push(lost));
    EXPECT_FALSE(stream.at(at(1.31), at(1.31)));
    EXPECT_FALSE(stream.latest()->valid);
    ASSERT_TRUE(stream.push(sampleAt(9.0, {5, 6, 7})));
    EXPECT_EQ(stream.at(at(9.06), at(9.0))->position, glm::dvec3(5, 6, 7)) << "found anew, nothing before counts";
}

TEST(PoseStream, IsStaleWhenNothingValidWasMeasuredLately) {
    PoseStream stream(Microseconds{200'000});
    EXPECT_TRUE(stream.isStale(at(0.0)));
    ASSERT_TRUE(stream.push(sampleAt(1.0, {1, 2, 3})));
    EXPECT_FALSE(stream.isStale(at(1.2)));
    EXPECT_TRUE(stream.isStale(at(1.21)));
    PoseSample lost = sampleAt(1.15, {});
    lost.valid = false;
    ASSERT_TRUE(stream.push(lost));
    EXPECT_FALSE(stream.isStale(at(1.2))) << "lost a moment ago";
    EXPECT_TRUE(stream.isStale(at(1.21))) << "what is lost makes nothing fresh";
}

TEST(PoseStream, BeginsAnewWithAnotherSource) {
    PoseStream stream;
    for (int k = 0; k <= 120; ++k) (void)stream.push(sampleAt(k / kRate, {0.3 * k / kRate, 0, 0}));
    EXPECT_FALSE(stream.restart(sampleAt(1.01, {kNan, 0, 0})));
    EXPECT_NEAR(stream.at(at(1.0), at(1.0))->position.x, 0.3, 1e-3) << "what is no pose changes nothing";
    ASSERT_TRUE(stream.restart(sampleAt(0.98, {5, 6, 7}))) << "its tracker is a little later";
    EXPECT_EQ(stream.at(at(1.1), at(1.0))->position, glm::dvec3(5, 6, 7)) << "neither mixed nor moving on";
    ASSERT_TRUE(stream.push(sampleAt(0.99, {5, 6, 7})));
    EXPECT_LT(glm::distance(stream.at(at(1.1), at(1.0))->position, {5, 6, 7}), 1e-6);
}

TEST(PoseStream, LeavesOutWhatIsLateOrNoPose) {
    PoseStream stream;
    ASSERT_TRUE(stream.push(sampleAt(1.0, {1, 2, 3})));
    const Pose before = *stream.at(at(1.0), at(1.0));
    EXPECT_FALSE(stream.push(sampleAt(0.99, {9, 9, 9})));
    EXPECT_FALSE(stream.push(sampleAt(1.0, {9, 9, 9})));
    for (const double wrong : {kNan, HUGE_VAL, -HUGE_VAL, 1e300}) {
        EXPECT_FALSE(stream.push(sampleAt(1.1, {0, wrong, 0})));
        EXPECT_FALSE(stream.push(sampleAt(1.1, {}, {wrong, 0.0, 0.0, 0.0})));
    }
    EXPECT_FALSE(stream.push(sampleAt(1.1, {}, {0.0, 0.0, 0.0, 0.0})));
    EXPECT_EQ(*stream.at(at(1.0), at(1.0)), before);
    EXPECT_EQ(stream.latest()->time, at(1.0));
}

TEST(PoseStream, ATeleportDoesNotOvershoot) {
    PoseStream stream;
    const auto place = [](double t) { return t < 1.0 ? 0.3 * t : 1.0; }; // jumps from 0.3 to 1 and rests there
    for (int k = 0; k < 2 * static_cast<int>(kRate); ++k) {
        const double t = k / kRate;
        (void)stream.push(sampleAt(t, {place(t), 0, 0}, aboutUp(t < 1.0 ? 0.0 : 2.0)));
        const Pose pose = *stream.at(at(t + kDelay), at(t));
        EXPECT_LE(pose.position.x, 1.0 + 1e-9) << t;
        if (t < 1.0) {
            EXPECT_LE(pose.position.x, 0.32) << t;
        } else {
            EXPECT_NEAR(pose.position.x, 1.0, 1e-6) << "there at once, " << t;
            EXPECT_NEAR(angleBetween(pose.rotation, aboutUp(2.0)), 0.0, 1e-6);
        }
    }
}

TEST(PoseStream, LooksAheadNoFurtherThanItCanKnow) {
    PoseStream stream;
    for (int k = 0; k <= 120; ++k) (void)stream.push(sampleAt(k / kRate, {0.3 * k / kRate, 0, 0}));
    EXPECT_NEAR(stream.at(at(1.10), at(1.0))->position.x, 0.33, 1e-3);
    EXPECT_NEAR(stream.at(at(1.15), at(1.0))->position.x, 0.345, 1e-3);
    EXPECT_EQ(stream.at(at(60.0), at(1.0))->position, stream.at(at(1.15), at(1.0))->position);
}

TEST(PoseStream, TellsALittleOfThePastToo) {
    PoseStream stream;
    for (int k = 0; k <= 120; ++k) (void)stream.push(sampleAt(k / kRate, {0.3 * k / kRate, 0, 0}));
    EXPECT_NEAR(stream.at(at(0.97), at(1.0))->position.x, 0.291, 1e-3) << "30 ms before the newest sample";
    EXPECT_NEAR(stream.at(at(0.96), at(1.0))->position.x, 0.288, 1e-3);
    EXPECT_EQ(stream.at(at(0.5), at(1.0))->position, stream.at(at(0.95), at(1.0))->position) << "and no more";
}

TEST(PoseStream, TrackerAndLoopMayUseItAtOnce) {
    // A body that goes along x at 0.1 m/s, its y and z bound to x: a sample that was read while it was written would
    // tear them apart. Neither goes on without the other, whoever has the processor first.
    constexpr std::size_t kMoments = 1000;
    PoseStream stream;
    std::atomic<int> looks{0};
    int samples = 0;
    std::jthread tracker([&](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            if (samples > 100 * (looks + 1)) {
                std::this_thread::yield();
                continue;
            }
            const double x = 1e-4 * ++samples;
            (void)stream.push(sampleAt(1e-3 * samples, {x, 2.0 * x - 1.0, -x}));
        }
    });
    std::set<Microseconds> times;
    double last = 0.0;
    while (times.size() < kMoments) {
        const auto newest = stream.latest();
        if (!newest || times.contains(newest->time)) std::this_thread::yield();
        if (!newest) continue;
        ++looks;
        times.insert(newest->time);
        const double seconds = 1e-6 * static_cast<double>(newest->time.count());
        ASSERT_NEAR(newest->pose.position.x, 0.1 * seconds, 1e-9);
        ASSERT_NEAR(newest->pose.position.y, 0.2 * seconds - 1.0, 1e-9);
        ASSERT_NEAR(newest->pose.position.z, -0.1 * seconds, 1e-9);
        const auto pose = stream.at(newest->time, newest->time);
        ASSERT_TRUE(pose);
        // The filter follows within a millimetre, and its three axes are of one moment.
        ASSERT_NEAR(pose->position.z, -pose->position.x, 1e-9);
        ASSERT_NEAR(pose->position.y, 2.0 * pose->position.x - 1.0, 2e-3);
        ASSERT_GE(pose->position.x, last - 1e-3);
        last = pose->position.x;
    }
    tracker.request_stop();
    tracker.join();
    const double end = 1e-3 * samples;
    EXPECT_NEAR(stream.at(at(end), at(end))->position.x, 0.1 * end, 1e-3);
}

TEST(PoseBoard, HandsOutOneStreamAName) {
    PoseBoard board;
    const auto head = board.stream("Ada", PoseRole::head);
    EXPECT_EQ(board.stream("Ada", PoseRole::head), head);
    EXPECT_NE(board.stream("tablet", PoseRole::device), head);
    ASSERT_EQ(board.entries().size(), 2U);
    EXPECT_EQ(board.entries()[1].name, "tablet");
    EXPECT_EQ(board.entries()[1].role, PoseRole::device);
    EXPECT_EQ(board.stream("tablet", PoseRole::pointer), board.entries()[1].stream);
    EXPECT_EQ(board.entries()[1].role, PoseRole::pointer);
    board.remove("Ada");
    board.remove("nobody");
    ASSERT_EQ(board.entries().size(), 1U);
    EXPECT_NE(board.stream("Ada", PoseRole::head), head);
}

} // namespace
} // namespace lumorph

#include "calibration/registration/hand_eye.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <stop_token>
#include <string_view>

#include <gtest/gtest.h>

#include "calibration/registration/clock_offset.h"
#include "calibration/registration/pose_file.h"
#include "tracked_motion.h"

// R25: two tracked bodies that are joined, each in its own world, against a known truth; and a real recording.

namespace lumorph {
namespace {

using test::HandMotion;
using test::trackOf;

constexpr double kDegrees = 180.0 / 3.14159265358979;

struct TwoBodies {
    HandMotion motion;
    Pose bFromA{{0.08, -0.05, 0.12}, rotationOfTurn({0.9, -1.7, 0.4})};
    Pose worldBFromWorldA{{1.4, -0.3, 2.2}, rotationOfTurn({-0.5, 2.1, 0.8})};
    double offset = 0.137;
    double drift = 0.0;

    explicit TwoBodies(unsigned seed, glm::dvec3 turns = glm::dvec3(0.6)) : motion(seed, turns) {}
    [[nodiscard]] PoseTrack a(unsigned seed, double seconds = 30.0) const {
        return trackOf([&](double t) { return motion.at(t); }, seconds, 100.0, seed);
    }
    [[nodiscard]] PoseTrack b(unsigned seed, double rate = 30.0, double seconds = 30.0) const {
        const auto pose = [&](double t) { return worldBFromWorldA * motion.at(timeOfA(t)) * inverseOf(bFromA); };
        return trackOf(pose, seconds, rate, seed + 1000);
    }
    [[nodiscard]] double timeOfA(double timeOfB) const { return timeOfB - offset - drift * timeOfB; }
};

double turnOff(const Pose& a, const Pose& b) { return kDegrees * angleOf(glm::conjugate(a.rotation) * b.rotation); }
double placeOff(const Pose& a, const Pose& b) { return 1000.0 * glm::distance(a.position, b.position); }

void expectRefused(Cause cause, const std::string& word, const PoseTrack& a, const PoseTrack& b) {
    try {
        (void)solveHandEye(a, b);
        ADD_FAILURE() << "not refused: " << keyOf(cause);
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(keyOf(refused.finding().cause), keyOf(cause)) << refused.what();
        EXPECT_NE(std::string(refused.what()).find(word), std::string::npos) << refused.what();
    }
}

TEST(HandEye, TwentySetUpsAreFoundWithinAMillimetreAndAFifthOfADegree) {
    double worstTurn = 0.0, worstPlace = 0.0, worstOffset = 0.0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        const TwoBodies truth(seed);
        const HandEye found = solveHandEye(truth.a(seed), truth.b(seed));
        worstTurn = std::max(worstTurn, turnOff(found.bFromA, truth.bFromA));
        worstPlace = std::max(worstPlace, placeOff(found.bFromA, truth.bFromA));
        worstOffset = std::max(worstOffset, 1000.0 * std::abs(found.timeOffset - truth.offset));
        EXPECT_LT(turnOff(found.worldBFromWorldA, truth.worldBFromWorldA), 0.2) << seed;
        EXPECT_TRUE(found.warnings.empty()) << sentenceOf(found.warnings.front());
    }
    std::printf("hand-eye, 20 set-ups with 1 mm and 0.2 degrees of noise: %.3f degrees, %.2f mm, %.2f ms at worst\n",
                worstTurn, worstPlace, worstOffset);
    EXPECT_LT(worstTurn, 0.2);
    EXPECT_LT(worstPlace, 1.0);
    EXPECT_LT(worstOffset, 2.0);
}

TEST(HandEye, SigmaTellsTheTrueError) {
    double errors = 0.0, sigmas = 0.0;
    for (unsigned seed = 30; seed < 40; ++seed) {
        const TwoBodies truth(seed);
        const HandEye found = solveHandEye(truth.a(seed), truth.b(seed));
        errors += std::pow(placeOff(found.bFromA, truth.bFromA), 2);
        sigmas += std::pow(1000.0 * found.shiftSigma, 2);
    }
    EXPECT_GT(std::sqrt(sigmas / errors), 0.5);
    EXPECT_LT(std::sqrt(sigmas / errors), 2.0);
}

TEST(HandEye, WhicheverIsGivenFirstTheSameIsFound) {
    const TwoBodies truth(3);
    const HandEye there = solveHandEye(truth.a(3), truth.b(3)), back = solveHandEye(truth.b(3), truth.a(3));
    EXPECT_LT(placeOff(there.bFromA, inverseOf(back.bFromA)), 1e-6);
    EXPECT_NEAR(there.timeOffset, -back.timeOffset, 1e-9);
}

TEST(HandEye, ClocksMayBeginYearsApart) {
    TwoBodies truth(5);
    PoseTrack b = truth.b(5);
    for (TimedPose& at : b.poses) at.seconds += 1.7e9;
    const HandEye found = solveHandEye(truth.a(5), b);
    EXPECT_NEAR(found.timeOffset - 1.7e9, truth.offset, 0.002);
}

// Twenty minutes of two clocks that differ by 50 ppm: 60 ms.
TEST(HandEye, ClocksThatDriftSpoilNothing) {
    for (const unsigned seed : {141U, 142U}) {
        TwoBodies truth(seed);
        truth.drift = seed % 2 == 0 ? 50e-6 : -50e-6;
        const PoseTrack a = truth.a(seed, 1200.0), b = truth.b(seed, 12.0, 1200.0);
        const auto since = std::chrono::steady_clock::now();
        const HandEye found = solveHandEye(a, b);
        const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
        double worst = 0.0;
        for (double t = 0.0; t < 1200.0; t += 10.0) worst = std::max(worst, std::abs(found.toA(t) - truth.timeOfA(t)));
        std::printf("%.3f degrees, %.2f mm beside; drift %.2f ppm, sigma %.2f; clocks within %.2f ms; %.1f s\n",
                    turnOff(found.bFromA, truth.bFromA), placeOff(found.bFromA, truth.bFromA), 1e6 * found.clockDrift,
                    1e6 * found.driftSigma, 1000.0 * worst, took);
        EXPECT_LT(turnOff(found.bFromA, truth.bFromA), 0.05) << seed;
        EXPECT_LT(placeOff(found.bFromA, truth.bFromA), 0.3) << seed;
        EXPECT_LT(worst, 0.001) << seed;
        EXPECT_NEAR(found.clockDrift, truth.drift, std::max(4.0 * found.driftSigma, 1e-7)) << seed;
        EXPECT_TRUE(found.warnings.empty());
    }
}

TEST(HandEye, ClocksThatDriftAreTheSameFromEitherSide) {
    TwoBodies truth(143);
    truth.drift = 80e-6;
    const PoseTrack a = truth.a(143, 120.0), b = truth.b(143, 12.0, 120.0);
    const HandEye there = solveHandEye(a, b), back = solveHandEye(b, a);
    EXPECT_NEAR(there.clockDrift, 80e-6, 4.0 * there.driftSigma);
    EXPECT_LT(there.driftSigma, 10e-6);
    for (const double t : {10.0, 60.0, 110.0}) {
        EXPECT_NEAR(there.toA(t), truth.timeOfA(t), 0.001) << t;
        EXPECT_NEAR(back.toA(there.toA(t)), t, 1e-5) << t;
    }
}

TEST(HandEye, CanBeCancelled) {
    const TwoBodies truth(151);
    for (const double at : {0.05, 0.3, 0.6}) {
        std::stop_source stop;
        const Progress progress(
            [&](double fraction, std::string_view) {
                if (fraction >= at) stop.request_stop();
            },
            stop.get_token());
        EXPECT_THROW((void)solveHandEye(truth.a(151), truth.b(151), progress), Cancelled) << at;
    }
}

TEST(HandEye, DegenerateMotionIsRefusedWithTheOneThatIsMissing) {
    const auto refused = [](glm::dvec3 turns, const char* word) {
        for (unsigned seed = 0; seed < 5; ++seed) {
            const TwoBodies truth(seed, turns);
            expectRefused(Cause::motionDegenerate, word, truth.a(seed), truth.b(seed));
        }
    };
    refused({0.0, 0.6, 0.0}, "also tilt");
    refused({0.6, 0.0, 0.0}, "vertical axis");
    const TwoBodies still(1, {0.0, 0.0, 0.0}); // pure shift: nothing tells the clocks either
    try {
        (void)solveHandEye(still.a(1), still.b(1));
        ADD_FAILURE() << "no turn at all";
    } catch (const CaptureRefused& e) {
        EXPECT_NE(std::string(e.what()).find("turn"), std::string::npos) << e.what();
    }
}

TEST(HandEye, LeftHandedCoordinatesAreRefused) {
    const TwoBodies truth(7);
    PoseTrack b = truth.b(7);
    for (TimedPose& at : b.poses) {
        at.pose.position.z = -at.pose.position.z;
        at.pose.rotation = {at.pose.rotation.w, -at.pose.rotation.x, -at.pose.rotation.y, at.pose.rotation.z};
    }
    expectRefused(Cause::mirrored, "left-handed", truth.a(7), b);
}

TEST(HandEye, CentimetresForMetresAreRefused) {
    const TwoBodies truth(8);
    PoseTrack b = truth.b(8);
    for (TimedPose& at : b.poses) at.pose.position *= 100.0;
    expectRefused(Cause::wrongUnits, "100.", truth.a(8), b);
}

TEST(HandEye, BodiesThatAreNotJoinedAreRefused) {
    const TwoBodies truth(9), other(10);
    EXPECT_THROW((void)solveHandEye(truth.a(9), other.b(10)), CaptureRefused);
}

TEST(HandEye, AClockThatJumpsIsRefused) {
    const TwoBodies truth(11);
    PoseTrack b = truth.b(11);
    for (std::size_t i = b.poses.size() / 2; i < b.poses.size(); ++i) b.poses[i].seconds += 0.4;
    expectRefused(Cause::clockJumps, "ms", truth.a(11), b);
}

TEST(HandEye, SwapsAndDropOutsCountForNothingAndAreTold) {
    const TwoBodies truth(12);
    PoseTrack b = truth.b(12);
    for (std::size_t i = 200; i < 260; ++i) b.poses[i].pose = {{3.0, 0.5, 1.0}, rotationOfTurn({0.0, 1.0, 0.0})};
    b.poses.erase(b.poses.begin() + 500, b.poses.begin() + 600);
    const HandEye found = solveHandEye(truth.a(12), b);
    EXPECT_LT(placeOff(found.bFromA, truth.bFromA), 1.2);
    ASSERT_EQ(found.warnings.size(), 1U);
    EXPECT_EQ(keyOf(found.warnings[0].cause), "body_swapped");
    EXPECT_NE(found.warnings[0].why.find("6.7 s"), std::string::npos) << found.warnings[0].why;
}

TEST(HandEye, RealRecordingsOfCameraAndTrackerAgreeWithTheirHalves) {
    const std::string folder = LUMORPH_SHARED_DIR "/data/handeye/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "without ../shared/data/handeye";
    const PoseTrack a = parsePoseTrack(test::textOfFile(folder + "vicon.csv"), "vicon.csv");
    const PoseTrack b = parsePoseTrack(test::textOfFile(folder + "camera.csv"), "camera.csv");
    const HandEye found = solveHandEye(a, b);
    std::printf("halves differ by %.2f degrees, %.1f mm; sigma %.2f degrees, %.1f mm, %.1f ms\n",
                kDegrees * found.halvesTurn, 1000.0 * found.halvesShift, kDegrees * found.turnSigma,
                1000.0 * found.shiftSigma, 1000.0 * found.offsetSigma);
    EXPECT_LT(kDegrees * found.halvesTurn, 0.8);
    EXPECT_LT(found.halvesShift, 0.010);
    EXPECT_LT(kDegrees * found.turnSigma, 0.3);
    EXPECT_LT(found.shiftSigma, 0.004);
    EXPECT_LT(found.offsetSigma, 0.004);
}

} // namespace
} // namespace lumorph

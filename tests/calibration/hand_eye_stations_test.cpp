#include "calibration/registration/hand_eye_stations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tracked_motion.h"

// Two joined bodies that stood still here and there, as on a robot or a tripod, against a known truth.

namespace lumorph {
namespace {

constexpr double kInDegrees = 180.0 / 3.14159265358979;

struct Stands {
    Pose bFromA, worldBFromWorldA;
    std::vector<Station> a, b;

    /// `turned` says how far a station is turned about each axis of the world, radians at most.
    Stands(unsigned seed, int count, glm::dvec3 turned = glm::dvec3(0.7), double moved = 0.4) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> one(-1.0, 1.0);
        std::normal_distribution<double> normal;
        const auto vector = [&] { return glm::dvec3(one(random), one(random), one(random)); };
        const auto noisy = [&](const Pose& pose) {
            const auto noise = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
            return Pose{pose.position + 0.0003 * noise(), pose.rotation * rotationOfTurn(0.001 * noise())};
        };
        bFromA = {0.15 * vector(), rotationOfTurn(1.7 * vector())};
        worldBFromWorldA = {1.5 * vector(), rotationOfTurn(1.7 * vector())};
        for (int i = 0; i < count; ++i) {
            const Pose pose{glm::dvec3(0.5, 0.6, 0.2) + moved * vector(), rotationOfTurn(turned * vector())};
            a.push_back({std::to_string(i + 1), noisy(pose)});
            b.push_back({std::to_string(i + 1), noisy(worldBFromWorldA * pose * inverseOf(bFromA))});
        }
    }
    void expectFound(const HandEye& found, double degrees, double millimetres, const std::string& what) const {
        EXPECT_LT(kInDegrees * angleOf(glm::conjugate(found.bFromA.rotation) * bFromA.rotation), degrees) << what;
        EXPECT_LT(1000.0 * glm::distance(found.bFromA.position, bFromA.position), millimetres) << what;
    }
};

std::string refusalOf(const Stands& stands) {
    try {
        (void)solveHandEyeStations(stands.a, stands.b);
    } catch (const CaptureRefused& refused) {
        return std::string(keyOf(refused.finding().cause)) + ": " + refused.what();
    }
    return "accepted";
}

TEST(HandEyeStations, EightToThirtyPairsAreEnough) {
    for (const int count : {8, 12, 20, 30})
        for (unsigned seed = 6001; seed < 6011; ++seed) {
            const Stands stands(seed * 31, count);
            const HandEye found = solveHandEyeStations(stands.a, stands.b);
            const std::string what = std::to_string(count) + " stations, seed " + std::to_string(seed);
            stands.expectFound(found, count < 12 ? 0.25 : 0.15, count < 12 ? 1.5 : 1.0, what);
            EXPECT_TRUE(found.warnings.empty()) << what << sentenceOf(found.warnings.front());
            EXPECT_EQ(found.poses, std::size_t(count));
            EXPECT_EQ(std::isfinite(found.halvesShift), count >= 12) << what;
        }
}

TEST(HandEyeStations, SigmaTellsTheTrueError) {
    double errors = 0.0, sigmas = 0.0;
    for (unsigned seed = 6101; seed < 6131; ++seed) {
        const Stands stands(seed * 31, 15);
        const HandEye found = solveHandEyeStations(stands.a, stands.b);
        errors += std::pow(glm::distance(found.bFromA.position, stands.bFromA.position), 2);
        sigmas += std::pow(found.shiftSigma, 2);
    }
    EXPECT_GT(std::sqrt(sigmas / errors), 0.5);
    EXPECT_LT(std::sqrt(sigmas / errors), 2.0);
}

TEST(HandEyeStations, MissingMotionIsNamed) {
    for (unsigned seed = 6201; seed < 6204; ++seed) {
        EXPECT_NE(refusalOf(Stands(seed, 12, {0.0, 0.7, 0.0})).find("motion_degenerate: "), std::string::npos);
        EXPECT_NE(refusalOf(Stands(seed, 12, {0.0, 0.7, 0.0})).find("also tilt"), std::string::npos);
        EXPECT_NE(refusalOf(Stands(seed, 12, {0.7, 0.0, 0.0})).find("vertical axis"), std::string::npos);
        EXPECT_NE(refusalOf(Stands(seed, 12, glm::dvec3(0.0))).find("motion_degenerate: "), std::string::npos);
        EXPECT_NE(refusalOf(Stands(seed, 12, glm::dvec3(0.0))).find("hardly turned"), std::string::npos);
    }
    EXPECT_EQ(refusalOf(Stands(6204, 5)).find("too_few_points: "), 0U);
}

TEST(HandEyeStations, AStationThatWasBumpedIsNamedAndLeftOut) {
    for (unsigned seed = 6301; seed < 6309; ++seed) {
        Stands stands(seed, 10);
        stands.b[6].pose.position += glm::dvec3(0.03, 0.0, 0.02);
        const HandEye found = solveHandEyeStations(stands.a, stands.b);
        stands.expectFound(found, 0.25, 1.5, std::to_string(seed));
        ASSERT_EQ(found.warnings.size(), 1U) << seed;
        EXPECT_EQ(keyOf(found.warnings[0].cause), "point_suspicious");
        EXPECT_NE(found.warnings[0].why.find("station 7 "), std::string::npos) << found.warnings[0].why;
    }
}

TEST(HandEyeStations, StationsBelongTogetherByTheirNames) {
    Stands stands(6401, 12);
    std::ranges::reverse(stands.b);
    stands.expectFound(solveHandEyeStations(stands.a, stands.b), 0.25, 1.5, "in another order");
    stands.a.erase(stands.a.begin() + 3);
    const HandEye fewer = solveHandEyeStations(stands.a, stands.b);
    stands.expectFound(fewer, 0.25, 1.5, "one is missing");
    ASSERT_EQ(fewer.warnings.size(), 1U);
    EXPECT_EQ(keyOf(fewer.warnings[0].cause), "tracker_lost");
    Stands timed(6402, 12); // each by its own clock
    for (std::size_t i = 0; i < 12; ++i) timed.b[i].name = std::to_string(1700000000 + 10 * i);
    timed.expectFound(solveHandEyeStations(timed.a, timed.b), 0.25, 1.5, "two clocks");
}

TEST(HandEyeStations, ReadingsUnitsAndPlacesAreToldApart) {
    const auto each = [](std::vector<Station>& stations, const std::function<Pose(const Pose&)>& change) {
        for (Station& at : stations) at.pose = change(at.pose);
    };
    const auto wFirst = [](const Pose& p) { // what a file with w first is read as
        return Pose{p.position, glm::dquat(p.rotation.z, p.rotation.w, p.rotation.x, p.rotation.y)};
    };
    const auto feet = [](const Pose& p) { return Pose{p.position / 0.3048, p.rotation}; };
    const auto mirrored = [](const Pose& p) {
        return Pose{{p.position.x, p.position.y, -p.position.z},
                    {p.rotation.w, -p.rotation.x, -p.rotation.y, p.rotation.z}};
    };
    for (unsigned seed = 6501; seed < 6506; ++seed) {
        const Stands stands(seed * 17, 14);
        for (const int which : {1, 2, 3}) {
            Stands spoiled = stands;
            if (which & 1) each(spoiled.a, wFirst);
            if (which & 2) each(spoiled.b, wFirst);
            const HandEye found = solveHandEyeStations(spoiled.a, spoiled.b);
            stands.expectFound(found, 0.25, 1.5, "w first " + std::to_string(which));
            ASSERT_EQ(found.warnings.size(), 1U) << seed;
            EXPECT_EQ(keyOf(found.warnings[0].cause), "quaternion_order");
        }
        Stands spoiled = stands;
        each(spoiled.a, [](const Pose& p) { return inverseOf(p); });
        EXPECT_EQ(refusalOf(spoiled).find("inverted: "), 0U) << refusalOf(spoiled);
        spoiled = stands;
        each(spoiled.b, feet);
        EXPECT_EQ(refusalOf(spoiled).find("wrong_units: "), 0U) << refusalOf(spoiled);
        spoiled = stands;
        each(spoiled.a, mirrored);
        EXPECT_EQ(refusalOf(spoiled).find("mirrored: "), 0U) << refusalOf(spoiled);
        spoiled = stands;
        std::rotate(spoiled.b.begin(), spoiled.b.begin() + 1, spoiled.b.end());
        for (std::size_t i = 0; i < spoiled.b.size(); ++i) spoiled.b[i].name = spoiled.a[i].name;
        EXPECT_EQ(refusalOf(spoiled).find("model_does_not_fit: "), 0U) << refusalOf(spoiled);
        const Stands turning(seed * 17, 14, glm::dvec3(0.7), 0.0);
        const HandEye inPlace = solveHandEyeStations(turning.a, turning.b);
        turning.expectFound(inPlace, 0.25, 1.5, "in place");
        ASSERT_EQ(inPlace.warnings.size(), 1U) << seed;
        EXPECT_EQ(keyOf(inPlace.warnings[0].cause), "turns_in_place");
    }
}

// The same real rig as in HandEye.RealRecordings..., as if somebody had taken 30 stations of it.
TEST(HandEyeStations, ThirtyPairsOfARealRecordingAgreeWithAllOfIt) {
    const std::string folder = LUMORPH_SHARED_DIR "/data/handeye/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "without ../shared/data/handeye";
    const PoseTrack a = parsePoseTrack(test::textOfFile(folder + "vicon.csv"), "vicon.csv");
    const PoseTrack b = parsePoseTrack(test::textOfFile(folder + "camera.csv"), "camera.csv");
    const HandEye all = solveHandEye(a, b);
    std::vector<Station> inA, inB;
    for (std::size_t k = 0; k < 30; ++k) {
        const TimedPose& at = b.poses[(2 * k + 1) * b.poses.size() / 60];
        const auto there = poseAt(a, all.toA(at.seconds));
        if (!there) continue;
        inA.push_back({std::to_string(k), *there});
        inB.push_back({std::to_string(k), at.pose});
    }
    ASSERT_GT(inA.size(), 20U);
    const HandEye found = solveHandEyeStations(inA, inB);
    const double turn = kInDegrees * angleOf(glm::conjugate(found.bFromA.rotation) * all.bFromA.rotation);
    const double shift = glm::distance(found.bFromA.position, all.bFromA.position);
    std::printf("%zu stations of a recording: %.2f degrees, %.1f mm beside all of it; sigma %.2f degrees, %.1f mm\n",
                found.poses, turn, 1000.0 * shift, kInDegrees * found.turnSigma, 1000.0 * found.shiftSigma);
    // Single views of that camera err by a degree and a centimetre: 30 are no better than they say themselves.
    EXPECT_LT(turn, 3.0 * kInDegrees * found.turnSigma);
    EXPECT_LT(shift, 3.0 * found.shiftSigma);
    EXPECT_LT(kInDegrees * found.turnSigma, 1.5);
    EXPECT_LT(found.shiftSigma, 0.02);
}

} // namespace
} // namespace lumorph

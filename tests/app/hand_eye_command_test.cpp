#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/process.h"
#include "tests/app/workspace.h"

namespace lumorph::test {
namespace {

/// A row of a recording: a hand that turns and moves about, at this time, `aside` metres along the body's x.
std::string rowOf(double clock, double time, double aside) {
    const auto wave = [time](double speed, double phase) {
        return std::sin(speed * time + phase) + 0.5 * std::sin(1.7 * speed * time);
    };
    const glm::dquat turn = glm::angleAxis(0.6 * wave(1.1, 0.2), glm::dvec3(0, 1, 0)) *
                            glm::angleAxis(0.5 * wave(1.6, 1.0), glm::dvec3(1, 0, 0)) *
                            glm::angleAxis(0.4 * wave(0.8, 2.0), glm::dvec3(0, 0, 1));
    const glm::dvec3 place = glm::dvec3(0.3 * wave(0.7, 0.0), 1.2 + 0.2 * wave(1.3, 0.5), 0.25 * wave(0.9, 1.5)) +
                             turn * glm::dvec3(aside, 0, 0);
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(), "%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f\n", clock, place.x, place.y,
                  place.z, turn.x, turn.y, turn.z, turn.w);
    return text.data();
}

TEST(HandEyeCommand, TellsHowFastTheClocksDrift) {
    constexpr double kOffset = 0.35, kDrift = 80e-6, kSeconds = 60.0; // of B's clock
    std::string a, b;
    for (double time = 0.0; time < kSeconds; time += 0.01) a += rowOf(time, time, 0.0);
    for (double time = 0.004; time < kSeconds; time += 0.04)
        b += rowOf(kOffset + time + kDrift * (time - 0.5 * kSeconds), time, 0.1);
    const SmallWorkspace folder;
    writeFile(folder["a.csv"], a);
    writeFile(folder["b.csv"], b);
    const Outcome outcome = lumorph({"calibrate", "handeye", folder["a.csv"], folder["b.csv"], "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json found = outcome.json();
    EXPECT_NEAR(double(found["timeOffset"]), kOffset, 0.001);
    EXPECT_NEAR(double(found["clockDrift"]), kDrift, 0.1 * kDrift);
    EXPECT_LT(double(found["sigma"]["clockDrift"]), 0.1 * kDrift);
    const Outcome words = lumorph({"calibrate", "handeye", folder["a.csv"], folder["b.csv"]});
    EXPECT_THAT(words.out, ::testing::ContainsRegex("drifting by (79|80)\\.[0-9] ppm"));
}

/// Sixteen stations of the same hand; `inverse` writes the world in the body's frame.
std::string stationsOf(double aside, bool named, bool inverse = false) {
    std::string text = named ? "name,x,y,z,qx,qy,qz,qw\n" : "";
    for (int k = 0; k < 16; ++k) {
        std::string row = rowOf(0.0, 2.3 * k, aside);
        row.erase(0, row.find(',') + 1);
        if (inverse) {
            std::array<double, 7> n{};
            std::sscanf(row.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf", &n[0], &n[1], &n[2], &n[3], &n[4], &n[5], &n[6]);
            const glm::dquat turn = glm::conjugate(glm::dquat(n[6], n[3], n[4], n[5]));
            const glm::dvec3 place = -(turn * glm::dvec3(n[0], n[1], n[2]));
            std::array<char, 200> line{};
            std::snprintf(line.data(), line.size(), "%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f\n", place.x, place.y, place.z,
                          turn.x, turn.y, turn.z, turn.w);
            row = line.data();
        }
        text += (named ? "P" + std::to_string(k) + "," : "") + row;
    }
    return text;
}

TEST(HandEyeCommand, SolvesStationsWithoutTimes) {
    const SmallWorkspace folder;
    writeFile(folder["a.csv"], stationsOf(0.0, false));
    writeFile(folder["b.csv"], stationsOf(0.1, false));
    writeFile(folder["c.csv"], stationsOf(0.1, true));
    const Outcome outcome = lumorph({"calibrate", "handeye", folder["a.csv"], folder["b.csv"], "--stations", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json found = outcome.json();
    EXPECT_NEAR(double(found["bFromA"]["position"][0]), -0.1, 1e-5);
    EXPECT_EQ(int(found["stations"]), 16);
    EXPECT_FALSE(found.contains("timeOffset"));
    const Outcome words = lumorph({"calibrate", "handeye", folder["a.csv"], folder["c.csv"], "--stations"});
    EXPECT_EQ(words.exitCode, 0) << "P0 and 1 are one station, by their order: " << words.err;
    EXPECT_THAT(words.out, ::testing::HasSubstr("16 stations"));
    const Outcome moving = lumorph({"calibrate", "handeye", folder["a.csv"], folder["b.csv"]});
    EXPECT_NE(moving.exitCode, 0);
    EXPECT_THAT(moving.err, ::testing::HasSubstr("it has no time"));
    EXPECT_THAT(moving.err, ::testing::HasSubstr("--stations"));
}

TEST(HandEyeCommand, AnInvertedRecordingIsSolvedWhenItIsSaidWhichItIs) {
    const SmallWorkspace folder;
    writeFile(folder["a.csv"], stationsOf(0.0, false, true));
    writeFile(folder["b.csv"], stationsOf(0.1, false));
    std::vector<std::string> words{"calibrate", "handeye", folder["a.csv"], folder["b.csv"], "--stations", "--json"};
    const Outcome refused = lumorph(words);
    EXPECT_NE(refused.exitCode, 0);
    EXPECT_EQ(refused.json()["refused"]["cause"], "inverted");
    EXPECT_THAT(refused.err, ::testing::HasSubstr("--inverted a"));
    words.insert(words.end(), {"--inverted", "a"});
    const Outcome solved = lumorph(words);
    ASSERT_EQ(solved.exitCode, 0) << solved.err;
    EXPECT_NEAR(double(solved.json()["bFromA"]["position"][0]), -0.1, 1e-5);
    words.back() = "c";
    EXPECT_NE(lumorph(words).exitCode, 0);
}

} // namespace
} // namespace lumorph::test

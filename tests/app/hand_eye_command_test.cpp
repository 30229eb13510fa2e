#include <array>
#include <cmath>
#include <cstdio>
#include <string>

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

} // namespace
} // namespace lumorph::test

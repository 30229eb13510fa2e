#include "devices/controllers/servo_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/devices/guard_key.h"
#include "tests/support/not_a_number.h"

namespace lumorph {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Microseconds kTick{5'000};

DeviceProfile profileOf(std::vector<ServoSetup> servos) {
    DeviceProfile profile;
    profile.servos = std::move(servos);
    profile.staggerSeconds = 0.1;
    return profile;
}

DeviceProfile oneServo() { return profileOf({{.channel = 3}}); }

/// A guard and its time; gives what it sent last.
struct Bench {
    ServoGuard guard;
    Microseconds now{1'000'000};
    std::vector<GuardedPulse> pulses;

    explicit Bench(const DeviceProfile& profile) : guard(testGuardKey(), profile) { run(0.0); }
    void step(Microseconds by = kTick) {
        now += by;
        const GuardedPulses all = guard.step(now);
        pulses.assign(all.servos().begin(), all.servos().end());
    }
    void run(double seconds) {
        step(Microseconds{0});
        for (double t = 0.0; t < seconds; t += 0.005) step();
    }
    void armAt(const std::vector<double>& strokes) {
        for (std::size_t i = 0; i < strokes.size(); ++i) guard.setKnown(i, strokes[i]);
        guard.arm(false);
        run(0.2 + 0.2 * static_cast<double>(strokes.size()));
        ASSERT_EQ(guard.phase(), ServoGuard::Phase::live);
    }
    double secondsTo(double stroke) {
        int steps = 0;
        while (std::abs(guard.strokes()[0] - stroke) > 1e-4 && ++steps < 100'000) step();
        return 0.005 * steps;
    }
};

bool want(ServoGuard& guard, std::vector<double> strokes) { return guard.want(strokes); }

TEST(ServoGuard, TakesTheTimeOfATrapezoidAndDoesNotOvershoot) {
    Bench bench(oneServo());
    bench.armAt({0.0});
    ASSERT_TRUE(want(bench.guard, {0.9}));
    double highest = 0.0;
    int steps = 0;
    for (; !bench.guard.settled() && steps < 1000; ++steps) {
        bench.step();
        highest = std::max(highest, bench.pulses[0].microseconds);
    }
    // 0.9 strokes at 1 stroke/s, and half of 1 / 8 s each to speed up and to brake; some ticks to come to rest.
    EXPECT_NEAR(0.005 * steps, 0.9 + 0.125, 0.05);
    EXPECT_NEAR(bench.pulses[0].microseconds, 1900.0, 0.02);
    EXPECT_LE(highest, 1900.0);
}

TEST(ServoGuard, IsSlowerInSlowModeAndBrakesIntoIt) {
    Bench bench(oneServo());
    bench.armAt({0.0});
    want(bench.guard, {1.0});
    bench.run(0.3);
    bench.guard.setSlow(true);
    const double before = bench.pulses[0].microseconds;
    bench.step();
    // From 1 stroke/s down by no more than 8 x 5 ms.
    EXPECT_NEAR(bench.pulses[0].microseconds - before, (1.0 - 8.0 * 0.005) * 5.0, 1e-6);
    bench.run(0.2);
    const double slow = bench.pulses[0].microseconds;
    bench.run(0.1);
    EXPECT_NEAR(bench.pulses[0].microseconds - slow, 0.25 * 1000.0 * 0.1, 2.0);
}

/// Up as well as down, and when it turns back on its way: what speeds up slowly one way must not leap the other.
TEST(ServoGuard, SpeedsUpSlowlyBothWaysInSlowMode) {
    DeviceProfile profile = oneServo();
    profile.slowShare = 0.2;
    const double most = 0.2 * profile.servos[0].maxAcceleration;
    for (const auto& [from, to, back] : {std::tuple{0.1, 0.9, 0.1}, {0.9, 0.1, 0.9}, {0.5, 0.45, 0.55}}) {
        Bench bench(profile);
        bench.armAt({from});
        bench.guard.setSlow(true);
        ASSERT_TRUE(want(bench.guard, {to}));
        double velocity = 0.0;
        double fastest = 0.0;
        for (int i = 0; i < 400; ++i) {
            if (i == 150) {
                ASSERT_TRUE(want(bench.guard, {back}));
            }
            const double before = bench.guard.strokes()[0];
            bench.step();
            const double next = (bench.guard.strokes()[0] - before) / 0.005;
            // Braking may be as hard as ever; only gaining speed is slow.
            const bool gains = next * velocity >= 0.0 ? std::abs(next) > std::abs(velocity) : true;
            const double gained = next * velocity >= 0.0 ? std::abs(next - velocity) : std::abs(next);
            if (gains) {
                ASSERT_LE(gained, most * 0.005 * (1.0 + 1e-6)) << from << " to " << to << ", step " << i;
            }
            velocity = next;
            fastest = std::max(fastest, std::abs(velocity));
        }
        EXPECT_GT(fastest, 0.02);
    }
}

TEST(ServoGuard, StartsServosOneByOneFromWhereTheyAre) {
    Bench bench(profileOf({{.channel = 0}, {.channel = 1}, {.channel = 2, .reversed = true, .trim = 20.0}}));
    for (std::size_t i = 0; i < 3; ++i) bench.guard.setKnown(i, 0.3);
    want(bench.guard, {1.0, 1.0, 1.0});
    bench.guard.arm(false);
    std::vector<double> attachedAt(3, -1.0);
    for (int k = 0; k < 100; ++k) {
        bench.step();
        for (std::size_t i = 0; i < 3; ++i) {
            if (!bench.pulses[i].attached || attachedAt[i] >= 0.0) continue;
            attachedAt[i] = 0.005 * k;
            EXPECT_NEAR(bench.pulses[i].microseconds, i == 2 ? 1720.0 : 1300.0, 1e-9);
        }
    }
    EXPECT_NEAR(attachedAt[0], 0.0, 1e-9);
    EXPECT_NEAR(attachedAt[1], 0.1, 0.0051);
    EXPECT_NEAR(attachedAt[2], 0.2, 0.0102);
    EXPECT_EQ(bench.guard.phase(), ServoGuard::Phase::live);
    bench.run(3.5); // 0.7 strokes, a quarter a second
    // The trim takes 20 us of its stroke at the end.
    EXPECT_NEAR(bench.pulses[2].microseconds, 1020.0, 0.1);
}

TEST(ServoGuard, AsksBeforeAServoJumps) {
    Bench bench(profileOf({{.channel = 0}, {.channel = 1}}));
    bench.guard.setKnown(0, 0.5);
    want(bench.guard, {0.5, 0.8});
    bench.guard.arm(false);
    bench.run(1.0);
    EXPECT_EQ(bench.guard.waiting(), std::vector<std::size_t>{1});
    EXPECT_TRUE(bench.pulses[0].attached);
    EXPECT_FALSE(bench.pulses[1].attached);
    bench.guard.arm(true);
    bench.step();
    EXPECT_TRUE(bench.pulses[1].attached);
    EXPECT_NEAR(bench.pulses[1].microseconds, 1800.0, 1e-9);
    EXPECT_TRUE(bench.guard.waiting().empty());
    EXPECT_FALSE(bench.guard.known(1)) << "it cannot have come there yet";
    bench.run(1.0);
    EXPECT_TRUE(bench.guard.known(1));
}

TEST(ServoGuard, DoesNotStiffenAServoThatIsReadAfterTheStart) {
    Bench bench(profileOf({{.channel = 0}, {.channel = 1}}));
    bench.guard.setKnown(0, 0.5);
    bench.guard.arm(false);
    bench.run(1.0);
    bench.guard.setKnown(1, 0.5);
    bench.run(1.0);
    EXPECT_FALSE(bench.pulses[1].attached);
    EXPECT_TRUE(bench.guard.waiting().empty());
    bench.guard.arm(false);
    bench.run(1.0);
    EXPECT_TRUE(bench.pulses[1].attached);
}

TEST(ServoGuard, StaysStoppedUntilItIsArmed) {
    Bench bench(oneServo());
    bench.armAt({0.2});
    want(bench.guard, {1.0});
    bench.run(0.3);
    const double there = bench.pulses[0].microseconds;
    bench.guard.stop();
    bench.step();
    EXPECT_EQ(bench.pulses[0], (GuardedPulse{3, 0.0, false}));
    want(bench.guard, {0.7});
    bench.guard.disarm();
    EXPECT_FALSE(bench.guard.wiggle(0));
    bench.run(5.0);
    EXPECT_EQ(bench.guard.phase(), ServoGuard::Phase::stopped);
    EXPECT_FALSE(bench.pulses[0].attached);
    bench.guard.arm(false);
    bench.step();
    EXPECT_TRUE(bench.pulses[0].attached);
    EXPECT_NEAR(bench.pulses[0].microseconds, there, 1e-9);
}

TEST(ServoGuard, LetsGoOfAServoBeforeItStartsItAnew) {
    Bench bench(oneServo());
    bench.armAt({0.2});
    want(bench.guard, {1.0});
    bench.run(0.3);
    bench.guard.disarm();
    bench.guard.arm(false); // before anybody was told
    bench.step();
    EXPECT_FALSE(bench.pulses[0].attached) << "else it would stop dead, out of full speed";
    bench.step();
    EXPECT_TRUE(bench.pulses[0].attached);
}

TEST(ServoGuard, WigglesOneServoSlowlyAroundWhereItIs) {
    Bench bench(profileOf({{.channel = 0}, {.channel = 1}}));
    bench.armAt({0.5, 0.5});
    ASSERT_TRUE(bench.guard.wiggle(1));
    double low = 1e9, high = 0.0, fastest = 0.0, last = 1500.0;
    int turns = 0, direction = 0;
    for (int i = 0; i < 2000 && !bench.guard.settled(); ++i) {
        bench.step();
        const double moved = bench.pulses[1].microseconds - last;
        last = bench.pulses[1].microseconds;
        fastest = std::max(fastest, std::abs(moved) / 0.005);
        const int way = moved > 1e-3 ? 1 : moved < -1e-3 ? -1 : direction;
        turns += direction != 0 && way != direction ? 1 : 0;
        direction = way;
        low = std::min(low, last);
        high = std::max(high, last);
        EXPECT_EQ(bench.pulses[0].microseconds, 1500.0);
    }
    EXPECT_TRUE(bench.guard.settled());
    EXPECT_NEAR(low, 1450.0, 1.5);
    EXPECT_NEAR(high, 1550.0, 1.5);
    EXPECT_EQ(turns, 4); // up, down, up, down, back
    EXPECT_LE(fastest, 250.0 + 1e-6);
    EXPECT_NEAR(last, 1500.0, 0.1);
}

/// A trim leaves room beside the strokes of the rig; pressing into the frame is not what a wiggle is for.
TEST(ServoGuard, WigglesWithinTheStrokesOfTheRigWhateverItsTrim) {
    for (const double trim : {120.0, -120.0})
        for (const double at : {0.0, 1.0}) {
            Bench bench(profileOf({{.channel = 3, .trim = trim}}));
            const bool reachable = trim > 0.0 ? at == 0.0 : at == 1.0; // the trim takes room at the other end
            bench.armAt({reachable ? at : at - std::copysign(0.12, trim)});
            ASSERT_TRUE(bench.guard.wiggle(0));
            double low = 1.0;
            double high = 0.0;
            for (int i = 0; i < 1000; ++i) {
                bench.step();
                low = std::min(low, bench.guard.strokes()[0]);
                high = std::max(high, bench.guard.strokes()[0]);
            }
            EXPECT_GE(low, -1e-9) << trim << " at " << at;
            EXPECT_LE(high, 1.0 + 1e-9) << trim << " at " << at;
            EXPECT_GT(high - low, 0.04) << trim << " at " << at;
        }
}

TEST(ServoGuard, RefusesWhatIsNotFiniteOrTheWrongCount) {
    Bench bench(oneServo());
    bench.armAt({0.5});
    ASSERT_TRUE(want(bench.guard, {0.6}));
    for (const std::vector<double>& bad : {std::vector<double>{kNan}, {kInfinity}, {-kInfinity}, {}, {0.1, 0.1}})
        EXPECT_FALSE(want(bench.guard, bad));
    EXPECT_EQ(bench.guard.refused(), 5U);
    EXPECT_TRUE(want(bench.guard, {1e300}));
    EXPECT_EQ(bench.guard.clamped(), 1U);
    bench.run(2.0);
    EXPECT_NEAR(bench.pulses[0].microseconds, 2000.0, 0.1);
    EXPECT_LE(bench.pulses[0].microseconds, 2000.0);
}

TEST(ServoGuard, MovesNothingWhenTimeStandsStillOrRunsBack) {
    Bench bench(oneServo());
    bench.armAt({0.0});
    want(bench.guard, {1.0});
    bench.run(0.2);
    const double before = bench.pulses[0].microseconds;
    bench.step(Microseconds{0});
    bench.step(Microseconds{-900'000});
    EXPECT_EQ(bench.pulses[0].microseconds, before);
    bench.step(Microseconds{3'600'000'000});
    EXPECT_NEAR(bench.pulses[0].microseconds, before + 50.0, 0.5);
}

TEST(ServoGuard, LeavesAServoWhereItIsWhenItsTrimOrLimitsChange) {
    Bench bench(oneServo());
    bench.armAt({1.0});
    want(bench.guard, {1.0});
    bench.run(0.5);
    DeviceProfile drawnIn = oneServo();
    drawnIn.servos[0].pulseMax = 1800.0;
    bench.guard.setProfile(drawnIn);
    double last = 2000.0;
    for (int i = 0; i < 250; ++i) {
        bench.step();
        EXPECT_LE(bench.pulses[0].microseconds, last);
        EXPECT_GE(bench.pulses[0].microseconds, last - 800.0 * 0.005 - 1e-9);
        last = bench.pulses[0].microseconds;
    }
    EXPECT_NEAR(last, 1800.0, 0.1);

    DeviceProfile turned = drawnIn;
    turned.servos[0].reversed = true;
    bench.guard.setProfile(turned);
    bench.step();
    EXPECT_FALSE(bench.pulses[0].attached);
    EXPECT_NEAR(bench.guard.known(0).value_or(kNan), 0.0, 1e-4);

    DeviceProfile moved = turned;
    moved.servos[0].channel = 9;
    bench.guard.setProfile(moved);
    EXPECT_FALSE(bench.guard.known(0));

    moved.servos[0].pulseMax = kNan;
    EXPECT_THROW(bench.guard.setProfile(moved), InvalidInput);
}

// A fast servo of which a number is edited creeps: a quarter of a stroke a second, whatever its velocity.
TEST(ServoGuard, CreepsToWhereOtherPulsesPutAServoThatIsDriven) {
    DeviceProfile fast = oneServo();
    fast.servos[0].maxVelocity = 10.0;
    fast.servos[0].maxAcceleration = 200.0;
    const struct {
        const char* what;
        double pulseMin, pulseMax, trim, ends; // microseconds; 1000 to 2000 before, at full stroke
    } rows[] = {{"wider", 1000.0, 2400.0, 0.0, 2400.0},
                {"narrower", 1000.0, 1500.0, 0.0, 1500.0},
                {"trimmed", 1000.0, 2000.0, -300.0, 1700.0}};
    for (const auto& row : rows) {
        SCOPED_TRACE(row.what);
        Bench bench(fast);
        bench.armAt({1.0});
        want(bench.guard, {1.0});
        bench.run(0.5);
        ASSERT_NEAR(bench.pulses[0].microseconds, 2000.0, 0.1);
        DeviceProfile next = fast;
        next.servos[0].pulseMin = row.pulseMin;
        next.servos[0].pulseMax = row.pulseMax;
        next.servos[0].trim = row.trim;
        bench.guard.setProfile(next);
        const double most = 0.25 * (row.pulseMax - row.pulseMin) * 0.005;
        double last = 2000.0;
        int steps = 0;
        for (; std::abs(last - row.ends) > 0.1 && steps < 5000; ++steps) {
            bench.step();
            ASSERT_LE(std::abs(bench.pulses[0].microseconds - last), most + 1e-9) << steps;
            last = bench.pulses[0].microseconds;
        }
        EXPECT_GE(0.005 * steps, std::abs(row.ends - 2000.0) / (0.25 * (row.pulseMax - row.pulseMin)) - 0.01);
        // Once there it is as fast as ever: half a stroke in a tenth of a second.
        bench.run(0.1);
        want(bench.guard, {0.5});
        EXPECT_LT(bench.secondsTo(0.5), 0.2);
    }
}

TEST(ServoGuard, GoesSlowlyFromWhereItWasAttachedAndThenAsFastAsItMay) {
    DeviceProfile fast = oneServo();
    fast.servos[0].maxVelocity = 10.0;
    fast.servos[0].maxAcceleration = 200.0;
    Bench bench(fast);
    bench.guard.setKnown(0, 0.1);
    want(bench.guard, {0.6});
    bench.guard.arm(false);
    const double seconds = bench.secondsTo(0.6);
    EXPECT_GE(seconds, 2.0) << "half a stroke";
    EXPECT_LE(seconds, 2.6);
    want(bench.guard, {0.1});
    EXPECT_LT(bench.secondsTo(0.1), 0.3);
}

TEST(ServoGuard, CatchesUpWithAShowThatGoesOnAndIsFastFromThere) {
    DeviceProfile fast = oneServo();
    fast.servos[0].maxVelocity = 10.0;
    fast.servos[0].maxAcceleration = 200.0;
    Bench bench(fast);
    bench.guard.setKnown(0, 0.0);
    want(bench.guard, {1.0});
    bench.guard.arm(false);
    bench.run(1.5);
    ASSERT_LT(bench.guard.strokes()[0], 0.4);
    // The show comes by below it, and goes up again.
    want(bench.guard, {0.1});
    bench.run(0.05);
    want(bench.guard, {1.0});
    EXPECT_LT(bench.secondsTo(1.0), 0.5);
}

TEST(ServoGuard, DoesNotLetALimpServoFollowItsLimits) {
    Bench bench(oneServo());
    bench.guard.setKnown(0, 1.0);
    DeviceProfile profile = oneServo();
    // A slider is drawn, a little with each event.
    for (; profile.servos[0].pulseMax > 1800.0; profile.servos[0].pulseMax -= 2.0) bench.guard.setProfile(profile);
    EXPECT_FALSE(bench.guard.known(0)) << "it stands at 2000, not at 1800";
}

TEST(ServoGuard, KnowsNothingOfAServoReadFarOutsideItsLimits) {
    Bench bench(oneServo());
    for (const double bad : {-0.1, 1.1, kNan, kInfinity, 1e300}) {
        bench.guard.setKnown(0, bad);
        EXPECT_FALSE(bench.guard.known(0)) << bad;
    }
    bench.guard.setKnown(0, 1.01);
    EXPECT_EQ(bench.guard.known(0), 1.0);
}

} // namespace
} // namespace lumorph

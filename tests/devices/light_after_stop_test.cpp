#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "core/loop/match_loop.h"
#include "core/motion/rig_motion.h"
#include "devices/controllers/servo_guard.h"
#include "tests/devices/guard_key.h"
#include "tests/support/small_rigs.h"

// Light falls where the servos are, also after the loop stood still: the guard of the link is what knows where they
// are. It gets each command when the loop gives it, and steps on its own meanwhile, as its link does.

namespace lumorph {
namespace {

constexpr double kFrame = 1.0 / 60.0;
constexpr Microseconds kTick{2'000}; // of the guard

Microseconds inTicks(double seconds) { return Microseconds(std::llround(1e6 * seconds)); }

/// One command of the loop, and where it believes the servos when the light comes.
struct Told {
    double seconds;
    std::vector<double> commands, believed;
};

/// Positions of guarded servos over time.
class GuardedServos {
public:
    GuardedServos(const Rig& rig, const std::vector<Told>& told, double until) {
        DeviceProfile profile;
        const std::vector<MotionLimits> limits = motionLimits(rig);
        for (std::size_t i = 0; i < limits.size(); ++i)
            profile.servos.push_back({.channel = static_cast<int>(i), .maxVelocity = limits[i].maxVelocity});
        profile.staggerSeconds = 0.0;
        ServoGuard guard(testGuardKey(), profile);
        for (std::size_t i = 0; i < limits.size(); ++i) guard.setKnown(i, 0.0);
        Microseconds now{0};
        guard.arm(false);
        while (guard.phase() != ServoGuard::Phase::live) (void)guard.step(now += kTick);
        for (int k = 0; k < 1000; ++k) (void)guard.step(now += kTick);
        std::size_t next = 0;
        for (double t = 0.0; t < until; t += 1e-6 * static_cast<double>(kTick.count())) {
            for (; next < told.size() && told[next].seconds <= t; ++next) EXPECT_TRUE(guard.want(told[next].commands));
            (void)guard.step(now += kTick);
            positions_.emplace_back(guard.strokes().begin(), guard.strokes().end());
        }
    }
    [[nodiscard]] double at(double seconds, std::size_t servo) const {
        const double tick = 1e6 * seconds / static_cast<double>(kTick.count());
        const auto last = static_cast<double>(positions_.size() - 1);
        return positions_[static_cast<std::size_t>(std::clamp(std::round(tick), 0.0, last))][servo];
    }

private:
    std::vector<std::vector<double>> positions_;
};

/// By how far light is ahead of the servos, and behind them, strokes.
struct Lead {
    double ahead = 0.0, behind = 0.0;
};

enum class Stop {
    none,
    stalled, ///< the loop's thread was held up
    rested   ///< the loop was paused
};

struct StopCase {
    const char* name;
    double lag;   ///< of all servos, seconds; 0: not measured
    double light; ///< seconds from a frame to its light
};

class LightAfterStop : public testing::TestWithParam<StopCase> {
protected:
    /// Servos go up and, half a second on, are stopped or not; the lead is that of the time after.
    Lead leadWith(Stop stop) const {
        const auto rig = std::make_shared<const Rig>(test::cushionRig());
        Installation room = defaultInstallation();
        room.predictionSeconds = GetParam().light;
        if (GetParam().lag > 0.0)
            for (const Actuator& actuator : rig->actuators())
                room.servos.push_back({.actuator = actuator.name, .points = {}, .lagSeconds = GetParam().lag});
        MatchWish wish;
        wish.rig = rig;
        wish.driver = Driver::hand;
        wish.installation = std::make_shared<const Installation>(room);
        wish.strokes.assign(rig->actuatorCount(), 1.0);
        wish.strokes.back() = 0.6;
        ManualClock clock;
        MatchLoop loop(clock);
        std::vector<Told> told;
        const auto step = [&](double seconds, double counted) {
            clock.advance(inTicks(seconds));
            const auto frame = loop.step(wish, counted);
            told.push_back(
                {1e-6 * static_cast<double>(clock.now().count()), frame->commandedStrokes, frame->estimatedStrokes});
        };
        step(0.0, 0.0);
        for (int k = 0; k < kFramesBefore; ++k) step(kFrame, kFrame);
        EXPECT_GT(told.back().commands.front(), 0.1) << "under way";
        EXPECT_LT(told.back().commands.front(), 0.6);
        const std::size_t first = told.size();
        if (stop == Stop::stalled) step(kStop, kStop);
        if (stop == Stop::rested) {
            loop.rest(kStop - kFrame);
            step(kStop, kFrame);
        }
        for (int k = 0; k < 180; ++k) step(kFrame, kFrame);
        EXPECT_NEAR(told.back().believed.front(), 1.0, 1e-4) << "they arrive";

        const GuardedServos servos(*rig, told, told.back().seconds + 1.0);
        // Without a lag a command is taken to be done when the next one comes.
        const double after = GetParam().lag > 0.0 ? GetParam().light - GetParam().lag : kFrame;
        Lead lead;
        for (std::size_t k = stop == Stop::none ? 0 : first; k < told.size(); ++k)
            for (std::size_t i = 0; i < rig->actuatorCount(); ++i) {
                const double off = told[k].believed[i] - servos.at(told[k].seconds + after, i);
                lead.ahead = std::max(lead.ahead, off);
                lead.behind = std::max(lead.behind, -off);
            }
        return lead;
    }

    static constexpr int kFramesBefore = 24;
    static constexpr double kStop = 3.0;
};

TEST_P(LightAfterStop, IsAsNearTheServosAsWithoutOne) {
    const Lead usual = leadWith(Stop::none);
    for (const Stop stop : {Stop::stalled, Stop::rested}) {
        const Lead lead = leadWith(stop);
        std::printf("%s, %s: ahead by %.3f strokes, behind by %.3f; without a stop %.3f and %.3f\n", GetParam().name,
                    stop == Stop::stalled ? "stalled" : "rested", lead.ahead, lead.behind, usual.ahead, usual.behind);
        EXPECT_LE(lead.ahead, usual.ahead + 0.01) << GetParam().name;
        EXPECT_LE(lead.behind, usual.behind + 0.01) << GetParam().name;
    }
}

INSTANTIATE_TEST_SUITE_P(Servos, LightAfterStop,
                         testing::Values(StopCase{"no lag", 0.0, 0.06}, StopCase{"lag after the light", 0.12, 0.06},
                                         StopCase{"lag before the light", 0.03, 0.1}),
                         [](const auto& row) {
                             std::string name = row.param.name;
                             std::ranges::replace(name, ' ', '_');
                             return name;
                         });

} // namespace
} // namespace lumorph

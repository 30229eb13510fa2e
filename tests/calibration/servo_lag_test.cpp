#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/lab/true_room.h"
#include "core/loop/match_loop.h"
#include "core/scene/measured_servos.h"
#include "tests/support/chain_judge.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/truth.h"

// R26: projected is what fits the device as it stands when the light comes, not as its servos are told to be.

namespace lumorph::test {
namespace {

constexpr double kFramesPerSecond = 60.0;

/// Where the lab's servo is: its horn starts a lag after each command and moves at its speed, its part has play.
class TrueServo {
public:
    TrueServo(MeasuredServo servo, double velocity) : servo_(std::move(servo)), velocity_(velocity) {}
    double at(double seconds, std::span<const double> commands) { // one a frame
        constexpr double kStep = 0.0005;
        for (; now_ < seconds; now_ += kStep) {
            const double frame = (now_ - servo_.lagSeconds) * kFramesPerSecond;
            const double told = frame < 0.0 ? 0.0 : commands[std::min(std::size_t(frame), commands.size() - 1)];
            horn_ += std::clamp(told - horn_, -velocity_ * kStep, velocity_ * kStep);
            part_ = realStroke(servo_, horn_, part_);
        }
        return part_;
    }

private:
    MeasuredServo servo_;
    double velocity_;
    double now_ = 0.0, horn_ = 0.0, part_ = 0.0;
};

/// Flaps that step up and down: what the loop tells servos, and where it believes them when the light comes.
struct SteppedRun {
    std::vector<std::vector<double>> told;     ///< by actuators, one a frame
    std::vector<std::vector<double>> believed; ///< one a frame
};
SteppedRun stepped(const std::shared_ptr<const Rig>& rig, const Installation& room, int frames) {
    SteppedRun run;
    run.told.resize(rig->actuatorCount());
    MatchWish wish;
    wish.rig = rig;
    wish.installation = std::make_shared<const Installation>(room);
    const ManualClock clock;
    MatchLoop loop(clock);
    for (int k = 0; k < frames; ++k) {
        wish.strokes.assign(rig->actuatorCount(), k < frames / 2 ? 0.8 : 0.25);
        const auto frame = loop.step(wish, k == 0 ? 0.0 : 1.0 / kFramesPerSecond);
        run.believed.push_back(frame->estimatedStrokes);
        for (std::size_t i = 0; i < run.told.size(); ++i) run.told[i].push_back(frame->commandedStrokes[i]);
    }
    return run;
}

TEST(ServoLag, AFlapThatStepsIsLitWhereItIs) {
    constexpr int kFrames = 90, kEach = 9;
    const auto rig = std::make_shared<const Rig>(test::cutTablet());
    const Installation truth = trueRoom(defaultInstallation(), rig->actuators(), 3);
    Installation lagless = truth;
    for (MeasuredServo& servo : lagless.servos) servo.lagSeconds = 0.0;
    const SteppedRun with = stepped(rig, truth, kFrames), without = stepped(rig, lagless, kFrames);
    EXPECT_EQ(with.told, without.told) << "servos are told the same";
    std::vector<TrueServo> servos;
    for (std::size_t i = 0; i < rig->actuatorCount(); ++i) {
        servos.emplace_back(truth.servos[i], rig->actuators()[i].maxVelocity);
        std::printf("%s: moves %.0f ms after its command, light comes %.0f ms after its frame\n",
                    rig->actuators()[i].name.c_str(), 1e3 * truth.servos[i].lagSeconds, 1e3 * truth.predictionSeconds);
    }
    ShownError lit, litWithout;
    for (int k = 0; k < kFrames; ++k) {
        std::vector<double> real;
        for (std::size_t i = 0; i < servos.size(); ++i)
            real.push_back(servos[i].at(k / kFramesPerSecond + truth.predictionSeconds, with.told[i]));
        const bool moves = without.believed[std::size_t(k)] != without.believed[std::size_t(std::max(k - 8, 0))];
        if (!moves || k % kEach != 0) continue;
        lit.add(lightBeside(rig, truth, with.believed[std::size_t(k)], real));
        litWithout.add(lightBeside(rig, truth, without.believed[std::size_t(k)], real));
    }
    std::printf("while flaps move, light on the skin is %.2f mm beside (95 %%: %.2f), without lags %.2f (%.2f)\n",
                meanOf(lit.skinMillimetres), quantileOf(lit.skinMillimetres, 0.95), meanOf(litWithout.skinMillimetres),
                quantileOf(litWithout.skinMillimetres, 0.95));
    EXPECT_GT(lit.skinMillimetres.size(), 1000U);
    EXPECT_LE(meanOf(lit.skinMillimetres), 0.5 * meanOf(litWithout.skinMillimetres));
}

} // namespace
} // namespace lumorph::test

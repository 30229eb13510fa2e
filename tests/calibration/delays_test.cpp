#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <random>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/lab/board_lab.h"
#include "calibration/lab/tracker_lab.h"
#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"
#include "core/loop/viewer_stage.h"
#include "core/scene/measured_servos.h"
#include "tests/calibration/measured_stage.h"
#include "tests/calibration/tracked_motion.h"
#include "tests/support/cut_tablet.h"

namespace lumorph {
namespace {

using test::measuredInLab;

bool delaysTakeLong() { return std::getenv("LUMORPH_LONG_TESTS") != nullptr; }

const Rig& delayTablet() {
    static const Rig rig = test::cutTablet();
    return rig;
}

template <typename Run> std::string causeIn(const Run& run) {
    try {
        (void)run();
    } catch (const CaptureRefused& refused) {
        return std::string(keyOf(refused.finding().cause));
    }
    return "";
}

/// Errors in units of the sigma that was said, and their size.
struct Spread {
    double square = 0.0, worst = 0.0, sigma = 0.0, bias = 0.0, count = 0.0;
    void add(double error, double said) {
        square += error * error / (said * said);
        worst = std::max(worst, std::abs(error));
        sigma = std::max(sigma, said);
        bias += error;
        count += 1.0;
    }
    [[nodiscard]] double inSigmas() const { return std::sqrt(square / count); }
    void print(const char* what) const {
        std::printf("%-10s %3.0f runs: worst %.2f ms, mean %+.2f ms, sigma at most %.2f ms, errors %.2f sigmas\n", what,
                    count, 1e3 * worst, 1e3 * bias / count, 1e3 * sigma, inSigmas());
    }
};

Installation roomWithDelays(double light, double tracker) {
    Installation room = withLabCamera(defaultInstallation());
    room.predictionSeconds = light;
    room.trackerSeconds = tracker;
    return room;
}

TEST(FlashDelay, IsWithinTwoMillisecondsByACameraOfThirtyPictures) {
    Spread spread;
    const int seeds = delaysTakeLong() ? 200 : 30;
    for (int seed = 1; seed <= seeds; ++seed) {
        DelaysLabOptions options;
        options.flashes = 24;
        options.readout = seed % 2 == 0 ? 0.018 : 0.0; // rolling and global shutters
        options.exposure = seed % 3 == 0 ? 0.004 : seed % 3 == 1 ? 0.01 : 0.025;
        if (seed % 5 == 0) options.fault = DelayFault::framesLost; // does no harm
        const double truth = 0.02 + 0.0037 * (seed % 40);
        const MeasuredDelay delay = solveFlashDelay(recordFlashesInLab(roomWithDelays(truth, 0.0), seed, options));
        spread.add(delay.seconds - truth, delay.sigma);
        EXPECT_LT(std::abs(delay.seconds - truth), 0.002) << "seed " << seed;
        EXPECT_LT(delay.sigma, 0.001) << "seed " << seed;
        EXPECT_GE(delay.events, 20);
    }
    spread.print("flash");
    EXPECT_GT(spread.inSigmas(), 0.6);
    EXPECT_LT(spread.inSigmas(), 1.5);
    EXPECT_LT(std::abs(spread.bias / spread.count), 0.0003);
}

TEST(FlashDelay, NamesWhatIsWrong) {
    const Installation room = roomWithDelays(0.07, 0.0);
    const auto with = [&](DelayFault fault) {
        DelaysLabOptions options;
        options.fault = fault;
        return recordFlashesInLab(room, 3, options);
    };
    EXPECT_EQ(causeIn([&] { return solveFlashDelay(with(DelayFault::cameraSlow)); }), "camera_slow");
    EXPECT_EQ(causeIn([&] { return solveFlashDelay(with(DelayFault::lightCovered)); }), "flash_not_seen");
    FlashRecording few = with(DelayFault::none);
    std::erase_if(few.pictures, [](const auto& picture) { return picture.seconds > 1.5; });
    EXPECT_EQ(causeIn([&] { return solveFlashDelay(few); }), "too_few_views");
    FlashRecording even = with(DelayFault::none);
    FlashRecording broken = even;
    broken.pictures[40].brightness = std::nan("");
    EXPECT_EQ(causeIn([&] { return solveFlashDelay(broken); }), "not_a_number");
    broken = even;
    broken.pictures[40].seconds -= 1.0;
    EXPECT_EQ(causeIn([&] { return solveFlashDelay(broken); }), "clock_jumps");
    // Flashes that come as evenly as a clock: any of them may be the one that is seen.
    even.flashes.clear();
    for (int k = 0; k < 60; ++k) even.flashes.push_back({0.5 + 0.2 * k, 0.6 + 0.2 * k});
    for (auto& picture : even.pictures)
        picture.brightness = std::fmod(picture.seconds - 0.57 + 20.0, 0.2) < 0.1 ? 180.0 : 20.0;
    EXPECT_EQ(causeIn([&] { return solveFlashDelay(even); }), "motion_periodic");
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)solveFlashDelay(with(DelayFault::none), Progress({}, stop.get_token())), Cancelled);
}

TEST(MarkDelay, IsWhatTrackerAndLightComeTo) {
    Spread spread;
    const int seeds = delaysTakeLong() ? 60 : 8;
    for (int seed = 1; seed <= seeds; ++seed) {
        const double light = 0.03 + 0.004 * (seed % 20), tracker = 0.002 * (seed % 9);
        DelaysLabOptions options;
        if (seed % 4 == 0) options.fault = DelayFault::framesLost;
        const MeasuredDelay delay = solveMarkDelay(recordMarkInLab(roomWithDelays(light, tracker), seed, options));
        spread.add(delay.seconds - light - tracker, delay.sigma);
        EXPECT_LT(std::abs(delay.seconds - light - tracker), 0.002) << "seed " << seed;
        EXPECT_LT(delay.sigma, 0.0015) << "seed " << seed;
    }
    spread.print("mark");
    EXPECT_LT(spread.inSigmas(), 2.0);
}

TEST(MarkDelay, NamesWhatIsWrong) {
    const Installation room = roomWithDelays(0.07, 0.01);
    DelaysLabOptions options;
    options.fault = DelayFault::nothingMoves;
    EXPECT_EQ(causeIn([&] { return solveMarkDelay(recordMarkInLab(room, 3, options)); }), "nothing_moves");
    MarkRecording other = recordMarkInLab(room, 3);
    for (auto& picture : other.pictures) picture.mark = {0.1 * std::sin(7.0 * picture.seconds), 0.0, 0.0};
    EXPECT_EQ(causeIn([&] { return solveMarkDelay(other); }), "model_does_not_fit");
    MarkRecording even = recordMarkInLab(room, 3);
    for (auto& picture : even.pictures) {
        const auto at = [](double t) { return glm::dvec3(0.05 * std::sin(20.0 * t), 0.0, 0.0); };
        picture.body = at(picture.seconds);
        picture.mark = at(picture.seconds - 0.08);
    }
    EXPECT_EQ(causeIn([&] { return solveMarkDelay(even); }), "motion_periodic");
}

BoardCapture boardInLab(const Installation& room, std::uint32_t seed, TrackerFault fault = TrackerFault::none,
                        const glm::dvec3& turns = glm::dvec3(0.5)) {
    TrackerLab lab(room, seed, {}, {}, fault);
    return lab.moveBoard(room.cameras.front().camera, parseCalibrationBoard("chess:9x7:20"), 0.001, turns, 30.0,
                         -room.trackerSeconds);
}

TEST(TrackerDelay, IsFoundByTheSameBodyInTheCamera) {
    Spread spread;
    const int seeds = delaysTakeLong() ? 40 : 4;
    for (int seed = 1; seed <= seeds; ++seed) {
        const Installation room = roomWithDelays(0.07, 0.003 * (seed % 12));
        const BoardCapture capture = boardInLab(room, seed);
        const MeasuredDelay delay = solveTrackerDelay(capture.body, capture.board);
        spread.add(delay.seconds - room.trackerSeconds, delay.sigma);
        EXPECT_LT(std::abs(delay.seconds - room.trackerSeconds), 0.002) << "seed " << seed;
        EXPECT_LT(delay.sigma, 0.001) << "seed " << seed;
    }
    spread.print("tracker");
    EXPECT_LT(spread.inSigmas(), 2.0);
}

TEST(TrackerDelay, AHalfThatTellsNothingIsNotAHalfThatAgrees) {
    const test::HandMotion hand(71);
    const Pose worldB{{0.4, -0.2, 1.1}, rotationOfTurn({0.3, 1.2, -0.4})};
    const Pose aFromB{{0.02, 0.05, -0.03}, rotationOfTurn({0.1, -0.5, 0.2})};
    for (const bool stops : {true, false}) {
        const auto at = [&](double seconds) { return hand.at(stops ? std::min(seconds, 18.0) : seconds); };
        const PoseTrack tracker = test::trackOf(at, 40.0, 60.0, 72);
        const PoseTrack camera =
            test::trackOf([&](double t) { return worldB * at(t + 0.0123) * aFromB; }, 40.0, 15.0, 73);
        const MeasuredDelay delay = solveTrackerDelay(tracker, camera);
        EXPECT_NEAR(delay.seconds, 0.0123, 0.002);
        EXPECT_EQ(delay.halvesDiffer.has_value(), !stops);
        EXPECT_GT(delay.sigma, 0.0);
    }
}

TEST(TrackerDelay, NamesWhatIsWrong) {
    const Installation room = roomWithDelays(0.07, 0.012);
    const auto cause = [&](const BoardCapture& capture) {
        return causeIn([&] { return solveTrackerDelay(capture.body, capture.board); });
    };
    EXPECT_EQ(cause(boardInLab(room, 2, TrackerFault::dropsOut)), "tracker_lost");
    EXPECT_EQ(cause(boardInLab(room, 2, TrackerFault::clockJumpsBack)), "clock_jumps");
    EXPECT_EQ(cause(boardInLab(room, 2, TrackerFault::notANumber)), "not_a_number");
    EXPECT_EQ(cause(boardInLab(room, 2, TrackerFault::none, glm::dvec3(0.0))), "nothing_moves");
    BoardCapture slow = boardInLab(room, 2);
    for (std::size_t k = slow.board.poses.size(); k-- > 0;)
        if (k % 4 != 0) slow.board.poses.erase(slow.board.poses.begin() + static_cast<std::ptrdiff_t>(k));
    EXPECT_EQ(cause(slow), "camera_slow");
    BoardCapture other = boardInLab(room, 2);
    for (TimedPose& at : other.board.poses) at.seconds += 3.0;
    EXPECT_EQ(cause(other), "clock_jumps");
}

/// A servo by an equation of its own, apart from the lab's: where a part is so long after a command.
StepRecording stepsOf(double lag, double velocity, double play, unsigned seed, double rate = 30.0,
                      double noise = 0.006) {
    StepRecording recording;
    recording.servo = "flap";
    recording.steps = planSteps(velocity, 0.3, seed);
    std::mt19937 dice(seed);
    std::normal_distribution<double> normal(0.0, noise);
    const double phase = std::uniform_real_distribution<double>(0.0, 1.0 / rate)(dice);
    double horn = 0.0, part = 0.0, now = 0.0;
    for (double t = phase; t < recording.steps.back().seconds + 1.4; t += 1.0 / rate) {
        for (; now < t; now += 2e-4) {
            double goal = 0.0;
            for (const auto& step : recording.steps)
                if (step.seconds + lag <= now) goal = step.commanded;
            horn += std::clamp(goal - horn, -velocity * 2e-4, velocity * 2e-4);
            part = std::clamp(part, horn - 0.5 * play, horn + 0.5 * play);
        }
        recording.samples.push_back({t, part + normal(dice)});
    }
    return recording;
}

TEST(StepLag, IsWithinTenMillisecondsWhateverThePlay) {
    Spread spread;
    const int seeds = delaysTakeLong() ? 20 : 2;
    for (int seed = 1; seed <= seeds; ++seed)
        for (const double lag : {0.03, 0.12, 0.25})
            for (const double velocity : {1.0, 4.0})
                for (const double play : {0.0, 0.022, 0.03}) {
                    const StepLag found = solveStepLag(stepsOf(lag, velocity, play, seed));
                    spread.add(found.lag.seconds - lag, found.lag.sigma);
                    EXPECT_LT(std::abs(found.lag.seconds - lag), 0.01)
                        << lag << " s, " << velocity << " /s, play " << play << ", seed " << seed;
                    EXPECT_LT(found.lag.sigma, 0.006);
                    EXPECT_NEAR(found.velocity, velocity, 0.1 * velocity);
                    EXPECT_NEAR(found.play, play, 0.015);
                }
    spread.print("steps");
    EXPECT_LT(spread.inSigmas(), 2.0);
}

TEST(StepLag, NamesAServoThatIsDeadReversedOrJammed) {
    const auto cause = [](StepRecording recording, double (*made)(double)) {
        for (auto& sample : recording.samples) sample.stroke = made(sample.stroke);
        return causeIn([&] { return solveStepLag(recording); });
    };
    const StepRecording sound = stepsOf(0.1, 2.0, 0.02, 1);
    EXPECT_EQ(cause(sound, [](double) { return 0.3; }), "servo_dead");
    EXPECT_EQ(cause(sound, [](double stroke) { return 1.0 - stroke; }), "servo_reversed");
    EXPECT_EQ(cause(sound, [](double stroke) { return std::min(stroke, 0.6); }), "servo_jammed");
    EXPECT_EQ(cause(sound, [](double) { return std::numeric_limits<double>::quiet_NaN(); }), "not_a_number");
    EXPECT_EQ(causeIn([] { return solveStepLag(stepsOf(0.1, 2.0, 0.02, 1, 8.0)); }), "camera_slow");
    StepRecording few = sound;
    std::erase_if(few.samples, [](const auto& sample) { return sample.seconds > 3.0; });
    EXPECT_EQ(causeIn([&] { return solveStepLag(few); }), "too_few_views");
}

TEST(DelaysLab, AllDelaysComeOutAsTheLabHasThem) {
    const int seeds = delaysTakeLong() ? 12 : 1;
    for (int seed = 1; seed <= seeds; ++seed) {
        const Installation believed = withLabCamera(defaultInstallation());
        const Installation truth = trueRoom(believed, delayTablet().actuators(), seed);
        const auto delays = measuredInLab<MeasuredDelays>("delays", delayTablet(), believed, truth, seed);
        ASSERT_TRUE(delays.good()) << delays.summary;
        std::printf("%s It takes %.0f s.\n", delays.summary.c_str(), delays.seconds);
        std::printf("  light %+.2f ms (sigma %.2f), tracker %+.2f (%.2f), mark %+.2f (%.2f)\n",
                    1e3 * (delays.light.seconds - truth.predictionSeconds), 1e3 * delays.light.sigma,
                    1e3 * (delays.tracker.seconds - truth.trackerSeconds), 1e3 * delays.tracker.sigma,
                    1e3 * (delays.mark.seconds - truth.predictionSeconds - truth.trackerSeconds),
                    1e3 * delays.mark.sigma);
        const Installation& room = delays.installation;
        EXPECT_NEAR(room.predictionSeconds, truth.predictionSeconds, 0.002);
        EXPECT_NEAR(room.trackerSeconds, truth.trackerSeconds, 0.002);
        EXPECT_EQ(room.origins.delays.way, Origin::Way::simulated);
        ASSERT_EQ(delays.servos.size(), delayTablet().actuatorCount());
        ASSERT_EQ(room.servos.size(), delayTablet().actuatorCount());
        for (std::size_t i = 0; i < room.servos.size(); ++i) {
            std::printf("  %-14s lag %6.1f ms, truth %6.1f, sigma %.1f, %.2f /s, play %.3f\n",
                        room.servos[i].actuator.c_str(), 1e3 * room.servos[i].lagSeconds,
                        1e3 * truth.servos[i].lagSeconds, 1e3 * delays.servos[i].step.lag.sigma,
                        delays.servos[i].step.velocity, delays.servos[i].step.play);
            EXPECT_EQ(room.servos[i].actuator, truth.servos[i].actuator);
            EXPECT_NEAR(room.servos[i].lagSeconds, truth.servos[i].lagSeconds, 0.01);
            EXPECT_TRUE(room.servos[i].points.empty()) << "a lag makes no curve";
        }
        std::printf("  slip %.1f mm, without prediction %.1f mm; at speed %.1f and %.1f mm\n",
                    1e3 * delays.gain->with.always, 1e3 * delays.gain->without.always, 1e3 * delays.gain->with.atSpeed,
                    1e3 * delays.gain->without.atSpeed);
        EXPECT_LE(delays.gain->with.always, 0.5 * delays.gain->without.always);
        EXPECT_NO_THROW(checkInstallation(room));
        // All else stays as it was.
        Installation back = room;
        takeDelays(believed, back);
        back.servos.clear();
        EXPECT_EQ(back, believed);
    }
}

// A connected camera records flashes alone: no board, mark or servo steps.
TEST(DelaysLab, FlashesAloneTimeTheLightAndLeaveAllElse) {
    Installation believed = withLabCamera(defaultInstallation());
    believed.trackerSeconds = 0.005;
    DelaysCapture capture;
    capture.flashes = recordFlashesInLab(roomWithDelays(0.083, 0.012), 9);
    const MeasuredDelays clocked = solveDelays(delayTablet(), believed, capture);
    ASSERT_TRUE(clocked.good()) << clocked.summary;
    EXPECT_TRUE(clocked.isOfLightAlone());
    EXPECT_NEAR(clocked.installation.predictionSeconds, 0.083, 0.002);
    EXPECT_EQ(clocked.installation.trackerSeconds, 0.005);
    EXPECT_TRUE(clocked.installation.servos.empty());
    ASSERT_EQ(clocked.warnings.size(), 1U) << "it says what stays";
    capture.flashes.arrivalSigma = 0.03;
    const StageSite site{std::make_shared<const Rig>(delayTablet()), believed};
    const StageRecording kept = stages::recordingOf(capture, {});
    const auto late = solveDelays(delayTablet(), believed, stages::delaysOf(kept));
    EXPECT_EQ(late.light.seconds, clocked.light.seconds);
    EXPECT_GT(late.light.sigma, 0.03) << "the times of a camera without a clock";
    EXPECT_EQ(late.warnings.size(), 2U);
}

/// What is wrong shows in short recordings too.
LabBenchOptions briefly() {
    LabBenchOptions options;
    options.delays.flashes = 16;
    options.delays.markSeconds = 8.0;
    options.delays.boardSeconds = 15.0;
    return options;
}

struct FaultOfDelays {
    const char* fault;
    const char* cause;
};

TEST(DelaysLab, NamesAFaultAndKeepsNothing) {
    const Installation believed = withLabCamera(defaultInstallation());
    const Installation truth = trueRoom(believed, delayTablet().actuators(), 4);
    for (const FaultOfDelays& row : {FaultOfDelays{"camera", "too_few_views"},
                                     {"slow", "camera_slow"},
                                     {"covered", "flash_not_seen"},
                                     {"tracker", "tracker_lost"},
                                     {"still", "nothing_moves"},
                                     {"dead", "servo_dead"},
                                     {"jammed", "servo_jammed"}}) {
        LabBenchOptions options = briefly();
        options.delays.fault = parseDelayFault(row.fault);
        const auto delays = measuredInLab<MeasuredDelays>("delays", delayTablet(), believed, truth, 4, options);
        ASSERT_TRUE(delays.refusal) << row.fault << ": " << delays.summary;
        EXPECT_EQ(keyOf(delays.refusal->cause), row.cause) << row.fault << ": " << delays.summary;
        EXPECT_EQ(delays.installation, believed) << row.fault;
    }
    LabBenchOptions lost = briefly();
    lost.delays.fault = DelayFault::framesLost;
    EXPECT_TRUE(measuredInLab<MeasuredDelays>("delays", delayTablet(), believed, truth, 4, lost).good())
        << "lost pictures do no harm";
    EXPECT_THROW((void)parseDelayFault("tired"), InvalidInput);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)measuredInLab<MeasuredDelays>("delays", delayTablet(), believed, truth, 4, {},
                                                     Progress({}, stop.get_token())),
                 Cancelled);
}

TEST(PredictionGain, IsThatOfAMotionThatIsWorkedOutApart) {
    // Without prediction light is late by all delays: at its fastest the hand leaves it behind by speed times delay.
    const Installation room = roomWithDelays(0.06, 0.01);
    CarriedDevice exact;
    exact.noiseMetres = exact.noiseRadians = 0.0;
    for (const double speed : {0.1, 0.3}) {
        exact.speed = speed;
        const PredictionGain gain = predictionGain(room, room, exact);
        EXPECT_NEAR(gain.without.atSpeed, speed * 0.07, 0.06 * speed * 0.07);
        EXPECT_LT(gain.with.atSpeed, 0.35 * gain.without.atSpeed);
        EXPECT_LT(gain.without.always, gain.without.atSpeed);
    }
    // Delays that are believed wrongly are worth less.
    Installation wrong = room;
    wrong.predictionSeconds = 0.03;
    EXPECT_GT(predictionGain(wrong, room).with.always, 1.4 * predictionGain(room, room).with.always);
    Installation none = room;
    none.predictionSeconds = 0.0;
    const PredictionGain off = predictionGain(none, room);
    EXPECT_EQ(off.with.always, off.without.always);
    exact.speed = 0.0;
    EXPECT_THROW((void)predictionGain(room, room, exact), InvalidInput);
}

} // namespace
} // namespace lumorph

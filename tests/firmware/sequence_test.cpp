#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "devices/firmware/board_sequence.h"
#include "tests/firmware/board.h"
#include "tests/firmware/firmata_bytes.h"
#include "tests/firmware/twelve.h"

// Pulses on the wire against strokesAt of the core: the board knows only its table of pulses and whole numbers.

namespace lumorph::firmware_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kFrame = 20.0;     // milliseconds
constexpr double kResolution = 4.0; // microseconds: rounding here and there, and the edge's own error
constexpr int kButton = 10;

/// Widths by pin and frame, counted from the one in which `begin` lies; 0: no pulse. Frames begin with the sketch.
class Widths {
public:
    Widths(const std::vector<Pulse>& pulses, double begin) {
        begin = kFrame * std::floor(begin / kFrame);
        for (const Pulse& pulse : pulses) {
            const auto frame = static_cast<long>(std::floor((pulse.start - begin) / kFrame));
            if (frame < 0) continue;
            std::vector<double>& row = rows_[pulse.pin];
            row.resize(std::max(row.size(), static_cast<std::size_t>(frame) + 1), 0.0);
            row[static_cast<std::size_t>(frame)] = pulse.width;
        }
    }
    [[nodiscard]] double at(int pin, std::size_t frame) const {
        const auto row = rows_.find(pin);
        return row != rows_.end() && frame < row->second.size() ? row->second[frame] : 0.0;
    }
    [[nodiscard]] std::size_t frames() const {
        std::size_t most = 0;
        for (const auto& [pin, row] : rows_) most = std::max(most, row.size());
        return most;
    }

private:
    std::map<int, std::vector<double>> rows_;
};

/// The largest difference to the plan where it begins with frame `start`, microseconds, over `count` frames.
double worstOf(const Widths& widths, const DeviceProfile& profile, const PoseSequence& sequence,
               const std::vector<double>& from, std::size_t start, std::size_t count) {
    double worst = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const std::vector<double> strokes = strokesAt(sequence, from, 1e-3 * kFrame * (static_cast<double>(k) + 1e-6));
        for (std::size_t s = 0; s < profile.servos.size(); ++s)
            worst = std::max(worst, std::abs(widths.at(profile.servos[s].channel, start + k) -
                                             pulseOf(profile.servos[s], strokes[s])));
    }
    return worst;
}

struct Fit {
    double worst = 1e9;
    std::size_t start = 0;
};
/// The start that fits best among the frames from `first` on.
Fit bestFit(const Widths& widths, const DeviceProfile& profile, const PoseSequence& sequence,
            const std::vector<double>& from, std::size_t first, std::size_t last, std::size_t count) {
    Fit best;
    for (std::size_t start = first; start <= last; ++start) {
        const double worst = worstOf(widths, profile, sequence, from, start, count);
        if (worst < best.worst) best = {worst, start};
    }
    return best;
}

/// No pulse beyond its limits; no speed and no acceleration beyond the profile's, but for what whole microseconds and
/// the edges' error make of them.
void expectWithinLimits(const Widths& widths, const DeviceProfile& profile) {
    for (const ServoSetup& servo : profile.servos) {
        const double range = servo.pulseMax - servo.pulseMin;
        const double most = servo.maxVelocity * range * 1e-3 * kFrame;
        const double change = servo.maxAcceleration * range * 1e-6 * kFrame * kFrame;
        double speed = 0.0, jerk = 0.0;
        for (std::size_t k = 0; k < widths.frames(); ++k) {
            const double now = widths.at(servo.channel, k);
            if (now == 0.0) continue;
            EXPECT_GE(now, servo.pulseMin);
            EXPECT_LE(now, servo.pulseMax);
            const double before = k >= 1 ? widths.at(servo.channel, k - 1) : 0.0;
            if (before == 0.0) continue;
            speed = std::max(speed, std::abs(now - before));
            const double earlier = k >= 2 ? widths.at(servo.channel, k - 2) : 0.0;
            if (earlier != 0.0) jerk = std::max(jerk, std::abs(now - 2.0 * before + earlier));
        }
        EXPECT_LE(speed, most + kResolution) << "channel " << servo.channel;
        EXPECT_LE(jerk, change + 2.0 * kResolution) << "channel " << servo.channel;
    }
}

class FirmwareSequence : public testing::TestWithParam<int> {};

TEST_P(FirmwareSequence, AButtonPlaysThePosesAsTheCoreReckonsThem) {
    const Variant variant = variantOf("button");
    const BoardPlan plan = planForBoard(variant.profile, *variant.poses);
    Board board("button", GetParam());
    board.setButton(kButton, false);
    board.run(5000.0);
    EXPECT_THAT(board.takePulses(), IsEmpty()) << "nobody has pressed yet";
    const double begin = board.now();
    board.setButton(kButton, true);
    board.run(70.0);
    board.setButton(kButton, false);
    const double seconds = durationOf(plan.sequence);
    board.run(1e3 * seconds + 3000.0);
    const Widths widths(board.takePulses(), begin);
    // One servo after the other, each where the plan begins.
    std::vector<std::size_t> starts;
    for (std::size_t s = 0; s < variant.profile.servos.size(); ++s) {
        const int pin = variant.profile.servos[s].channel;
        std::size_t first = 0;
        while (first < widths.frames() && widths.at(pin, first) == 0.0) ++first;
        EXPECT_NEAR(widths.at(pin, first), pulseOf(variant.profile.servos[s], plan.from[s]), kResolution);
        if (!starts.empty()) {
            EXPECT_GE(first, starts.back() + 5U);
        }
        starts.push_back(first);
    }
    const auto frames = static_cast<std::size_t>(std::ceil(50.0 * seconds)) + 20U; // and it stays in its last pose
    const Fit fit =
        bestFit(widths, variant.profile, plan.sequence, plan.from, starts.back(), starts.back() + 20U, frames);
    RecordProperty("worst", std::to_string(fit.worst));
    EXPECT_LE(fit.worst, kResolution);
    expectWithinLimits(widths, variant.profile);

    // Once more, from the last pose on.
    const double again = board.now();
    board.setButton(kButton, true);
    board.run(100.0);
    board.setButton(kButton, false);
    board.run(1e3 * seconds + 1500.0);
    const Widths second(board.takePulses(), again);
    const std::vector<double> last = strokesAt(plan.sequence, plan.from, 1e6);
    EXPECT_LE(bestFit(second, variant.profile, plan.sequence, last, 1U, 15U, frames).worst, kResolution);
    expectWithinLimits(second, variant.profile);
}

TEST_P(FirmwareSequence, PressedWhileItPlaysTheServosAreLetGoAndGoOnFromThere) {
    const Variant variant = variantOf("button");
    Board board("button", GetParam());
    const auto press = [&] {
        board.setButton(kButton, true);
        board.run(90.0);
        board.setButton(kButton, false);
        board.run(60.0);
    };
    board.setButton(kButton, false);
    board.run(1000.0);
    press();
    board.run(2600.0); // on its way
    press();
    (void)board.takePulses();
    board.run(500.0);
    EXPECT_THAT(board.takePulses(), IsEmpty());
    const double begin = board.now();
    press();
    board.run(6000.0);
    const Widths widths(board.takePulses(), begin);
    EXPECT_GT(widths.frames(), 200U);
    expectWithinLimits(widths, variant.profile);
    // A bounce shorter than a frame is no press.
    board.setButton(kButton, true);
    board.run(5.0);
    board.setButton(kButton, false);
    board.run(100.0);
    (void)board.takePulses();
    board.run(100.0);
    EXPECT_FALSE(board.takePulses().empty());
}

TEST_P(FirmwareSequence, TheFirstByteOfAComputerTakesOver) {
    Board board("button", GetParam());
    board.setButton(kButton, false);
    board.run(1000.0);
    board.setButton(kButton, true);
    board.run(100.0);
    board.setButton(kButton, false);
    board.run(2500.0);
    ASSERT_FALSE(board.takePulses().empty());
    board.send({0xF9});
    board.runUntilSent();
    board.run(21.0); // the frame that was laid out already
    (void)board.takePulses();
    board.run(60.0);
    EXPECT_THAT(board.takePulses(), IsEmpty());
    // It speaks as to a board that has just started: nothing moves until it is told to, and then it is held.
    board.setButton(kButton, true);
    board.run(100.0);
    board.setButton(kButton, false);
    board.send(write(5, 1500));
    board.send(attach(5));
    board.runUntilSent();
    board.run(60.0);
    (void)board.takePulses();
    board.run(200.0);
    const std::vector<Pulse> pulses = board.takePulses();
    ASSERT_FALSE(pulses.empty());
    for (const Pulse& pulse : pulses) {
        EXPECT_EQ(pulse.pin, 5);
        EXPECT_NEAR(pulse.width, 1500.0, kResolution);
    }
    // Half a second after it has gone silent, the button works again.
    board.run(700.0);
    (void)board.takePulses();
    board.setButton(kButton, true);
    board.run(100.0);
    board.setButton(kButton, false);
    board.run(2500.0);
    EXPECT_FALSE(board.takePulses().empty());
}

TEST_P(FirmwareSequence, FromPowerOnItLoopsWhereNoComputerSpeaks) {
    const Variant variant = variantOf("power");
    const BoardPlan plan = planForBoard(variant.profile, *variant.poses);
    EXPECT_TRUE(plan.sequence.loop);
    Board board("power", GetParam());
    board.run(2900.0);
    EXPECT_THAT(board.takePulses(), IsEmpty()) << "a computer may still speak";
    const double begin = board.now();
    const double round = durationOf(plan.sequence);
    board.run(1e3 * 3.0 * round + 1000.0);
    const Widths widths(board.takePulses(), begin);
    const auto frames = static_cast<std::size_t>(50.0 * 3.0 * round) - 5U;
    EXPECT_LE(bestFit(widths, variant.profile, plan.sequence, plan.from, 10U, 45U, frames).worst, kResolution);
    expectWithinLimits(widths, variant.profile);
    board.send({0xFF});
    board.runUntilSent();
    board.run(21.0);
    (void)board.takePulses();
    board.run(5000.0);
    EXPECT_THAT(board.takePulses(), IsEmpty()) << "it does not begin again until power comes anew";
}

TEST_P(FirmwareSequence, AComputerThatSpeaksEarlyKeepsItFromBeginning) {
    Board board("power", GetParam());
    board.run(1000.0);
    board.send({0xF9});
    board.run(6000.0);
    EXPECT_THAT(board.takePulses(), IsEmpty());
}

TEST_P(FirmwareSequence, AfterAHangItDoesNotBeginByItself) {
    Board board("power", GetParam());
    board.run(5000.0);
    ASSERT_FALSE(board.takePulses().empty());
    board.hang(true);
    board.run(700.0);
    (void)board.takePulses();
    board.run(5000.0);
    EXPECT_THAT(board.takePulses(), IsEmpty());
}

TEST_P(FirmwareSequence, TheLongestOneFitsTheBoard) {
    const BoardPlan plan = planForBoard(variantOf("full").profile, *variantOf("full").poses);
    EXPECT_EQ(plan.bytes, kMostSequenceBytes);
    const Board board("full", GetParam());
    const std::size_t sketch = Board("twelve", GetParam()).flashBytes();
    RecordProperty("flash", std::to_string(board.flashBytes()));
    EXPECT_LE(board.flashBytes(), 30'720U) << "of a Pro Mini beside its bootloader";
    EXPECT_GE(board.flashBytes(), plan.bytes) << "the table lies in flash";
    EXPECT_LE(sketch, 5'500U) << "without poses nothing of them is there";
}

INSTANTIATE_TEST_SUITE_P(Clocks, FirmwareSequence, testing::Values(8, 16));

TEST(BoardSequence, SaysWhatItChanges) {
    const Variant variant = variantOf("button");
    const BoardPlan plan = planForBoard(variant.profile, *variant.poses);
    EXPECT_EQ(plan.sequence.poses.size(), 2U) << "a pose that no step names needs no room";
    ASSERT_EQ(plan.notes.size(), 2U);
    EXPECT_THAT(plan.notes[0], HasSubstr("smoothly in step 3."));
    EXPECT_THAT(plan.notes[1], HasSubstr("steps 1, 3 and 5."));
    for (const PoseStep& step : plan.sequence.steps) {
        EXPECT_NEAR(std::remainder(step.travelSeconds, 0.02), 0.0, 1e-9);
        EXPECT_NEAR(std::remainder(step.holdSeconds, 0.02), 0.0, 1e-9);
    }
}

TEST(BoardSequence, RefusesWhatTheBoardCannotShow) {
    const auto refused = [](auto&& change) -> std::string {
        Variant variant = variantOf("button");
        change(variant);
        try {
            (void)posesHeader(variant.profile, *variant.poses);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "made";
    };
    EXPECT_EQ(refused([](Variant&) {}), "made");
    EXPECT_THAT(refused([](Variant& v) { v.poses->button = 3; }), HasSubstr("pin 3"));
    EXPECT_THAT(refused([](Variant& v) { v.poses->button = 13; }), HasSubstr("pin 13"));
    EXPECT_THAT(refused([](Variant& v) { v.poses->button = 14; }), HasSubstr("pin 14"));
    EXPECT_THAT(refused([](Variant& v) { v.profile.servos.pop_back(); }), HasSubstr("12 strokes"));
    EXPECT_THAT(refused([](Variant& v) { v.profile.servos[1].channel = 0; }), HasSubstr("serial line"));
    EXPECT_THAT(refused([](Variant& v) { v.poses->sequence.steps.clear(); }), HasSubstr("no step"));
    EXPECT_THAT(refused([](Variant& v) {
                    v = variantOf("full");
                    v.poses->sequence.steps.push_back(v.poses->sequence.steps.front());
                }),
                HasSubstr("1000"));
}

} // namespace
} // namespace lumorph::firmware_test

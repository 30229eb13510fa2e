#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>

#include "app/applications/labyrinth/labyrinth.h"
#include "core/show/show_player.h"
#include "tests/support/long_tests.h"

// R39: half an hour of the labyrinth, in the loop and with visitors that come, play badly and go.

namespace lumorph::labyrinth {
namespace {

constexpr double kWarmUp = 60.0; ///< seconds until memory counts

double allocatedMegabytes() {
    const struct mallinfo2 heap = ::mallinfo2();
    return static_cast<double>(heap.uordblks + heap.hblkhd) / 1e6;
}

/// The labyrinth, with what each of its answers takes of one core. The player's own clock stands still meanwhile.
class Timed : public ShowProgram {
public:
    explicit Timed(std::size_t frames) : program_(1, bundledLevels()) { milliseconds_.reserve(frames); }
    ShowContent frame(const ShowMoment& moment) override {
        const double begun = threadSeconds();
        ShowContent content = program_.frame(moment);
        milliseconds_.push_back(static_cast<float>(1e3 * (threadSeconds() - begun)));
        return content;
    }
    [[nodiscard]] std::vector<float> sorted() const {
        std::vector<float> times = milliseconds_;
        std::ranges::sort(times);
        return times;
    }

private:
    static double threadSeconds() {
        timespec now{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }
    LabyrinthProgram program_;
    std::vector<float> milliseconds_;
};

/// Visitors by chance: they lean by pointer, stick and keys, press buttons, and leave it alone for longer than it
/// waits.
class Visitors {
public:
    void play(double seconds, ShowInputs& inputs) {
        if (seconds < next_) return;
        next_ = seconds + 0.1 + 0.6 * chance();
        if (seconds > changes_) {
            there_ = !there_;
            changes_ = seconds + (there_ ? 20.0 + 60.0 * chance() : 50.0 + 15.0 * chance());
            for (const char* name : {"pointer.x", "pointer.y", "pad.x", "pad.y", "key.left", "key.right"})
                inputs.push({name, 0.0});
        }
        if (!there_) return;
        inputs.push({"pointer.x", 2.0 * chance() - 1.0});
        inputs.push({"pointer.y", 2.0 * chance() - 1.0});
        if (chance() < 0.2) inputs.push({chance() < 0.5 ? "pad.x" : "pad.y", 2.0 * chance() - 1.0});
        if (chance() < 0.2) inputs.push({chance() < 0.5 ? "key.left" : "key.right", chance() < 0.5 ? 1.0 : 0.0});
        if (chance() < 0.05) inputs.push({chance() < 0.5 ? "key.next" : "key.restart", 1.0});
    }

private:
    double chance() { return static_cast<double>(random_()) * 0x1p-32; }

    std::mt19937 random_{29};
    double next_ = 0.0, changes_ = 5.0;
    bool there_ = false;
};

TEST(LabyrinthEndurance, HalfAnHourOfVisitorsKeepsMemoryServosAndTime) {
    const int frames = 3600 * (test::longTests() ? 30 : 3);
    const Demo demo = labyrinthDemo();
    MatchWish wish = wishOf(demo.open({}));
    wish.showTint = false;
    const auto program = std::make_shared<Timed>(static_cast<std::size_t>(frames));
    wish.program = program;
    wish.inputs = std::make_shared<ShowInputs>();
    wish.driver = Driver::program;
    const std::shared_ptr<const Rig> rig = wish.rig;
    ManualClock clock;
    ShowPlayer player(clock, wish);
    Visitors visitors;
    std::vector<double> strokes(rig->actuatorCount(), 0.0), least(strokes.size(), 1.0), most(strokes.size(), 0.0);
    double begun = 0.0, largest = 0.0, fastest = 0.0;
    for (int k = 0; k < frames; ++k) {
        const double seconds = k * ShowPlayer::kStep;
        visitors.play(seconds, *wish.inputs);
        const MatchFrame& frame = *player.step();
        ASSERT_TRUE(frame.programError.empty()) << frame.programError;
        for (std::size_t i = 0; i < strokes.size(); ++i) {
            const double stroke = frame.estimatedStrokes[i];
            ASSERT_TRUE(stroke >= 0.0 && stroke <= 1.0) << "servo " << i << " after " << seconds << " s";
            const double limit = rig->actuators()[i].maxVelocity;
            if (k > 0) fastest = std::max(fastest, std::abs(stroke - strokes[i]) / ShowPlayer::kStep / limit);
            least[i] = std::min(least[i], stroke);
            most[i] = std::max(most[i], stroke);
            strokes[i] = stroke;
        }
        if (k % 600 == 0 && seconds >= kWarmUp) {
            if (begun == 0.0) begun = allocatedMegabytes();
            largest = std::max(largest, allocatedMegabytes() - begun);
        }
    }
    const std::vector<float> milliseconds = program->sorted();
    const float middle = milliseconds[milliseconds.size() / 2], late = milliseconds[milliseconds.size() * 99 / 100];
    RecordProperty("growthMegabytes", std::to_string(largest));
    RecordProperty("shareOfVelocityLimit", std::to_string(fastest));
    RecordProperty("medianMilliseconds", std::to_string(middle));
    RecordProperty("percentile99Milliseconds", std::to_string(late));
    EXPECT_LT(largest, 5.0) << "megabytes after the first minute";
    EXPECT_LE(middle, 2.0F) << "milliseconds";
    EXPECT_LE(late, 8.0F);
    EXPECT_LE(fastest, 1.0 + 1e-9);
    EXPECT_GT(fastest, 0.02) << "they do move";
    for (std::size_t i = 0; i < strokes.size(); ++i) EXPECT_GT(most[i] - least[i], 0.1) << "servo " << i;
}

} // namespace
} // namespace lumorph::labyrinth

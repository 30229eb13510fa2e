#include <random>

#include <gtest/gtest.h>

#include "app/applications/labyrinth/labyrinth.h"
#include "tests/support/long_tests.h"
#include "tests/support/program_visit.h"

// R39: half an hour of the labyrinth, in the loop and with visitors that come, play badly and go.

namespace lumorph::labyrinth {
namespace {

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
    LabyrinthProgram program(1, bundledLevels());
    Visitors visitors;
    const test::LongVisit visit =
        test::visitForLong(program, test::longTests() ? 1800.0 : 180.0, ShowPlayer::kStep,
                           [&](int, double seconds, ShowInputs& inputs) { visitors.play(seconds, inputs); });
    test::expectSteady(visit);
    for (std::size_t i = 0; i < visit.most.size(); ++i) EXPECT_GT(visit.most[i] - visit.least[i], 0.1) << "servo " << i;
}

} // namespace
} // namespace lumorph::labyrinth

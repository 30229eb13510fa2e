#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/loop/match_loop.h"
#include "core/loop/show_program.h"
#include "core/mdf/sampling.h"
#include "core/scene/measured_servos.h"
#include "tests/core/loop/loop_fixture.h"

// A servo that meets a stop is known by its curve: what matching asks for is what the device can do.

namespace lumorph {
namespace {

using test::matchFieldOf;

/// Follows what it is told up to its stop.
MeasuredServo jammedAt(const std::string& actuator, double stop) {
    return {.actuator = actuator, .points = {{0.0, 0.0, 0.0}, {stop, stop, stop}, {1.0, stop, stop}}};
}

class Standing : public ShowProgram {
public:
    explicit Standing(BitColumns voxels) : voxels_(std::make_shared<const BitColumns>(std::move(voxels))) {}
    [[nodiscard]] ShowContent frame(const ShowMoment& /*moment*/) override {
        ShowContent content;
        content.target = voxels_;
        content.moves = false;
        return content;
    }

private:
    std::shared_ptr<const BitColumns> voxels_;
};

class JammedMatchTest : public testing::Test {
protected:
    explicit JammedMatchTest(const Rig& rig = test::cushionRig()) : field(matchFieldOf(rig)) {}

    /// What the live loop makes of a target in such a room.
    [[nodiscard]] std::shared_ptr<const MatchFrame> matched(const BitColumns& target, const Installation& room,
                                                            MatchMethod method) const {
        MatchWish wish = test::wishFor(field, nullptr);
        wish.driver = Driver::program;
        wish.program = std::make_shared<Standing>(target);
        wish.installation = std::make_shared<const Installation>(room);
        wish.method = method;
        const ManualClock clock;
        return MatchLoop(clock).step(wish, 0.0);
    }
    /// Of the real device that is asked for these strokes.
    [[nodiscard]] double iouOf(std::vector<double> wanted, const Installation& room, const BitColumns& target) {
        ServoCurves(field->rig.actuators(), room.servos).limit(wanted);
        field->coverage.coveredAt(wanted, covered, scratch);
        return intersectionOverUnion(covered, target);
    }
    [[nodiscard]] std::vector<double> strokesOf(const State& state) const {
        std::vector<double> strokes;
        for (const Level level : state) strokes.push_back(lumorph::strokeOf(level, field->field.levels));
        return strokes;
    }
    void judge(const char* what);

    std::shared_ptr<const MatchField> field;
    BitColumns covered;
    CoverageScratch scratch;
};

void JammedMatchTest::judge(const char* what) {
    std::mt19937 random(5);
    const std::size_t count = field->rig.actuatorCount();
    double sum = 0.0, clampedSum = 0.0, bestSum = 0.0, votedSum = 0.0, clampedVotes = 0.0;
    int judged = 0;
    for (int k = 0; k < 24; ++k) {
        State hidden(count);
        for (Level& level : hidden)
            level.index = static_cast<int>(random() % static_cast<unsigned>(field->field.levels));
        BitColumns target;
        field->coverage.covered(hidden, target, scratch);
        if (target.count() < 20) continue;
        const double stop = 0.125 * static_cast<double>(1 + random() % 5);
        Installation room = defaultInstallation();
        const std::size_t jammed = random() % count;
        room.servos = {jammedAt(field->rig.actuators()[jammed].name, stop)};
        const double reached = reachOf(room.servos.front()).high * (field->field.levels - 1);

        const auto now = matched(target, room, MatchMethod::refined);
        EXPECT_LE(now->wanted[jammed].index, reached + 1e-9);
        const double iou = iouOf(now->wantedStrokes, room, target);
        EXPECT_NEAR(now->iouWanted, iou, 1e-12) << "what is told of the match is what the device can do";
        const auto before = matched(target, defaultInstallation(), MatchMethod::refined);
        const double clamped = iouOf(before->wantedStrokes, room, target);
        double best = 0.0;
        for (const State& state : allStates(static_cast<int>(count), field->field.levels))
            if (state[jammed].index <= reached + 1e-9) best = std::max(best, iouOf(strokesOf(state), room, target));
        EXPECT_GE(iou, clamped - 1e-12) << k;
        EXPECT_GE(iou, 0.97 * best) << k;

        const auto votes = matched(target, room, MatchMethod::voting);
        EXPECT_LE(votes->wanted[jammed].index, reached + 1e-9);
        votedSum += iouOf(strokesOf(votes->wanted), room, target);
        clampedVotes +=
            iouOf(strokesOf(matched(target, defaultInstallation(), MatchMethod::voting)->wanted), room, target);
        ++judged;
        sum += iou;
        clampedSum += clamped;
        bestSum += best;
    }
    std::printf(
        "%s, %d targets: IoU %.4f, clamped after the match %.4f, best of all reachable states %.4f; votes %.4f, "
        "clamped %.4f\n",
        what, judged, sum / judged, clampedSum / judged, bestSum / judged, votedSum / judged, clampedVotes / judged);
    EXPECT_GE(judged, 15);
    EXPECT_GE(sum, clampedSum);
    EXPECT_GE(votedSum, clampedVotes - 1e-9);
}

TEST_F(JammedMatchTest, ChoosesTheBestOfWhatTheDeviceReaches) {
    judge("cushion");
    field = matchFieldOf(test::lifterRig());
    judge("lifter");
}

TEST_F(JammedMatchTest, AnOrdinaryServoKeepsAllItsLevels) {
    // Within half a level of both ends.
    Installation room = defaultInstallation();
    room.servos = {{.actuator = field->rig.actuators()[0].name, .points = {{0.0, 0.02, 0.04}, {1.0, 0.96, 0.98}}}};
    for (const int level : {0, 8}) {
        BitColumns target;
        field->coverage.covered(State{Level{level}, Level{6}, Level{3}}, target, scratch);
        EXPECT_EQ(matched(target, room, MatchMethod::refined)->wanted,
                  matched(target, defaultInstallation(), MatchMethod::refined)->wanted);
    }
}

TEST_F(JammedMatchTest, AStopThatIsMeasuredWhileItRunsIsKeptFromThenOn) {
    BitColumns target;
    field->coverage.covered(State{Level{8}, Level{8}, Level{8}}, target, scratch);
    MatchWish wish = test::wishFor(field, nullptr);
    wish.driver = Driver::program;
    wish.program = std::make_shared<Standing>(target);
    wish.installation = std::make_shared<const Installation>(defaultInstallation());
    const ManualClock clock;
    MatchLoop loop(clock);
    EXPECT_EQ(loop.step(wish, 0.0)->wanted[1].index, 8);
    Installation room = defaultInstallation();
    room.servos = {jammedAt(field->rig.actuators()[1].name, 0.5)};
    wish.installation = std::make_shared<const Installation>(room);
    EXPECT_LE(loop.step(wish, 0.01)->wanted[1].index, 4);
    wish.installation = std::make_shared<const Installation>(defaultInstallation());
    EXPECT_EQ(loop.step(wish, 0.01)->wanted[1].index, 8);
}

} // namespace
} // namespace lumorph

#include "core/mdf/refine.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/builder.h"
#include "core/mdf/sampling.h"
#include "core/mdf/voting.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

constexpr int kRefineLevels = 9;

struct RefineCase {
    const char* name;
    Rig (*make)();
};

class RefineOnRig : public testing::TestWithParam<RefineCase> {
protected:
    void SetUp() override {
        const Rig rig = GetParam().make();
        coverage_ = std::make_unique<Coverage>(rig, frameOf(rig.reach(), 12), kRefineLevels);
    }
    BitColumns volumeOf(const State& state) {
        BitColumns bits;
        coverage_->covered(state, bits, scratch_);
        return bits;
    }
    std::unique_ptr<Coverage> coverage_;
    CoverageScratch scratch_;
    SteadyClock clock_;
};

TEST_P(RefineOnRig, FindsHiddenStatesFromRest) {
    Refiner refiner(*coverage_);
    std::mt19937 random(11);
    double worst = 1.0;
    for (int i = 0; i < 20; ++i) {
        State hidden(3);
        for (Level& level : hidden) level.index = static_cast<int>(random() % kRefineLevels);
        const BitColumns target = volumeOf(hidden);
        if (target.count() < 20) continue;
        const Refinement refined = refiner.refine(target, State(3), Microseconds{0}, clock_);
        EXPECT_TRUE(refined.converged);
        EXPECT_GE(refined.after.iou(), refined.before.iou());
        worst = std::min(worst, refined.after.iou());
    }
    EXPECT_GE(worst, 0.9);
}

TEST_P(RefineOnRig, BetweenLevelsIsFoundWhatLiesThere) {
    std::mt19937 random(29);
    for (int i = 0; i < 6; ++i) {
        State hidden(3);
        for (Level& level : hidden) level.index = 2 + static_cast<int>(random() % (kRefineLevels - 3));
        const BitColumns onLevels = volumeOf(hidden);
        EXPECT_EQ(iouBetweenLevels(*coverage_, onLevels, hidden), 1.0);
        std::vector<double> strokes;
        for (const Level level : hidden) strokes.push_back((level.index - 0.5) / (kRefineLevels - 1));
        BitColumns between;
        coverage_->coveredAt(strokes, between, scratch_);
        Refiner refiner(*coverage_);
        const double own = refiner.qualityOf(between, hidden).iou();
        EXPECT_GE(iouBetweenLevels(*coverage_, between, hidden), own + 0.6 * (1.0 - own)) << own;
    }
}

TEST_P(RefineOnRig, LeavesWhatIsHeldWhereItStarts) {
    Refiner refiner(*coverage_);
    const BitColumns target = volumeOf({Level{6}, Level{7}, Level{5}});
    const State start{Level{2}, Level{0}, Level{1}};
    refiner.hold({0, 2});
    const Refinement refined = refiner.refine(target, start, Microseconds{0}, clock_);
    EXPECT_EQ(refined.state[0], start[0]);
    EXPECT_EQ(refined.state[2], start[2]);
    // Every level of the one that is free, looked at one by one.
    double best = 0.0;
    for (int level = 0; level < kRefineLevels; ++level)
        best = std::max(best, refiner.qualityOf(target, {start[0], Level{level}, start[2]}).iou());
    EXPECT_DOUBLE_EQ(refined.after.iou(), best);
    refiner.hold({});
    EXPECT_GT(refiner.refine(target, start, Microseconds{0}, clock_).after.iou(), best);
    EXPECT_THROW(refiner.hold({3}), InvalidInput);
}

/// Runs out of time after so many looks at it.
class CountingClock final : public Clock {
public:
    [[nodiscard]] Microseconds now() const override { return ++looks_; }

private:
    mutable Microseconds looks_{0};
};

TEST_P(RefineOnRig, ManyShortBudgetsDoWhatOneLongOneDoes) {
    const BitColumns target = volumeOf({Level{6}, Level{1}, Level{4}});
    const Refinement whole = Refiner(*coverage_).refine(target, State(3), Microseconds{0}, clock_);
    const CountingClock counting;
    Refiner refiner(*coverage_);
    Refinement part = refiner.refine(target, State(3), Microseconds{5}, counting);
    int seen = part.statesSeen;
    for (int k = 0; k < 2000 && !part.converged; ++k) {
        EXPECT_LE(part.statesSeen, 12);
        part = refiner.resume(Microseconds{5}, counting);
        seen += part.statesSeen;
    }
    EXPECT_TRUE(part.converged);
    EXPECT_EQ(part.state, whole.state);
    EXPECT_EQ(part.after.iou(), whole.after.iou());
    EXPECT_LE(seen, 2 * whole.statesSeen);
}

// Every reported figure is checked against the volume itself, and the end is a local optimum.
TEST_P(RefineOnRig, ReportsTrueQualityAndEndsWhereNoSingleActuatorHelps) {
    Refiner refiner(*coverage_);
    BitColumns target(coverage_->frame().dimensions);
    const glm::ivec3 d = target.dimensions();
    for (int z = 0; z < d.z; ++z)
        for (int x = 0; x < d.x; ++x)
            for (int y = 0; y < d.y * (0.6 + 0.3 * std::sin(x / 3.0 + z / 5.0)); ++y) target.set(x, y, z);
    BitColumns wanted = target;
    wanted &= coverage_->domain();
    const Refinement refined = refiner.refine(target, {Level{2}, Level{7}, Level{1}}, Microseconds{0}, clock_);
    EXPECT_NEAR(refined.before.iou(), intersectionOverUnion(volumeOf({Level{2}, Level{7}, Level{1}}), wanted), 1e-12);
    EXPECT_NEAR(refined.after.iou(), intersectionOverUnion(volumeOf(refined.state), wanted), 1e-12);
    EXPECT_EQ(refined.after.both + refined.after.unmatched, wanted.count());
    double best = 0.0;
    for (const State& state : allStates(3, kRefineLevels))
        best = std::max(best, intersectionOverUnion(volumeOf(state), wanted));
    EXPECT_GE(refined.after.iou(), 0.98 * best) << "exhaustive search finds " << best;
    for (std::size_t i = 0; i < 3; ++i)
        for (int level = 0; level < kRefineLevels; ++level) {
            State other = refined.state;
            other[i] = Level{level};
            EXPECT_LE(intersectionOverUnion(volumeOf(other), wanted), refined.after.iou() + 1e-12);
        }
}

/// Whether another level of one actuator, or a step of two coupled ones together, gives more: by trying all of them.
std::string whatHelps(const Coverage& coverage, const State& state, const BitColumns& wanted) {
    CoverageScratch scratch;
    BitColumns bits;
    const auto iouOf = [&](const State& at) {
        coverage.covered(at, bits, scratch);
        return intersectionOverUnion(bits, wanted);
    };
    const double reached = iouOf(state) + 1e-12;
    for (std::size_t i = 0; i < state.size(); ++i)
        for (int level = 0; level < coverage.levels(); ++level) {
            State other = state;
            other[i] = Level{level};
            if (iouOf(other) > reached) return "one";
        }
    for (const auto& [i, j] : coverage.coupledPairs())
        for (const int first : {-4, -2, -1, 1, 2, 4})
            for (const int second : {-4, -2, -1, 1, 2, 4}) {
                State other = state;
                other[i].index += first;
                other[j].index += second;
                const auto inRange = [&](Level level) { return level.index >= 0 && level.index < coverage.levels(); };
                if (inRange(other[i]) && inRange(other[j]) && iouOf(other) > reached)
                    return std::to_string(first) + " and " + std::to_string(second);
            }
    return "";
}

// Where one must give way for the other to gain, no single move helps: a move of two does, and after it single ones
// may.
TEST_P(RefineOnRig, EndsWhereNoStepOfACoupledPairHelpsEither) {
    Refiner refiner(*coverage_);
    std::mt19937 random(23);
    const glm::ivec3 d = coverage_->frame().dimensions;
    ASSERT_EQ(coverage_->coupledPairs().empty(), GetParam().make == &test::lifterRig);
    const int rounds = GetParam().make == &test::armRig ? 25 : 120; // a body that sweeps takes long
    for (int round = 0; round < rounds; ++round) {
        // A ragged landscape with many hollows: blocks of columns of any height, and crumbs.
        BitColumns target(d);
        const int side = 1 + static_cast<int>(random() % 5);
        std::vector<int> heights(1000);
        for (int& height : heights) height = static_cast<int>(random() % static_cast<unsigned>(d.y + 1));
        for (int z = 0; z < d.z; ++z)
            for (int x = 0; x < d.x; ++x) {
                const auto block = static_cast<std::size_t>(z / side * 29 + x / side) % heights.size();
                for (int y = 0; y < d.y; ++y)
                    if ((y < heights[block]) != (random() % 12 == 0)) target.set(x, y, z);
            }
        target &= coverage_->domain();
        State start(3);
        for (Level& level : start) level.index = static_cast<int>(random() % kRefineLevels);
        const Refinement refined = refiner.refine(target, start, Microseconds{0}, clock_);
        EXPECT_TRUE(refined.converged);
        EXPECT_EQ(whatHelps(*coverage_, refined.state, target), "") << "round " << round;
    }
}

INSTANTIATE_TEST_SUITE_P(SmallRigs, RefineOnRig,
                         testing::Values(RefineCase{"cushion", &test::cushionRig}, RefineCase{"arm", &test::armRig},
                                         RefineCase{"lifter", &test::lifterRig}),
                         [](const auto& rig) { return rig.param.name; });

// The same with many fine levels, where steps of four are far from all the way.
TEST(Refine, EndsWhereNoStepOfACoupledPairHelpsAmongFineLevels) {
    constexpr int kFineLevels = 25;
    const Rig rig = test::cushionRig();
    const Coverage coverage(rig, frameOf(rig.reach(), 14), kFineLevels);
    Refiner refiner(coverage);
    const SteadyClock clock;
    std::mt19937 random(31);
    for (int round = 0; round < 250; ++round) {
        BitColumns target(coverage.frame().dimensions);
        const glm::ivec3 d = target.dimensions();
        const int side = 1 + static_cast<int>(random() % 9);
        std::vector<int> heights(1000);
        for (int& height : heights) height = static_cast<int>(random() % static_cast<unsigned>(d.y + 1));
        for (int z = 0; z < d.z; ++z)
            for (int x = 0; x < d.x; ++x)
                for (int y = 0; y < heights[static_cast<std::size_t>(z / side * 29 + x / side) % heights.size()]; ++y)
                    if (random() % 5 != 0) target.set(x, y, z);
        target &= coverage.domain();
        State start(3);
        for (Level& level : start) level.index = static_cast<int>(random() % kFineLevels);
        const Refinement refined = refiner.refine(target, start, Microseconds{0}, clock);
        ASSERT_EQ(whatHelps(coverage, refined.state, target), "") << "round " << round;
    }
}

/// A clock that moves on by a millisecond each time it is looked at.
class TickingClock final : public Clock {
public:
    [[nodiscard]] Microseconds now() const override { return now_ += Microseconds{1000}; }

private:
    mutable Microseconds now_{0};
};

TEST(Refine, StopsWhenItsTimeIsUp) {
    const Rig rig = test::cushionRig();
    const Coverage coverage(rig, frameOf(rig.reach(), 12), kRefineLevels);
    CoverageScratch scratch;
    BitColumns target;
    coverage.covered(State{Level{8}, Level{8}, Level{8}}, target, scratch);
    Refiner refiner(coverage);
    const Refinement refined = refiner.refine(target, State(3), Microseconds{5000}, TickingClock());
    EXPECT_FALSE(refined.converged);
    EXPECT_LE(refined.statesSeen, 6);
    EXPECT_GE(refined.after.iou(), refined.before.iou());
}

TEST(Refine, RefusesStatesAndTargetsThatDoNotFit) {
    const Rig rig = test::cushionRig();
    const Coverage coverage(rig, frameOf(rig.reach(), 12), kRefineLevels);
    Refiner refiner(coverage);
    const SteadyClock clock;
    const BitColumns target(coverage.frame().dimensions);
    EXPECT_THROW((void)refiner.refine(target, State(2), Microseconds{0}, clock), InvalidInput);
    EXPECT_THROW((void)refiner.refine(target, {Level{0}, Level{0}, Level{kRefineLevels}}, Microseconds{0}, clock),
                 InvalidInput);
    EXPECT_THROW((void)refiner.refine(BitColumns({1, 1, 1}), State(3), Microseconds{0}, clock), InvalidInput);
}

} // namespace
} // namespace lumorph

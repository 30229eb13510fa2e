#include "core/mdf/voting.h"

#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/builder.h"
#include "tests/support/literal_vote.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

using test::LiteralVote;
using test::literalVote;

Field fieldOf(const Rig& rig, int resolution, int levels, int samples) {
    BuildOptions options;
    options.resolution = resolution;
    options.levels = levels;
    options.samples = samples;
    return buildField(rig, options);
}

/// A relief: columns filled up to a wave's height.
BitColumns wave(const Field& field, double lengthX, double lengthZ, double phase) {
    const glm::ivec3& d = field.frame.dimensions;
    BitColumns bits(d);
    for (int z = 0; z < d.z; ++z)
        for (int x = 0; x < d.x; ++x) {
            const double height = d.y * (0.5 + 0.4 * std::sin(x / lengthX + phase) * std::cos(z / lengthZ));
            for (int y = 0; y < height && y < d.y; ++y) bits.set(x, y, z);
        }
    return bits;
}

BitColumns randomBits(const Field& field, unsigned seed, unsigned share) {
    std::mt19937 random(seed);
    BitColumns bits(field.frame.dimensions);
    for (int z = 0; z < field.frame.dimensions.z; ++z)
        for (int y = 0; y < field.frame.dimensions.y; ++y)
            for (int x = 0; x < field.frame.dimensions.x; ++x)
                if (random() % 100 < share) bits.set(x, y, z);
    return bits;
}

class VotingOnRig : public testing::TestWithParam<Rig (*)()> {};

// R16, R17: the one-pass match gives what Eq. 1 gives when it is evaluated literally.
TEST_P(VotingOnRig, AgreesWithTheLiteralEquation) {
    const Field field = fieldOf(GetParam()(), 15, 21, 40);
    const Voting voting(field);
    const Coverage coverage(GetParam()(), field.frame, field.levels);
    CoverageScratch scratch;
    std::vector<BitColumns> targets{wave(field, 6, 5, 0),    wave(field, 3, 9, 1),
                                    wave(field, 11, 2, 2),   randomBits(field, 1, 50),
                                    randomBits(field, 2, 3), BitColumns(field.frame.dimensions)};
    std::mt19937 random(5);
    for (int i = 0; i < 12; ++i) {
        State hidden(field.actuators.size());
        for (Level& level : hidden) level.index = static_cast<int>(random() % 21);
        coverage.covered(hidden, targets.emplace_back(field.frame.dimensions), scratch);
    }
    std::set<int> levels;
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const Votes votes = voting.match(targets[t]);
        for (std::size_t i = 0; i < votes.actuators.size(); ++i) {
            const LiteralVote literal = literalVote(field, i, targets[t]);
            const ActuatorVote& vote = votes.actuators[i];
            ASSERT_EQ(vote.level.index, literal.level) << "target " << t << " actuator " << i;
            ASSERT_EQ(vote.reached, literal.reached);
            for (std::size_t j = 0; j < literal.errors.size(); ++j) {
                ASSERT_NEAR(vote.errors[j], literal.errors[j], 1e-7 * (1.0 + literal.errors[j]));
                ASSERT_NEAR(vote.intersections[j], literal.intersections[j], 1e-7 * (1.0 + literal.intersections[j]));
            }
            levels.insert(literal.level);
        }
    }
    EXPECT_GE(levels.size(), 8U) << "the targets do not tell levels apart";
}

INSTANTIATE_TEST_SUITE_P(SmallRigs, VotingOnRig, testing::Values(&test::cushionRig, &test::armRig, &test::lifterRig));

TEST(Voting, AnEmptyTargetLeavesTheDeviceAtRestAndSaysSo) {
    const Field field = fieldOf(test::cushionRig(), 12, 9, 20);
    const Votes votes = Voting(field).match(BitColumns(field.frame.dimensions));
    EXPECT_EQ(votes.targetVoxels, 0U);
    for (const ActuatorVote& vote : votes.actuators) {
        EXPECT_FALSE(vote.reached);
        EXPECT_EQ(vote.level.index, 0);
        EXPECT_EQ(vote.stroke, 0.0);
    }
}

TEST(Voting, TargetVoxelsInsideTheBodyDoNotCount) {
    const Field field = fieldOf(test::cushionRig(), 12, 9, 20);
    const Voting voting(field);
    BitColumns target = wave(field, 4, 4, 0);
    target -= field.body;
    const Votes without = voting.match(target);
    target |= field.body;
    const Votes with = voting.match(target);
    EXPECT_EQ(with.targetVoxels, without.targetVoxels);
    for (std::size_t i = 0; i < with.actuators.size(); ++i)
        EXPECT_EQ(with.actuators[i].errors, without.actuators[i].errors);
}

TEST(Voting, HysteresisKeepsALevelThatIsNearlyAsGoodAndLeavesOneThatIsNot) {
    const Field field = fieldOf(test::cushionRig(), 15, 21, 40);
    const Voting voting(field);
    const BitColumns target = wave(field, 8, 8, 0.3);
    const Votes free = voting.match(target);
    Votes steady;
    Voting::Workspace workspace;
    for (std::size_t i = 0; i < free.actuators.size(); ++i) {
        State last = free.state();
        const ActuatorVote& vote = free.actuators[i];
        const auto ratio = [&](int level) {
            const auto j = static_cast<std::size_t>(level);
            return vote.errors[j] / vote.intersections[j];
        };
        for (int level = 0; level < field.levels; ++level) {
            if (vote.intersections[static_cast<std::size_t>(level)] < 50.0) continue;
            last[i] = Level{level};
            voting.match(target, steady, workspace, &last, 0.05);
            const bool asGood = ratio(level) <= 1.05 * ratio(vote.level.index);
            EXPECT_EQ(steady.actuators[i].level.index, asGood ? level : vote.level.index);
        }
    }
}

TEST(Voting, TheStrokeBetweenLevelsStaysWithinHalfALevelOfTheVote) {
    const Field field = fieldOf(test::cushionRig(), 15, 21, 40);
    const Votes votes = Voting(field).match(wave(field, 8, 8, 0.3));
    int between = 0;
    for (const ActuatorVote& vote : votes.actuators) {
        EXPECT_LE(std::abs(20.0 * vote.stroke - vote.level.index), 0.5 + 1e-9);
        between += vote.reached && std::abs(20.0 * vote.stroke - vote.level.index) > 1e-6;
    }
    EXPECT_GT(between, 0);
}

/// Columns that a lift fills four voxels a level: a target of 4 k + 1 voxels is meant a quarter above level k.
TEST(Voting, TheStrokeBetweenLevelsLiesOnTheSideOfTheTruth) {
    constexpr int kLevels = 11;
    constexpr int kColumns = 5;
    Field field;
    field.frame = {{0, 0, 0}, 0.01, {kColumns, 40, 1}};
    field.levels = kLevels;
    field.body = BitColumns(field.frame.dimensions);
    field.background.assign(field.frame.voxelCount(), 128);
    ActuatorField actuator{"lift", {}, {}};
    for (std::uint32_t x = 0; x < kColumns; ++x) {
        actuator.runs.push_back({x, 0, 40, 40 * x});
        for (int y = 0; y < 40; ++y) {
            const auto from = static_cast<std::uint8_t>(y / 4 + 1);
            actuator.ramps.push_back({from, from, 0, 255});
        }
    }
    field.actuators = {actuator};
    const Voting voting(field);
    for (int height = 9; height < 36; ++height) {
        if (height % 4 == 0) continue;
        BitColumns target(field.frame.dimensions);
        for (int x = 0; x < kColumns; ++x)
            for (int y = 0; y < height; ++y) target.set(x, y, 0);
        const ActuatorVote vote = voting.match(target).actuators[0];
        const double truth = height / 4.0;
        const double found = vote.stroke * (kLevels - 1);
        EXPECT_LT(std::abs(found - truth), std::abs(vote.level.index - truth)) << height;
        EXPECT_NEAR(found, truth, 0.25) << height;
    }
}

TEST(Voting, TheStrokeIsTheLowestPointOfTheParabolaThroughTheRatios) {
    for (Rig (*const make)() : {&test::cushionRig, &test::armRig, &test::lifterRig}) {
        const Field field = fieldOf(make(), 13, 21, 40);
        const Voting voting(field);
        for (int t = 0; t < 8; ++t) {
            const BitColumns target = wave(field, 5.0 + t, 8.0 - 0.5 * t, 0.3 * t);
            const Votes votes = voting.match(target);
            for (std::size_t i = 0; i < votes.actuators.size(); ++i)
                EXPECT_NEAR(votes.actuators[i].stroke, test::literalStroke(literalVote(field, i, target)), 1e-6);
        }
    }
}

/// Ramps of one step each, one a voxel of a row of columns, and a target of the voxels that are named.
struct StepField {
    explicit StepField(const std::vector<Ramp>& ramps, const std::vector<bool>& wanted) {
        const auto height = static_cast<int>(ramps.size());
        field.frame = {{0, 0, 0}, 0.01, {1, height, 1}};
        field.levels = 4;
        field.body = BitColumns(field.frame.dimensions);
        field.background.assign(ramps.size(), 0);
        field.actuators = {{"a", {{0, 0, static_cast<std::uint16_t>(height), 0}}, ramps}};
        target = BitColumns(field.frame.dimensions);
        for (int y = 0; y < height; ++y)
            if (wanted[static_cast<std::size_t>(y)]) target.set(0, y, 0);
    }
    Field field;
    BitColumns target;
};

TEST(Voting, LessThanAVoxelIsNoMatch) {
    const StepField half({{2, 2, 0, 128}, {2, 2, 0, 255}}, {true, false});
    EXPECT_FALSE(Voting(half.field).match(half.target).actuators[0].reached) << "half of one voxel";
    const StepField whole({{2, 2, 0, 128}, {2, 2, 0, 128}}, {true, true});
    EXPECT_TRUE(Voting(whole.field).match(whole.target).actuators[0].reached) << "two halves";
    EXPECT_EQ(Voting(whole.field).match(whole.target).actuators[0].level.index, 2);
}

/// Level 1 reaches few wanted voxels and nothing else, level 2 a few more and very many that nobody wants.
TEST(Voting, ALevelCountsFromOneInAHundredWantedVoxelsOn) {
    for (const auto& [few, level] : {std::pair{5, 1}, {2, 1}}) {
        std::vector<Ramp> ramps;
        std::vector<bool> wanted;
        for (int i = 0; i < 100; ++i) {
            ramps.push_back(i < few ? Ramp{1, 1, 0, 255} : i < 20 ? Ramp{2, 2, 0, 255} : Ramp{3, 3, 0, 3});
            wanted.push_back(true);
        }
        for (int i = 0; i < 2000; ++i) {
            ramps.push_back({2, 2, 0, 255});
            wanted.push_back(false);
        }
        const StepField steps(ramps, wanted);
        const ActuatorVote vote = Voting(steps.field).match(steps.target).actuators[0];
        EXPECT_TRUE(vote.reached);
        EXPECT_EQ(vote.level.index, level) << few;
        EXPECT_EQ(literalVote(steps.field, 0, steps.target).level, level);
    }
}

TEST(Voting, ATargetOfAnotherShapeIsRefused) {
    const Field field = fieldOf(test::cushionRig(), 12, 9, 20);
    EXPECT_THROW((void)Voting(field).match(BitColumns({3, 3, 3})), InvalidInput);
}

/// Three voxels that only two actuators together can cover hold background but no ramp of their own.
TEST(Voting, BackgroundThatNoActuatorChangesIsCounted) {
    Field field;
    field.frame = {{0, 0, 0}, 0.01, {2, 4, 1}};
    field.levels = 3;
    field.body = BitColumns(field.frame.dimensions);
    field.background = {255, 255, 0, 0, 128, 128, 0, 0};
    ActuatorField actuator{"a", {{1, 0, 2, 0}}, {{1, 2, 64, 192}, {2, 2, 0, 255}}};
    field.actuators = {actuator};
    BitColumns target(field.frame.dimensions);
    for (int y = 0; y < 3; ++y) {
        target.set(0, y, 0);
        target.set(1, y, 0);
    }
    const Votes votes = Voting(field).match(target);
    const LiteralVote literal = literalVote(field, 0, target);
    EXPECT_EQ(votes.actuators[0].level.index, literal.level);
    for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_NEAR(votes.actuators[0].errors[j], literal.errors[j], 1e-9);
        EXPECT_NEAR(votes.actuators[0].intersections[j], literal.intersections[j], 1e-9);
    }
}

/// A target that the device can take on exactly: its error is nothing but what rounding leaves of a difference, and of
/// the levels that all fit the lowest is meant.
TEST(Voting, AnExactFitIsFoundAtItsLowestLevel) {
    constexpr int kLevels = 33;
    std::mt19937 random(11);
    for (int round = 0; round < 300; ++round) {
        Field field;
        field.frame = {{0, 0, 0}, 0.01, {1, 40, 1}};
        field.levels = kLevels;
        field.body = BitColumns(field.frame.dimensions);
        field.background.assign(40, 128);
        ActuatorField actuator{"a", {{0, 0, 40, 0}}, {}};
        int full = 0;
        BitColumns target(field.frame.dimensions);
        for (int y = 0; y < 40; ++y) {
            const auto v0 = static_cast<std::uint8_t>(1 + random() % 12);
            const auto v1 = static_cast<std::uint8_t>(v0 + random() % 16);
            actuator.ramps.push_back({v0, v1, static_cast<std::uint8_t>(random() % 200), 255});
            full = std::max(full, int{v1});
            target.set(0, y, 0);
        }
        field.actuators = {actuator};
        const ActuatorVote vote = Voting(field).match(target).actuators[0];
        ASSERT_TRUE(vote.reached);
        ASSERT_EQ(vote.level.index, full) << "round " << round;
        for (const double error : vote.errors) ASSERT_GE(error, 0.0);
        ASSERT_NEAR(vote.stroke * (kLevels - 1), full, 0.5);
    }
}

TEST(Ramp, FollowsItsDefinition) {
    const Ramp ramp{2, 5, 51, 255};
    const double expected[] = {0.2, 0.2, 0.4, 0.6, 0.8, 1.0, 1.0};
    for (int level = 0; level < 7; ++level) EXPECT_NEAR(expectationAt(ramp, level), expected[level], 1e-12);
}

// R11: the fit is the least-squares optimum, found here by trying every pair.
TEST(Ramp, FitIsTheLeastSquaresOptimum) {
    std::mt19937 random(4);
    for (int round = 0; round < 200; ++round) {
        std::vector<double> expectation(12);
        for (double& value : expectation) value = static_cast<double>(random() % 1000) / 999.0;
        std::sort(expectation.begin(), expectation.end());
        const auto errorOf = [&](const Ramp& ramp) {
            double sum = 0.0;
            for (int j = 0; j < 12; ++j)
                sum += std::pow(expectationAt(ramp, j) - expectation[static_cast<std::size_t>(j)], 2);
            return sum;
        };
        const Ramp fitted = fitRamp(expectation);
        double best = INFINITY;
        for (std::uint8_t v0 = 1; v0 < 12; ++v0)
            for (std::uint8_t v1 = v0; v1 < 12; ++v1) best = std::min(best, errorOf({v0, v1, fitted.base, fitted.top}));
        ASSERT_NEAR(errorOf(fitted), best, 1e-9);
    }
}

TEST(Ramp, AConstantIsUnchangedAndAStepIsExact) {
    EXPECT_EQ(fitRamp(std::vector<double>(8, 0.3)).v0, kUnchanged);
    const Ramp step = fitRamp(std::vector<double>{0.0, 0.0, 0.0, 1.0, 1.0});
    EXPECT_EQ(step, (Ramp{3, 3, 0, 255}));
}

} // namespace
} // namespace lumorph

#include "core/mdf/builder.h"

#include <cmath>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/field_file.h"
#include "core/mdf/refine.h"
#include "core/mdf/sampling.h"
#include "core/mdf/voting.h"
#include "tests/support/cgal_oracle.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

constexpr int kBuilderLevels = 5;

/// V(s) by CGAL alone: each voxel centre asked against the deformed mesh along the path (R6).
std::vector<bool> coveredByOracle(const Coverage& coverage, const State& state, const std::vector<bool>& body) {
    const Rig& rig = coverage.rig();
    const VoxelFrame& frame = coverage.frame();
    const std::vector<double> full = strokesOf(rig, state, kBuilderLevels);
    const int steps = rig.pathInside() ? 1 : coverage.pathSteps(full);
    std::vector<bool> covered(frame.voxelCount());
    for (int step = 1; step <= steps; ++step) {
        std::vector<double> strokes = full;
        for (double& stroke : strokes) stroke *= static_cast<double>(step) / steps;
        const test::InsideOracle inside(deformed(rig, strokes));
        std::size_t i = 0;
        for (int z = 0; z < frame.dimensions.z; ++z)
            for (int x = 0; x < frame.dimensions.x; ++x)
                for (int y = 0; y < frame.dimensions.y; ++y, ++i)
                    if (!covered[i] && !body[i]) covered[i] = inside(frame.centre(x, y, z));
    }
    return covered;
}

struct RigCase {
    const char* name;
    Rig (*make)();
    int resolution;
};

class BuilderOracle : public testing::TestWithParam<RigCase> {
protected:
    void SetUp() override {
        const Rig rig = GetParam().make();
        coverage_ = std::make_unique<Coverage>(rig, frameOf(rig.reach(), GetParam().resolution), kBuilderLevels);
        const test::InsideOracle inside(rig.restMesh());
        std::size_t i = 0;
        const VoxelFrame& frame = coverage_->frame();
        body_.assign(frame.voxelCount(), false);
        for (int z = 0; z < frame.dimensions.z; ++z)
            for (int x = 0; x < frame.dimensions.x; ++x)
                for (int y = 0; y < frame.dimensions.y; ++y, ++i) body_[i] = inside(frame.centre(x, y, z));
        for (const State& state : allStates(3, kBuilderLevels)) {
            auto& v = volumes_[key(state)] = coveredByOracle(*coverage_, state, body_);
            reachable_ += static_cast<std::size_t>(std::count(v.begin(), v.end(), true));
        }
    }
    static int key(const State& s) { return s[0].index + kBuilderLevels * (s[1].index + kBuilderLevels * s[2].index); }

    /// Mean over the given states, actuator at a level, coverage OR-ed over lower levels first (R8, R10).
    [[nodiscard]] double expectation(const std::vector<State>& states, std::size_t actuator, int level,
                                     std::size_t voxel) const {
        std::size_t count = 0;
        for (State state : states) {
            bool covered = false;
            for (int j = 0; j <= level && !covered; ++j) {
                state[actuator] = Level{j};
                covered = volumes_.at(key(state))[voxel];
            }
            count += covered;
        }
        return static_cast<double>(count) / static_cast<double>(states.size());
    }

    std::unique_ptr<Coverage> coverage_;
    std::vector<bool> body_;
    std::map<int, std::vector<bool>> volumes_;
    std::size_t reachable_ = 0;
};

// R6: the coverage of every one of the 125 states is what CGAL says, voxel by voxel.
TEST_P(BuilderOracle, CoverageOfEveryStateIsWhatCgalSays) {
    CoverageScratch scratch;
    BitColumns kept;
    BitColumns afresh;
    std::size_t different = 0;
    for (const State& state : allStates(3, kBuilderLevels)) {
        coverage_->covered(state, kept, scratch);
        coverage_->coveredAt(strokesOf(coverage_->rig(), state, kBuilderLevels), afresh, scratch);
        ASSERT_EQ(kept, afresh) << "kept pieces give another volume than rasterising afresh";
        const std::vector<bool>& expected = volumes_.at(key(state));
        std::size_t i = 0;
        for (int z = 0; z < kept.dimensions().z; ++z)
            for (int x = 0; x < kept.dimensions().x; ++x)
                for (int y = 0; y < kept.dimensions().y; ++y, ++i) different += kept.test(x, y, z) != expected[i];
    }
    ASSERT_GT(reachable_, 10'000U);
    EXPECT_EQ(different, 0U);
}

// R8, R9: with all states sampled the field is the expectation itself, exactly.
TEST_P(BuilderOracle, FieldEqualsTheExpectationOverAllStates) {
    const std::vector<State> states = allStates(3, kBuilderLevels);
    const SampledField sampled = sampleField(*coverage_, states);
    std::size_t coupled = 0;
    const auto height = static_cast<std::size_t>(coverage_->frame().dimensions.y);
    for (std::size_t actuator = 0; actuator < 3; ++actuator) {
        std::vector<bool> listed(volumes_.begin()->second.size());
        for (const SampledField::Voxel& voxel : sampled.actuators[actuator]) {
            const std::size_t index = voxel.column * height + static_cast<std::size_t>(voxel.y);
            listed[index] = true;
            for (int level = 0; level < kBuilderLevels; ++level)
                ASSERT_DOUBLE_EQ(voxel.expectation[static_cast<std::size_t>(level)],
                                 expectation(states, actuator, level, index));
            coupled += voxel.expectation.front() > 0.0;
        }
        // What the field does not list must indeed be the same at every level.
        for (std::size_t index = 0; index < listed.size(); ++index)
            if (!listed[index]) {
                ASSERT_DOUBLE_EQ(expectation(states, actuator, 0, index),
                                 expectation(states, actuator, kBuilderLevels - 1, index));
            }
    }
    EXPECT_GT(coupled, 100U) << "the rig does not couple its actuators, so this test would prove little";
}

// R8: with fewer samples the expectation is met within three standard errors nearly everywhere.
TEST_P(BuilderOracle, SampledFieldIsWithinThreeSigma) {
    constexpr std::size_t kSamples = 48;
    const std::vector<State> all = allStates(3, kBuilderLevels);
    const SampledField sampled = sampleField(*coverage_, quasiRandomStates(3, kBuilderLevels, kSamples, 7));
    const auto height = static_cast<std::size_t>(coverage_->frame().dimensions.y);
    std::size_t compared = 0;
    for (std::size_t actuator = 0; actuator < 3; ++actuator)
        for (const SampledField::Voxel& voxel : sampled.actuators[actuator])
            for (int level = 0; level < kBuilderLevels; ++level) {
                const double p =
                    expectation(all, actuator, level, voxel.column * height + static_cast<std::size_t>(voxel.y));
                const double sigma = std::sqrt(p * (1.0 - p) / kSamples);
                ASSERT_NEAR(voxel.expectation[static_cast<std::size_t>(level)], p, 3.0 * sigma + 1e-12);
                ++compared;
            }
    EXPECT_GT(compared, 1000U);
}

// R8, R11: what is stored stands for the oracle's expectation as well as its own report says.
TEST_P(BuilderOracle, StoredRampsAndBackgroundFitTheExpectation) {
    BuildOptions options;
    options.resolution = GetParam().resolution;
    options.levels = kBuilderLevels;
    options.samples = 1000; // more than there are states: all are used
    const Field field = buildField(coverage_->rig(), options);
    ASSERT_TRUE(field.exhaustive);
    ASSERT_EQ(field.samples, 125U);
    const std::vector<State> states = allStates(3, kBuilderLevels);
    double error = 0.0;
    std::size_t terms = 0;
    for (std::size_t actuator = 0; actuator < 3; ++actuator) {
        const std::vector<Ramp> ramps = denseRamps(field, actuator);
        for (std::size_t voxel = 0; voxel < ramps.size(); ++voxel) {
            if (ramps[voxel].v0 == kUnchanged) continue;
            for (int level = 0; level < kBuilderLevels; ++level, ++terms)
                error += std::abs(expectationAt(ramps[voxel], level) - expectation(states, actuator, level, voxel));
            ASSERT_NEAR(ramps[voxel].base / 255.0, expectation(states, actuator, 0, voxel), 0.5 / 255.0 + 1e-9);
            ASSERT_NEAR(ramps[voxel].top / 255.0, expectation(states, actuator, kBuilderLevels - 1, voxel),
                        0.5 / 255.0 + 1e-9);
        }
    }
    EXPECT_NEAR(error / static_cast<double>(terms), field.report.rampErrorMean, 1e-9);
    EXPECT_EQ(terms, field.report.changedVoxels * kBuilderLevels);
    for (std::size_t voxel = 0; voxel < field.background.size(); ++voxel) {
        std::size_t covered = 0;
        for (const State& state : states) covered += volumes_.at(key(state))[voxel];
        ASSERT_NEAR(field.background[voxel] / 255.0, static_cast<double>(covered) / 125.0, 0.5 / 255.0 + 1e-9);
    }
}

// R10: every time a sample's voxel is uncovered again at a higher level is counted, and the field still
// never falls.
TEST_P(BuilderOracle, MonotonicityIsEnforcedAndItsViolationsAreCounted) {
    BuildOptions options;
    options.resolution = GetParam().resolution;
    options.levels = kBuilderLevels;
    options.samples = 1000;
    const Field field = buildField(coverage_->rig(), options);
    std::uint64_t violations = 0;
    for (std::size_t actuator = 0; actuator < 3; ++actuator)
        for (State state : allStates(3, kBuilderLevels)) {
            std::vector<bool> seen(field.frame.voxelCount());
            for (int level = 0; level < kBuilderLevels; ++level) {
                state[actuator] = Level{level};
                const std::vector<bool>& now = volumes_.at(key(state));
                for (std::size_t voxel = 0; voxel < seen.size(); ++voxel) {
                    violations += seen[voxel] && !now[voxel];
                    seen[voxel] = seen[voxel] || now[voxel];
                }
            }
        }
    EXPECT_EQ(field.report.monotonicityViolations, violations);
    EXPECT_EQ(violations > 0, GetParam().make == &test::armRig) << "only the arm's way depends on its other joints";
    for (const ActuatorField& actuator : field.actuators)
        for (const Ramp& ramp : actuator.ramps)
            if (ramp.v0 != kUnchanged) {
                ASSERT_LT(ramp.base, ramp.top);
            }
}

// R11: matching by the stored ramps is as good as matching by the sampled expectation itself.
TEST_P(BuilderOracle, VotingByRampsIsAsGoodAsByTheSampledField) {
    constexpr int kFineLevels = 21;
    const Rig& rig = coverage_->rig();
    BuildOptions options;
    options.resolution = GetParam().resolution;
    options.levels = kFineLevels;
    const Field field = buildField(rig, options);
    EXPECT_LE(field.report.rampErrorMean, 0.02);
    const Coverage coverage(rig, field.frame, kFineLevels);
    const SampledField sampled = sampleField(coverage, sampledStates(rig, options));
    const Voting voting(field);
    Refiner refiner(coverage);
    CoverageScratch scratch;
    const auto height = static_cast<std::size_t>(field.frame.dimensions.y);
    double difference = 0.0;
    int compared = 0;
    for (const State& hidden : quasiRandomStates(3, kFineLevels, 12, 99)) {
        BitColumns target;
        coverage.covered(hidden, target, scratch);
        if (target.count() < 30) continue;
        double background = 0.0;
        for (int z = 0; z < target.dimensions().z; ++z)
            for (int x = 0; x < target.dimensions().x; ++x)
                for (int y = 0; y < target.dimensions().y; ++y)
                    if (target.test(x, y, z)) background += field.background[field.voxelIndex(x, y, z)] / 255.0;
        double total = 0.0;
        for (const std::uint8_t p : field.background) total += p / 255.0;
        State best(3);
        for (std::size_t i = 0; i < 3; ++i) {
            double bestRatio = INFINITY;
            for (std::size_t level = 0; level < kFineLevels; ++level) {
                double sum = total;
                double shared = background;
                for (const SampledField::Voxel& v : sampled.actuators[i]) {
                    const double p = field.background[v.column * height + static_cast<std::size_t>(v.y)] / 255.0;
                    const int width = field.frame.dimensions.x;
                    const bool wanted =
                        target.test(static_cast<int>(v.column) % width, v.y, static_cast<int>(v.column) / width);
                    sum += v.expectation[level] - p;
                    if (wanted) shared += v.expectation[level] - p;
                }
                const double ratio = (sum + static_cast<double>(target.count()) - 2.0 * shared) / shared;
                if (shared < 1.0 || ratio >= bestRatio) continue;
                bestRatio = ratio;
                best[i] = Level{static_cast<int>(level)};
            }
        }
        const double bySamples = refiner.qualityOf(target, best).iou();
        const double byRamps = refiner.qualityOf(target, voting.match(target).state()).iou();
        difference += byRamps - bySamples;
        ++compared;
    }
    ASSERT_GE(compared, 6);
    EXPECT_NEAR(difference / compared, 0.0, 0.02);
}

INSTANTIATE_TEST_SUITE_P(SmallRigs, BuilderOracle,
                         testing::Values(RigCase{"cushion", &test::cushionRig, 14}, RigCase{"arm", &test::armRig, 7},
                                         RigCase{"lifter", &test::lifterRig, 14}),
                         [](const auto& rig) { return rig.param.name; });

// With many levels the work of an actuator is cut into parts, and each part's ramps must come to their own voxels.
TEST(Builder, RampsOfAFineFieldLieInTheirOwnVoxels) {
    BuildOptions options;
    options.resolution = 26;
    options.levels = 200;
    options.samples = 3;
    const Rig rig = test::cushionRig();
    const Field field = buildField(rig, options);
    const Coverage coverage(rig, field.frame, options.levels);
    const ColumnRange& columns = coverage.columnsMovedBy(0);
    const double bytes = 2.0 * columns.width() * (columns.z1 - columns.z0 + 1) * field.frame.dimensions.y * 200.0;
    ASSERT_GT(bytes, 1.2 * 8'388'608.0) << "all of it is one part";
    const std::vector<State> states = sampledStates(rig, options);
    CoverageScratch scratch;
    BitColumns now;
    for (std::size_t actuator = 0; actuator < 3; ++actuator) {
        std::vector<int> atRest(field.frame.voxelCount());
        std::vector<int> atAll(field.frame.voxelCount());
        for (State state : states) {
            BitColumns seen(field.frame.dimensions);
            for (int level = 0; level < options.levels; ++level) {
                state[actuator] = Level{level};
                coverage.covered(state, now, scratch);
                seen |= now;
                if (level != 0 && level + 1 != options.levels) continue;
                std::vector<int>& counts = level == 0 ? atRest : atAll;
                for (int z = 0; z < field.frame.dimensions.z; ++z)
                    for (int x = 0; x < field.frame.dimensions.x; ++x)
                        for (int y = 0; y < field.frame.dimensions.y; ++y)
                            counts[field.voxelIndex(x, y, z)] += seen.test(x, y, z);
            }
        }
        const std::vector<Ramp> ramps = denseRamps(field, actuator);
        const auto stored = [&](int count) { return std::lround(255.0 * count / static_cast<double>(states.size())); };
        std::size_t changed = 0;
        std::size_t wrong = 0;
        for (std::size_t v = 0; v < ramps.size(); ++v) {
            const bool changes = atAll[v] > atRest[v];
            changed += changes;
            wrong += changes != (ramps[v].v0 != kUnchanged);
            if (changes) wrong += ramps[v].base != stored(atRest[v]) || ramps[v].top != stored(atAll[v]);
        }
        EXPECT_GT(changed, 5'000U);
        EXPECT_EQ(wrong, 0U) << "actuator " << actuator;
    }
}

TEST(Builder, TheSameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
    BuildOptions options;
    options.resolution = 16;
    options.levels = 9;
    options.samples = 20;
    options.threads = 1;
    const std::vector<std::byte> one = writeField(buildField(test::cushionRig(), options));
    options.threads = 4;
    EXPECT_EQ(writeField(buildField(test::cushionRig(), options)), one);
    options.seed = 2;
    EXPECT_NE(writeField(buildField(test::cushionRig(), options)), one);
}

TEST(Builder, AsManySamplesAsThereAreStatesAreAllOfThem) {
    BuildOptions options;
    options.resolution = 8;
    options.levels = 3;
    for (const auto& [samples, used, all] : {std::tuple{26, 26U, false}, {27, 27U, true}, {28, 27U, true}}) {
        options.samples = samples;
        const Field field = buildField(test::cushionRig(), options);
        EXPECT_EQ(field.samples, used);
        EXPECT_EQ(field.exhaustive, all) << samples;
    }
}

TEST(Builder, ReportsProgressAndStopsWhenAsked) {
    std::stop_source stop;
    double highest = 0.0;
    const Progress progress(
        [&](double fraction, std::string_view) {
            highest = std::max(highest, fraction);
            if (fraction > 0.0) stop.request_stop(); // it begins with 0
        },
        stop.get_token());
    BuildOptions options;
    options.threads = 1;
    EXPECT_THROW((void)buildField(test::cushionRig(), options, progress), Cancelled);
    EXPECT_GT(highest, 0.0);
}

TEST(Builder, RefusesOptionsOutOfRange) {
    const Rig rig = test::cushionRig();
    EXPECT_THROW((void)buildField(rig, {.levels = 1}), InvalidInput);
    EXPECT_THROW((void)buildField(rig, {.levels = 201}), InvalidInput);
    EXPECT_THROW((void)buildField(rig, {.samples = 0}), InvalidInput);
    EXPECT_THROW((void)buildField(rig, {.resolution = 0}), InvalidInput);
}

} // namespace
} // namespace lumorph

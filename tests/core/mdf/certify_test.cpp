#include "core/mdf/certify.h"

#include <cmath>
#include <ctime>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mdf/box_bound.h"
#include "core/mdf/refine.h"
#include "core/mdf/sampling.h"
#include "core/mdf/volume_bounds.h"
#include "core/rig/templates/bundled_rigs.h"
#include "tests/support/lifted_sheet.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

constexpr Microseconds kToTheEnd{60'000'000};

/// Wanted columns up to heights that go up and down, with crumbs.
BitColumns raggedTarget(const Coverage& coverage, std::mt19937& random) {
    const glm::ivec3 d = coverage.frame().dimensions;
    BitColumns target(d);
    const int side = 1 + static_cast<int>(random() % 5);
    std::vector<int> heights(1000);
    for (int& height : heights) height = static_cast<int>(random() % static_cast<unsigned>(d.y + 1));
    const unsigned crumbs = 8 + random() % 20;
    for (int z = 0; z < d.z; ++z)
        for (int x = 0; x < d.x; ++x) {
            const auto block = static_cast<std::size_t>(z / side * 29 + x / side) % heights.size();
            for (int y = 0; y < d.y; ++y)
                if ((y < heights[block]) != (random() % crumbs == 0)) target.set(x, y, z);
        }
    target &= coverage.domain();
    return target;
}

/// A smooth hilly landscape.
BitColumns hillyTarget(const Coverage& coverage, std::mt19937& random) {
    const glm::ivec3 d = coverage.frame().dimensions;
    BitColumns target(d);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const double a = 8.0 * share(random), b = 8.0 * share(random), base = 0.3 + 0.5 * share(random);
    for (int z = 0; z < d.z; ++z)
        for (int x = 0; x < d.x; ++x)
            for (int y = 0; y < d.y * (base + 0.25 * std::sin(a * x / d.x + b * z / d.z)); ++y) target.set(x, y, z);
    target &= coverage.domain();
    return target;
}

struct CertifyCase {
    const char* name;
    Rig (*make)();
    int resolution;
    int levels;
    std::size_t mostTabulated; ///< 0: everything that can be is bounded by boxes
    int targets;
};

class CertifyOnRig : public testing::TestWithParam<CertifyCase> {
protected:
    void SetUp() override {
        const Rig rig = GetParam().make();
        coverage_ = std::make_unique<Coverage>(rig, frameOf(rig.reach(), GetParam().resolution), GetParam().levels);
        states_ = allStates(rig.actuatorCount(), GetParam().levels);
        for (const State& state : states_) coverage_->covered(state, volumes_.emplace_back(), scratch_);
    }
    [[nodiscard]] BitColumns targetOf(int round) {
        if (round % 4 == 3) return volumes_[random_() % volumes_.size()];
        return round % 2 == 0 ? raggedTarget(*coverage_, random_) : hillyTarget(*coverage_, random_);
    }
    std::unique_ptr<Coverage> coverage_;
    CoverageScratch scratch_;
    std::vector<State> states_;
    std::vector<BitColumns> volumes_; ///< of all states
    std::mt19937 random_{5};
    SteadyClock clock_;
};

TEST_P(CertifyOnRig, BoundsAreNeverBelowTheBestOfAllStatesAndMeetIt) {
    Certifier certifier(*coverage_, {GetParam().mostTabulated});
    for (int round = 0; round < GetParam().targets; ++round) {
        const BitColumns target = targetOf(round);
        double best = 0.0;
        for (const BitColumns& volume : volumes_) best = std::max(best, compareVolumes(volume, target).iou());
        certifier.start(target, State(coverage_->rig().actuatorCount()));
        double last = 1.0;
        Certificate known;
        for (int slice = 0; slice < 100'000 && !known.done; ++slice) {
            known = certifier.tighten(Microseconds{500}, clock_);
            ASSERT_GE(known.upperBound, best) << "round " << round << ", slice " << slice;
            ASSERT_LE(known.upperBound, last) << "it only tightens";
            last = known.upperBound;
        }
        ASSERT_TRUE(known.exact) << "round " << round;
        ASSERT_EQ(known.quality.iou(), best) << "round " << round;
        ASSERT_EQ(known.upperBound, best);
        coverage_->covered(known.best, volumes_.emplace_back(), scratch_);
        ASSERT_EQ(compareVolumes(volumes_.back(), target).iou(), best) << "the state has what is said of it";
        volumes_.pop_back();
    }
}

// The bound of a box against all states in it, for boxes of all sizes.
TEST_P(CertifyOnRig, EnclosuresHoldEveryStateOfTheirBox) {
    const std::size_t count = coverage_->rig().actuatorCount();
    std::vector<std::uint16_t> actuators;
    for (std::size_t a = 0; a < count; ++a) actuators.push_back(static_cast<std::uint16_t>(a));
    const VolumeBounds bounds(*coverage_, actuators, std::vector<std::uint8_t>(coverage_->domain().columnCount(), 1));
    const auto workspace = VolumeBounds::makeWorkspace();
    VolumeEnclosure enclosure;
    BoxBound boxBound;
    for (int round = 0; round < 25; ++round) {
        State low(count), high(count);
        for (std::size_t i = 0; i < count; ++i) {
            const int a = static_cast<int>(random_() % static_cast<unsigned>(GetParam().levels));
            const int most = 1 + static_cast<int>(random_() % static_cast<unsigned>(GetParam().levels));
            low[i] = Level{a};
            high[i] =
                Level{std::min(GetParam().levels - 1, a + static_cast<int>(random_() % static_cast<unsigned>(most)))};
        }
        bounds.over(low, high, enclosure, *workspace);
        const BitColumns target = targetOf(round);
        boxBound.set(enclosure, target, coverage_->domain());
        const double lambda = 0.1 * static_cast<double>(random_() % 11);
        const double bound = boxBound.at(lambda, -1e9);
        for (std::size_t s = 0; s < states_.size(); ++s) {
            bool inside = true;
            for (std::size_t i = 0; i < count; ++i)
                inside = inside && states_[s][i] >= low[i] && states_[s][i] <= high[i];
            if (!inside) continue;
            const BitColumns& volume = volumes_[s];
            ASSERT_EQ(volume.countAnd(enclosure.possible), volume.count()) << "round " << round;
            ASSERT_EQ(volume.countAnd(enclosure.always), enclosure.always.count()) << "round " << round;
            const FitQuality quality = compareVolumes(volume, target);
            ASSERT_GE(bound, static_cast<double>(quality.both) - lambda * static_cast<double>(quality.overfilled))
                << "round " << round;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(SmallRigs, CertifyOnRig,
                         testing::Values(CertifyCase{"cushion", &test::cushionRig, 12, 9, 0, 16},
                                         CertifyCase{"cushionInTables", &test::cushionRig, 12, 7, 2000, 8},
                                         CertifyCase{"lifter", &test::lifterRig, 12, 9, 2000, 16},
                                         CertifyCase{"corners", &test::cornersRig, 14, 9, 0, 8},
                                         CertifyCase{"arm", &test::armRig, 9, 5, 0, 4},
                                         CertifyCase{"armInTables", &test::armRig, 9, 5, 2000, 4}),
                         [](const auto& rig) { return rig.param.name; });

/// Bounds after some time against what many states reach.
void expectNoStateBeats(const Coverage& coverage, const std::vector<BitColumns>& targets, Microseconds budget,
                        int states) {
    const SteadyClock clock;
    std::vector<Certificate> known;
    Certifier certifier(coverage);
    for (const BitColumns& target : targets) {
        certifier.start(target, State(coverage.rig().actuatorCount()));
        known.push_back(certifier.tighten(budget, clock));
        EXPECT_LE(known.back().quality.iou(), known.back().upperBound);
    }
    CoverageScratch scratch;
    BitColumns covered;
    Refiner refiner(coverage);
    for (std::size_t t = 0; t < targets.size(); ++t) // a search of its own
        EXPECT_LE(
            refiner.refine(targets[t], State(coverage.rig().actuatorCount()), Microseconds{50'000}, clock).after.iou(),
            known[t].upperBound);
    for (const State& state :
         quasiRandomStates(coverage.rig().actuatorCount(), coverage.levels(), static_cast<std::size_t>(states), 9)) {
        coverage.covered(state, covered, scratch);
        for (std::size_t t = 0; t < targets.size(); ++t)
            ASSERT_LE(compareVolumes(covered, targets[t]).iou(), known[t].upperBound) << "target " << t;
    }
}

TEST(Certify, NoStateOfTheCutTabletBeatsItsExactBound) {
    const Rig rig = cutTabletRig();
    const Coverage coverage(rig, frameOf(rig.reach(), 24), 17);
    std::mt19937 random(3);
    std::vector<BitColumns> targets;
    for (int k = 0; k < 2; ++k) targets.push_back(hillyTarget(coverage, random));
    targets.push_back(raggedTarget(coverage, random));
    expectNoStateBeats(coverage, targets, Microseconds{400'000}, 1000);
    Certifier certifier(coverage);
    const SteadyClock clock;
    certifier.start(targets.front(), State(rig.actuatorCount()));
    EXPECT_TRUE(certifier.tighten(kToTheEnd, clock).exact);
}

TEST(Certify, NoStateOfASheetBeatsItsBound) {
    const Rig rig(test::liftedSheetParts());
    const Coverage coverage(rig, frameOf(rig.reach(), 20), 17);
    std::mt19937 random(4);
    std::vector<BitColumns> targets;
    for (int k = 0; k < 3; ++k) targets.push_back(hillyTarget(coverage, random));
    // States of the sheet itself: the bound must leave room for all of them.
    CoverageScratch scratch;
    for (const State& state : quasiRandomStates(rig.actuatorCount(), 17, 3, 21))
        coverage.covered(state, targets.emplace_back(), scratch);
    expectNoStateBeats(coverage, targets, Microseconds{250'000}, 1500);
}

/// Boxes of a rig's states, against states drawn from them.
void expectEnclosed(const Rig& rig, int resolution, int rounds) {
    constexpr int kLevels = 33;
    const Coverage coverage(rig, frameOf(rig.reach(), resolution), kLevels);
    const std::size_t count = rig.actuatorCount();
    std::vector<std::uint16_t> actuators;
    for (std::size_t a = 0; a < count; ++a) actuators.push_back(static_cast<std::uint16_t>(a));
    const VolumeBounds bounds(coverage, actuators, std::vector<std::uint8_t>(coverage.domain().columnCount(), 1));
    const auto workspace = VolumeBounds::makeWorkspace();
    VolumeEnclosure enclosure;
    BoxBound boxBound;
    CoverageScratch scratch;
    BitColumns covered;
    std::mt19937 random(8);
    for (int round = 0; round < rounds; ++round) {
        State low(count), high(count);
        const int width = 1 << round % 6;
        for (std::size_t i = 0; i < count; ++i) {
            low[i] = Level{static_cast<int>(random() % static_cast<unsigned>(kLevels - width))};
            high[i] = Level{low[i].index + static_cast<int>(random() % static_cast<unsigned>(width + 1))};
        }
        bounds.over(low, high, enclosure, *workspace);
        const BitColumns target = hillyTarget(coverage, random);
        boxBound.set(enclosure, target, coverage.domain());
        const double bound = boxBound.at(0.7, -1e9);
        for (int draw = 0; draw < 40; ++draw) {
            State state(count);
            for (std::size_t i = 0; i < count; ++i) {
                const int span = high[i].index - low[i].index;
                state[i] =
                    Level{low[i].index + (draw < 20 ? static_cast<int>(random() % 2) * span
                                                    : static_cast<int>(random() % static_cast<unsigned>(span + 1)))};
            }
            coverage.covered(state, covered, scratch);
            ASSERT_EQ(covered.countAnd(enclosure.possible), covered.count()) << "round " << round;
            ASSERT_EQ(covered.countAnd(enclosure.always), enclosure.always.count()) << "round " << round;
            const FitQuality quality = compareVolumes(covered, target);
            ASSERT_GE(bound, static_cast<double>(quality.both) - 0.7 * static_cast<double>(quality.overfilled))
                << "round " << round;
        }
    }
}

struct EnclosedCase {
    const char* name;
    Rig (*make)();
    int resolution;
    int rounds;
};
class CertifyEnclosures : public testing::TestWithParam<EnclosedCase> {};

TEST_P(CertifyEnclosures, HoldTheStatesOfTheirBox) {
    expectEnclosed(GetParam().make(), GetParam().resolution, GetParam().rounds);
}

INSTANTIATE_TEST_SUITE_P(Rigs, CertifyEnclosures,
                         testing::Values(EnclosedCase{"sheet", [] { return Rig(test::liftedSheetParts()); }, 24, 24},
                                         EnclosedCase{"tablet", &bakedTablet, 33, 24},
                                         EnclosedCase{"cutTablet", [] { return cutTabletRig(); }, 24, 12},
                                         EnclosedCase{"ribbon", &ribbonRig, 16, 12},
                                         EnclosedCase{"hills", &hillsRig, 24, 12},
                                         EnclosedCase{"chambers", [] { return cushionRig(); }, 20, 12}),
                         [](const auto& rig) { return rig.param.name; });

TEST(Certify, NoStateOfTheTabletBeatsItsBound) {
    const Rig rig = bakedTablet();
    const Coverage coverage(rig, frameOf(rig.reach(), 24), 33);
    std::mt19937 random(14);
    std::vector<BitColumns> targets;
    for (int k = 0; k < 2; ++k) targets.push_back(hillyTarget(coverage, random));
    CoverageScratch scratch;
    for (const State& state : quasiRandomStates(rig.actuatorCount(), 33, 2, 5))
        coverage.covered(state, targets.emplace_back(), scratch);
    expectNoStateBeats(coverage, targets, Microseconds{200'000}, 800);
}

TEST(Certify, HundredsOfPinsAreSolvedExactly) {
    const Rig rig = pinDisplayRig({.columns = 16, .rows = 16});
    const Coverage coverage(rig, frameOf(rig.reach(), 24), 9);
    std::mt19937 random(6);
    const BitColumns target = hillyTarget(coverage, random);
    Certifier certifier(coverage);
    const SteadyClock clock;
    certifier.start(target, State(rig.actuatorCount()));
    const Certificate known = certifier.tighten(kToTheEnd, clock);
    EXPECT_TRUE(known.exact);
    EXPECT_EQ(known.note, "");
    Refiner refiner(coverage);
    const Refinement refined = refiner.refine(target, known.best, Microseconds{0}, clock);
    EXPECT_EQ(refined.after.iou(), known.upperBound) << "nothing helps any more";
}

/// Overlapping slabs in one place, an actuator each: all of them share voxels.
Rig pileRig(int count) {
    RigParts parts;
    parts.name = "pile";
    parts.pathInside = true;
    parts.restMesh = test::boxMesh({0.0F, 0.0F, 0.0F}, {0.1F, 0.02F, 0.1F});
    for (int k = 0; k < count; ++k) {
        const float shift = 0.001F * static_cast<float>(k % 7);
        const TriangleMesh box = test::boxMesh({0.02F + shift, 0.001F, 0.02F}, {0.07F + shift, 0.0195F, 0.08F - shift});
        Actuator actuator;
        actuator.name = "slab " + std::to_string(k);
        actuator.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.02 + 0.001 * (k % 5)};
        for (std::size_t v = 0; v < box.positions.size(); ++v)
            if (box.positions[v].y > 0.01F)
                actuator.influences.push_back({static_cast<std::uint32_t>(parts.restMesh.positions.size() + v), 1.0F});
        append(parts.restMesh, box);
        parts.actuators.push_back(std::move(actuator));
    }
    return Rig(std::move(parts));
}

TEST(Certify, TooManySharedActuatorsGetATrivialBoundThatSaysSo) {
    const Rig rig = pileRig(40);
    const Coverage coverage(rig, frameOf(rig.reach(), 10), 9);
    BitColumns target = coverage.domain();
    Certifier certifier(coverage);
    const SteadyClock clock;
    certifier.start(target, State(rig.actuatorCount()));
    const Certificate known = certifier.tighten(kToTheEnd, clock);
    EXPECT_TRUE(known.done);
    EXPECT_FALSE(known.exact);
    EXPECT_NE(known.note.find("40 actuators share voxels"), std::string::npos) << known.note;
    EXPECT_LT(known.upperBound, 1.0) << "what no actuator reaches is left out";
    CoverageScratch scratch;
    BitColumns covered;
    coverage.covered(State(rig.actuatorCount(), Level{8}), covered, scratch);
    EXPECT_LE(compareVolumes(covered, target).iou(), known.upperBound);
}

TEST(Certify, ATargetOutsideIsBoundedByZero) {
    const Rig rig = test::cushionRig();
    const Coverage coverage(rig, frameOf(rig.reach(), 12), 9);
    Certifier certifier(coverage);
    const SteadyClock clock;
    certifier.start(coverage.body(), State(3)); // all of it inside the device
    const Certificate known = certifier.tighten(Microseconds{1000}, clock);
    EXPECT_EQ(known.upperBound, 0.0);
    EXPECT_TRUE(known.exact);
    EXPECT_NE(known.note, "");
}

/// A clock that goes by the processor time of this program, so that a busy machine is no slow program.
class ProcessClock final : public Clock {
public:
    [[nodiscard]] Microseconds now() const override {
        return Microseconds(static_cast<std::int64_t>(1e6 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC));
    }
};

TEST(Certify, KeepsItsTimeAndStopsWhenAsked) {
    const Rig rig(test::liftedSheetParts());
    const Coverage coverage(rig, frameOf(rig.reach(), 33), 33);
    std::mt19937 random(12);
    const BitColumns target = hillyTarget(coverage, random);
    Certifier certifier(coverage);
    const ProcessClock clock;
    certifier.start(target, State(6));
    (void)certifier.tighten(Microseconds{400'000}, clock); // past what is made once
    // The processor time of all threads together: twice the allowance of 50 ms on two cores.
    for (const int budget : {1'000, 20'000, 100'000}) {
        const Microseconds start = clock.now();
        (void)certifier.tighten(Microseconds{budget}, clock);
        EXPECT_LE(clock.now() - start, Microseconds{budget + 100'000});
    }
    std::stop_source stop;
    stop.request_stop();
    const Microseconds start = clock.now();
    const Certificate known = certifier.tighten(kToTheEnd, clock, stop.get_token());
    EXPECT_LE(clock.now() - start, Microseconds{50'000});
    EXPECT_FALSE(known.done);
}

TEST(Certify, RefusesStatesAndTargetsThatDoNotFit) {
    const Rig rig = test::cushionRig();
    const Coverage coverage(rig, frameOf(rig.reach(), 12), 9);
    Certifier certifier(coverage);
    EXPECT_THROW(certifier.start(coverage.domain(), State(2)), InvalidInput);
    EXPECT_THROW(certifier.start(BitColumns({1, 1, 1}), State(3)), InvalidInput);
}

} // namespace
} // namespace lumorph

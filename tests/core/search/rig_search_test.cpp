#include "core/search/rig_search.h"

#include <fstream>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/base/error.h"
#include "core/rig/templates/sheet_outline.h"
#include "core/search/search_file.h"
#include "core/search/search_front.h"
#include "tests/core/file_size_limit.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/long_tests.h"

namespace lumorph {
namespace {

using testing::HasSubstr;

/// A sheet, and poses of a design of three lines on it that the search does not know.
class RigSearchTest : public testing::Test {
protected:
    RigSearchTest() {
        SheetDevice hidden = blank();
        hidden.bends = {{"a", {-0.105, 0.0}, {-0.04, -0.075}},
                        {"b", {0.03, -0.075}, {0.03, 0.075}},
                        {"c", {-0.08, 0.03}, {0.0, 0.03}, BendLine::Ends::free, BendLine::Side::left}};
        const Rig rig = sheetRig(hidden);
        for (const std::vector<double>& strokes :
             {std::vector<double>{1.0, 0.3, 0.0}, {0.2, 0.0, 0.8}, {0.0, 0.9, 0.5}})
            targets_.push_back(makeTarget(deformed(rig, strokes)));
        fit_ = std::make_unique<SheetFit>(designs_.sheet(), designs_.angle(), targets_, SheetFit::Options{24, 9});
    }
    static SheetDevice blank() {
        SheetDevice device;
        device.outline = rectangleOutline(0.21, 0.15);
        return device;
    }
    [[nodiscard]] SearchState begin(std::uint64_t seed) const { return beginSearch(designs_, 16, seed, {}, score()); }
    [[nodiscard]] ScoreBatch score() const {
        return [this](const std::vector<DesignPoint>& points) { return scorer().batch(points); };
    }
    [[nodiscard]] DesignScorer scorer() const { return {designs_, *fit_, SearchCost::servos}; }
    [[nodiscard]] SearchIdentity identity() const {
        return {"sheet", fingerprint(blank()), fingerprint(targets_), 1, 16, 4, SearchCost::servos};
    }

    SheetDesigns designs_{blank(), 4};
    std::vector<Target> targets_;
    std::unique_ptr<SheetFit> fit_;
};

TEST_F(RigSearchTest, FindsTheSameOnAnyNumberOfThreads) {
    const auto run = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        SearchState state = begin(7);
        for (int k = 0; k < 3; ++k) nextGeneration(state, score());
        return state;
    };
    const SearchState alone = run(1);
    EXPECT_TRUE(alone == run(4));
    EXPECT_EQ(alone.generation, 3);
    EXPECT_FALSE(alone == [&] {
        SearchState other = begin(8);
        for (int k = 0; k < 3; ++k) nextGeneration(other, score());
        return other;
    }());
}

TEST_F(RigSearchTest, GoesOnFromItsFileAsIfItHadNeverEnded) {
    const TemporaryFolder folder;
    SearchState whole = begin(1);
    for (int k = 0; k < 4; ++k) nextGeneration(whole, score());
    SearchState state = begin(1);
    for (int k = 0; k < 4; ++k) {
        writeSearchState(folder.path(), identity(), state);
        state = readSearchState(folder.path(), identity()).value();
        nextGeneration(state, score());
    }
    EXPECT_TRUE(state == whole);
    EXPECT_EQ(readSearchState(folder / "none", identity()), std::nullopt);
}

TEST_F(RigSearchTest, IsBetterThanAsManyRandomDesigns) {
    const int seeds = test::longTests() ? 10 : 2;
    int won = 0;
    for (int k = 1; k <= seeds; ++k) {
        const auto seed = static_cast<std::uint64_t>(1000 + k); // not those that the search was made to win
        SearchState state = begin(seed);
        for (int g = 0; g < 10; ++g) nextGeneration(state, score());
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> share(0.0, 1.0);
        std::vector<DesignPoint> points(state.evaluations, DesignPoint(designs_.dimension()));
        for (DesignPoint& point : points)
            for (double& gene : point) gene = share(random);
        std::map<double, double> best;
        for (const DesignScore& one : scorer().batch(points)) best[one.cost] = std::max(best[one.cost], one.fit);
        bool better = true;
        double reached = 0.0;
        std::map<double, double> found;
        for (const ScoredDesign& design : frontOf(state)) found[design.score.cost] = design.score.fit;
        for (const auto& [cost, fit] : best) {
            for (const auto& [paid, got] : found)
                if (paid <= cost) reached = std::max(reached, got);
            better = better && reached >= fit;
        }
        won += better ? 1 : 0;
    }
    EXPECT_GE(10 * won, 9 * seeds);
}

TEST_F(RigSearchTest, FindsAHiddenDesign) {
    const SheetFit fit(designs_.sheet(), designs_.angle(), targets_, {48, 13});
    const DesignScorer scorer(designs_, fit, SearchCost::servos);
    const ScoreBatch batch = [&](const std::vector<DesignPoint>& points) { return scorer.batch(points); };
    SearchState state = beginSearch(designs_, 32, 1, {}, batch);
    for (int k = 0; k < 250; ++k) nextGeneration(state, batch);
    SearchTargets targets;
    targets.targets = targets_;
    for (std::size_t t = 0; t < targets_.size(); ++t) {
        targets.library.push_back({"pose", targets_[t], boundingBox(targets_[t].mesh.positions)});
        targets.box.include(targets.library.back().box);
    }
    const std::vector<FrontDesign> front = buildFront(designs_, scorer, SearchCost::servos, state, targets);
    ASSERT_FALSE(front.empty());
    for (std::size_t k = 1; k < front.size(); ++k) {
        EXPECT_GT(front[k].rig.actuatorCount(), front[k - 1].rig.actuatorCount());
        EXPECT_GT(front[k].fit.mean, front[k - 1].fit.mean);
    }
    EXPECT_GT(front.back().fit.mean, 0.9); // of the hidden one's 1
}

TEST_F(RigSearchTest, FrontIsWhatNothingBeats) {
    SearchState state = begin(2);
    nextGeneration(state, score());
    std::vector<ScoredDesign> all;
    for (const auto& [cost, designs] : state.best) all.insert(all.end(), designs.begin(), designs.end());
    const std::vector<ScoredDesign> front = frontOf(state);
    for (const ScoredDesign& one : front)
        for (const ScoredDesign& other : all)
            EXPECT_FALSE(other.score.cost <= one.score.cost && other.score.fit > one.score.fit);
    for (const ScoredDesign& one : front) EXPECT_EQ(scorer().of(one.point), one.score);
}

TEST_F(RigSearchTest, StateIsLeftAloneWhenItIsStopped) {
    SearchState state = begin(3);
    const SearchState before = state;
    const ScoreBatch stopped = [](const std::vector<DesignPoint>&) -> std::vector<DesignScore> { throw Cancelled(); };
    EXPECT_THROW(nextGeneration(state, stopped), Cancelled);
    EXPECT_TRUE(state == before);
}

TEST_F(RigSearchTest, PriceIsOfServosThatCarryTheFlaps) {
    const auto priceOf = [&](double depth) {
        Flap flap;
        flap.rim = {{-100.0, 0.0}, {-100.0, depth}, {100.0, depth}, {100.0, 0.0}};
        return scorer().priceOf({flap});
    };
    // By hand: 2.4 kg/m2 on 0.2 x d m2 with its weight at d / 2, and half a newton at d.
    EXPECT_EQ(priceOf(60.0), servoType("SG90").price);    // 0.008 + 0.030 N m of 0.088
    EXPECT_EQ(priceOf(160.0), servoType("MG92B").price);  // 0.060 + 0.080 of 0.152
    EXPECT_EQ(priceOf(400.0), servoType("DS3218").price); // 0.377 + 0.200 of 0.883; the MG996R holds 0.461
}

TEST_F(RigSearchTest, FolderOfAnotherSearchIsRefusedByName) {
    const TemporaryFolder folder;
    writeSearchState(folder.path(), identity(), begin(1));
    const auto refusal = [&](const SearchIdentity& now) -> std::string {
        try {
            (void)readSearchState(folder.path(), now);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refusal(identity()), "");
    SearchIdentity other = identity();
    other.sheet += 1;
    EXPECT_THAT(refusal(other), HasSubstr("another rig, 'sheet'"));
    other = identity();
    other.targets += 1;
    EXPECT_THAT(refusal(other), HasSubstr("other targets"));
    other = identity();
    other.seed = 2;
    EXPECT_THAT(refusal(other), HasSubstr("seed 1"));
    other = identity();
    other.population = 20;
    EXPECT_THAT(refusal(other), HasSubstr("population of 16"));
    other = identity();
    other.mostServos = 5;
    EXPECT_THAT(refusal(other), HasSubstr("up to 4 servos"));
    other = identity();
    other.cost = SearchCost::price;
    EXPECT_THAT(refusal(other), HasSubstr("another cost"));
}

TEST_F(RigSearchTest, FullDiskLeavesTheStateBefore) {
    const TemporaryFolder folder;
    SearchState state = begin(1);
    writeSearchState(folder.path(), identity(), state);
    const SearchState before = state;
    nextGeneration(state, score());
    {
        const FileSizeLimit full(1000);
        EXPECT_THROW(writeSearchState(folder.path(), identity(), state), DeviceError);
    }
    EXPECT_TRUE(readSearchState(folder.path(), identity()).value() == before);
}

TEST_F(RigSearchTest, DamagedStatesAreRefused) {
    const TemporaryFolder folder;
    writeSearchState(folder.path(), identity(), begin(1));
    std::ifstream in(searchStateFile(folder.path()));
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    const auto write = [&](const std::string& content) { std::ofstream(searchStateFile(folder.path())) << content; };
    std::mt19937 random(1);
    for (int k = 0; k < 200; ++k) { // cut off, and with a byte changed: refused, or a state that still makes sense
        std::string damaged = text;
        if (k % 2 == 0)
            damaged.resize(random() % text.size());
        else
            damaged[random() % text.size()] = static_cast<char>(' ' + random() % 90);
        write(damaged);
        try {
            (void)readSearchState(folder.path(), identity());
            EXPECT_EQ(k % 2, 1);
        } catch (const Error&) {
        }
    }
    write(R"({"lumorphSearch": 1})");
    EXPECT_THROW((void)readSearchState(folder.path(), identity()), DataError);
    write("[1, 2]");
    EXPECT_THROW((void)readSearchState(folder.path(), identity()), DataError);
}

} // namespace
} // namespace lumorph

#include <algorithm>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "core/base/file.h"
#include "core/base/resources.h"
#include "core/mdf/builder.h"
#include "core/mdf/field_file.h"
#include "core/mdf/refine.h"
#include "core/mdf/sampling.h"
#include "core/mdf/voting.h"
#include "core/rig/templates/bundled_rigs.h"

namespace lumorph {
namespace {

/// The bundled tablet, on which every voxel of the top depends on all six levers.
class TabletMatching : public testing::Test {
protected:
    static const Rig& rig() {
        static const Rig tablet = bakedTablet();
        return tablet;
    }
    static const Field& field() {
        static const Field bundled = parseField(readFile(resourceFile("models/tablet.mdf"), 64U << 20U), "tablet.mdf");
        return bundled;
    }
    static const Coverage& coverage() {
        static const Coverage all(rig(), field().frame, field().levels);
        return all;
    }

    /// Voxels of the domain up to height(x, z) of all there are, x and z from -1 to 1.
    template <typename Height> static BitColumns relief(const Coverage& over, Height&& height) {
        const glm::ivec3 size = over.frame().dimensions;
        BitColumns bits(size);
        for (int z = 0; z < size.z; ++z)
            for (int x = 0; x < size.x; ++x)
                for (int y = 0; y < size.y; ++y)
                    if (over.domain().test(x, y, z) &&
                        y < size.y * height(2.0 * (x + 0.5) / size.x - 1.0, 2.0 * (z + 0.5) / size.z - 1.0))
                        bits.set(x, y, z);
        return bits;
    }
    static std::vector<BitColumns> reliefs(const Coverage& over) {
        return {relief(over, [](double x, double z) { return 0.3 + 0.35 * x * z; }),
                relief(over, [](double x, double z) { return 0.25 + 0.4 * x * x - 0.2 * z; }),
                relief(over, [](double x, double z) { return 0.2 + 0.5 * std::max(0.0, x + 0.6 * z - 0.3); })};
    }

    SteadyClock clock_;
};

TEST_F(TabletMatching, HiddenStatesAreFound) {
    Refiner refiner(coverage());
    CoverageScratch scratch;
    double worst = 1.0, worstVoted = 1.0;
    for (const State& hidden : quasiRandomStates(rig().actuatorCount(), field().levels, 20, 4711)) {
        BitColumns target;
        coverage().covered(hidden, target, scratch);
        const Refinement refined =
            refiner.refine(target, Voting(field()).match(target).state(), Microseconds{0}, clock_);
        worstVoted = std::min(worstVoted, refined.before.iou());
        worst = std::min(worst, refined.after.iou());
        EXPECT_GE(refined.after.iou(), 0.97);
    }
    std::printf("20 hidden states: IoU %.3f or more by voting, %.3f refined\n", worstVoted, worst);
}

TEST_F(TabletMatching, RefinedIsAsGoodAsTheBestOfFiftyStarts) {
    Refiner refiner(coverage());
    std::mt19937 random(2027);
    for (const BitColumns& target : reliefs(coverage())) {
        const double ours =
            refiner.refine(target, Voting(field()).match(target).state(), Microseconds{0}, clock_).after.iou();
        double best = 0.0;
        for (int start = 0; start < 50; ++start) {
            State from(rig().actuatorCount());
            for (Level& level : from) level.index = static_cast<int>(random() % static_cast<unsigned>(field().levels));
            best = std::max(best, refiner.refine(target, from, Microseconds{0}, clock_).after.iou());
        }
        EXPECT_GE(ours, 0.995 * best);
        std::printf("IoU %.4f refined from the votes, %.4f the best of 50 starts\n", ours, best);
    }
}

TEST_F(TabletMatching, RefinedIsAsGoodAsTheBestOfAllStates) {
    BuildOptions options;
    options.levels = 5;
    options.resolution = 24;
    options.samples = 24;
    const Field coarse = buildField(rig(), options);
    const Coverage all(rig(), coarse.frame, coarse.levels);
    const std::vector<BitColumns> targets = reliefs(all);
    std::vector<double> best(targets.size(), 0.0);
    BitColumns covered;
    CoverageScratch scratch;
    for (const State& state : allStates(rig().actuatorCount(), coarse.levels)) {
        all.covered(state, covered, scratch);
        for (std::size_t k = 0; k < targets.size(); ++k)
            best[k] = std::max(best[k], compareVolumes(covered, targets[k]).iou());
    }
    Refiner refiner(all);
    for (std::size_t k = 0; k < targets.size(); ++k) {
        const double ours =
            refiner.refine(targets[k], Voting(coarse).match(targets[k]).state(), Microseconds{0}, clock_).after.iou();
        EXPECT_GE(ours, 0.995 * best[k]);
        std::printf("IoU %.4f refined from the votes, %.4f the best of 15,625 states\n", ours, best[k]);
    }
}

} // namespace
} // namespace lumorph

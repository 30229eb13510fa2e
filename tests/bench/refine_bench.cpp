#include <random>

#include <benchmark/benchmark.h>

#include "core/base/clock.h"
#include "core/base/statistics.h"
#include "core/mdf/refine.h"
#include "core/mdf/sampling.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_inputs.h"
#include "tests/bench/bench_timing.h"

namespace lumorph::bench {

namespace {

constexpr Microseconds kBudget{10'000};
constexpr int kRandomStarts = 50;

/// What refinement reaches within the budget, against the best state known.
struct Outcome {
    TargetVolume::Kind kind;
    std::string name;
    double rest = 0.0;
    double voted = 0.0;
    double refined = 0.0;
    double best = 0.0;
    double states = 0.0; ///< looked at within the budget
    double seconds = 0.0;

    [[nodiscard]] bool counts() const { return best - rest >= kWorthwhile; }
    [[nodiscard]] double share() const { return refined / best; }
};

Outcome refineOne(const Device& device, Refiner& refiner, const TargetVolume& target) {
    const SteadyClock clock;
    Outcome outcome{target.kind, target.name};
    const State rest(device.coverage.rig().actuatorCount());
    outcome.rest = refiner.qualityOf(target.voxels, rest).iou();
    const State voted = device.voting.match(target.voxels).state();
    Refinement refined;
    outcome.seconds = secondsOf([&] { refined = refiner.refine(target.voxels, voted, kBudget, clock); });
    outcome.voted = refined.before.iou();
    outcome.refined = outcome.best = refined.after.iou();
    outcome.states = refined.statesSeen;
    return outcome;
}

double bestOfRandomStarts(const Coverage& coverage, Refiner& refiner, const BitColumns& target,
                          std::mt19937_64& random) {
    const SteadyClock clock;
    std::uniform_int_distribution<int> level(0, coverage.levels() - 1);
    double best = 0.0;
    for (int k = 0; k < kRandomStarts; ++k) {
        State start(coverage.rig().actuatorCount());
        for (Level& of : start) of.index = level(random);
        best = std::max(best, refiner.refine(target, start, Microseconds{0}, clock).after.iou());
    }
    return best;
}

struct Summary {
    double worst = 1.0;
    std::vector<std::string> notes;
};

Summary summarise(const std::vector<Outcome>& outcomes) {
    std::vector<double> shares;
    std::vector<double> states;
    double slowest = 0.0;
    std::string worst;
    Summary summary;
    for (const Outcome& of : outcomes) {
        slowest = std::max(slowest, of.seconds);
        if (!of.counts()) continue;
        if (shares.empty() || of.share() < smallestOf(shares))
            worst = of.name + " (voting " + fixed(of.voted, 4) + ", refined " + fixed(of.refined, 4) + ", best " +
                    fixed(of.best, 4) + ")";
        shares.push_back(of.share());
        states.push_back(of.states);
    }
    if (shares.empty()) return {0.0, {"no target counts"}};
    summary.worst = smallestOf(shares);
    summary.notes = {std::to_string(shares.size()) + " of " + std::to_string(outcomes.size()) +
                         " targets count; mean " + fixed(meanOf(shares), 4) + "; worst " + worst,
                     "median " + std::to_string(static_cast<int>(median(states))) + " states looked at; at most " +
                         fixed(1e3 * slowest, 2) + " ms"};
    return summary;
}

/// Refines every target and compares with the best of many unbudgeted starts.
std::vector<Outcome> compareWithStarts(const Device& device) {
    Refiner refiner(device.coverage);
    std::mt19937_64 random(3);
    std::vector<Outcome> outcomes;
    for (const TargetVolume& target : allTargets(device)) {
        Outcome outcome = refineOne(device, refiner, target);
        outcome.best = std::max(outcome.best, bestOfRandomStarts(device.coverage, refiner, target.voxels, random));
        if (target.kind == TargetVolume::Kind::hidden) outcome.best = 1.0; // by the state that made the target
        outcomes.push_back(outcome);
    }
    return outcomes;
}

void benchStarts(const Filter& filter, Report& report) {
    const std::string best = "refine-best";
    const std::string hidden = "refine-hidden";
    const std::string coupled = "refine-coupled";
    if (filter.wants(best) || filter.wants(hidden)) {
        const std::vector<Outcome> outcomes = compareWithStarts(*makeDevice("tablet.glb", 33));
        const Summary summary = summarise(outcomes);
        double worstHidden = 1.0;
        for (const Outcome& of : outcomes)
            if (of.kind == TargetVolume::Kind::hidden) worstHidden = std::min(worstHidden, of.refined);
        if (filter.wants(best))
            report.add(Row{best,
                           "refined within 10 ms, share of the best of 50 unbudgeted starts (worst)",
                           summary.worst,
                           "",
                           atLeast(0.98),
                           {},
                           summary.notes});
        if (filter.wants(hidden))
            report.add(Row{hidden, "IoU of 20 hidden states (worst)", worstHidden, "", atLeast(0.97), {}, {}});
    }
    if (filter.wants(coupled)) {
        const Summary summary = summarise(compareWithStarts(*makeDevice("hills.glb", 33)));
        report.add(Row{coupled,
                       "the same with three hills that overlap (worst)",
                       summary.worst,
                       "",
                       atLeast(0.98),
                       {},
                       summary.notes});
    }
}

void benchExhaustive(const Filter& filter, Report& report) {
    const std::string name = "refine-exhaustive";
    if (!filter.wants(name)) return;
    constexpr int kLevels = 5;
    const auto device = makeDevice("tablet.glb", kLevels);
    const std::vector<TargetVolume> targets = allTargets(*device);
    Refiner refiner(device->coverage);
    std::vector<Outcome> outcomes;
    for (const TargetVolume& target : targets) outcomes.push_back(refineOne(*device, refiner, target));

    CoverageScratch scratch;
    BitColumns covered;
    const std::vector<State> states = allStates(device->coverage.rig().actuatorCount(), kLevels);
    for (const State& state : states) {
        device->coverage.covered(state, covered, scratch);
        for (std::size_t t = 0; t < targets.size(); ++t)
            outcomes[t].best = std::max(outcomes[t].best, compareVolumes(covered, targets[t].voxels).iou());
    }
    Summary summary = summarise(outcomes);
    report.add(Row{name,
                   "m = 5, refined, share of the best of all " + std::to_string(states.size()) + " states (worst)",
                   summary.worst,
                   "",
                   atLeast(0.98),
                   {},
                   std::move(summary.notes)});
}

void benchEvaluation(const Filter& filter, Report& report) {
    const std::string anew = "evaluation-lean";
    const std::string kept = "evaluation-kept";
    if (!filter.wants(anew) && !filter.wants(kept)) return;
    const auto device = makeDevice("tablet.glb", 33);
    const BitColumns target = hiddenStates(device->coverage, 1, 9).front().voxels;
    const std::vector<State> states = quasiRandomStates(device->coverage.rig().actuatorCount(), 33, 64, 2);
    CoverageScratch scratch;
    BitColumns covered;
    std::size_t next = 0;
    std::vector<std::vector<double>> strokes;
    for (const State& state : states) {
        strokes.push_back(strokesOf(device->coverage.rig(), state, 33));
        device->coverage.covered(state, covered, scratch); // so that every piece is kept before it is timed
    }
    const std::vector<double> medians =
        interleavedMedians(200, {{[&] {
                                      device->coverage.coveredAt(strokes[++next % strokes.size()], covered, scratch);
                                      benchmark::DoNotOptimize(compareVolumes(covered, target).iou());
                                  },
                                  5},
                                 {[&] {
                                      device->coverage.covered(states[++next % states.size()], covered, scratch);
                                      benchmark::DoNotOptimize(compareVolumes(covered, target).iou());
                                  },
                                  5}});
    if (filter.wants(anew))
        report.add(Row{anew,
                       "one joint state of the tablet: deform, voxelise, IoU",
                       1e3 * medians[0],
                       "ms",
                       atMost(0.15),
                       {},
                       {std::to_string(device->coverage.rig().restMesh().triangles.size()) + " triangles, " +
                        std::to_string(device->coverage.rig().restMesh().positions.size()) + " vertices"}});
    if (filter.wants(kept))
        report.add(Row{kept,
                       "the same from the pieces kept for each level",
                       1e3 * medians[1],
                       "ms",
                       {},
                       {},
                       {"kept pieces: " + fixed(static_cast<double>(device->coverage.bytes()) / 1e6, 1) + " MB"}});
}

} // namespace

void benchRefine(const Filter& filter, Report& report) {
    benchEvaluation(filter, report);
    benchStarts(filter, report);
    benchExhaustive(filter, report);
}

} // namespace lumorph::bench

#include <algorithm>
#include <set>
#include <stdexcept>

#include "core/base/statistics.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_inputs.h"
#include "tests/bench/bench_timing.h"
#include "tests/bench/literal_voting.h"

namespace lumorph::bench {

namespace {

constexpr std::size_t kDistinctLevels = 4;

/// Medians for one target, seconds.
struct VotingTimes {
    double literal = 0.0;
    double vectorised = 0.0;
    double voting = 0.0;
};

std::vector<TargetVolume> variedTargets(const Device& device) {
    std::vector<TargetVolume> targets = hiddenStates(device.coverage, 8, 11);
    for (TargetVolume& target : wavesAndReliefs(device.field, device.coverage.domain())) targets.push_back(target);
    for (TargetVolume& target : meshTargets(device.field, device.coverage.domain())) targets.push_back(target);
    std::erase_if(targets, [&](const TargetVolume& target) {
        const State state = device.voting.match(target.voxels).state();
        return std::set<Level>(state.begin(), state.end()).size() < kDistinctLevels;
    });
    return targets;
}

VotingTimes measureVoting(const Device& device, const DenseField& dense, const TargetVolume& target) {
    const std::vector<float> wanted = denseTarget(device.field, target.voxels);
    const std::vector<std::size_t> reachable = reachableVoxels(dense, wanted);
    EquationSums sums;
    State literal;
    State vectorised;
    Votes votes;
    Voting::Workspace workspace;
    const std::vector<double> medians =
        interleavedMedians(7, {{[&] {
                                   literalSums(dense, wanted, sums);
                                   literal = chosenState(dense, sums, reachable);
                               }},
                               {[&] {
                                   vectorisedSums(dense, wanted, sums);
                                   vectorised = chosenState(dense, sums, reachable);
                               }},
                               {[&] { device.voting.match(target.voxels, votes, workspace); }, 50}});
    const State voted = votes.state();
    if (literal != voted) throw std::runtime_error("the literal loop finds another state for " + target.name);
    if (vectorised != voted) throw std::runtime_error("the vectorised loop finds another state for " + target.name);
    return {medians[0], medians[1], medians[2]};
}

} // namespace

void benchVoting(const Filter& filter, Report& report) {
    const std::string names[] = {"voting-literal", "voting-literal-worst", "voting-vectorised", "voting-match",
                                 "voting-baseline"};
    if (std::none_of(std::begin(names), std::end(names), [&](const auto& name) { return filter.wants(name); })) return;
    const auto device = makeDevice("tablet.glb", 33);
    const DenseField dense(device->field);
    const std::vector<TargetVolume> targets = variedTargets(*device);
    if (targets.empty()) throw std::runtime_error("no target has an answer of four distinct levels");

    std::vector<double> literalRatios;
    std::vector<double> vectorisedRatios;
    std::vector<double> milliseconds;
    std::vector<double> nanoseconds;
    for (const TargetVolume& target : targets) {
        const VotingTimes of = measureVoting(*device, dense, target);
        literalRatios.push_back(of.literal / of.voting);
        vectorisedRatios.push_back(of.vectorised / of.voting);
        milliseconds.push_back(1e3 * of.voting);
        nanoseconds.push_back(1e9 * of.literal / static_cast<double>(dense.expectation.size()));
    }
    const glm::ivec3 size = device->field.frame.dimensions;
    const std::string inputs = std::to_string(size.x) + "x" + std::to_string(size.y) + "x" + std::to_string(size.z) +
                               ", " + std::to_string(dense.voxels) + " voxels outside the body, " +
                               std::to_string(dense.actuators) + " actuators, " + std::to_string(dense.levels) +
                               " levels; " + std::to_string(targets.size()) +
                               " targets with at least four distinct levels; same states on both sides";
    const auto add = [&](Row row) {
        if (filter.wants(row.name)) report.add(std::move(row));
    };
    add({names[0],
         "Eq. 1 against the literal loop (median target)",
         median(literalRatios),
         "x",
         atLeast(400.0),
         atLeast(1000.0),
         {inputs}});
    add({names[1],
         "Eq. 1 against the literal loop (worst target)",
         smallestOf(literalRatios),
         "x",
         atLeast(400.0),
         atLeast(1000.0),
         {}});
    add({names[2],
         "Eq. 1 against dense vector sums (median target)",
         median(vectorisedRatios),
         "x",
         {},
         {},
         {"worst target " + fixed(smallestOf(vectorisedRatios), 0) + "x"}});
    add({names[3],
         "one match (slowest target)",
         *std::max_element(milliseconds.begin(), milliseconds.end()),
         "ms",
         {},
         atMost(0.1),
         {"median target " + fixed(median(milliseconds), 4) + " ms"}});
    add({names[4],
         "literal loop, a voxel, actuator and level (slowest target)",
         *std::max_element(nanoseconds.begin(), nanoseconds.end()),
         "ns",
         atMost(1.4),
         {},
         {"where this is missed the baseline is too slow, and the ratios above say too much"}});
}

} // namespace lumorph::bench

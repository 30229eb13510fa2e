#include <algorithm>

#include "core/base/clock.h"
#include "core/base/statistics.h"
#include "core/mdf/certify.h"
#include "core/mdf/refine.h"
#include "core/rig/templates/bundled_rigs.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_inputs.h"

namespace lumorph::bench {
namespace {

constexpr Microseconds kRefining{10'000};

/// What is left between the bound and the best state known, of each target.
struct Gaps {
    std::vector<double> all, solids; ///< solids: without volumes of the device's own states
    std::size_t exact = 0;

    [[nodiscard]] std::vector<std::string> notes() const {
        return {std::to_string(exact) + " of " + std::to_string(all.size()) + " exact; worst " +
                    fixed(*std::ranges::max_element(all), 4),
                "meshes, waves and reliefs alone: median " + fixed(median(solids), 4) + ", worst " +
                    fixed(*std::ranges::max_element(solids), 4)};
    }
};

std::vector<TargetVolume> targetsOf(const Device& device) {
    std::vector<TargetVolume> targets = meshTargets(device.field, device.coverage.domain());
    for (TargetVolume& target : wavesAndReliefs(device.field, device.coverage.domain())) targets.push_back(target);
    for (TargetVolume& target : hiddenStates(device.coverage, 20, 7)) targets.push_back(target);
    return targets;
}

/// After each of the times; each target is certified once, for the longest of them.
std::vector<Gaps> gapsAfter(const Device& device, const std::vector<double>& seconds) {
    const SteadyClock clock;
    Refiner refiner(device.coverage);
    std::vector<Gaps> gaps(seconds.size());
    for (const TargetVolume& target : targetsOf(device)) {
        if (target.voxels.count() == 0) continue;
        Certifier certifier(device.coverage);
        const State voted = device.voting.match(target.voxels).state();
        certifier.start(target.voxels, refiner.refine(target.voxels, voted, kRefining, clock).state);
        const Microseconds start = clock.now();
        for (std::size_t k = 0; k < seconds.size(); ++k) {
            const Microseconds end = start + Microseconds(static_cast<std::int64_t>(1e6 * seconds[k]));
            const Certificate known = certifier.tighten(end - clock.now(), clock);
            gaps[k].all.push_back(known.gap());
            if (target.kind != TargetVolume::Kind::hidden) gaps[k].solids.push_back(known.gap());
            gaps[k].exact += known.exact ? 1U : 0U;
        }
    }
    return gaps;
}

} // namespace

void benchCertify(const Filter& filter, Report& report) {
    const std::string cut = "certify-cut", sheet = "certify-sheet", longer = "certify-sheet-minute";
    const std::string what = "certified gap (upper bound - IoU), median over the targets, ";
    if (filter.wants(cut)) {
        BuildOptions options;
        options.levels = 33;
        const Device device(cutTabletRig(), options);
        const Gaps gaps = gapsAfter(device, {1.0}).front();
        report.add(Row{cut, what + "cut tablet after 1 s", median(gaps.all), "", atMost(0.01), {}, gaps.notes()});
    }
    if (!filter.wants(sheet) && !filter.wants(longer)) return;
    const auto device = makeDevice("tablet.glb", 33);
    // A minute for each target is for those who ask for it by name.
    const bool minute = filter.text == longer;
    const std::vector<Gaps> gaps = gapsAfter(*device, minute ? std::vector{1.0, 60.0} : std::vector{1.0});
    report.add(
        Row{sheet, what + "the sheet after 1 s", median(gaps.front().all), "", atMost(0.10), {}, gaps.front().notes()});
    if (minute)
        report.add(
            Row{longer, what + "after 60 s", median(gaps.back().all), "", atMost(0.03), {}, gaps.back().notes()});
}

} // namespace lumorph::bench

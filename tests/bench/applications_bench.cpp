#include <algorithm>
#include <memory>

#include "app/applications/program_start.h"
#include "app/applications/registry/demos.h"
#include "core/base/statistics.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_timing.h"

namespace lumorph::bench {
namespace {

constexpr double kStep = 1.0 / 60.0;
constexpr int kFramesPlayed = 60 * 60;

/// What a visitor does in a frame: keys pressed and released, a pointer that moves.
std::vector<ShowInput> visitorDoes(int frame) {
    switch (frame % 1200) {
    case 300:
        return {{"key.next", 1.0}};
    case 400:
        return {{"pointer.x", 0.4}, {"key.right", 1.0}};
    case 600:
        return {{"pointer.x", 0.0}, {"key.right", 0.0}, {"key.rain", 1.0}};
    case 800:
        return {{"key.rain", 0.0}, {"key.in", 1.0}};
    case 900:
        return {{"key.in", 0.0}};
    default:
        return {};
    }
}

/// Milliseconds of one core for each frame of a minute with a visitor.
std::vector<double> frameTimes(const Demo& demo) {
    const ProjectContents contents = demo.open({});
    const std::unique_ptr<ShowProgram> program = beginProgram(demo, {.seed = 1}).program;
    ShowMoment moment;
    moment.rig = contents.rig;
    moment.installation = std::make_shared<const Installation>(defaultInstallation());
    std::vector<double> milliseconds;
    for (int k = 0; k < kFramesPlayed; ++k) {
        const std::vector<ShowInput> inputs = visitorDoes(k);
        moment.inputs = inputs;
        const double begun = threadSeconds();
        (void)program->frame(moment);
        milliseconds.push_back(1e3 * (threadSeconds() - begun));
        moment.step = kStep;
        moment.seconds += kStep;
    }
    return milliseconds;
}

} // namespace

void benchApplications(const Filter& filter, Report& report) {
    for (const Demo& demo : demos()) {
        const std::string name = "application-" + demo.name;
        if (!demo.program || !filter.wants(name)) continue;
        std::vector<double> shares = frameTimes(demo); // of a frame's time
        for (double& share : shares) share *= 1e-1 / kStep;
        std::ranges::sort(shares);
        report.add({name, "a frame of the application alone, median of a minute with a visitor", median(shares),
                    "% of a frame", atMost(12.0)});
        report.add({name + "-slow", "the same, the slowest frame but 1 in 100", shares[shares.size() * 99 / 100],
                    "% of a frame", atMost(48.0)});
    }
}

} // namespace lumorph::bench

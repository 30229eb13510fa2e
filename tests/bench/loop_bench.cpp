#include <numeric>

#include "core/base/clock.h"
#include "core/base/statistics.h"
#include "core/geometry/model.h"
#include "core/mdf/placement.h"
#include "core/mdf/refine.h"
#include "core/motion/motion.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_inputs.h"
#include "tests/bench/bench_timing.h"

namespace lumorph::bench {

namespace {

/// Everything between a pose and the deformed rig, as a frame of the loop does it.
class Loop {
public:
    static constexpr const char* kStages[] = {"pose", "voxelise", "match", "refine", "motion", "deform"};
    static constexpr std::size_t kStageCount = std::size(kStages);

    explicit Loop(const Device& device)
        : device_(device), target_(modelOf(bumpyEllipsoid(), "target")),
          placement_(fitPlacement(device.field, boundingBox(flatten(target_).positions))), refiner_(device.coverage),
          motion_(limitsOf(device.coverage.rig())), deformed_(device.coverage.rig().restMesh().positions.size()) {}

    /// Seconds of each stage; a refinement budget of zero leaves refinement out.
    std::vector<double> frame(int number, Microseconds budget) {
        std::vector<double> seconds(kStageCount, 0.0);
        TriangleMesh mesh;
        seconds[0] = secondsOf([&] {
            placement_.yaw = Angle::degrees(3.0 * number);
            target_.nodes.front().matrix = placement_.deviceFromTarget();
            mesh = flatten(target_);
        });
        seconds[1] =
            secondsOf([&] { voxelizer_.voxelize(device_.field.frame, mesh.positions, mesh.triangles, wanted_); });
        seconds[2] = secondsOf([&] { device_.voting.match(wanted_, votes_, workspace_); });
        State state = votes_.state();
        if (budget > Microseconds{0})
            seconds[3] = secondsOf([&] { state = refiner_.refine(wanted_, state, budget, clock_).state; });
        std::span<const double> strokes;
        seconds[4] = secondsOf([&] {
            strokes = motion_.step(strokesOf(device_.coverage.rig(), state, device_.field.levels), 1.0 / 60.0);
        });
        seconds[5] = secondsOf([&] { device_.coverage.rig().deform(strokes, deformed_); });
        return seconds;
    }

private:
    static std::vector<MotionLimits> limitsOf(const Rig& rig) {
        std::vector<MotionLimits> limits;
        for (const Actuator& actuator : rig.actuators())
            limits.push_back({actuator.maxVelocity, actuator.dampingRatio});
        return limits;
    }

    const Device& device_;
    Model target_;
    Placement placement_;
    SteadyClock clock_;
    SolidVoxelizer voxelizer_;
    BitColumns wanted_;
    Votes votes_;
    Voting::Workspace workspace_;
    Refiner refiner_;
    MotionModel motion_;
    std::vector<glm::vec3> deformed_;
};

Row measure(Loop& loop, const std::string& name, const std::string& what, Microseconds budget) {
    constexpr int kFramesLooped = 120;
    std::vector<double> whole;
    std::vector<std::vector<double>> stages(Loop::kStageCount);
    for (int number = 0; number < kFramesLooped; ++number) {
        const std::vector<double> seconds = loop.frame(number, budget);
        whole.push_back(1e3 * std::accumulate(seconds.begin(), seconds.end(), 0.0));
        for (std::size_t s = 0; s < seconds.size(); ++s) stages[s].push_back(1e3 * seconds[s]);
    }
    std::string note = "medians of " + std::to_string(kFramesLooped) + " frames, ms:";
    for (std::size_t s = 0; s < stages.size(); ++s)
        note += std::string(" ") + Loop::kStages[s] + " " + fixed(median(stages[s]), 3);
    return {name, what, median(whole), "ms", atMost(3.0), {}, {note}};
}

} // namespace

void benchLoop(const Filter& filter, Report& report) {
    if (!filter.wants("loop-voting") && !filter.wants("loop-refined")) return;
    const auto device = makeDevice("tablet.glb", 33);
    Loop loop(*device);
    if (filter.wants("loop-voting"))
        report.add(
            measure(loop, "loop-voting", "one frame without rendering, 70,000-triangle target", Microseconds{0}));
    if (filter.wants("loop-refined"))
        report.add(measure(loop, "loop-refined", "the same, refined for at most 0.5 ms", Microseconds{500}));
}

} // namespace lumorph::bench

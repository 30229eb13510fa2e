#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>

#include <glm/gtc/quaternion.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/clock.h"
#include "core/mdf/auto_place.h"
#include "core/mdf/placement_scorer.h"
#include "core/mdf/refine.h"
#include "core/rig/templates/rig_templates.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_inputs.h"
#include "tests/bench/bench_timing.h"

namespace lumorph::bench {

namespace {

constexpr std::size_t kGridPoses = 10'000;

struct NamedTarget {
    std::string name;
    Target target;
};

std::vector<NamedTarget> modelsToPlace() {
    std::vector<NamedTarget> models{{"bumpy ellipsoid", makeTarget(bumpyEllipsoid())}};
    for (const char* file : kSharedMeshes)
        if (std::optional<TriangleMesh> mesh = sharedMesh(file)) models.push_back({file, makeTarget(std::move(*mesh))});
    return models;
}

/// The best refined IoU of poses drawn over all orientations, over the whole frame, at sizes from a fifth to twice
/// what fits, with the rules that auto-place keeps.
double bestOfRandomPoses(const Device& device, const Target& target, std::uint64_t seed) {
    const AutoPlaceOptions rules;
    const TargetGrid grid(target);
    const Box frame = device.field.frame.box();
    struct Worker {
        explicit Worker(const Coverage& coverage) : refiner(coverage) {}
        Refiner refiner;
        BitColumns bits;
        Votes votes;
        Voting::Workspace voting;
    };
    tbb::enumerable_thread_specific<Worker> workers([&] { return Worker(device.coverage); });
    std::vector<double> best(kGridPoses, 0.0);
    tbb::parallel_for(std::size_t{0}, kGridPoses, [&](std::size_t k) {
        std::mt19937_64 random(seed * 1'000'003 + k);
        std::normal_distribution<float> normal;
        std::uniform_real_distribution<float> unit(0.0F, 1.0F);
        Placement at;
        at.orientation = glm::normalize(glm::quat(normal(random), normal(random), normal(random), normal(random)));
        Box turned;
        for (const glm::vec3& corner : grid.hull()) turned.include(at.orientation * corner);
        const glm::vec3 share =
            glm::vec3(frame.size().x, frame.max.y - device.field.restSurface, frame.size().z) / turned.size();
        const float scale = std::min({share.x, share.y, share.z}) * 0.2F * std::pow(10.0F, unit(random));
        at.scale = static_cast<double>(scale);
        const glm::vec3 middle = frame.min + frame.size() * glm::vec3(unit(random), 0.0F, unit(random));
        const float height = scale * turned.size().y;
        at.translation = glm::vec3(middle.x, device.field.restSurface - 0.5F * unit(random) * height, middle.z) -
                         scale * glm::vec3(turned.centre().x, turned.min.y, turned.centre().z);
        std::size_t inFrame = 0;
        for (const glm::vec3& sample : grid.samples()) {
            const glm::vec3 p(at.deviceFromTarget() * glm::vec4(sample, 1.0F));
            inFrame +=
                p.x > frame.min.x && p.x < frame.max.x && p.z > frame.min.z && p.z < frame.max.z && p.y < frame.max.y;
        }
        if (static_cast<double>(inFrame) < rules.minInFrame * static_cast<double>(grid.samples().size())) return;
        Worker& worker = workers.local();
        grid.lookUp(device.field.frame, at.deviceFromTarget(), worker.bits);
        worker.bits &= device.coverage.domain();
        if (static_cast<double>(worker.bits.count()) * device.field.frame.voxelVolume() <
            rules.minInside * grid.volume() * std::pow(at.scale, 3.0))
            return;
        device.voting.match(worker.bits, worker.votes, worker.voting);
        best[k] =
            worker.refiner.refine(worker.bits, worker.votes.state(), Microseconds{4000}, SteadyClock()).after.iou();
    });
    return *std::ranges::max_element(best);
}

} // namespace

void benchPlacement(const Filter& filter, Report& report) {
    const std::string grid = "place-grid", seconds = "place-seconds";
    if (!filter.wants(grid) && !filter.wants(seconds)) return;
    const std::vector<NamedTarget> models = modelsToPlace();
    BuildOptions build;
    build.samples = 64;
    std::vector<double> shares, times;
    std::vector<std::string> notes;
    for (const char* kind : {"tablet", "flower", "book", "phone"}) {
        const Device device(rigOf(rigTemplate(kind), {}), build);
        for (const NamedTarget& model : models) {
            AutoPlacement found;
            times.push_back(
                secondsOf([&] { found = autoPlace(device.field, device.coverage, device.voting, model.target); }));
            std::string note = std::string(kind) + ", " + model.name + ": " + fixed(found.iou, 3) + " in " +
                               fixed(times.back(), 2) + " s, " + fixed(found.iouAtFit, 3) + " where it fits";
            if (filter.wants(grid)) {
                const double best = bestOfRandomPoses(device, model.target, 11);
                if (best > 0.0) shares.push_back(found.iou / best);
                note += ", " + fixed(best, 3) + " the best of 10,000 poses";
            }
            notes.push_back(std::move(note));
        }
    }
    if (filter.wants(grid)) {
        std::vector<double> sorted = shares;
        std::ranges::sort(sorted);
        const double tenth = sorted.empty() ? 0.0 : sorted[sorted.size() / 10];
        report.add(Row{grid,
                       "auto-place, IoU against the best of 10,000 random poses (a tenth lies below)",
                       tenth,
                       "",
                       atLeast(0.98),
                       {},
                       notes});
    }
    if (filter.wants(seconds))
        report.add(Row{seconds,
                       "auto-place of a model, most of them with 10,000 triangles or more (median)",
                       median(times),
                       "s",
                       atMost(2.0),
                       {},
                       filter.wants(grid) ? std::vector<std::string>{} : notes});
}

} // namespace lumorph::bench

#include "tests/bench/bench_groups.h"
#include "tests/bench/field_measurement.h"

namespace lumorph::bench {

namespace {

Series emptySeries(const std::string& name, const std::string& title, const std::string& first) {
    return {name,
            title,
            {first, "voxels", "changed voxels", "build s", "ns/changed voxel, sample", "peak MB", "file MB", "match ms",
             "changed target voxels", "match ns/changed target voxel"},
            {}};
}

std::vector<double> lineOf(double first, const FieldJob& job, const FieldMeasurement& of) {
    const auto changed = static_cast<double>(of.changedVoxels);
    return {first,
            static_cast<double>(of.voxels),
            changed,
            of.buildSeconds,
            1e9 * of.buildSeconds / (changed * job.samples),
            static_cast<double>(of.peakBytes) / 1e6,
            static_cast<double>(of.fileBytes) / 1e6,
            1e3 * of.matchSeconds,
            of.changedTargetVoxels,
            1e9 * of.matchSeconds / of.changedTargetVoxels};
}

} // namespace

void benchScaling(const Filter& filter, Report& report) {
    if (filter.wants("scaling-resolution")) {
        Series series =
            emptySeries("scaling-resolution", "the tablet, 33 levels, two cores; 64 samples, 16 at r = 129", "r");
        for (const int resolution : {17, 33, 65, 129}) {
            FieldJob job{"tablet.glb"};
            job.resolution = resolution;
            job.samples = resolution > 65 ? 16 : 64;
            series.lines.push_back(lineOf(resolution, job, measureField(job)));
        }
        report.add(std::move(series));
    }
    if (filter.wants("scaling-actuators")) {
        Series series =
            emptySeries("scaling-actuators",
                        "the pin display with only some pins driven, 101 levels, 64 samples, two cores", "actuators");
        FieldJob job{"pin_display.glb"};
        job.levels = 101;
        job.resolution = resolutionFor(job.model, 1'000'000);
        for (const std::size_t driven : {6U, 24U, 96U, 900U}) {
            job.driven = driven;
            series.lines.push_back(lineOf(static_cast<double>(driven), job, measureField(job)));
        }
        report.add(std::move(series));
    }
}

} // namespace lumorph::bench

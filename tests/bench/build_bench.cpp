#include "tests/bench/bench_groups.h"
#include "tests/bench/field_measurement.h"

namespace lumorph::bench {

namespace {

constexpr double kMegabyte = 1e6;

std::string describe(const FieldMeasurement& of, const FieldJob& job) {
    return std::to_string(of.voxels) + " voxels (r = " + std::to_string(job.resolution) + "), " +
           std::to_string(of.actuators) + " actuators, " + std::to_string(job.levels) + " levels, " +
           std::to_string(job.samples) + " samples; " + std::to_string(of.changedVoxels) +
           " changed voxels; mean ramp error " + fixed(of.rampErrorMean, 5);
}

void benchTablet(const Filter& filter, Report& report) {
    const std::string seconds = "build-tablet-time";
    const std::string memory = "build-tablet-memory";
    if (!filter.wants(seconds) && !filter.wants(memory)) return;
    const FieldJob job{"tablet.glb"};
    const FieldMeasurement of = measureField(job);
    if (filter.wants(seconds))
        report.add(Row{seconds,
                       "MDF build of the tablet, two cores",
                       of.buildSeconds,
                       "s",
                       atMost(10.0),
                       {},
                       {describe(of, job)}});
    if (filter.wants(memory))
        report.add(Row{memory,
                       "its peak memory, packing the file included",
                       static_cast<double>(of.peakBytes) / kMegabyte,
                       "MB",
                       atMost(300.0),
                       {},
                       {}});
}

void benchPins(const Filter& filter, Report& report) {
    const std::string names[] = {"pins-build", "pins-match", "pins-file"};
    if (!filter.wants(names[0]) && !filter.wants(names[1]) && !filter.wants(names[2])) return;
    FieldJob job{"pin_display.glb"};
    job.levels = 101;
    job.resolution = resolutionFor(job.model, 1'000'000);
    const FieldMeasurement of = measureField(job);
    const auto add = [&](Row row) {
        if (filter.wants(row.name)) report.add(std::move(row));
    };
    add({names[0],
         "pin display 30 x 30, MDF build, two cores",
         of.buildSeconds,
         "s",
         atMost(60.0),
         {},
         {describe(of, job), "peak memory " + fixed(static_cast<double>(of.peakBytes) / kMegabyte, 0) + " MB"}});
    add({names[1],
         "pin display 30 x 30, one match (slowest of 14 targets)",
         1e3 * of.matchSeconds,
         "ms",
         atMost(5.0),
         {},
         {}});
    add({names[2],
         "pin display 30 x 30, .mdf file",
         static_cast<double>(of.fileBytes) / kMegabyte,
         "MB",
         atMost(50.0),
         {},
         {}});
}

} // namespace

void benchBuild(const Filter& filter, Report& report) {
    benchTablet(filter, report);
    benchPins(filter, report);
}

} // namespace lumorph::bench

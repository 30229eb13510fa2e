#include "tests/bench/field_measurement.h"

#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <unistd.h>

#include <nlohmann/json.hpp>

#include "core/base/resources.h"
#include "core/mdf/field_file.h"
#include "core/rig/rig_file.h"
#include "tests/bench/bench_inputs.h"
#include "tests/bench/bench_timing.h"

namespace lumorph::bench {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FieldJob, model, resolution, levels, samples, driven)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FieldMeasurement, voxels, actuators, changedVoxels, fileBytes, peakBytes,
                                   buildSeconds, matchSeconds, changedTargetVoxels, rampErrorMean)

namespace {

Rig withDriven(const Rig& rig, std::size_t count) {
    if (count == 0 || count >= rig.actuatorCount()) return rig;
    RigParts parts = rig.parts();
    std::vector<Actuator> kept;
    for (std::size_t k = 0; k < count; ++k)
        kept.push_back(std::move(parts.actuators[k * parts.actuators.size() / count]));
    parts.actuators = std::move(kept);
    return Rig(std::move(parts));
}

/// The most memory this process has held, as the kernel counts it since it was started.
std::size_t peakResidentBytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
    throw std::runtime_error("/proc/self/status tells no VmHWM");
}

double changedWithin(const Field& field, const BitColumns& target) {
    const auto width = static_cast<std::uint32_t>(field.frame.dimensions.x);
    std::size_t count = 0;
    for (const ActuatorField& actuator : field.actuators)
        for (const ActuatorField::Run& run : actuator.runs)
            for (std::uint32_t k = 0; k < run.count; ++k)
                if (actuator.ramps[run.firstRamp + k].v0 != kUnchanged &&
                    target.test(static_cast<int>(run.column % width), static_cast<int>(run.firstY + k),
                                static_cast<int>(run.column / width)))
                    ++count;
    return static_cast<double>(count);
}

void measureMatches(const Rig& rig, const Field& field, FieldMeasurement& result) {
    const Coverage coverage(rig, field.frame, field.levels);
    const Voting voting(field);
    std::vector<TargetVolume> targets = hiddenStates(coverage, 2, 5);
    for (TargetVolume& target : wavesAndReliefs(field, coverage.domain())) targets.push_back(target);
    Votes votes;
    Voting::Workspace workspace;
    for (const TargetVolume& target : targets) {
        const double seconds =
            interleavedMedians(15, {{[&] { voting.match(target.voxels, votes, workspace); }}}).front();
        if (seconds <= result.matchSeconds) continue;
        result.matchSeconds = seconds;
        result.changedTargetVoxels = changedWithin(field, target.voxels);
    }
}

} // namespace

void measureFieldHere(const std::string& job) {
    const auto of = nlohmann::json::parse(job).get<FieldJob>();
    FieldMeasurement result;
    {
        const Rig rig = withDriven(readRig(resourceFile("models/" + of.model)), of.driven);
        BuildOptions options;
        options.resolution = of.resolution;
        options.levels = of.levels;
        options.samples = of.samples;
        options.threads = 2;
        Field field;
        result.buildSeconds = secondsOf([&] { field = buildField(rig, options); });
        result.fileBytes = writeField(field).size();
        result.peakBytes = peakResidentBytes();
        result.voxels = field.frame.voxelCount();
        result.actuators = field.actuators.size();
        result.changedVoxels = field.report.changedVoxels;
        result.rampErrorMean = field.report.rampErrorMean;
        measureMatches(rig, field, result);
    }
    std::printf("%s\n", nlohmann::json(result).dump().c_str());
}

FieldMeasurement measureField(const FieldJob& job) {
    // The job holds no quote: its names are file names of ours.
    const std::string command =
        "exec /proc/" + std::to_string(getpid()) + "/exe " + kMeasureFlag + " '" + nlohmann::json(job).dump() + "'";
    const auto closePipe = [](std::FILE* pipe) { return pclose(pipe); };
    const std::unique_ptr<std::FILE, decltype(closePipe)> pipe(popen(command.c_str(), "r"), closePipe);
    if (!pipe) throw std::runtime_error("cannot start a process to measure in");
    std::string text;
    char part[4096];
    while (const std::size_t size = std::fread(part, 1, sizeof part, pipe.get())) text.append(part, size);
    const nlohmann::json measured = nlohmann::json::parse(text, nullptr, false);
    if (measured.is_discarded()) throw std::runtime_error("measuring " + job.model + " failed; its error stands above");
    return measured.get<FieldMeasurement>();
}

int resolutionFor(const std::string& model, std::size_t voxels) {
    const Box reach = readRig(resourceFile("models/" + model)).reach();
    int resolution = 1;
    while (frameOf(reach, resolution).voxelCount() < voxels) ++resolution;
    return resolution;
}

} // namespace lumorph::bench

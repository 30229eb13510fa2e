#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "app/cli/field_input.h"
#include "core/base/error.h"
#include "core/loop/match_field.h"
#include "core/mdf/builder.h"
#include "core/mdf/field_export.h"
#include "core/mdf/field_file.h"
#include "core/mdf/field_story.h"
#include "core/rig/rig_file.h"
#include "core/voxels/nrrd.h"

namespace lumorph::cli {

namespace {

/// Monotonicity violations among all that were looked for: changed voxels x sampled states x levels.
double violationShare(const Field& field) {
    const double looked = static_cast<double>(field.report.changedVoxels) * field.samples * field.levels;
    return looked > 0.0 ? static_cast<double>(field.report.monotonicityViolations) / looked : 0.0;
}

nlohmann::json infoJson(const Field& field, std::size_t bytes) {
    nlohmann::json names = nlohmann::json::array();
    for (const ActuatorField& actuator : field.actuators) names.push_back(actuator.name);
    const VoxelFrame& f = field.frame;
    return {{"rig", field.rigName},
            {"dims", {f.dimensions.x, f.dimensions.y, f.dimensions.z}},
            {"origin", {f.origin.x, f.origin.y, f.origin.z}},
            {"voxelSize", f.voxelSize},
            {"restSurface", field.restSurface},
            {"levels", field.levels},
            {"samples", field.samples},
            {"exhaustive", field.exhaustive},
            {"seed", field.seed},
            {"actuators", names},
            {"voxels", f.voxelCount()},
            {"bodyVoxels", field.body.count()},
            {"reachable", reachableVoxels(field).count()},
            {"changedVoxels", field.report.changedVoxels},
            {"rampError", {{"mean", field.report.rampErrorMean}, {"max", field.report.rampErrorMax}}},
            {"monotonicityViolations", field.report.monotonicityViolations},
            {"monotonicityViolationShare", violationShare(field)},
            {"bytes", bytes}};
}

void printInfo(const Field& field, std::size_t bytes) {
    const glm::ivec3& d = field.frame.dimensions;
    std::printf("%s: %d x %d x %d voxels of %.3f mm, %zu actuators with %d levels\n", field.rigName.c_str(), d.x, d.y,
                d.z, 1000 * field.frame.voxelSize, field.actuators.size(), field.levels);
    std::printf("  expectation over %u joint states%s, seed %llu\n", field.samples,
                field.exhaustive ? " (all there are)" : "", static_cast<unsigned long long>(field.seed));
    std::printf("  body %zu voxels; %zu of the other %zu can be reached\n", field.body.count(),
                reachableVoxels(field).count(), field.frame.voxelCount() - field.body.count());
    std::printf("  ramp error mean %.4f, max %.4f; uncovered again at a higher level: %.2f %%; %zu bytes\n",
                field.report.rampErrorMean, field.report.rampErrorMax, 100.0 * violationShare(field), bytes);
    if (field.report.rampErrorMean > 0.02)
        std::printf(
            "  ! The ramps are far from the sampled expectation: matching by voting will be coarse; use 'refined'.\n");
}

struct BuildArguments {
    std::string rig;
    std::string output;
    BuildOptions build;
    bool json = false;
};

void build(const BuildArguments& arguments, const Session& session) {
    if (arguments.json && arguments.output == "-")
        throw InvalidInput("--json", "standard output would hold the field and the report", "name a file with -o");
    checkOutput(arguments.output, arguments.rig);
    const Rig rig = readRig(arguments.rig);
    const auto start = std::chrono::steady_clock::now();
    const Field field = buildField(rig, arguments.build, session.progress());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    Session::endProgress();
    const std::vector<std::byte> bytes = writeField(field);
    session.throwIfCancelled();
    writeOutput(arguments.output, bytes);
    if (arguments.json) {
        nlohmann::json json = infoJson(field, bytes.size());
        json["seconds"] = seconds;
        printJson(json);
    } else if (arguments.output != "-") {
        printInfo(field, bytes.size());
        std::printf("  built in %.2f s: %s\n", seconds, arguments.output.c_str());
    }
}

struct FieldArguments {
    std::string field;
    std::string output;
    bool json = false;
};

void info(const FieldArguments& arguments, const Session& session) {
    const std::vector<std::byte> bytes = session.readInput(arguments.field);
    const Field field = parseField(bytes, inputName(arguments.field));
    arguments.json ? printJson(infoJson(field, bytes.size())) : printInfo(field, bytes.size());
}

nlohmann::json reachJson(const Field& field, const JointReach& reach) {
    nlohmann::json pairs = nlohmann::json::array();
    for (const JointReach::Pair& pair : reach.pairs)
        pairs.push_back({{"first", field.actuators[pair.first].name},
                         {"second", field.actuators[pair.second].name},
                         {"voxels", pair.voxels}});
    return {{"alone", reach.alone.count()},
            {"together", reach.together.count()},
            {"voxelVolume", field.frame.voxelVolume()},
            {"pairs", pairs}};
}

void printReach(const Field& field, const JointReach& reach) {
    const double cubicCentimetres = 1e6 * field.frame.voxelVolume();
    const auto volume = [cubicCentimetres](std::size_t voxels) {
        return cubicCentimetres * static_cast<double>(voxels);
    };
    std::printf("%s: actuators one at a time reach %zu voxels (%.1f cm3)\n", field.rigName.c_str(), reach.alone.count(),
                volume(reach.alone.count()));
    std::printf("  only two of them together reach %zu more (%.1f cm3)\n", reach.together.count(),
                volume(reach.together.count()));
    for (const JointReach::Pair& pair : reach.pairs)
        std::printf("  %8zu  %s with %s\n", pair.voxels, field.actuators[pair.first].name.c_str(),
                    field.actuators[pair.second].name.c_str());
}

void reach(const FieldArguments& arguments, const Session& session) {
    if (arguments.json && arguments.output == "-")
        throw InvalidInput("--json", "standard output would hold the grid and the report", "name a file with -o");
    if (!arguments.output.empty()) checkOutput(arguments.output, arguments.field);
    const MatchField field(readFieldFile(session, arguments.field));
    const JointReach found = jointReach(field.coverage, session.progress());
    Session::endProgress();
    if (!arguments.output.empty())
        writeOutput(arguments.output, writeNrrd(bytesOf(field.field.frame, found.together), "only two together"));
    if (arguments.json)
        printJson(reachJson(field.field, found));
    else if (arguments.output != "-")
        printReach(field.field, found);
}

} // namespace

Field readFieldFile(const Session& session, const std::string& path) {
    return parseField(session.readInput(path), inputName(path));
}

void addMdfCommands(CLI::App& app, Session& session) {
    CLI::App* group = app.add_subcommand("mdf", "Build and look at mechanical distance fields");
    group->require_subcommand(1);

    auto b = std::make_shared<BuildArguments>();
    CLI::App* buildCommand = group->add_subcommand("build", "Build the field of a rig");
    buildCommand->add_option("rig", b->rig, "A .glb or .gltf file, or a folder of one mesh per state")->required();
    buildCommand->add_option("-o,--output", b->output, "The .mdf file to write, or -")->required();
    buildCommand->add_option("--resolution", b->build.resolution, "Voxels along the shortest side")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    buildCommand->add_option("--levels", b->build.levels, "Levels an actuator")
        ->check(CLI::Range(2, kMaxLevels))
        ->capture_default_str();
    buildCommand->add_option("--samples", b->build.samples, "Joint states of the others to average over")
        ->check(CLI::Range(1, 65535))
        ->capture_default_str();
    buildCommand->add_option("--seed", b->build.seed, "Which states; equal seeds give equal files")
        ->check(seedNumber())
        ->capture_default_str();
    buildCommand->add_option("--threads", b->build.threads, "Threads (0: one a core)")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    buildCommand->add_flag("--json", b->json, "Print the report as one JSON value");
    buildCommand->callback([b, &session] { build(*b, session); });

    auto i = std::make_shared<FieldArguments>();
    CLI::App* infoCommand = group->add_subcommand("info", "What a field holds");
    infoCommand->add_option("field", i->field, "A .mdf file (- for standard input)")->required();
    infoCommand->add_flag("--json", i->json, "Print one JSON value");
    infoCommand->callback([i, &session] { info(*i, session); });

    auto r = std::make_shared<FieldArguments>();
    CLI::App* reachCommand =
        group->add_subcommand("reach", "What actuators reach one at a time, and what only two of them together reach");
    reachCommand->add_option("field", r->field, "A .mdf file (- for standard input)")->required();
    reachCommand->add_option("-o,--output", r->output, "Write the voxels of the latter as an NRRD grid");
    reachCommand->add_flag("--json", r->json, "Print one JSON value");
    reachCommand->callback([r, &session] { reach(*r, session); });

    auto e = std::make_shared<FieldArguments>();
    CLI::App* exportCommand =
        group->add_subcommand("export", "Write the field as NRRD files for ParaView or 3D Slicer");
    exportCommand->add_option("field", e->field, "A .mdf file (- for standard input)")->required();
    exportCommand->add_option("-o,--output", e->output, "The folder to write into")->required();
    exportCommand->callback([e, &session] { exportField(readFieldFile(session, e->field), e->output); });
}

} // namespace lumorph::cli

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "app/cli/target_arguments.h"
#include "core/base/error.h"
#include "core/mdf/library_fit.h"
#include "core/rig/rig_file.h"
#include "core/rig/shape_resolution.h"
#include "core/rig/templates/reference_rigs.h"

namespace lumorph::cli {

namespace {

struct ReportOptions {
    std::string rig;
    LibraryArguments targets;
    std::string servo = "SG90";
    double pixelMillimetres = 1e3 * DeviceLight{}.pixelPitch;
    double push = DeviceLoad{}.push;
    bool coarse = false;
    bool json = false;
};

struct Report {
    ShapeResolution device;
    std::vector<ShapeResolution> references;
    LibraryFit coarse;
    LibraryFit fit;
    std::vector<FitWithout> byActuators;
    double coarseMilliseconds = 0.0;
    double milliseconds = 0.0;
};

template <typename Work> double millisecondsOf(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Report reportOf(const Rig& rig, const std::vector<LibraryTarget>& library, const ReportOptions& options,
                const Session& session) {
    const Progress progress = session.progress();
    Report report;
    ShapeResolutionOptions measures;
    measures.light.pixelPitch = 1e-3 * options.pixelMillimetres;
    measures.load.push = options.push;
    measures.servo = &servoType(options.servo);
    report.device = shapeResolution(rig, measures, progress.part(0.0, 0.1));
    for (const Rig& reference : referenceRigs(progress.part(0.1, 0.2)))
        report.references.push_back(shapeResolution(reference, measures, progress.part(0.2, 0.3)));
    LibraryFitOptions coarse = LibraryFitOptions::coarse();
    coarse.placing = options.targets.placing();
    report.coarseMilliseconds = millisecondsOf([&] {
        LibraryMatcher matcher(rig, library, coarse, progress.part(0.3, 0.3));
        report.coarse = matcher.fit(progress.part(0.3, 0.4));
    });
    report.byActuators = LibraryMatcher(rig, library, coarse).fitByActuators(progress.part(0.4, 0.6));
    if (options.coarse) {
        report.fit = report.coarse;
        report.milliseconds = report.coarseMilliseconds;
        return report;
    }
    LibraryFitOptions fine;
    fine.placing = options.targets.placing();
    report.milliseconds = millisecondsOf([&] {
        LibraryMatcher matcher(rig, library, fine, progress.part(0.6, 0.7));
        report.fit = matcher.fit(progress.part(0.7, 1.0));
    });
    return report;
}

std::vector<std::string> warningsOf(const Report& report) {
    std::vector<std::string> warnings = report.device.warnings;
    for (const TargetFit& target : report.fit.targets)
        if (target.unreachable > 0.995)
            warnings.push_back("The target '" + target.name +
                               "' does not meet what the device can reach; try --place " + "fit.");
    return warnings;
}

nlohmann::json optionalJson(const std::optional<double>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

nlohmann::json metricsJson(const ShapeResolution& resolution, bool explained) {
    nlohmann::json metrics = nlohmann::json::array();
    for (const ShapeMetric& metric : resolution.metrics) {
        nlohmann::json entry = {{"key", metric.key},
                                {"name", metric.name},
                                {"unit", metric.unit},
                                {"physical", optionalJson(metric.physical)},
                                {"light", optionalJson(metric.withLight)},
                                {"together", optionalJson(metric.together)}};
        if (explained) {
            entry["meaning"] = metric.meaning;
            entry["withLight"] = metric.light;
        }
        metrics.push_back(std::move(entry));
    }
    return metrics;
}

nlohmann::json loadsJson(const ShapeResolution& device) {
    nlohmann::json loads = nlohmann::json::array();
    for (const ServoLoad& load : device.loads)
        loads.push_back({{"actuator", load.actuator},
                         {"servo", load.servo->name},
                         {"lever", load.lever},
                         {"torqueNeeded", load.torque},
                         {"force", load.force},
                         {"weak", load.weak},
                         {"servoThatDoes", load.stronger}});
    return loads;
}

nlohmann::json fitJson(const Report& report) {
    nlohmann::json targets = nlohmann::json::array();
    for (std::size_t t = 0; t < report.fit.targets.size(); ++t) {
        const TargetFit& target = report.fit.targets[t];
        nlohmann::json levels = nlohmann::json::array();
        for (const Level level : target.state) levels.push_back(level.index);
        targets.push_back({{"name", target.name},
                           {"iou", target.iou},
                           {"coarseIou", report.coarse.targets[t].iou},
                           {"state", levels},
                           {"scale", target.placement.scale},
                           {"unreachable", target.unreachable}});
    }
    nlohmann::json steps = nlohmann::json::array();
    for (const FitWithout& step : report.byActuators)
        steps.push_back({{"actuators", step.actuators}, {"fit", step.fit}, {"leftOut", step.leftOut}});
    const glm::ivec3 size = report.fit.frame.dimensions;
    return {{"targets", targets},
            {"mean", report.fit.mean},
            {"best", report.fit.targets[report.fit.best].name},
            {"worst", report.fit.targets[report.fit.worst].name},
            {"levels", report.fit.levels},
            {"voxels", {size.x, size.y, size.z}},
            {"voxelSize", report.fit.frame.voxelSize},
            {"coarseMean", report.coarse.mean},
            {"byActuators", steps},
            {"ms", {{"coarse", report.coarseMilliseconds}, {"full", report.milliseconds}}}};
}

nlohmann::json reportJson(const Report& report, const ReportOptions& options) {
    nlohmann::json references = nlohmann::json::array();
    for (const ShapeResolution& reference : report.references)
        references.push_back({{"name", reference.name}, {"metrics", metricsJson(reference, false)}});
    const ServoType& servo = servoType(options.servo);
    return {
        {"name", report.device.name},
        {"metrics", metricsJson(report.device, true)},
        {"references", references},
        {"servo", {{"type", servo.name}, {"stallTorque", servo.stallTorque}, {"usableTorque", servo.usableTorque()}}},
        {"loads", loadsJson(report.device)},
        {"fit", fitJson(report)},
        {"warnings", warningsOf(report)}};
}

// Text.

void printWrapped(const std::string& text, int indent) {
    constexpr std::size_t kWidth = 96;
    std::string line;
    const auto flush = [&] {
        std::printf("%*s%s\n", indent, "", line.c_str());
        line.clear();
    };
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        if (!line.empty() && line.size() + 1 + (end - at) + static_cast<std::size_t>(indent) > kWidth) flush();
        line += (line.empty() ? "" : " ") + text.substr(at, end - at);
        at = end + 1;
    }
    if (!line.empty()) flush();
}

void printMetrics(const Report& report) {
    std::printf("%s: shape resolution, in the ten features of \"Morphees\" (Roudaut et al., CHI 2013)\n\n",
                report.device.name.c_str());
    std::printf("  %-14s %13s %13s %13s  |", "", "physical", "with light", "together");
    for (const ShapeResolution& reference : report.references) std::printf(" %11s", reference.name.c_str());
    std::printf("  (physical)\n");
    for (std::size_t m = 0; m < report.device.metrics.size(); ++m) {
        const ShapeMetric& metric = report.device.metrics[m];
        std::printf("  %-14s %13s %13s %13s  |", std::string(metric.name).c_str(),
                    inUsualUnit(metric.physical, metric.unit).c_str(),
                    inUsualUnit(metric.withLight, metric.unit).c_str(),
                    inUsualUnit(metric.together, metric.unit).c_str());
        for (const ShapeResolution& reference : report.references)
            std::printf(" %11s", inUsualUnit(reference.metrics[m].physical, metric.unit).c_str());
        std::printf("\n");
    }
    std::printf("\n");
    for (const ShapeMetric& metric : report.device.metrics) {
        printWrapped(
            std::string(metric.name) + ": " + std::string(metric.meaning) + " Light: " + std::string(metric.light), 2);
    }
}

void printLoads(const Report& report, const ReportOptions& options) {
    std::printf("\nServos: of what stalls one half is to be held; a finger pushes with %.1f N\n\n", options.push);
    std::printf("  %-22s %9s %12s %10s   servo, and what it holds\n", "actuator", "lever", "needs", "force");
    constexpr std::size_t kMost = 24;
    for (std::size_t a = 0; a < std::min(kMost, report.device.loads.size()); ++a) {
        const ServoLoad& load = report.device.loads[a];
        std::printf("  %-22s %6.1f mm %8.3f N m %8.2f N   %s, %.3f N m%s\n", load.actuator.c_str(), 1e3 * load.lever,
                    load.torque, load.force, std::string(load.servo->name).c_str(), load.servo->usableTorque(),
                    load.weak ? ": too weak" : "");
    }
    if (report.device.loads.size() > kMost) std::printf("  ... and %zu more\n", report.device.loads.size() - kMost);
}

std::string barOf(double share) {
    std::string bar(static_cast<std::size_t>(std::lround(20.0 * std::clamp(share, 0.0, 1.0))), '=');
    bar.resize(20, ' ');
    return "|" + bar + "|";
}

void printFit(const Report& report) {
    const LibraryFit& fit = report.fit;
    std::printf("\nWhat it can be: %zu targets in %d x %d x %d voxels of %.1f mm, %.0f ms (coarsely in %.0f ms)\n\n",
                fit.targets.size(), fit.frame.dimensions.x, fit.frame.dimensions.y, fit.frame.dimensions.z,
                1e3 * fit.frame.voxelSize, report.milliseconds, report.coarseMilliseconds);
    std::vector<std::size_t> order(fit.targets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](auto a, auto b) { return fit.targets[a].iou > fit.targets[b].iou; });
    for (const std::size_t t : order) {
        const TargetFit& target = fit.targets[t];
        std::printf("  %-22s IoU %.3f %s", target.name.c_str(), target.iou, barOf(target.iou).c_str());
        if (target.unreachable >= 0.01) std::printf("  %.0f %% out of reach", 100.0 * target.unreachable);
        std::printf("%s\n", t == fit.best ? "  best" : t == fit.worst ? "  worst" : "");
    }
    std::printf("  %-22s IoU %.3f\n", "mean", fit.mean);
    std::printf("\nFit against the number of actuators, the least missed left out first (coarsely):\n\n");
    for (const FitWithout& step : report.byActuators) {
        std::printf("  %3zu  IoU %.3f %s", step.actuators, step.fit, barOf(step.fit).c_str());
        for (std::size_t k = 0; k < std::min<std::size_t>(3, step.leftOut.size()); ++k)
            std::printf("%s%s", k == 0 ? "  without " : ", ", step.leftOut[k].c_str());
        std::printf("%s\n", step.leftOut.size() > 3 ? ", ..." : "");
    }
}

void rigReport(const ReportOptions& options, const Session& session) {
    const Rig rig = readRig(options.rig);
    if (rig.actuatorCount() == 0)
        throw InvalidInput(options.rig, "it has no actuator, so that it has one shape only",
                           "draw bend lines with 'lumorph rig sheet', or start from a template");
    (void)servoType(options.servo);
    const std::vector<LibraryTarget> library = readTargetLibrary(options.targets.folder(), session.progress());
    const Report report = reportOf(rig, library, options, session);
    Session::endProgress();
    if (options.json) {
        printJson(reportJson(report, options));
        return;
    }
    printMetrics(report);
    printLoads(report, options);
    printFit(report);
    for (const LibraryTarget& target : library) printWarnings(target.target.warnings);
    for (const std::string& warning : warningsOf(report)) std::printf("  ! %s\n", warning.c_str());
}

} // namespace

void addRigReport(CLI::App& group, Session& session) {
    auto options = std::make_shared<ReportOptions>();
    CLI::App* command =
        group.add_subcommand("report", "What a rig can be: shape resolution with and without light, strength of its "
                                       "servos, fit over a library of targets and with fewer actuators");
    command->add_option("rig", options->rig, "A .glb or .gltf file, or a folder of one mesh per state")->required();
    options->targets.addTo(*command);
    std::string names;
    for (const ServoType& type : servoTypes()) names += (names.empty() ? "" : ", ") + std::string(type.name);
    command->add_option("--servo", options->servo, "Which servos it has: " + names)->capture_default_str();
    command->add_option("--pixel-mm", options->pixelMillimetres, "From pixel to pixel of the light on the device, mm")
        ->check(numberBetween(0.001, 100.0))
        ->capture_default_str();
    command->add_option("--push", options->push, "Newtons that a finger pushes with")
        ->check(numberBetween(0.0, 1000.0))
        ->capture_default_str();
    command->add_flag("--coarse", options->coarse, "Match in coarse voxels only");
    command->add_flag("--json", options->json, "Print one JSON value");
    command->callback([options, &session] { rigReport(*options, session); });
}

} // namespace lumorph::cli

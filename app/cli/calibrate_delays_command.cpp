#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/project_frame.h"
#include "calibration/delays/delays_lab.h"
#include "core/base/error.h"
#include "core/show/project_contents.h"

namespace lumorph::cli {

namespace {

struct DelaysArguments {
    std::string project, fault;
    std::uint32_t seed = 1;
    bool json = false;
    LabApply lab;
};

nlohmann::json delayJson(const MeasuredDelay& delay) {
    return {{"ms", 1e3 * delay.seconds},
            {"sigmaMs", 1e3 * delay.sigma},
            {"halvesDifferMs", delay.halvesDiffer ? nlohmann::json(1e3 * *delay.halvesDiffer) : nlohmann::json()},
            {"events", delay.events}};
}

nlohmann::json slipJson(const LightSlip& slip) {
    return {{"rmsMm", 1e3 * slip.always}, {"atSpeedMm", 1e3 * slip.atSpeed}};
}

nlohmann::json delaysJson(const MeasuredDelays& delays, bool applied) {
    nlohmann::json servos = nlohmann::json::array();
    for (const MeasuredDelays::Servo& servo : delays.servos) {
        nlohmann::json json = delayJson(servo.step.lag);
        json["actuator"] = servo.name;
        json["strokesPerSecond"] = servo.step.velocity;
        json["playStrokes"] = servo.step.play;
        servos.push_back(std::move(json));
    }
    return {{"light", delayJson(delays.light)},
            {"tracker", delayJson(delays.tracker)},
            {"movedMark", delayJson(delays.mark)},
            {"servos", servos},
            {"slip", {{"with", slipJson(delays.gain.with)}, {"without", slipJson(delays.gain.without)}}},
            {"warnings", jsonOf(delays.warnings)},
            {"simulatedSeconds", delays.seconds},
            {"applied", applied},
            {"way", "simulated"}};
}

std::string milliseconds(double seconds) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1f ms", 1e3 * seconds);
    return text.data();
}

void printDelay(const char* name, const MeasuredDelay& delay) {
    const std::string halves = delay.halvesDiffer ? milliseconds(*delay.halvesDiffer) : "-";
    std::printf("  %-22s %6.1f +- %.1f ms, halves differ by %s\n", name, 1e3 * delay.seconds, 1e3 * delay.sigma,
                halves.c_str());
}

void printDelays(const MeasuredDelays& delays, bool applied) {
    std::printf("%s It takes %.0f s.\n", delays.summary.c_str(), delays.seconds);
    printDelay("frame to light", delays.light);
    printDelay("age of poses", delays.tracker);
    printDelay("a moved mark says", delays.mark);
    for (const MeasuredDelays::Servo& servo : delays.servos) printDelay(servo.name.c_str(), servo.step.lag);
    printFindings(delays.warnings);
    std::printf("  carried at 30 cm/s     light lies %.1f mm beside instead of %.1f mm\n",
                1e3 * delays.gain.with.atSpeed, 1e3 * delays.gain.without.atSpeed);
    if (applied) std::printf("The project's installation has the delays simulated in the virtual lab now.\n");
}

void delays(const DelaysArguments& arguments, const Session& session) {
    const std::filesystem::path file = projectFile(arguments.project);
    arguments.lab.checkProject(arguments.project);
    DelaysLabOptions options;
    if (!arguments.fault.empty()) options.fault = parseDelayFault(arguments.fault);
    const Progress progress = session.progress();
    const ProjectContents contents = readContents(file, progress.part(0.0, 0.1));
    arguments.lab.checkRoom(arguments.project, contents.project.installation);
    const Rig& rig = *contents.rig;
    const Installation& believed = contents.project.installation;
    const Installation truth = trueRoom(believed, rig.actuators(), arguments.seed);
    const MeasuredDelays measured = orRefused(arguments.json, [&] {
        MeasuredDelays found =
            measureDelaysInLab(rig, believed, truth, arguments.seed, progress.part(0.1, 1.0), options);
        if (found.refusal) throw CaptureRefused(*found.refusal);
        return found;
    });
    Session::endProgress();
    if (arguments.lab.apply) {
        Project project = contents.project;
        project.installation = measured.installation;
        writeProject(project, file);
    }
    if (arguments.json)
        printJson(delaysJson(measured, arguments.lab.apply));
    else
        printDelays(measured, arguments.lab.apply);
}

} // namespace

void addCalibrateDelays(CLI::App& group, Session& session) {
    auto arguments = std::make_shared<DelaysArguments>();
    CLI::App* command = group.add_subcommand(
        "delays", "How late light, poses and servos are, by flashes, a moved board and steps in the virtual lab");
    command->add_option("project", arguments->project, "A project, or resource:projects/NAME.lumorph")->required();
    command->add_option("--seed", arguments->seed, "Other delays of the lab for another number");
    command->add_option("--fault", arguments->fault,
                        "What is wrong in the lab: frames, camera, slow, covered, tracker, still, dead or jammed");
    arguments->lab.addTo(*command, "Write what the virtual lab made into the project's installation, as simulated");
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments, &session] { delays(*arguments, session); });
}

} // namespace lumorph::cli

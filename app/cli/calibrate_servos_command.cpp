#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/project_frame.h"
#include "calibration/lab/true_room.h"
#include "calibration/servos/servo_gain.h"
#include "calibration/servos/servo_lab.h"
#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/show/project_contents.h"

namespace lumorph::cli {

namespace {

struct ServosArguments {
    std::string project, fault;
    std::uint32_t seed = 1;
    bool json = false;
    LabApply lab;
};

/// Shapes that the real device is judged by: the project's own target, or a few of the bundled ones.
std::vector<LibraryTarget> shapesFor(const ProjectContents& contents) {
    if (contents.target) {
        LibraryTarget own{contents.target->name, contents.target->solid, contents.target->box};
        return {std::move(own)};
    }
    return readTargets(
        {resourceFile("targets/bowl.glb"), resourceFile("targets/cove.glb"), resourceFile("targets/valley.glb")});
}

nlohmann::json servoJson(const ServoFinding& servo, const Rig& rig) {
    nlohmann::json curve = nlohmann::json::array();
    for (const MeasuredServo::Point& point : servo.curve.points)
        curve.push_back({{"commanded", point.commanded}, {"rising", point.rising}, {"falling", point.falling}});
    const bool measured = !servo.curve.points.empty();
    nlohmann::json json = {{"actuator", servo.curve.actuator},
                           {"strokeDegrees", servo.degrees},
                           {"moves", rig.actuators()[servo.moves].name},
                           {"curve", curve}};
    json["backlashDegrees"] = measured ? nlohmann::json(servo.backlashDegrees) : nlohmann::json();
    json["backlashSigmaDegrees"] = measured ? nlohmann::json(servo.backlashSigma) : nlohmann::json();
    json["curveSigmaDegrees"] = measured ? nlohmann::json(servo.curveSigma) : nlohmann::json();
    json["stopsAtCommand"] = jsonOf(servo.stopsAt);
    // The step response is measured together with the other delays.
    json["lagSeconds"] = servo.curve.lagSeconds > 0.0 ? nlohmann::json(servo.curve.lagSeconds) : nlohmann::json();
    return json;
}

nlohmann::json servosJson(const ServoMeasurement& result, const ServoGain& gain, const Rig& rig, bool applied) {
    nlohmann::json servos = nlohmann::json::array();
    for (const ServoFinding& servo : result.measured.servos) servos.push_back(servoJson(servo, rig));
    nlohmann::json groups = nlohmann::json::array();
    for (const auto& group : result.plan.groups) {
        nlohmann::json names = nlohmann::json::array();
        for (const std::size_t i : group) names.push_back(rig.actuators()[i].name);
        groups.push_back(std::move(names));
    }
    return {{"servos", servos},
            {"groups", groups},
            {"passes", result.plan.steps.size()},
            {"simulatedSeconds", result.seconds},
            {"freshDegrees", {{"median", result.measured.freshDegrees}, {"worst", result.measured.freshWorst}}},
            {"rmsMm", 1e3 * result.measured.rms},
            {"findings", jsonOf(result.measured.findings)},
            {"usable", result.measured.usable},
            {"applied", applied},
            {"way", "simulated"},
            {"iou", {{"wanted", gain.wanted}, {"before", gain.told}, {"after", gain.measured}}},
            {"projectionOffMm", {{"before", 1e3 * gain.toldOff}, {"after", 1e3 * gain.measuredOff}}}};
}

void printServos(const ServoMeasurement& result, const ServoGain& gain, bool applied) {
    std::printf("%zu states in %.0f simulated seconds, in %zu groups of servos; points lie %.2f mm off the surface\n",
                result.plan.steps.size(), result.seconds, result.plan.groups.size(), 1e3 * result.measured.rms);
    for (const ServoFinding& servo : result.measured.servos) {
        if (servo.curve.points.empty()) {
            std::printf("  %-22s no curve\n", servo.curve.actuator.c_str());
            continue;
        }
        double bent = 0.0;
        for (const MeasuredServo::Point& point : servo.curve.points) {
            const double off = 0.5 * (point.rising + point.falling) - point.commanded;
            if (std::abs(off) > std::abs(bent)) bent = off;
        }
        std::printf("  %-22s backlash %.2f +- %.2f degrees, %+.1f degrees from what it is told at most\n",
                    servo.curve.actuator.c_str(), servo.backlashDegrees, servo.backlashSigma, servo.degrees * bent);
    }
    printFindings(result.measured.findings);
    if (!result.measured.usable) {
        std::printf("Nothing is kept: remove what was found, then measure again.\n");
        return;
    }
    std::printf("  fresh states       %.2f degrees off (median), %.2f at worst\n", result.measured.freshDegrees,
                result.measured.freshWorst);
    std::printf("  IoU of the device  %.4f before, %.4f after; %.4f is wanted\n", gain.told, gain.measured,
                gain.wanted);
    std::printf("  projection lies    %.2f mm beside the surface before, %.2f mm after\n", 1e3 * gain.toldOff,
                1e3 * gain.measuredOff);
    if (applied) std::printf("The project's installation has the servos simulated in the virtual lab now.\n");
}

void servos(const ServosArguments& arguments, const Session& session) {
    const std::filesystem::path file = projectFile(arguments.project);
    arguments.lab.checkProject(arguments.project);
    ServoLabOptions options;
    if (!arguments.fault.empty()) options.fault = parseServoFault(arguments.fault);
    const Progress progress = session.progress();
    const ProjectContents contents = readContents(file, progress.part(0.0, 0.1));
    arguments.lab.checkRoom(arguments.project, contents.project.installation);
    const Rig& rig = *contents.rig;
    Installation believed = contents.project.installation;
    believed.servos.clear(); // they are measured anew
    const Installation truth = trueRoom(believed, rig.actuators(), arguments.seed);
    const ServoMeasurement result = orRefused(arguments.json, [&] {
        return measureServosInLab(rig, believed, truth, arguments.seed, progress.part(0.1, 0.8), options);
    });
    LibraryFitOptions fitting;
    fitting.resolution = 25;
    const ServoGain gain = servoGain(rig, shapesFor(contents), result.room, truth, fitting, progress.part(0.8, 1.0));
    Session::endProgress();
    const bool applies = arguments.lab.apply && result.measured.usable;
    if (applies) {
        Project project = contents.project;
        project.installation = result.room;
        writeProject(project, file);
    }
    if (arguments.json)
        printJson(servosJson(result, gain, rig, applies));
    else
        printServos(result, gain, applies);
}

} // namespace

void addCalibrateServos(CLI::App& group, Session& session) {
    auto arguments = std::make_shared<ServosArguments>();
    CLI::App* command = group.add_subcommand(
        "servos", "Where servos really go, their play and what is wrong with them, by camera in the virtual lab");
    command->add_option("project", arguments->project, "A project, or resource:projects/NAME.lumorph")->required();
    command->add_option("--seed", arguments->seed, "Other servos of the lab for another number");
    command->add_option("--fault", arguments->fault, "What is wrong in the lab: swapped, reversed, dead or jammed");
    arguments->lab.addTo(*command, "Write what the virtual lab made into the project's installation, as simulated");
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments, &session] { servos(*arguments, session); });
}

} // namespace lumorph::cli

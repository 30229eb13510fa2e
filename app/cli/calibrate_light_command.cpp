#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/project_frame.h"
#include "calibration/lab/true_room.h"
#include "calibration/light/light_lab.h"
#include "core/base/error.h"
#include "core/show/project_contents.h"

namespace lumorph::cli {

namespace {

struct LightArguments {
    std::string project, fault;
    std::uint32_t seed = 1;
    bool json = false, withoutSheet = false;
    LabApply lab;
};

nlohmann::json colorJson(const glm::vec3& color) { return {color.r, color.g, color.b}; }

nlohmann::json freshJson(const FreshLight& fresh) {
    return {{"median", fresh.median}, {"p95", fresh.most}, {"places", fresh.places}};
}

nlohmann::json lightJson(const LightCalibration& result, bool applied) {
    nlohmann::json projectors = nlohmann::json::array();
    if (result.good())
        for (const InstalledProjector& projector : result.room.projectors) {
            nlohmann::json curve = nlohmann::json::array();
            for (const InstalledProjector::ResponsePoint& point : projector.responseCurve)
                curve.push_back({{"value", point.value}, {"light", colorJson(point.light)}});
            projectors.push_back({{"name", projector.name},
                                  {"gain", colorJson(projector.gain)},
                                  {"black", colorJson(projector.black)},
                                  {"curve", curve}});
        }
    nlohmann::json json = {{"projectors", projectors},
                           {"whiteSheet", result.hasWhiteSheet},
                           {"assumption", result.assumption},
                           {"fresh", freshJson(result.fresh)},
                           {"before", freshJson(result.before)},
                           {"cameraRms", result.responseRms},
                           {"ambient", result.ambient},
                           {"photographs", result.photographs},
                           {"findings", jsonOf(result.warnings)},
                           {"usable", result.good()},
                           {"applied", applied},
                           {"way", "simulated"}};
    json["refused"] = result.refusal ? jsonOf(*result.refusal) : nlohmann::json();
    json["deviceColor"] = result.good() ? colorJson(result.room.deviceColor) : nlohmann::json();
    json["tableColor"] = result.good() ? colorJson(result.room.tableColor) : nlohmann::json();
    return json;
}

void printLight(const LightCalibration& result, bool applied) {
    std::printf("%d photographs of flat light\n", result.photographs);
    for (const std::string& figure : result.figures) std::printf("  %s\n", figure.c_str());
    const auto printColor = [](const char* what, const glm::vec3& color) {
        const glm::dvec3 c(color);
        std::printf("  %s: %.3f %.3f %.3f (sRGB)\n", what, c.r, c.g, c.b);
    };
    printColor("bare device", result.room.deviceColor);
    printColor("bare table", result.room.tableColor);
    std::printf("%s\n", result.assumption.c_str());
    if (applied) std::printf("The project's installation has the light simulated in the virtual lab now.\n");
}

/// As nobody has looked: what is measured does not build on what was measured before.
Installation withoutLight(Installation room) {
    const InstalledProjector plain;
    for (InstalledProjector& projector : room.projectors) {
        projector.gain = plain.gain;
        projector.black = plain.black;
        projector.gamma = plain.gamma;
        projector.responseCurve.clear();
    }
    room.deviceColor = room.tableColor = glm::vec3(1.0F);
    return room;
}

void light(const LightArguments& arguments, const Session& session) {
    const std::filesystem::path file = projectFile(arguments.project);
    arguments.lab.checkProject(arguments.project);
    LightLabOptions options;
    options.laysSheet = !arguments.withoutSheet;
    if (!arguments.fault.empty()) options.fault = parseLightFault(arguments.fault);
    const Progress progress = session.progress();
    const ProjectContents contents = readContents(file, progress.part(0.0, 0.1));
    arguments.lab.checkRoom(arguments.project, contents.project.installation);
    const Rig& rig = *contents.rig;
    const Installation believed = withoutLight(contents.project.installation);
    const Installation truth = trueRoom(believed, rig.actuators(), arguments.seed);
    const LightCalibration result =
        measureLightInLab(rig, believed, truth, arguments.seed, progress.part(0.1, 1.0), options);
    Session::endProgress();
    const bool applies = arguments.lab.apply && result.good();
    if (applies) {
        Project project = contents.project;
        project.installation = result.room;
        writeProject(project, file);
    }
    if (arguments.json) printJson(lightJson(result, applies));
    if (!arguments.json) printFindings(result.warnings);
    if (result.refusal) throw CaptureRefused(*result.refusal);
    if (!arguments.json) printLight(result, applies);
}

} // namespace

void addCalibrateLight(CLI::App& group, Session& session) {
    auto arguments = std::make_shared<LightArguments>();
    CLI::App* command = group.add_subcommand(
        "light", "How much light values make, black, and bare colours, by camera in the virtual lab");
    command->add_option("project", arguments->project, "A project, or resource:projects/NAME.lumorph")->required();
    command->add_option("--seed", arguments->seed, "Other light of the lab for another number");
    command->add_option("--fault", arguments->fault,
                        "What is wrong in the lab: saturated, dark, automatic, ambient, falling or unseen");
    command->add_flag("--without-sheet", arguments->withoutSheet, "No sheet of white paper lies beside the device");
    arguments->lab.addTo(*command, "Write what the virtual lab made into the project's installation, as simulated");
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments, &session] { light(*arguments, session); });
}

} // namespace lumorph::cli

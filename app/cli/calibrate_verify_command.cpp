#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/project_frame.h"
#include "calibration/lab/moved_room.h"
#include "calibration/verify/check_picture.h"
#include "calibration/verify/verify_lab.h"
#include "core/base/error.h"
#include "core/base/image.h"
#include "core/rig/rig_file.h"
#include "core/scene/project.h"

namespace lumorph::cli {

namespace {

constexpr double kMillimetre = 1e-3;

struct VerifyArguments {
    std::string project;
    std::vector<std::string> moved;
    std::string pattern = "graycode";
    std::string picture, grid;
    std::uint32_t seed = 1;
    bool json = false;
    LabApply lab;
};

nlohmann::json summaryJson(const ErrorSummary& summary) {
    return {{"median", summary.median / kMillimetre},
            {"p95", summary.most / kMillimetre},
            {"worst", summary.worst / kMillimetre},
            {"places", summary.places}};
}

nlohmann::json checkJson(const VerifiedRoom& found) {
    const RoomCheck& check = found.check;
    nlohmann::json all = {{"verdict", wordOf(check.verdict)}, {"sentence", check.sentence}, {"way", "simulated"}};
    if (check.obstacle) {
        all["obstacle"] = keyOf(check.obstacle->obstacle);
        return all;
    }
    nlohmann::json parts = nlohmann::json::array();
    for (std::size_t i = 0; i < check.names.size(); ++i)
        parts.push_back({{"part", check.names[i]},
                         {"millimetres", check.found.parts[i].beside / kMillimetre},
                         {"sigmaMm", check.found.parts[i].sigma / kMillimetre}});
    all["part"] = check.names.empty() ? nlohmann::json() : nlohmann::json(check.names.front());
    all["millimetres"] = check.names.empty() ? 0.0 : check.found.parts.front().beside / kMillimetre;
    all["parts"] = std::move(parts);
    all["couldAlsoBe"] = check.couldAlsoBe;
    all["map"] = summaryJson(check.now);
    all["map"]["device"] = summaryJson(check.device);
    all["map"]["table"] = summaryJson(check.table);
    all["corrected"] = summaryJson(check.corrected);
    all["fresh"] = summaryJson(found.fresh);
    all["photographs"] = found.photographs;
    return all;
}

void printCheck(const VerifiedRoom& found) {
    std::printf("%s\n", found.check.sentence.c_str());
    if (found.check.obstacle) return;
    const auto print = [](const char* what, const ErrorSummary& light) {
        std::printf("  %-22s %7.2f %7.2f %7.2f mm\n", what, light.median / kMillimetre, light.most / kMillimetre,
                    light.worst / kMillimetre);
    };
    std::printf("  %-22s  median    95 %%   worst\n", "light lies beside");
    print("on the device", found.check.device);
    print("on the table", found.check.table);
    print("once corrected", found.check.corrected);
    for (const std::string& figure : found.figures) std::printf("  %s\n", figure.c_str());
}

Installation trueRoomOf(const VerifyArguments& arguments, const Installation& believed, const Rig& rig) {
    Installation truth = believed;
    std::uint32_t seed = arguments.seed;
    for (const std::string& text : arguments.moved) truth = pushed(truth, rig, parseLabPush(text, rig), seed++);
    return truth;
}

void keepCorrection(const VerifyArguments& arguments, const std::filesystem::path& file, const VerifiedRoom& found) {
    if (found.check.verdict != RoomCheck::Verdict::moved || !found.check.couldAlsoBe.empty()) return;
    Project project = readProject(file);
    project.installation = found.installation;
    // A camera that the project does not have is the lab's own.
    if (readProject(file).installation.cameras.empty()) project.installation.cameras.clear();
    writeProject(project, file);
    if (!arguments.json) std::printf("The correction, simulated in the virtual lab, is in %s.\n", file.c_str());
}

void verify(const VerifyArguments& arguments, const Session& session) {
    const std::filesystem::path file = projectFile(arguments.project);
    arguments.lab.checkProject(arguments.project);
    for (const std::string& output : {arguments.picture, arguments.grid})
        if (!output.empty()) checkOutput(output, file.string());
    const Project project = readProject(file);
    arguments.lab.checkRoom(arguments.project, project.installation);
    const Rig rig = readRig(assetPath(file, project.rig));
    const Installation believed = withLabCamera(project.installation);
    const Installation truth = trueRoomOf(arguments, believed, rig);
    VerifyLabOptions options;
    options.pattern = arguments.pattern;
    const VerifiedRoom found = measureVerifyInLab(rig, believed, truth, arguments.seed, session.progress(), options);
    Session::endProgress();
    const std::vector<double> bend = checkBends(rig).front();
    if (!arguments.picture.empty()) writePng(errorPicture(found.check, rig, believed, bend), arguments.picture);
    if (!arguments.grid.empty()) writePng(gridPicture(rig, believed, bend), arguments.grid);
    if (arguments.lab.apply) keepCorrection(arguments, file, found);
    arguments.json ? printJson(checkJson(found)) : printCheck(found);
    if (found.check.verdict == RoomCheck::Verdict::none)
        throw DataError("check of the room", found.check.obstacle->why, found.check.obstacle->remedy);
}

} // namespace

void addCalibrateVerify(CLI::App& group, Session& session) {
    auto arguments = std::make_shared<VerifyArguments>();
    CLI::App* command = group.add_subcommand(
        "verify", "In the virtual lab, whether the room of a project is still as it was calibrated, or what has moved");
    command->add_option("project", arguments->project, "A project (.lumorph)")->required();
    command
        ->add_option(
            "--moved", arguments->moved,
            "What was pushed in the lab since: projector:3mm, camera:2mm, device:4mm, or an actuator's name and "
            "degrees, 'edge front:5deg'; may be given again")
        ->expected(1)
        ->take_all();
    command->add_option("--pattern", arguments->pattern, "graycode, or phase:16x3+1x3");
    command->add_option("--picture", arguments->picture, "Draw the error map over the device into a PNG file");
    command->add_option("--grid", arguments->grid,
                        "Draw what the projector shows to check by eye into a PNG file: crosshairs and lines");
    command->add_option("--seed", arguments->seed, "Another number gives other noise, and pushes elsewhere");
    arguments->lab.addTo(*command, "Write the corrected installation into the project, as simulated");
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments, &session] { verify(*arguments, session); });
}

} // namespace lumorph::cli

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "app/cli/calibrate_output.h"
#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "app/cli/stage_output.h"
#include "calibration/lab/true_room.h"
#include "calibration/stages/lab_bench.h"
#include "calibration/stages/stage.h"
#include "core/base/error.h"
#include "core/rig/rig_file.h"

// Tracker, pointer, device and eye registered in the virtual lab, beside its truth: for trying, and for seeing what
// each fault looks like.

namespace lumorph::cli {

namespace {

struct RegisterArguments {
    std::string rig;
    std::string fault;
    std::uint32_t seed = 1;
    bool json = false;
};

/// How far a figure is from the lab's truth.
struct FromTruth {
    double millimetres = 0.0;
    std::optional<double> degrees; ///< of what has a turn
};

FromTruth fromTruth(const glm::mat4& measured, const glm::mat4& truth, const glm::dvec3& place) {
    const glm::dmat4 error = glm::dmat4(measured) * glm::inverse(glm::dmat4(truth));
    const double cosine = 0.5 * (error[0][0] + error[1][1] + error[2][2] - 1.0);
    const glm::dvec3 sine(error[1][2] - error[2][1], error[2][0] - error[0][2], error[0][1] - error[1][0]);
    return {1000.0 * glm::distance(glm::dvec3(error * glm::dvec4(place, 1.0)), place),
            kDegreesPerRadian * std::atan2(0.5 * glm::length(sine), cosine)};
}
FromTruth fromTruth(const glm::vec3& measured, const glm::vec3& truth) {
    return {1000.0 * static_cast<double>(glm::distance(measured, truth)), std::nullopt};
}

struct Stage {
    const char* name;
    Registration result;
    FromTruth off;
};

nlohmann::json jsonOf(const Stage& stage) {
    nlohmann::json one = cli::jsonOf(stage.result);
    one["stage"] = stage.name;
    if (!stage.result.refusal)
        one["fromTruth"] = {{"mm", stage.off.millimetres}, {"degrees", cli::jsonOf(stage.off.degrees)}};
    return one;
}

/// One after the other; ends with the first that is refused.
std::vector<Stage> stagesOf(const std::shared_ptr<const Rig>& rig, const RegisterArguments& arguments,
                            const Progress& progress) {
    StageSite site{rig, withLabCamera(defaultInstallation())};
    const Installation &room = site.room, truth = trueRoom(room, rig->actuators(), arguments.seed);
    const glm::dvec3 device(truth.bodyFromDevice[3]);
    LabBench lab(*rig, truth, arguments.seed, labWithFault("pointer", arguments.fault)); // one tracker for all of them
    std::vector<Stage> stages;
    const auto run = [&](const char* key, const char* name, const auto& off) {
        if (!stages.empty() && !stages.back().result.good()) return;
        const double share = 0.25 * double(stages.size());
        const Progress part = progress.part(share, share + 0.25);
        auto result = std::get<Registration>(measureStage(calibrationStage(key), site, lab, part).result);
        site.room = result.installation;
        stages.push_back({name, std::move(result), off()});
    };
    run("pointer", "pointer", [&] { return fromTruth(room.pointerTip, truth.pointerTip); });
    run("tracker", "tracker",
        [&] { return fromTruth(room.worldFromTracker, truth.worldFromTracker, glm::dvec3(0.0)); });
    run("body", "device", [&] { return fromTruth(room.bodyFromDevice, truth.bodyFromDevice, device); });
    run("eye", "eye", [&] { return fromTruth(room.eyeFromHead, truth.eyeFromHead); });
    return stages;
}

void print(const Stage& stage) {
    std::printf("%-8s %s\n", stage.name, stage.result.summary.c_str());
    if (!stage.result.refusal) {
        std::printf("         from the lab's truth: %.2f mm", stage.off.millimetres);
        if (stage.off.degrees) std::printf(", %.3f degrees", *stage.off.degrees);
        std::printf("\n");
    }
    printFindings(stage.result.warnings);
}

void registerInLab(const RegisterArguments& arguments, const Session& session) {
    const auto rig = std::make_shared<const Rig>(readRig(arguments.rig));
    const std::vector<Stage> stages = stagesOf(rig, arguments, session.progress());
    Session::endProgress();
    const std::optional<Finding>& refusal = stages.back().result.refusal;
    if (arguments.json) {
        nlohmann::json all = nlohmann::json::array();
        for (const Stage& stage : stages) all.push_back(jsonOf(stage));
        nlohmann::json printed = {{"seed", arguments.seed}, {"stages", all}};
        if (refusal) printed["refused"] = cli::jsonOf(*refusal);
        printJson(printed);
    } else {
        for (const Stage& stage : stages) print(stage);
    }
    if (refusal) throw CaptureRefused(*refusal);
}

} // namespace

void addLabRegisterCommand(CLI::App& group, Session& session) {
    auto arguments = std::make_shared<RegisterArguments>();
    CLI::App* command = group.add_subcommand(
        "register",
        "Register pointer, tracker, device and eye in a lab whose truth is known, with the noise of tracker "
        "and hands");
    command->add_option("rig", arguments->rig, "The device")->required();
    command->add_option("--seed", arguments->seed, "Another room and other noise for another number")
        ->check(seedNumber())
        ->capture_default_str();
    command->add_option("--fault", arguments->fault, "Let the tracker have one: " + trackerFaultKeys());
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments, &session] { registerInLab(*arguments, session); });
}

} // namespace lumorph::cli

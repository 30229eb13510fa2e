#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/pattern_arguments.h"
#include "app/cli/project_frame.h"
#include "calibration/report/calibrated_room.h"
#include "calibration/report/calibration_file.h"
#include "core/base/error.h"
#include "core/scene/project.h"

namespace lumorph::cli {

namespace {

struct ImportArguments {
    std::string file;
    std::string project; ///< empty: the virtual lab's installation
    std::string camera, projector;
    std::size_t number = 1; ///< of the room's projector
    std::string exported;
    bool apply = false;
    bool json = false;
};

/// What the file says, lengths in millimetres, and the room with it.
struct Imported {
    CalibrationRecord record;
    Installation room;
    bool hasPlaces = false; ///< it has poses of a board, which tell where the devices stand
};

KnownSizes knownSizesFor(const ImportArguments& arguments, const Installation& room) {
    KnownSizes sizes;
    if (arguments.number <= room.projectors.size()) {
        const glm::ivec2 size = room.projectors[arguments.number - 1].camera.size;
        sizes.projector = {size.x, size.y};
    }
    if (!room.cameras.empty()) sizes.camera = {room.cameras.front().camera.size.x, room.cameras.front().camera.size.y};
    if (!arguments.projector.empty()) sizes.projector = parseProjectorSize(arguments.projector);
    if (!arguments.camera.empty()) sizes.camera = parseProjectorSize(arguments.camera);
    return sizes;
}

Imported importFile(const ImportArguments& arguments, const Installation& room) {
    Imported imported;
    imported.record = inMillimetres(readCalibration(arguments.file, knownSizesFor(arguments, room)));
    const CalibrationRecord& record = imported.record;
    CalibrationBoard board;
    try {
        board = parseCalibrationBoard(record.source.board);
    } catch (const InvalidInput&) { // not said, or in another program's words: it only names a scale
    }
    RoomPlacement placement;
    placement.projector = arguments.number - 1;
    placement.date = record.source.date;
    try {
        imported.room = withImport(room, record.result, board, placement);
        imported.hasPlaces = !tableViewsOf(record.result).empty();
    } catch (const InvalidInput& error) { // its first pose did not lie on a table, say
        if (arguments.apply) throw;
        imported.room = room;
        printWarnings({error.what()});
    }
    if (record.source.isSimulated) markSimulated(room, imported.room);
    return imported;
}

nlohmann::json roomPlaceOf(const CalibratedCamera& camera) {
    const glm::dvec3 at = positionOf(camera);
    return {at.x, at.y, at.z};
}

nlohmann::json importedJson(const Imported& imported, const ImportArguments& arguments) {
    const ProcamCalibration& result = imported.record.result;
    const bool hasProjector = !result.projector.size.empty();
    nlohmann::json all = {{"camera", jsonOf(result.camera)},
                          {"projector", hasProjector ? jsonOf(result.projector) : nlohmann::json()},
                          {"rms", jsonOf(whereSaid(result.rms))},
                          {"poses", result.views.size()},
                          {"lightWithinMillimetres", jsonOf(heldOutMillimetresOf(result))},
                          {"warnings", jsonOf(result.warnings)},
                          {"simulated", imported.record.source.isSimulated},
                          {"applied", arguments.apply}};
    if (hasProjector) {
        const PoseVector& rig = result.projectorFromCamera;
        all["R"] = rotationOf(rig);
        all["T"] = {rig[3], rig[4], rig[5]};
    }
    all["room"] = nullptr;
    if (!imported.hasPlaces) return all;
    all["room"] = {{"camera", roomPlaceOf(imported.room.cameras.front().camera)}};
    if (hasProjector) all["room"]["projector"] = roomPlaceOf(imported.room.projectors[arguments.number - 1].camera);
    return all;
}

void printImported(const Imported& imported, const ImportArguments& arguments) {
    const ProcamCalibration& result = imported.record.result;
    const bool hasProjector = !result.projector.size.empty();
    printDevice("camera", result.camera);
    if (hasProjector) {
        printDevice("projector", result.projector);
        const PoseVector& rig = result.projectorFromCamera;
        std::printf("%-10s at (%.2f, %.2f, %.2f) mm in the projector's frame\n", "camera", rig[3], rig[4], rig[5]);
    } else {
        std::printf("%-10s not in this file\n", "projector");
    }
    if (hasProjector && imported.hasPlaces) {
        const glm::dvec3 at = positionOf(imported.room.projectors[arguments.number - 1].camera);
        std::printf("%-10s at (%.3f, %.3f, %.3f) m in the room\n", "projector", at.x, at.y, at.z);
    }
    if (hasProjector) {
        const std::optional<double> within = heldOutMillimetresOf(result);
        if (within)
            std::printf("light lands within %.2f mm of where it is meant to, in 95 %% of cases\n", *within);
        else
            std::printf("the file does not say how far light lands from where it is meant to\n");
    }
    if (tableViewsOf(result).empty())
        std::printf("no pose of a board in it: lenses alone are known, not where the devices stand\n");
    if (imported.record.source.isSimulated) std::printf("simulated: its pictures were the virtual lab's\n");
    printFindings(result.warnings);
}

void importCalibration(const ImportArguments& arguments) {
    if (arguments.apply && arguments.project.empty())
        throw InvalidInput("--apply", "it says no project to write into", "add --project ROOM.lumorph");
    if (arguments.apply && arguments.project.starts_with("resource:"))
        throw InvalidInput("--apply", "a bundled project cannot be written", "copy it first");
    if (!arguments.exported.empty()) requireCalibrationName(arguments.exported);
    Project project;
    const bool hasProject = !arguments.project.empty();
    if (hasProject) project = readProject(projectFile(arguments.project));
    const Imported imported = orRefused(arguments.json, [&] {
        return importFile(arguments, hasProject ? project.installation : defaultInstallation());
    });
    if (!arguments.exported.empty()) writeCalibration(imported.record, arguments.exported);
    if (arguments.apply) {
        project.installation = imported.room;
        writeProject(project, projectFile(arguments.project));
    }
    if (arguments.json)
        printJson(importedJson(imported, arguments));
    else
        printImported(imported, arguments);
}

} // namespace

void addCalibrateImport(CLI::App& group) {
    auto arguments = std::make_shared<ImportArguments>();
    CLI::App* command = group.add_subcommand("import", "What a calibration of Lumorph or of another program says");
    command
        ->add_option("file", arguments->file,
                     "JSON of Lumorph, or YAML, XML or JSON of OpenCV, ROS, Kalibr, "
                     "SLStudio or procam-calibration")
        ->required();
    command->add_option("--project", arguments->project,
                        "The project whose room it is for (default: the virtual lab's installation)");
    command->add_option("--number", arguments->number, "Which projector of the room it is")
        ->check(CLI::Range(1, 16))
        ->capture_default_str();
    command->add_option("--projector", arguments->projector,
                        "The projector's size in pixels where the file does not say it (default: the room's)");
    command->add_option("--camera", arguments->camera, "The camera's, likewise");
    command->add_option("--export", arguments->exported, "Write it to a file, lengths in millimetres: .json or .yaml");
    command->add_flag("--apply", arguments->apply, "Write it into the project's installation");
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments] { importCalibration(*arguments); });
}

} // namespace lumorph::cli

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/project_frame.h"
#include "app/cli/stage_output.h"
#include "calibration/lab/moved_room.h"
#include "calibration/lab/true_room.h"
#include "calibration/stages/lab_bench.h"
#include "calibration/stages/session.h"
#include "calibration/verify/check_picture.h"
#include "core/base/error.h"
#include "core/base/image.h"
#include "core/base/resources.h"
#include "core/show/project_contents.h"

// The stages of a calibration, one command each: recorded in the virtual lab or at the table, or solved from a
// recording. Some also read a folder of pictures, for which no project is needed. Then all in turn, and how they stand.

namespace lumorph::cli {

namespace {

struct StageArguments {
    std::string project, from, record, fault;
    bool inLab = false, atTable = false, json = false;
    bool inTurn = false; ///< one lab for all stages, so that a check looks at what the others measured
    std::uint32_t seed = 1;
    LabApply apply;
    // Of single stages:
    bool withoutSheet = false;
    std::vector<std::string> moved;
    std::string pattern = "graycode", picture, grid;
};

/// What a stage has beside what all have.
struct StageHelp {
    const char *key, *help, *faults;
    FolderCommand (*addFolder)(CLI::App& command, const Session& session) = nullptr;
};
constexpr StageHelp kHelp[] = {
    {"room", "Several cameras and projectors together, by patterns on a board", "pushed", addRoomFolder},
    {"mirror", "A projector whose light the camera sees only in a mirror", "", addMirrorFolder},
    {"device", "Camera and projectors without a board, by patterns on the device at rest and raised", "",
     addDeviceFolder},
    {"light", "How much light values make, black, and bare colours, by photographs of flat light",
     "saturated, dark, automatic, ambient, falling or unseen"},
    {"pointer", "Where the tip of the tracked pointer is, by swings about it", nullptr},
    {"tracker", "Where the tracker's world lies in the room, by projected dots that the tip touches", nullptr},
    {"body", "Where the device lies on its tracked body, by points that the tip touches", nullptr},
    {"eye", "Where the eye is on a tracked head, by marks that the tip covers", nullptr},
    {"servos", "Where servos really go, their play and what is wrong with them, by camera",
     "swapped, reversed, dead or jammed"},
    {"delays", "How late light, poses and servos are, by flashes, a moved board and steps",
     "frames, camera, slow, covered, tracker, still, dead or jammed"},
    {"verify", "Whether the room is still as it was calibrated, or what has moved", nullptr},
};

/// Without the light that was measured before, so that a measurement does not build on an earlier one.
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

/// The bench of a command line: it has no window for patterns and follows no tracker, so each stage says what is
/// missing.
class Terminal final : public Bench {
public:
    [[nodiscard]] RecordingSource source() const override { return {RecordingSource::Kind::table, "", utcDate(), 0}; }
    [[nodiscard]] std::vector<ProjectorPoint> look(const StageSite& site, const std::vector<double>&,
                                                   const Progress&) override {
        lacks(site);
    }
    [[nodiscard]] DeviceBench& device(const StageSite& site) override { lacks(site); }
    [[nodiscard]] LightBench& light(const StageSite& site, const std::optional<WhiteSheet>&, const Progress&) override {
        lacks(site);
    }
    [[nodiscard]] DelaysCapture recordDelays(const StageSite& site, const Progress&) override { lacks(site); }

    [[noreturn]] static void lacks(const StageSite& site) {
        if (site.room.cameras.empty() || site.room.cameras.front().address.empty())
            throw DeviceError("camera", "the room has none that is connected to this machine",
                              "calibrate projector and camera with it first, in the studio");
        throw DeviceError("projector of camera " + site.room.cameras.front().address,
                          "a command line has no window to show pictures in",
                          "measure at the table in the studio, keep the recording, and solve it with --from");
    }
};

Installation trueRoomOf(const StageArguments& arguments, const CalibrationStage& stage, const StageSite& site) {
    const std::string_view key = stage.key;
    if (arguments.inTurn || (key != "verify" && key != "device"))
        return unpackedLab(site.room, site.rig->actuators(), arguments.seed);
    // A check asks what has moved since, and by the device only what is known can be measured: else all is as it was.
    Installation truth = withLabCamera(site.room);
    std::uint32_t seed = arguments.seed;
    for (const std::string& text : arguments.moved)
        truth = pushed(truth, *site.rig, parseLabPush(text, *site.rig), seed++);
    return truth;
}

MeasuredStage measured(const StageArguments& arguments, const CalibrationStage& stage, StageSite site,
                       const Progress& progress) {
    if (stage.key == std::string_view("light")) site.room = withoutLight(site.room);
    if (!arguments.from.empty()) {
        StageRecording recording = readStageRecording(arguments.from, progress.part(0.0, 0.1));
        StageResult result = solveStage(stage, recording, site, progress.part(0.1, 1.0));
        return {std::move(recording), std::move(result)};
    }
    if (arguments.atTable) {
        // Before anything is planned: what a table lacks has nothing to do with the room's figures.
        if (std::ranges::find(stage.needs, "pointer") == stage.needs.end() && stage.key != std::string_view("pointer"))
            Terminal::lacks(site);
        Terminal table;
        return measureStage(stage, site, table, progress);
    }
    LabBenchOptions options = labWithFault(stage.key, arguments.fault);
    options.light.laysSheet = !arguments.withoutSheet;
    options.checkPattern = arguments.pattern;
    LabBench lab(*site.rig, trueRoomOf(arguments, stage, site), arguments.seed, options);
    return measureStage(stage, site, lab, progress);
}

/// Shapes that the real device is judged by: the project's own target, or a few of the bundled ones.
std::vector<LibraryTarget> shapesFor(const ProjectContents& contents) {
    if (contents.target) {
        LibraryTarget own{contents.target->name, contents.target->solid, contents.target->box};
        return {std::move(own)};
    }
    return readTargets(
        {resourceFile("targets/bowl.glb"), resourceFile("targets/cove.glb"), resourceFile("targets/valley.glb")});
}

StageView viewOf(const ProjectContents& contents, const StageOutcome& done, const Progress& progress) {
    StageView view{*contents.rig, std::nullopt};
    const auto* servos = std::get_if<ServoMeasurement>(&done.result);
    if (!servos || !done.recording->truth) return view;
    LibraryFitOptions fitting;
    fitting.resolution = 25;
    view.servoGain =
        servoGain(*contents.rig, shapesFor(contents), servos->room, *done.recording->truth, fitting, progress);
    return view;
}

const char* wayOf(const StageArguments& arguments, const StageOutcome& done) {
    return done.isSimulated ? "simulated" : arguments.from.empty() ? "measured" : "recorded";
}

/// Before anything takes long. Throws InvalidInput.
void checkRecord(const std::string& folder) {
    std::error_code error;
    if (std::filesystem::exists(folder, error) && !std::filesystem::is_empty(folder, error))
        throw InvalidInput("--record " + folder, "is there already and not an empty folder",
                           "name a new folder, or empty this one");
}

/// Measures a stage of a project's room, and keeps the recording where that is asked for.
StageOutcome measuredIn(const Installation& room, const StageArguments& arguments, const CalibrationStage& stage,
                        const std::shared_ptr<const Rig>& rig, const Progress& progress) {
    MeasuredStage done = measured(arguments, stage, {rig, room}, progress.part(0.0, 0.97));
    if (done.recording.source.isSimulated()) arguments.apply.checkRoom(arguments.project, room);
    if (!arguments.record.empty()) writeStageRecording(done.recording, arguments.record, progress.part(0.97, 1.0));
    return outcomeOf(std::move(done), room);
}

void run(const StageArguments& arguments, const CalibrationStage& stage, const Session& session) {
    const std::filesystem::path file = projectFile(arguments.project);
    arguments.apply.checkProject(arguments.project);
    for (const std::string& output : {arguments.picture, arguments.grid})
        if (!output.empty()) checkOutput(output, file.string());
    checkRecord(arguments.record);
    (void)labWithFault(stage.key, arguments.fault);
    const Progress progress = session.progress();
    const ProjectContents contents = readContents(file, progress.part(0.0, 0.1));
    Project project = contents.project;
    if (arguments.from.empty() && !arguments.atTable)
        arguments.apply.checkRoom(arguments.project, project.installation);
    const StageOutcome done = orRefused(arguments.json, [&] {
        return measuredIn(project.installation, arguments, stage, contents.rig, progress.part(0.1, 0.92));
    });
    const StageView view = viewOf(contents, done, progress.part(0.92, 1.0));
    Session::endProgress();
    const auto* check = std::get_if<VerifiedRoom>(&done.result);
    if (check) {
        const Rig& rig = *contents.rig;
        const Installation seen = withLabCamera(project.installation);
        const std::vector<double> bend = checkBends(rig).front();
        if (!arguments.picture.empty()) writePng(errorPicture(check->check, rig, seen, bend), arguments.picture);
        if (!arguments.grid.empty()) writePng(gridPicture(rig, seen, bend), arguments.grid);
    }
    const bool isApplied = arguments.apply.apply && done.changesRoom && (done.isGood || check);
    if (isApplied) {
        stage.apply(roomOf(done.result), project.installation);
        writeProject(project, file);
    }
    const std::optional<Finding> refusal = refusalOf(done.result);
    if (arguments.json) {
        nlohmann::json json = jsonOf(done.result, view);
        json["applied"] = isApplied;
        json["way"] = wayOf(arguments, done);
        if (refusal) json["refused"] = jsonOf(*refusal);
        printJson(json);
    } else if (!refusal) {
        printResult(done.result, view);
        if (isApplied) std::printf("The project's installation has it now, as %s.\n", wayOf(arguments, done));
    }
    if (refusal) throw CaptureRefused(*refusal);
    if (check && check->check.verdict == RoomCheck::Verdict::none)
        throw DataError("check of the room", check->check.obstacle->why, check->check.obstacle->remedy);
}

nlohmann::json standsJson(const CalibrationSession& chain) {
    nlohmann::json stages = nlohmann::json::array(), next;
    for (std::size_t k = 0; k < chain.stands().size(); ++k) {
        const CalibrationStage& stage = calibrationStages()[k];
        const StageStand& stand = chain.stands()[k];
        stages.push_back({{"stage", stage.key}, {"title", stage.title}, {"how", keyOf(stand.how)}});
        stages.back()["other"] = stand.other ? nlohmann::json(calibrationStages()[*stand.other].key) : nlohmann::json();
        stages.back()["words"] = standText(stand);
    }
    if (const auto k = chain.next())
        next = {{"stage", calibrationStages()[*k].key}, {"why", whyNext(*k, chain.stands()[*k])}};
    return {{"stages", std::move(stages)}, {"next", std::move(next)}};
}

void printStands(const CalibrationSession& chain) {
    for (std::size_t k = 0; k < chain.stands().size(); ++k)
        std::printf("%-10s %-36s %-10s %s\n", calibrationStages()[k].key, calibrationStages()[k].title,
                    keyOf(chain.stands()[k].how), standText(chain.stands()[k]).c_str());
    if (const auto k = chain.next())
        std::printf("next: %s, %s\n", calibrationStages()[*k].key, whyNext(*k, chain.stands()[*k]).c_str());
    else
        std::printf("next: nothing, all is measured\n");
}

/// Measures the stage whose turn it is, and takes it into the project's room. Throws where it is not good.
void takeTurn(CalibrationSession& chain, std::size_t place, const StageArguments& arguments,
              const ProjectContents& contents, Project& project, nlohmann::json& results, const Progress& progress) {
    const CalibrationStage& stage = calibrationStages()[place];
    Installation& room = project.installation;
    StageArguments own = arguments;
    for (std::string* folder : {&own.from, &own.record})
        if (!folder->empty()) *folder = (std::filesystem::path(*folder) / stage.key).string();
    if (!arguments.record.empty()) std::filesystem::create_directories(arguments.record);
    chain.begin(place);
    StageOutcome outcome = measuredIn(room, own, stage, contents.rig, progress);
    Session::endProgress();
    const StageView view{*contents.rig, std::nullopt};
    const std::optional<Finding> refusal = refusalOf(outcome.result);
    results.push_back({{"stage", stage.key},
                       {"way", wayOf(arguments, outcome)},
                       {"good", outcome.isGood},
                       {"result", jsonOf(outcome.result, view)}});
    if (!arguments.json) std::printf("%s: %s\n", stage.key, stage.title);
    if (!arguments.json && !refusal) printResult(outcome.result, view);
    if (auto doubted = chain.take(place, std::move(outcome), room)) room = std::move(*doubted);
    if (refusal) throw CaptureRefused(*refusal);
    const StageOutcome& done = *chain.outcomeAt(place);
    if (!done.isGood)
        throw DataError(stage.title, "what came of it is not to be trusted, or something has moved",
                        "look at its figures");
    if (done.changesRoom) stage.apply(roomOf(done.result), room);
}

void measureAll(const StageArguments& arguments, const Session& session) {
    const std::filesystem::path file = projectFile(arguments.project);
    arguments.apply.checkProject(arguments.project);
    checkRecord(arguments.record);
    const Progress progress = session.progress();
    const ProjectContents contents = readContents(file, progress.part(0.0, 0.05));
    Project project = contents.project;
    if (arguments.from.empty()) arguments.apply.checkRoom(arguments.project, project.installation);
    CalibrationSession chain;
    chain.follow(project.installation);
    chain.measureRest();
    nlohmann::json results = nlohmann::json::array(), ended;
    std::optional<std::size_t> place;
    std::string why;
    bool isWritten = false;
    while (const auto turn = chain.nextOfRest()) {
        // Boards measure one projector as they measure several.
        place = calibrationStages()[*turn].hasSequence() ? placeOfStage("room") : *turn;
        const double each = 0.95 / static_cast<double>(chain.stands().size());
        const double from = 0.05 + each * static_cast<double>(*turn);
        try {
            takeTurn(chain, *place, arguments, contents, project, results, progress.part(from, from + each));
        } catch (const Cancelled&) {
            if (!isWritten) throw;
            why = "it was stopped; what was measured before it stays in the project";
            chain.fail(*place, "");
        } catch (const std::exception& error) {
            why = error.what();
            chain.fail(*place, why);
        }
        chain.follow(project.installation);
        if (!arguments.apply.apply) continue;
        writeProject(project, file);
        isWritten = true;
    }
    if (const auto next = chain.next(); next && why.empty()) {
        place = next;
        why = "it was measured, and still: " + whyNext(*next, chain.stands()[*next]);
    }
    if (!why.empty()) ended = {{"stage", calibrationStages()[place.value()].key}, {"why", why}};
    if (arguments.json) {
        nlohmann::json json = standsJson(chain);
        json["measured"] = std::move(results);
        json["applied"] = arguments.apply.apply;
        json["ended"] = std::move(ended);
        printJson(json);
    } else {
        printStands(chain);
    }
    if (!why.empty())
        throw DataError("stage " + std::string(calibrationStages()[*place].key), why,
                        "set that right, then go on: what was good before it is not measured again");
}

/// Else it is a folder of pictures.
bool isProject(const std::string& text) { return text.starts_with("resource:") || text.ends_with(".lumorph"); }

struct Ways {
    CLI::Option *lab, *from;
};

/// Where stages are recorded, and what becomes of it.
Ways addWays(CLI::App& command, StageArguments& arguments) {
    CLI::Option* lab = command.add_flag("--lab", arguments.inLab, "Record in the virtual lab; as without a way");
    CLI::Option* from =
        command.add_option("--from", arguments.from, "Solve a recording: a folder that --record or the studio wrote");
    lab->excludes(from);
    command.add_option("--seed", arguments.seed, "Another lab and other noise for another number")->excludes(from);
    command.add_option("--record", arguments.record, "Keep what devices said in a new folder, to solve it again");
    arguments.apply.addTo(command, "Write what it came to into the project's installation");
    command.add_flag("--json", arguments.json, "Print one JSON value");
    return {lab, from};
}

void addAll(CLI::App& group, Session& session) {
    auto arguments = std::make_shared<StageArguments>();
    arguments->inTurn = true;
    CLI::App* command = group.add_subcommand(
        "all",
        "All that is missing or stale in turn, each in its own folder of --record or --from; ends with the first "
        "that is not good");
    command->add_option("project", arguments->project, "A project, or resource:projects/NAME.lumorph")->required();
    addWays(*command, *arguments);
    command->callback([arguments, &session] { measureAll(*arguments, session); });
    auto asked = std::make_shared<StageArguments>();
    command = group.add_subcommand("status", "How each stage stands in a project's room, and which is next");
    command->add_option("project", asked->project, "A project, or resource:projects/NAME.lumorph")->required();
    command->add_flag("--json", asked->json, "Print one JSON value");
    command->callback([asked] {
        CalibrationSession chain;
        chain.follow(readProject(projectFile(asked->project)).installation);
        if (asked->json) return printJson(standsJson(chain));
        printStands(chain);
    });
}

void addStage(CLI::App& group, const StageHelp& help, Session& session) {
    auto arguments = std::make_shared<StageArguments>();
    const std::string_view key = help.key;
    CLI::App* command = group.add_subcommand(help.key, help.help);
    FolderCommand readFolder;
    if (help.addFolder) readFolder = help.addFolder(*command, session);
    command
        ->add_option("project", arguments->project,
                     help.addFolder ? "A project, or resource:projects/NAME.lumorph; or a folder of pictures, as the "
                                      "guide's chapter on the command line has it"
                                    : "A project, or resource:projects/NAME.lumorph")
        ->required();
    const auto [lab, from] = addWays(*command, *arguments);
    CLI::Option* table =
        command->add_flag("--table", arguments->atTable, "Record with what is connected to this machine");
    table->excludes(lab)->excludes(from)->excludes(command->get_option("--seed"));
    if (!help.faults || *help.faults != 0)
        command
            ->add_option("--fault", arguments->fault,
                         "What is wrong in the lab: " + (help.faults ? std::string(help.faults) : trackerFaultKeys()))
            ->excludes(table)
            ->excludes(from);
    if (key == "light")
        command->add_flag("--without-sheet", arguments->withoutSheet, "No sheet of white paper lies beside the device")
            ->excludes(table)
            ->excludes(from);
    if (key == "verify") {
        command
            ->add_option("--moved", arguments->moved,
                         "What was pushed in the lab since: projector:3mm, camera:2mm, device:4mm, or an actuator's "
                         "name and degrees, 'edge front:5deg'; may be given again")
            ->expected(1)
            ->take_all()
            ->excludes(table)
            ->excludes(from);
        command->add_option("--pattern", arguments->pattern, "graycode, or phase:16x3+1x3")->excludes(from);
        command->add_option("--picture", arguments->picture, "Draw the error map over the device into a PNG file");
        command->add_option("--grid", arguments->grid,
                            "Draw what the projector shows to check by eye into a PNG file: crosshairs and lines");
    }
    command->callback([arguments, key, readFolder, &session] {
        if (readFolder && !isProject(arguments->project)) return readFolder(arguments->project, arguments->json);
        run(*arguments, calibrationStage(key), session);
    });
}

} // namespace

void addCalibrateStages(CLI::App& group, Session& session) {
    for (const StageHelp& help : kHelp) addStage(group, help, session);
    addAll(group, session);
}

} // namespace lumorph::cli

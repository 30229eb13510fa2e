#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/pattern_arguments.h"
#include "app/output/pattern_export.h"
#include "calibration/doctor/capture_calibration.h"
#include "calibration/report/calibration_file.h"
#include "calibration/report/report_page.h"
#include "calibration/solve/crosshair_calibration.h"
#include "calibration/solve/crosshair_points.h"
#include "calibration/tracking/board_page.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/rig/rig_file.h"
#include "core/scene/installation.h"

namespace lumorph::cli {

namespace {

struct CalibrateArguments {
    std::string folder;
    std::string board;
    std::string projector;
    PatternArguments patterns;
    std::string report;   ///< .html
    std::string exported; ///< .json or .yaml
    bool json = false;
};

struct CrosshairArguments {
    std::string input; ///< a table, or a rig
    std::string projector;
    double aimingSigma = 1.0;
    std::vector<double> place{0.0, 2.0, 0.4};
    int most = 8;
    bool json = false;
};

struct PatternsToShow {
    std::string folder, projector;
    PatternArguments patterns;
    double seconds = 2.0;
};

nlohmann::json intrinsicsJson(const ProcamCalibration& result) {
    nlohmann::json views = nlohmann::json::array();
    for (const ViewQuality& view : result.views)
        views.push_back({{"name", view.name}, {"rms", view.cameraRms}, {"heldOut", jsonOf(view.heldOut)}});
    return {{"camera", jsonOf(result.camera)},
            {"rms", result.rms},
            {"views", views},
            {"worstView", result.worstView},
            {"model", result.camera.model},
            {"warnings", jsonOf(result.warnings)},
            {"degenerate", result.degenerate}};
}

void printIntrinsics(const ProcamCalibration& result) {
    printDevice("camera", result.camera);
    for (const ViewQuality& view : result.views)
        std::printf("  %-24s %.3f pixels%s\n", view.name.c_str(), view.cameraRms,
                    view.name == result.worstView ? "  (worst)" : "");
    printFindings(result.warnings);
}

/// Points of crosshairs, one a line: x, y, z (metres), u, v (projector pixels) and, if there is one, a name. A first
/// line that names the columns may stand before them.
std::vector<Crosshair> readCrosshairs(const std::string& path, const Session& session) {
    const std::vector<std::byte> bytes = session.readInput(path);
    std::istringstream lines(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    std::vector<Crosshair> crosshairs;
    std::string line;
    constexpr std::size_t kMostLines = 10'000;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        const std::string place = inputName(path) + ", line " + std::to_string(number);
        double values[5] = {};
        const char* at = line.data();
        const char* const end = line.data() + line.size();
        const auto skip = [&](std::string_view what) {
            while (at != end && what.find(*at) != std::string_view::npos) ++at;
        };
        bool whole = true;
        for (int i = 0; i < 5 && whole; ++i) {
            skip(" \t");
            const auto [next, error] = std::from_chars(at, end, values[i]);
            whole = error == std::errc() && std::isfinite(values[i]);
            at = next;
            skip(" \t\r");
            whole = whole && (at == end ? i == 4 : *at == ',');
            if (at != end) ++at;
        }
        if (!whole && number == 1) continue; // names of the columns
        if (!whole || number > kMostLines)
            throw DataError(place, whole ? "there are too many points" : "it has not five numbers",
                            "write x, y, z in metres and the crosshair's column and row, separated by commas");
        skip(" \t\"");
        std::string name(at, end);
        name.erase(name.find_last_not_of(" \t\r\"") + 1);
        if (name.empty()) name = "point " + std::to_string(crosshairs.size() + 1);
        crosshairs.push_back({name, {values[0], values[1], values[2]}, {values[3], values[4]}, true});
    }
    return crosshairs;
}

void crosshairs(const CrosshairArguments& arguments, const Session& session) {
    const cv::Size size = parseProjectorSize(arguments.projector);
    CrosshairOptions options;
    options.aimingSigma = arguments.aimingSigma;
    const std::vector<Crosshair> aimed = readCrosshairs(arguments.input, session);
    const CrosshairCalibration result = orRefused(arguments.json, [&] {
        CrosshairCalibration solved = calibrateCrosshairs(aimed, size, options);
        if (solved.refusal) throw CaptureRefused(*solved.refusal);
        return solved;
    });
    const PoseVector& pose = result.projectorFromWorld;
    const PoseVector& sigma = result.projectorFromWorldSigma;
    double worst = 0.0;
    for (const Crosshair& at : aimed) worst = std::max(worst, result.error95At(at.point));
    if (arguments.json) {
        nlohmann::json points = nlohmann::json::array();
        for (std::size_t i = 0; i < aimed.size(); ++i)
            points.push_back({{"name", aimed[i].name},
                              {"error", {result.points[i].error.x, result.points[i].error.y}},
                              {"contradiction", result.points[i].contradiction},
                              {"suspicious", result.points[i].suspicious}});
        printJson({{"projector", jsonOf(result.projector)},
                   {"R", rotationOf(pose)},
                   {"T", {pose[3], pose[4], pose[5]}},
                   {"sigma", poseSigmaOf(sigma)},
                   {"rms", result.projector.rms},
                   {"points", points},
                   {"error95", worst},
                   {"model", result.projector.model},
                   {"warnings", jsonOf(result.warnings)},
                   {"degenerate", false}});
        return;
    }
    printDevice("projector", result.projector);
    for (std::size_t i = 0; i < aimed.size(); ++i)
        std::printf("  %-32s %7.2f %7.2f pixels%s\n", aimed[i].name.c_str(), result.points[i].error.x,
                    result.points[i].error.y, result.points[i].suspicious ? "  (suspicious)" : "");
    std::printf("light lies within %.1f mm of where it is meant to at these points, in 95 %% of cases\n", 1e3 * worst);
    printFindings(result.warnings);
}

void points(const CrosshairArguments& arguments) {
    const DevicePoints proposal = proposeDevicePoints(
        readRig(arguments.input), {arguments.place[0], arguments.place[1], arguments.place[2]}, arguments.most);
    if (arguments.json) {
        nlohmann::json all = nlohmann::json::array();
        for (const DevicePoint& at : proposal.points)
            all.push_back({{"name", at.name}, {"point", {at.point.x, at.point.y, at.point.z}}});
        printJson({{"strokes", proposal.strokes}, {"points", all}});
        return;
    }
    std::printf("with all actuators raised; x, y, z in millimetres:\n");
    for (const DevicePoint& at : proposal.points)
        std::printf("  %-32s %7.1f %7.1f %7.1f\n", at.name.c_str(), 1e3 * at.point.x, 1e3 * at.point.y,
                    1e3 * at.point.z);
}

/// Before anything takes long. Throws InvalidInput.
void checkOutputs(const CalibrateArguments& arguments) {
    const std::string& report = arguments.report;
    if (report.ends_with(".pdf"))
        throw InvalidInput("--report " + report, "the command line writes no PDF",
                           "write .html, or let the studio make the PDF");
    if (!report.empty() && !report.ends_with(".html"))
        throw InvalidInput("--report " + report, "is no .html", "name it OUT.html");
    if (!arguments.exported.empty()) requireCalibrationName(arguments.exported);
}

CalibrationSource sourceOf(const CalibrateArguments& arguments, bool hasPatterns) {
    CalibrationSource source;
    source.date = utcDate();
    source.board = arguments.board;
    if (hasPatterns) source.pattern = arguments.patterns.name();
    source.inputs = {arguments.folder};
    source.isSimulated = isLabCapture(arguments.folder);
    return source;
}

void writeReport(const CalibrateArguments& arguments, const CalibrationReport& report) {
    if (arguments.report.empty()) return;
    const std::string page = reportPage(report);
    writeFileAtomically(arguments.report, std::as_bytes(std::span(page)));
}

void writeOutputs(const CalibrateArguments& arguments, const CalibrationReport& report) {
    if (!arguments.exported.empty()) writeCalibration(report.record, arguments.exported);
    writeReport(arguments, report);
}

void procam(const CalibrateArguments& arguments, const Session& session) {
    checkOutputs(arguments);
    const CalibrationBoard board = parseCalibrationBoard(arguments.board);
    const cv::Size projector = parseProjectorSize(arguments.projector);
    const CaptureOrder order = arguments.patterns.orderFor(projector);
    CalibrationReport report;
    report.record.source = sourceOf(arguments, true);
    const auto run = [&] {
        constexpr double kReading = 0.6; // of the whole time
        const Progress progress = session.progress();
        const CaptureListing listing = listCapture(arguments.folder);
        report.sights.resize(listing.views.size());
        ReadCapture capture = readPoses(
            listing.views, board, order,
            [&](std::size_t index, const ReadPose& pose) {
                if (!arguments.report.empty()) report.sights[index] = pose.decoded.white;
            },
            progress.part(0.0, kReading));
        capture.warnings.insert(capture.warnings.begin(), listing.passedOver.begin(), listing.passedOver.end());
        report.observations = capture.views;
        return calibrateCapture(capture, order.projector, {}, progress.part(kReading, 1.0));
    };
    try {
        report.record.result = orRefused(arguments.json, run);
    } catch (const CaptureRefused& refused) {
        report.refusal = refused.finding();
        writeReport(arguments, report);
        throw;
    }
    Session::endProgress();
    writeOutputs(arguments, report);
    if (arguments.json) {
        nlohmann::json all = jsonOf(report.record.result);
        if (report.record.source.isSimulated) all["simulated"] = true;
        printJson(all);
    } else {
        printProcam(report.record.result);
        if (report.record.source.isSimulated) std::printf("simulated: the pictures are the virtual lab's\n");
    }
}

void intrinsics(const CalibrateArguments& arguments, const Session& session) {
    checkOutputs(arguments);
    const CalibrationBoard board = parseCalibrationBoard(arguments.board);
    const ProcamCalibration result = orRefused(
        arguments.json, [&] { return calibrateIntrinsicsFolder(arguments.folder, board, {}, session.progress()); });
    Session::endProgress();
    CalibrationReport report;
    report.record = {result, sourceOf(arguments, false)};
    writeOutputs(arguments, report);
    if (arguments.json)
        printJson(intrinsicsJson(result));
    else
        printIntrinsics(result);
}

/// What both commands can write beside what they print.
void addOutputs(CLI::App& command, CalibrateArguments& arguments) {
    command.add_option("--export", arguments.exported,
                       "Write the result to a file: .json (Lumorph's own) or .yaml (OpenCV's)");
    command.add_option("--report", arguments.report, "Write a report with plots and pictures: .html");
}

} // namespace

void addCalibrateCommands(CLI::App& app, Session& session) {
    CLI::App* group = app.add_subcommand("calibrate", "Calibrate cameras and projectors from captured images");
    group->require_subcommand(1);

    auto both = std::make_shared<CalibrateArguments>();
    CLI::App* command = group->add_subcommand("procam", "A projector and a camera, from patterns on a board");
    command->add_option("folder", both->folder, "A folder with one folder of images for each pose")->required();
    command->add_option("--board", both->board, kBoardHelp)->required();
    command->add_option("--projector", both->projector, "The projector's size in pixels, such as 1024x768")->required();
    both->patterns.addTo(*command);
    addOutputs(*command, *both);
    command->add_flag("--json", both->json, "Print one JSON value");
    command->callback([both, &session] { procam(*both, session); });

    auto aims = std::make_shared<CrosshairArguments>();
    command = group->add_subcommand("crosshairs", "A projector without a camera, from crosshairs on known points");
    command
        ->add_option("points", aims->input,
                     "A table with x, y, z (metres), u, v (projector pixels) and a name a line, separated by commas; - "
                     "is standard input")
        ->required();
    command->add_option("--projector", aims->projector, "The projector's size in pixels, such as 1024x768")->required();
    command->add_option("--aiming", aims->aimingSigma, "How well the crosshairs were aimed, pixels")
        ->capture_default_str();
    command->add_flag("--json", aims->json, "Print one JSON value");
    command->callback([aims, &session] { crosshairs(*aims, session); });

    auto wanted = std::make_shared<CrosshairArguments>();
    command = group->add_subcommand("points", "Which points of a device to lay crosshairs onto");
    command->add_option("rig", wanted->input, "A rig")->required();
    command->add_option("--from", wanted->place, "Where the projector stands, X,Y,Z in the device's frame, metres")
        ->delimiter(',')
        ->expected(3)
        ->capture_default_str();
    command->add_option("--count", wanted->most, "How many at most")->capture_default_str()->check(CLI::Range(6, 64));
    command->add_flag("--json", wanted->json, "Print one JSON value");
    command->callback([wanted] { points(*wanted); });

    auto printed = std::make_shared<std::pair<std::string, std::string>>();
    command = group->add_subcommand("board", "Write a board to print, as PDF of true size");
    command->add_option("board", printed->first, kBoardHelp)->required();
    command->add_option("output", printed->second, "PDF to write, or - for standard output")->required();
    command->callback([printed] {
        checkOutput(printed->second, {});
        writeOutput(printed->second, bytesOfText(calibrationBoardPdf(parseCalibrationBoard(printed->first))));
        if (printed->second != "-") std::printf("%s: print it at 100 %%\n", printed->second.c_str());
        finishOutput();
    });

    auto shown = std::make_shared<PatternsToShow>();
    command = group->add_subcommand("patterns", "Write patterns as pictures and as a film, to photograph them by hand");
    command->add_option("folder", shown->folder, "A new folder")->required();
    command->add_option("--projector", shown->projector, "The projector's size in pixels, such as 1024x768")
        ->required();
    shown->patterns.addTo(*command);
    command->add_option("--seconds", shown->seconds, "How long each stands in the film")->capture_default_str();
    command->callback([shown, &session] {
        const CaptureOrder order = shown->patterns.orderFor(parseProjectorSize(shown->projector));
        writePatterns(order, shown->folder, shown->seconds, session.progress());
        Session::endProgress();
        std::printf("%s: %zu patterns; photograph each once a pose, in this order, and calibrate with --order %s\n",
                    shown->folder.c_str(), order.images.size(),
                    (std::filesystem::path(shown->folder) / "order.txt").c_str());
        finishOutput();
    });

    auto alone = std::make_shared<CalibrateArguments>();
    command = group->add_subcommand("intrinsics", "A camera alone, from pictures of a board");
    command->add_option("folder", alone->folder, "A folder of pictures")->required();
    command->add_option("--board", alone->board, kBoardHelp)->required();
    addOutputs(*command, *alone);
    command->add_flag("--json", alone->json, "Print one JSON value");
    command->callback([alone, &session] { intrinsics(*alone, session); });

    addCalibrateImport(*group);
    addCalibrateBudget(*group, session);
    addCalibrateStages(*group, session);
    addCalibrateTracking(*group, session);
}

} // namespace lumorph::cli

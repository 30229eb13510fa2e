#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/pattern_arguments.h"
#include "calibration/doctor/boards_capture.h"
#include "core/base/error.h"

namespace lumorph::cli {

namespace {

constexpr double kReading = 0.6; // of the whole time

struct RoomArguments {
    std::string board;
    std::vector<std::string> projectors; ///< NAME=1024x768; of a mirror, one without a name
    PatternArguments patterns;
};

// ---- Several cameras and projectors ----

/// Parses "NAME=1024x768". Throws InvalidInput.
NamedDevice parseProjector(const std::string& text) {
    const std::size_t sign = text.rfind('=');
    if (sign == std::string::npos || sign == 0 || text.find('/') != std::string::npos)
        throw InvalidInput("--projector " + text, "has no name", "write the name of its folders too: upper=1024x768");
    return {text.substr(0, sign), parseProjectorSize(text.substr(sign + 1))};
}

std::vector<NamedDevice> parseProjectors(const std::vector<std::string>& texts) {
    std::vector<NamedDevice> projectors;
    for (const std::string& text : texts) {
        NamedDevice next = parseProjector(text);
        for (const NamedDevice& other : projectors)
            if (other.name == next.name)
                throw InvalidInput("--projector " + text, "another has the same name", "give each its own");
        projectors.push_back(std::move(next));
    }
    return projectors;
}

using InstallationDevice = InstallationState::Device;

nlohmann::json devicesJson(const std::vector<NamedDevice>& names, const std::vector<CalibratedDevice>& devices,
                           const std::vector<InstallationDevice>& state, const std::vector<InstallationDevice>& sigma) {
    nlohmann::json all = nlohmann::json::array();
    for (std::size_t i = 0; i < names.size(); ++i) {
        nlohmann::json device = jsonOf(devices[i]);
        const PoseVector& pose = state[i].fromWorld;
        device["name"] = names[i].name;
        device["R"] = rotationOf(pose);
        device["T"] = {pose[3], pose[4], pose[5]};
        device["poseSigma"] = poseSigmaOf(sigma[i].fromWorld);
        all.push_back(std::move(device));
    }
    return all;
}

nlohmann::json roomJson(const InstallationCalibration& result, const std::vector<NamedDevice>& cameras,
                        const std::vector<NamedDevice>& projectors) {
    nlohmann::json views = nlohmann::json::array();
    for (const ViewQuality& view : result.views)
        views.push_back({{"name", view.name}, {"cameraRms", view.cameraRms}, {"projectorRms", view.projectorRms}});
    return {
        {"cameras", devicesJson(cameras, result.cameras, result.state.cameras, result.sigma.cameras)},
        {"projectors", devicesJson(projectors, result.projectors, result.state.projectors, result.sigma.projectors)},
        {"rms", result.rms},
        {"views", views},
        {"worstView", result.worstView},
        {"warnings", jsonOf(result.warnings)}};
}

void printDevices(const std::vector<NamedDevice>& names, const std::vector<CalibratedDevice>& devices,
                  const std::vector<InstallationDevice>& state) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        printDevice(names[i].name.c_str(), devices[i]);
        const glm::dvec3 place = Rigid::exp(state[i].fromWorld).inverse().translation;
        std::printf("  at (%.2f, %.2f, %.2f) in the first camera's frame, in the board's unit\n", place.x, place.y,
                    place.z);
    }
}

void printRoom(const InstallationCalibration& result, const std::vector<NamedDevice>& cameras,
               const std::vector<NamedDevice>& projectors) {
    printDevices(cameras, result.cameras, result.state.cameras);
    printDevices(projectors, result.projectors, result.state.projectors);
    for (const ViewQuality& view : result.views)
        std::printf("  %-20s cameras %.3f  projectors %.3f pixels%s\n", view.name.c_str(), view.cameraRms,
                    view.projectorRms, view.name == result.worstView ? "  (worst)" : "");
    printFindings(result.warnings);
}

void room(const RoomArguments& arguments, const std::string& folder, bool json, const Session& session) {
    const std::vector<NamedDevice> projectors = parseProjectors(arguments.projectors);
    std::vector<NamedOrder> orders;
    orders.reserve(projectors.size());
    for (const NamedDevice& projector : projectors)
        orders.push_back({projector.name, arguments.patterns.orderFor(projector.size)});
    BoardsCapture read;
    const InstallationCalibration result = orRefused(json, [&] {
        const Progress progress = session.progress();
        read = readBoardsCapture(folder, arguments.board, orders, progress.part(0.0, kReading));
        InstallationCalibration solved =
            calibrateInstallation(read.views, read.cameras, projectors, progress.part(kReading, 1.0));
        solved.warnings.insert(solved.warnings.end(), read.warnings.begin(), read.warnings.end());
        return solved;
    });
    Session::endProgress();
    if (json)
        printJson(roomJson(result, read.cameras, projectors));
    else
        printRoom(result, read.cameras, projectors);
}

// ---- A mirror ----

nlohmann::json mirrorJson(const MirrorCalibration& result) {
    nlohmann::json json = jsonOf(result.procam);
    json["mirror"] = nullptr;
    if (const auto& mirror = result.mirror)
        json["mirror"] = {
            {"normal", {mirror->normal[0], mirror->normal[1], mirror->normal[2]}},
            {"distance", mirror->distance},
            {"sigma",
             {{"normalDegrees", kDegreesPerRadian * mirror->normalSigma}, {"distance", mirror->distanceSigma}}}};
    return json;
}

void printMirror(const MirrorCalibration& result) {
    printProcam(result.procam);
    if (const auto& mirror = result.mirror)
        std::printf("%-10s %.2f +- %.2f before the camera, in the board's unit, normal (%.4f, %.4f, %.4f) +- %.3f "
                    "degrees\n",
                    "mirror", mirror->distance, mirror->distanceSigma, mirror->normal[0], mirror->normal[1],
                    mirror->normal[2], kDegreesPerRadian * mirror->normalSigma);
}

void mirror(const RoomArguments& arguments, const std::string& folder, bool json, const Session& session) {
    const cv::Size projector = parseProjectorSize(arguments.projectors.front());
    const CaptureOrder order = arguments.patterns.orderFor(projector);
    const MirrorCalibration result = orRefused(json, [&] {
        const Progress progress = session.progress();
        const MirrorCapture capture = readMirrorCapture(folder, arguments.board, order, progress.part(0.0, kReading));
        MirrorCalibration solved =
            calibrateMirrored(capture.views, capture.camera, projector, progress.part(kReading, 1.0));
        std::vector<Finding>& warnings = solved.procam.warnings;
        warnings.insert(warnings.end(), capture.warnings.begin(), capture.warnings.end());
        return solved;
    });
    Session::endProgress();
    if (json)
        printJson(mirrorJson(result));
    else
        printMirror(result);
}

/// What a folder of pictures needs, which a stage of a project does not.
void require(const std::string& value, const char* option) {
    if (value.empty()) throw CLI::RequiredError(option);
}

using FolderReader = void (*)(const RoomArguments&, const std::string&, bool, const Session&);
FolderCommand addFolder(CLI::App& command, const char* projectorHelp, FolderReader read, const Session& session) {
    auto arguments = std::make_shared<RoomArguments>();
    command.add_option("--projector", arguments->projectors, projectorHelp)->expected(1)->take_all();
    command.add_option("--board", arguments->board, kBoardHelp);
    arguments->patterns.addTo(command);
    return [arguments, read, &session](const std::string& folder, bool json) {
        require(arguments->board, "--board");
        require(arguments->projectors.empty() ? "" : arguments->projectors.front(), "--projector");
        read(*arguments, folder, json, session);
    };
}

} // namespace

FolderCommand addRoomFolder(CLI::App& command, const Session& session) {
    return addFolder(command, "Of a folder: a projector's name and size in pixels, upper=1024x768; repeat", room,
                     session);
}

FolderCommand addMirrorFolder(CLI::App& command, const Session& session) {
    return addFolder(command, "Of a folder: the projector's size in pixels, such as 1024x768", mirror, session);
}

} // namespace lumorph::cli

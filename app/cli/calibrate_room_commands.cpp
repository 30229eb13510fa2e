#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/pattern_arguments.h"
#include "calibration/doctor/capture_calibration.h"
#include "calibration/doctor/view_check.h"
#include "calibration/solve/installation_calibration.h"
#include "calibration/solve/mirror_calibration.h"
#include "core/base/error.h"

namespace lumorph::cli {

namespace {

constexpr double kReading = 0.6; // of the whole time

struct RoomArguments {
    std::string folder;
    std::string board;
    std::vector<std::string> projectors; ///< NAME=1024x768; of a mirror, one without a name
    PatternArguments patterns;
    bool json = false;
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

/// Where the images of one projector's light, by one camera, lie; pose by pose.
struct LightSeen {
    std::vector<std::size_t> poses;
    std::vector<CapturedView> views;
};

/// What lies in a folder POSE/CAMERA/PROJECTOR/images.
struct RoomFolder {
    std::vector<std::string> poses, cameras;
    std::map<std::pair<std::string, std::size_t>, LightSeen> lights; ///< by camera's name and projector
};

std::size_t projectorNamed(const std::filesystem::path& folder, const std::vector<NamedDevice>& projectors) {
    const std::string name = folder.filename().string();
    const auto found = std::ranges::find(projectors, name, &NamedDevice::name);
    if (found == projectors.end())
        throw DataError(folder.string(), "no projector has this name",
                        "give --projector " + name + "=WIDTHxHEIGHT, or rename the folder");
    return static_cast<std::size_t>(found - projectors.begin());
}

RoomFolder listRoom(const std::filesystem::path& folder, const std::vector<NamedDevice>& projectors) {
    RoomFolder room;
    for (const std::filesystem::path& pose : foldersIn(folder)) {
        for (const std::filesystem::path& camera : foldersIn(pose)) {
            const std::string name = camera.filename().string();
            if (std::ranges::find(room.cameras, name) == room.cameras.end()) room.cameras.push_back(name);
            for (const std::filesystem::path& light : foldersIn(camera)) {
                LightSeen& seen = room.lights[{name, projectorNamed(light, projectors)}];
                const std::string view = pose.filename().string() + "/" + name + "/" + light.filename().string();
                seen.poses.push_back(room.poses.size());
                seen.views.push_back({view, imagesIn(light)});
            }
        }
        room.poses.push_back(pose.filename().string());
    }
    if (room.lights.empty())
        throw DataError(folder.string(), "holds no folders POSE/CAMERA/PROJECTOR with images",
                        "give one folder a pose, in it one a camera, in that one a projector whose light it saw");
    std::ranges::sort(room.cameras, isNamedBefore);
    return room;
}

/// A board stays where it is while one projector after the other lights it.
void requireStill(const BoardPoints& before, const BoardPoints& now, const std::string& view) {
    constexpr double kStill = 1.0; // pixels
    std::vector<double> ways;
    for (const cv::Point2d& seen : now.seen) {
        double nearest = HUGE_VAL;
        for (const cv::Point2d& other : before.seen)
            nearest = std::min(nearest, std::hypot(seen.x - other.x, seen.y - other.y));
        ways.push_back(nearest);
    }
    const auto middle = ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2);
    std::ranges::nth_element(ways, middle);
    if (*middle > kStill)
        throw CaptureRefused({Cause::rigMoved, view, "",
                              "the board or the camera moved since another projector lit this pose",
                              "capture this pose again, with all projectors while nothing moves"});
}

/// All that was read of a room.
struct ReadRoom {
    std::vector<InstallationView> views;
    std::vector<NamedDevice> cameras;
    std::vector<Finding> warnings;
};

/// What a camera saw of one projector's light becomes part of the poses.
void addLight(ReadRoom& room, const ReadCapture& capture, const LightSeen& seen, std::size_t camera,
              std::size_t projector) {
    cv::Size& size = room.cameras[camera].size;
    if (!size.empty() && size != capture.camera)
        throw CaptureRefused({Cause::imageSize, seen.views.front().name, "",
                              "its images have another size than this camera's under another projector",
                              "capture all with one camera setting"});
    size = capture.camera;
    for (std::size_t i = 0; i < capture.views.size(); ++i) {
        InstallationView& view = room.views[seen.poses[i]];
        BoardPoints& corners = view.corners[camera];
        if (corners.seen.empty())
            corners = capture.views[i].corners;
        else
            requireStill(corners, capture.views[i].corners, seen.views[i].name);
        view.light[camera][projector] = capture.views[i].projector;
    }
    room.warnings.insert(room.warnings.end(), capture.warnings.begin(), capture.warnings.end());
}

ReadRoom readRoom(const RoomFolder& folder, const CalibrationBoard& board, const std::vector<CaptureOrder>& orders,
                  const Progress& progress) {
    ReadRoom room;
    for (const std::string& name : folder.cameras) room.cameras.push_back({name, {}});
    for (const std::string& name : folder.poses) {
        InstallationView& view = room.views.emplace_back();
        view.name = name;
        view.corners.resize(folder.cameras.size());
        view.light.assign(folder.cameras.size(), std::vector<std::vector<ProjectorPoint>>(orders.size()));
    }
    const auto count = static_cast<double>(folder.lights.size());
    double done = 0.0;
    for (const auto& [who, seen] : folder.lights) {
        const auto camera = std::ranges::find(folder.cameras, who.first) - folder.cameras.begin();
        const ReadCapture capture =
            readPoses(seen.views, board, orders[who.second], {}, progress.part(done / count, (done + 1.0) / count));
        if (const auto mirrored = checkMirrored(capture.views)) throw CaptureRefused(*mirrored);
        addLight(room, capture, seen, static_cast<std::size_t>(camera), who.second);
        done += 1.0;
    }
    for (const NamedDevice& camera : room.cameras)
        if (camera.size.empty())
            throw CaptureRefused({Cause::disconnected, "", "", "camera " + camera.name + " has no images",
                                  "remove its folders, or put what it saw of each projector's light into them"});
    return room;
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

void room(const RoomArguments& arguments, const Session& session) {
    const CalibrationBoard board = parseCalibrationBoard(arguments.board);
    const std::vector<NamedDevice> projectors = parseProjectors(arguments.projectors);
    std::vector<CaptureOrder> orders;
    orders.reserve(projectors.size());
    for (const NamedDevice& projector : projectors) orders.push_back(arguments.patterns.orderFor(projector.size));
    const RoomFolder folder = listRoom(arguments.folder, projectors);
    ReadRoom read;
    const InstallationCalibration result = orRefused(arguments.json, [&] {
        const Progress progress = session.progress();
        read = readRoom(folder, board, orders, progress.part(0.0, kReading));
        InstallationCalibration solved =
            calibrateInstallation(read.views, read.cameras, projectors, progress.part(kReading, 1.0));
        solved.warnings.insert(solved.warnings.end(), read.warnings.begin(), read.warnings.end());
        return solved;
    });
    Session::endProgress();
    if (arguments.json)
        printJson(roomJson(result, read.cameras, projectors));
    else
        printRoom(result, read.cameras, projectors);
}

// ---- A mirror ----

bool isDirect(const std::filesystem::path& file) { return file.stem() == "direct"; }

/// The board past the mirror, in a picture of its own.
BoardPoints findDirect(const std::filesystem::path& file, const std::string& view, const CalibrationBoard& board,
                       cv::Size camera, const BoardPoints& mirrored) {
    const auto refuse = [&](Cause cause, const char* why, const char* remedy) {
        throw CaptureRefused({cause, view, file.filename().string(), why, remedy});
    };
    const cv::Mat grey = readGrey(file, view);
    if (grey.size() != camera)
        refuse(Cause::imageSize, "has another size than the other images", "take it with the camera's setting of them");
    const std::optional<BoardPoints> found = findBoard(grey, board);
    if (!found)
        refuse(Cause::boardNotFound, "the board cannot be found past the mirror",
               "leave the picture out, or take it again with the mirror covered and all of the board in sight");
    const auto outlineOf = [](const std::vector<cv::Point2d>& points) {
        return cv::boundingRect(std::vector<cv::Point2f>(points.begin(), points.end()));
    };
    const cv::Rect there = outlineOf(mirrored.seen);
    const cv::Rect both = there & outlineOf(found->seen);
    if (2 * both.area() > there.area())
        refuse(Cause::mirrored, "shows the board in the mirror again", "cover the mirror for this picture");
    return *found;
}

/// The patterns in the mirror, and by which files the poses are seen directly.
struct MirrorFolder {
    std::vector<CapturedView> patterns;
    std::vector<std::filesystem::path> direct; ///< empty where there is none
};

MirrorFolder listMirror(const std::filesystem::path& folder) {
    MirrorFolder all{viewsIn(folder), {}};
    for (CapturedView& view : all.patterns) {
        const auto found = std::ranges::find_if(view.files, isDirect);
        all.direct.push_back(found == view.files.end() ? std::filesystem::path() : *found);
        std::erase_if(view.files, isDirect);
        if (view.files.empty())
            throw CaptureRefused({Cause::missingImage, view.name, "", "it has no images of the patterns",
                                  "capture this pose again, or remove its folder"});
    }
    return all;
}

/// Throws where the board was found past the mirror instead: then it is not mirrored, once the picture is.
void requireMirrored(const std::vector<ViewObservations>& turned) {
    std::optional<Finding> wrong = checkMirrored(turned);
    if (!wrong) return;
    if (wrong->cause == Cause::mirrored) {
        wrong->why = "the board that is found is not seen in a mirror";
        wrong->remedy = "let only the mirror show the board while patterns are shown; without a mirror, use procam";
    }
    throw CaptureRefused(*wrong);
}

/// Pixels of the picture turned left for right become those of the picture.
std::vector<MirrorView> mirrorViews(const ReadCapture& capture, const MirrorFolder& folder,
                                    const CalibrationBoard& board) {
    std::vector<MirrorView> views;
    const auto turn = [&](cv::Point2d& pixel) { pixel.x = capture.camera.width - 1 - pixel.x; };
    for (std::size_t i = 0; i < capture.views.size(); ++i) {
        MirrorView& view = views.emplace_back();
        view.name = capture.views[i].name;
        view.mirrored = capture.views[i].corners;
        view.light = capture.views[i].projector;
        for (cv::Point2d& pixel : view.mirrored.seen) turn(pixel);
        for (ProjectorPoint& point : view.light) turn(point.camera);
        if (!folder.direct[i].empty())
            view.direct = findDirect(folder.direct[i], view.name, board, capture.camera, view.mirrored);
    }
    return views;
}

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

void mirror(const RoomArguments& arguments, const Session& session) {
    const CalibrationBoard board = parseCalibrationBoard(arguments.board);
    const cv::Size projector = parseProjectorSize(arguments.projectors.front());
    const CaptureOrder order = arguments.patterns.orderFor(projector);
    const MirrorCalibration result = orRefused(arguments.json, [&] {
        const Progress progress = session.progress();
        const MirrorFolder folder = listMirror(arguments.folder);
        const ReadCapture capture =
            readPoses(folder.patterns, board, order, {}, progress.part(0.0, kReading), Sight::mirrored);
        requireMirrored(capture.views);
        const std::vector<MirrorView> views = mirrorViews(capture, folder, board);
        MirrorCalibration solved = calibrateMirrored(views, capture.camera, projector, progress.part(kReading, 1.0));
        std::vector<Finding>& warnings = solved.procam.warnings;
        warnings.insert(warnings.end(), capture.warnings.begin(), capture.warnings.end());
        return solved;
    });
    Session::endProgress();
    if (arguments.json)
        printJson(mirrorJson(result));
    else
        printMirror(result);
}

void addCommonOptions(CLI::App& command, RoomArguments& arguments) {
    command.add_option("--board", arguments.board, kBoardHelp)->required();
    arguments.patterns.addTo(command);
    command.add_flag("--json", arguments.json, "Print one JSON value");
}

} // namespace

void addCalibrateRoomCommands(CLI::App& group, Session& session) {
    auto all = std::make_shared<RoomArguments>();
    CLI::App* command = group.add_subcommand("room", "Several cameras and projectors, from patterns on a board");
    command->add_option("folder", all->folder, "A folder with folders POSE/CAMERA/PROJECTOR of images")->required();
    command->add_option("--projector", all->projectors, "A projector's name and size in pixels: upper=1024x768; repeat")
        ->required()
        ->expected(1)
        ->take_all();
    addCommonOptions(*command, *all);
    command->callback([all, &session] { room(*all, session); });

    auto glass = std::make_shared<RoomArguments>();
    command = group.add_subcommand("mirror", "A projector whose light the camera sees only in a mirror");
    command
        ->add_option("folder", glass->folder,
                     "A folder with one folder of images for each pose; direct.png in it shows the board past the "
                     "mirror")
        ->required();
    command->add_option("--projector", glass->projectors, "The projector's size in pixels, such as 1024x768")
        ->required()
        ->expected(1);
    addCommonOptions(*command, *glass);
    command->callback([glass, &session] { mirror(*glass, session); });
}

} // namespace lumorph::cli

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>

#include "calibration/report/calibrated_room.h"
#include "calibration/solve/first_guess.h"
#include "calibration/solve/installation_calibration.h"
#include "calibration/stages/stage_rows.h"
#include "core/base/error.h"

// All projectors and cameras at once by boards, and a projector that the camera sees in a mirror alone. A recording has
// the devices, the board's points as each camera saw them in each pose, and the light that was decoded on it. The last
// pose is held out: it checks what the others tell.

namespace lumorph {

namespace {

const std::vector<std::string> kDeviceColumns{"projector", "width", "height"};
const std::vector<std::string> kViewColumns{"check"};
const std::vector<std::string> kCornerColumns{"pose", "camera", "direct", "x", "y", "camera_column", "camera_row"};
const std::vector<std::string> kBoardLightColumns{"pose",       "camera",       "projector", "camera_column",
                                                  "camera_row", "light_column", "light_row"};
constexpr double kMetresPerUnit = 0.001; // boards are named in millimetres
constexpr std::size_t kFewestPoses = 4;  // three to solve, one to check

void addDevice(RecordedTable& devices, const NamedDevice& device, bool isProjector) {
    devices.add(device.name, {isProjector ? 1.0 : 0.0, static_cast<double>(device.size.width),
                              static_cast<double>(device.size.height)});
}

void addCorners(RecordedTable& corners, std::size_t pose, std::size_t camera, bool isDirect, const BoardPoints& seen) {
    for (std::size_t i = 0; i < seen.seen.size(); ++i)
        corners.add({static_cast<double>(pose), static_cast<double>(camera), isDirect ? 1.0 : 0.0, seen.board[i].x,
                     seen.board[i].y, seen.seen[i].x, seen.seen[i].y});
}

void addBoardLight(RecordedTable& table, std::size_t pose, std::size_t camera, std::size_t projector,
                   const std::vector<ProjectorPoint>& light) {
    for (const ProjectorPoint& point : light)
        table.add({static_cast<double>(pose), static_cast<double>(camera), static_cast<double>(projector),
                   point.camera.x, point.camera.y, point.projector.x, point.projector.y});
}

/// The tables that both kinds have.
struct BoardTables {
    RecordedTable devices{kDeviceColumns, {}, {}}, poses{kViewColumns, {}, {}}, corners{kCornerColumns, {}, {}},
        light{kBoardLightColumns, {}, {}};

    void addPoses(const std::vector<std::string>& names) {
        for (std::size_t i = 0; i < names.size(); ++i) poses.add(names[i], {i + 1 == names.size() ? 1.0 : 0.0});
    }
    void into(StageRecording& recording) && {
        recording.tables["devices"] = std::move(devices);
        recording.tables["poses"] = std::move(poses);
        recording.tables["corners"] = std::move(corners);
        recording.tables["light"] = std::move(light);
    }
};

StageRecording recordingOf(const BoardsCapture& capture, StageRecording recording) {
    recording.method = capture.board;
    BoardTables tables;
    for (const NamedDevice& camera : capture.cameras) addDevice(tables.devices, camera, false);
    for (const NamedDevice& projector : capture.projectors) addDevice(tables.devices, projector, true);
    std::vector<std::string> names;
    for (std::size_t pose = 0; pose < capture.views.size(); ++pose) {
        const InstallationView& view = capture.views[pose];
        names.push_back(view.name);
        for (std::size_t c = 0; c < capture.cameras.size(); ++c) {
            addCorners(tables.corners, pose, c, false, view.corners[c]);
            for (std::size_t p = 0; p < capture.projectors.size(); ++p)
                addBoardLight(tables.light, pose, c, p, view.light[c][p]);
        }
    }
    tables.addPoses(names);
    std::move(tables).into(recording);
    return recording;
}

StageRecording recordingOf(const MirrorCapture& capture, StageRecording recording) {
    recording.method = capture.board;
    BoardTables tables;
    addDevice(tables.devices, {"camera", capture.camera}, false);
    addDevice(tables.devices, {"projector", capture.projector}, true);
    std::vector<std::string> names;
    for (std::size_t pose = 0; pose < capture.views.size(); ++pose) {
        const MirrorView& view = capture.views[pose];
        names.push_back(view.name);
        addCorners(tables.corners, pose, 0, false, view.mirrored);
        addCorners(tables.corners, pose, 0, true, view.direct);
        addBoardLight(tables.light, pose, 0, 0, view.light);
    }
    tables.addPoses(names);
    std::move(tables).into(recording);
    return recording;
}

/// A board in sight shows at least so many points; findBoard gives no fewer.
constexpr std::size_t kFewestCorners = 4;

void requireSound(const StageRecording& recording, const RecordedTable& table) {
    if (std::ranges::all_of(table.numbers, [](double number) { return std::isfinite(number); })) return;
    throw DataError("recording of " + recording.stage, "a number of it is none",
                    "record the stage again, or take another copy of the folder");
}

void requireSound(const StageRecording& recording, const BoardPoints& points) {
    if (points.seen.empty() || points.seen.size() >= kFewestCorners) return;
    throw DataError("recording of " + recording.stage, "a board in it has fewer than four points",
                    "record the stage again");
}

cv::Size sizeIn(std::span<const double> row) {
    constexpr std::size_t kMostPixels = 100'000;
    const cv::Size size(static_cast<int>(stages::indexIn(row[1], kMostPixels, "pixels")),
                        static_cast<int>(stages::indexIn(row[2], kMostPixels, "pixels")));
    if (size.empty()) throw DataError("recording of boards", "a device has no pixels", "record the stage again");
    return size;
}

/// What both kinds of recording hold, by pose; the cameras' direct sights apart.
struct ReadBoards {
    std::vector<NamedDevice> cameras, projectors;
    std::vector<InstallationView> views;
    std::vector<BoardPoints> direct; ///< of the first camera, by pose
    std::vector<bool> isCheck;
};

ReadBoards boardsOf(const StageRecording& recording) {
    ReadBoards read;
    const RecordedTable& devices = tableOf(recording, "devices", kDeviceColumns);
    const RecordedTable& poses = tableOf(recording, "poses", kViewColumns);
    const RecordedTable& corners = tableOf(recording, "corners", kCornerColumns);
    const RecordedTable& light = tableOf(recording, "light", kBoardLightColumns);
    if (devices.names.size() != devices.rows() || poses.names.size() != poses.rows())
        throw DataError("recording of " + recording.stage, "its devices or poses have no names",
                        "record the stage again");
    for (const RecordedTable* table : {&devices, &poses, &corners, &light}) requireSound(recording, *table);
    for (std::size_t i = 0; i < devices.rows(); ++i)
        (devices.row(i)[0] != 0.0 ? read.projectors : read.cameras)
            .push_back({devices.names[i], sizeIn(devices.row(i))});
    read.direct.resize(poses.rows());
    for (std::size_t i = 0; i < poses.rows(); ++i) {
        InstallationView& view = read.views.emplace_back();
        view.name = poses.names[i];
        view.corners.resize(read.cameras.size());
        view.light.assign(read.cameras.size(), std::vector<std::vector<ProjectorPoint>>(read.projectors.size()));
        read.isCheck.push_back(poses.row(i)[0] != 0.0);
    }
    for (std::size_t i = 0; i < corners.rows(); ++i) {
        const auto row = corners.row(i);
        const std::size_t pose = stages::indexIn(row[0], read.views.size(), "a pose"),
                          camera = stages::indexIn(row[1], read.cameras.size(), "a camera");
        BoardPoints& points = row[2] != 0.0 ? read.direct[pose] : read.views[pose].corners[camera];
        points.board.emplace_back(row[3], row[4], 0.0);
        points.seen.emplace_back(row[5], row[6]);
    }
    for (std::size_t pose = 0; pose < read.views.size(); ++pose) {
        requireSound(recording, read.direct[pose]);
        for (const BoardPoints& points : read.views[pose].corners) requireSound(recording, points);
    }
    for (std::size_t i = 0; i < light.rows(); ++i) {
        const auto row = light.row(i);
        const std::size_t pose = stages::indexIn(row[0], read.views.size(), "a pose"),
                          camera = stages::indexIn(row[1], read.cameras.size(), "a camera"),
                          projector = stages::indexIn(row[2], read.projectors.size(), "a projector");
        read.views[pose].light[camera][projector].push_back({{row[3], row[4]}, {row[5], row[6]}});
    }
    if (read.cameras.empty() || read.projectors.empty() || read.views.size() < kFewestPoses)
        throw DataError("recording of " + recording.stage, "it has no camera, no projector, or fewer than four poses",
                        "record the stage again");
    return read;
}

/// Light of a board that was held out: where the others put it, less where it was decoded.
std::vector<stages::LightBeside> besideOn(InstallationState state, std::size_t camera, std::size_t projector,
                                          const Rigid& worldFromBoard, const std::vector<ProjectorPoint>& light,
                                          bool isMirrored) {
    std::vector<stages::LightBeside> all;
    state.worldFromBody = {worldFromBoard.log()};
    const InstallationState::Device& lamp = state.projectors[projector];
    const Rigid lampFromBoard = Rigid::exp(lamp.fromWorld) * worldFromBoard;
    const double distance = kMetresPerUnit * glm::length(lampFromBoard.translation);
    std::vector<SeenLight> seen(light.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
        seen[i].camera = static_cast<int>(camera);
        seen[i].projector = static_cast<int>(projector);
        seen[i].mirrored = isMirrored;
        seen[i].pixels = light[i];
    }
    for (const auto& error : errorsOf(seen, state)) {
        if (!error) continue;
        const double pixels = std::hypot(error->x, error->y);
        all.push_back({pixels, pixels * distance / lamp.lens[kFocalLength]});
    }
    return all;
}

/// The number of the room's device of this name; else of the first that no other recorded one has.
template <class Devices> std::size_t placeIn(const Devices& devices, const std::string& name, std::size_t otherwise) {
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (devices[i].name == name) return i;
    return otherwise;
}

// All projectors and cameras.

/// First camera and one projector of the whole, as of a capture of these two alone.
ProcamCalibration pairOf(const InstallationCalibration& solved, std::size_t projector) {
    ProcamCalibration pair;
    pair.camera = solved.cameras.front();
    pair.projector = solved.projectors[projector];
    pair.projectorFromCamera = solved.state.projectors[projector].fromWorld; // the first camera is the world
    pair.views = solved.views;
    pair.state.cameraFromBoard = solved.state.worldFromBody;
    return pair;
}

Installation roomWith(const Installation& room, const InstallationCalibration& solved, const ReadBoards& read,
                      const CalibrationBoard& board, const std::string& method) {
    Installation with = room;
    RoomPlacement placement;
    placement.metresPerUnit = kMetresPerUnit;
    placement.tableView = read.views.front().name;
    placement.date = utcDate();
    placement.camera = placeIn(room.cameras, read.cameras.front().name, 0);
    glm::dmat4 world(1.0);
    for (std::size_t p = 0; p < read.projectors.size(); ++p) {
        placement.projector = placeIn(room.projectors, read.projectors[p].name, p);
        const ProcamCalibration pair = pairOf(solved, p);
        if (p == 0) { // which way the board lay is decided once
            world = worldFromCamera(pair, board, room, placement);
            placement.turn = 0.0;
            const glm::dmat4 straight = worldFromCamera(pair, board, room, placement);
            if (glm::dot(glm::dvec3(world[0]), glm::dvec3(straight[0])) < 0.0) placement.turn = glm::pi<double>();
        }
        with = withCalibration(std::move(with), pair, board, placement);
        InstalledProjector& projector = with.projectors[placement.projector];
        projector.lens.method = projector.pose.method = method;
    }
    InstalledCamera& first = with.cameras[placement.camera];
    first.lens.method = first.pose.method = method;
    for (std::size_t c = 1; c < read.cameras.size(); ++c) {
        const std::size_t place = placeIn(with.cameras, read.cameras[c].name, c);
        if (place >= with.cameras.size()) with.cameras.resize(place + 1);
        InstalledCamera& camera = with.cameras[place];
        camera.name = read.cameras[c].name;
        camera.camera = cameraOf(solved.cameras[c]);
        Rigid pose = Rigid::exp(solved.state.cameras[c].fromWorld);
        pose.translation *= kMetresPerUnit;
        camera.camera.cameraFromWorld = (pose * Rigid(world).inverse()).matrix();
        camera.lens = camera.pose = first.pose;
    }
    checkInstallation(with);
    return with;
}

double shiftOf(const PoseVector& sigma) { return kMetresPerUnit * std::hypot(sigma[3], sigma[4], sigma[5]); }

StageResult solveRoom(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    PlacedDevices result;
    result.room = site.room;
    ReadBoards read = boardsOf(recording);
    const CalibrationBoard board = parseCalibrationBoard(recording.method);
    std::vector<InstallationView> used, held;
    for (std::size_t v = 0; v < read.views.size(); ++v) (read.isCheck[v] ? held : used).push_back(read.views[v]);
    try {
        const InstallationCalibration solved = calibrateInstallation(used, read.cameras, read.projectors, progress);
        result.rms = solved.rms;
        result.warnings = solved.warnings;
        std::vector<std::vector<stages::LightBeside>> beside(read.projectors.size());
        std::vector<stages::LightBeside> all;
        for (const InstallationView& view : held)
            for (std::size_t c = 0; c < read.cameras.size(); ++c) {
                if (view.corners[c].seen.empty()) continue;
                const PoseVector pose = poseFromCamera({view.name, view.corners[c], {}}, solved.cameras[c].lens);
                const Rigid world = Rigid::exp(solved.state.cameras[c].fromWorld).inverse() * Rigid::exp(pose);
                for (std::size_t p = 0; p < read.projectors.size(); ++p)
                    for (const stages::LightBeside& one :
                         besideOn(solved.state, c, p, world, view.light[c][p], false)) {
                        beside[p].push_back(one);
                        all.push_back(one);
                    }
            }
        for (std::size_t c = 0; c < read.cameras.size(); ++c)
            result.devices.push_back({read.cameras[c].name,
                                      false,
                                      solved.cameras[c].rms,
                                      solved.cameras[c].sigma[kFocalLength],
                                      shiftOf(solved.sigma.cameras[c].fromWorld),
                                      {}});
        for (std::size_t p = 0; p < read.projectors.size(); ++p)
            result.devices.push_back({read.projectors[p].name, true, solved.projectors[p].rms,
                                      solved.projectors[p].sigma[kFocalLength],
                                      shiftOf(solved.sigma.projectors[p].fromWorld), stages::heldOutOf(beside[p])});
        result.heldOut = stages::heldOutOf(std::move(all));
        stages::judgePlaces(result);
        if (result.good())
            result.room =
                roomWith(site.room, solved, read, board,
                         "structured light, " + std::to_string(used.size()) + " boards, all devices together");
    } catch (const CaptureRefused& refused) {
        result.refusal = refused.finding();
    }
    return result;
}

// A mirror.

constexpr const char* kMirrorMethod = "structured light in a mirror";

/// Where a board lies before the camera that sees it in a mirror. In the picture turned left for right there is no
/// mirror, but a camera behind it; turning x and mirroring together are a rotation again.
Rigid behindMirror(const MirrorView& view, Lens lens, int pictureWidth, const MirrorPlane& plane) {
    const double last = pictureWidth - 1;
    lens[kPrincipalX] = last - lens[kPrincipalX];
    lens[kP2] = -lens[kP2];
    ViewObservations turned{view.name, view.mirrored, {}};
    for (cv::Point2d& pixel : turned.corners.seen) pixel.x = last - pixel.x;
    const glm::dvec3 normal(plane.normal[0], plane.normal[1], plane.normal[2]);
    glm::dmat3 flip(1.0);
    flip[0][0] = -1.0;
    const Rigid back((glm::dmat3(1.0) - 2.0 * glm::outerProduct(normal, normal)) * flip, 2.0 * plane.distance * normal);
    return back * Rigid::exp(poseFromCamera(turned, lens));
}

StageResult solveMirror(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    PlacedDevices result;
    result.room = site.room;
    const ReadBoards read = boardsOf(recording);
    const CalibrationBoard board = parseCalibrationBoard(recording.method);
    std::vector<MirrorView> used, held;
    for (std::size_t v = 0; v < read.views.size(); ++v)
        (read.isCheck[v] ? held : used)
            .push_back({read.views[v].name, read.views[v].corners.front(), read.views[v].light.front().front(),
                        read.direct[v]});
    try {
        const MirrorCalibration solved =
            calibrateMirrored(used, read.cameras.front().size, read.projectors.front().size, progress);
        const ProcamCalibration& procam = solved.procam;
        result.rms = procam.rms;
        result.warnings = procam.warnings;
        result.mirror = solved.mirror;
        if (!solved.mirror)
            throw CaptureRefused({Cause::mirrorUnknown, "", "",
                                  "no pose of the board was also seen past the mirror: where camera and projector "
                                  "stand nobody can tell",
                                  "cover the mirror in some poses, and photograph the board directly too"});
        InstallationState state;
        state.cameras = {{procam.camera.lens, PoseVector{}}};
        state.projectors = {{procam.projector.lens, procam.projectorFromCamera}};
        const cv::Vec3d nearest = solved.mirror->distance * solved.mirror->normal;
        state.mirror = {nearest[0], nearest[1], nearest[2]};
        state.board = procam.state.board;
        std::vector<stages::LightBeside> beside;
        for (const MirrorView& view : held) {
            const Rigid pose = behindMirror(view, procam.camera.lens, read.cameras.front().size.width, *solved.mirror);
            const auto more = besideOn(state, 0, 0, pose, view.light, true);
            beside.insert(beside.end(), more.begin(), more.end());
        }
        result.heldOut = stages::heldOutOf(std::move(beside));
        const std::string camera = site.room.cameras.empty() ? "Camera" : site.room.cameras.front().name;
        const std::string projector = site.room.projectors.empty() ? "Projector" : site.room.projectors.front().name;
        result.devices = {{camera, false, procam.camera.rms, procam.camera.sigma[kFocalLength], 0.0, {}},
                          {projector, true, procam.projector.rms, procam.projector.sigma[kFocalLength],
                           shiftOf(procam.projectorFromCameraSigma), result.heldOut}};
        stages::judgePlaces(result);
        if (result.good()) {
            RoomPlacement placement;
            placement.metresPerUnit = kMetresPerUnit;
            placement.tableView = read.views.front().name;
            result.room = withCalibration(site.room, procam, board, placement);
            const std::string method = std::string(kMirrorMethod) + ", " + std::to_string(used.size()) + " boards";
            for (Origin* origin : {&result.room.projectors.front().lens, &result.room.projectors.front().pose,
                                   &result.room.cameras.front().lens, &result.room.cameras.front().pose})
                origin->method = method;
        }
    } catch (const CaptureRefused& refused) {
        result.refusal = refused.finding();
    }
    return result;
}

MeasuredStage solvedBoards(StageRecording recording, const CalibrationStage& stage, const StageSite& site,
                           const Progress& progress) {
    progress.throwIfCancelled();
    StageResult result = stage.solve(recording, site, progress.part(0.8, 1.0));
    return {std::move(recording), std::move(result)};
}

} // namespace

namespace stages {

CalibrationStage roomStage() {
    CalibrationStage stage;
    stage.key = "room";
    stage.title = "All projectors and cameras";
    stage.isWanted = [](const Installation& room) {
        return std::ranges::count_if(room.projectors, &InstalledProjector::enabled) > 1 || room.cameras.size() > 1;
    };
    stage.measure = [](const StageSite& site, Bench& bench, const Progress& progress) {
        const auto capture = bench.recordBoards(site, progress.part(0.0, 0.8));
        return solvedBoards(recordingOf(capture, stages::emptyRecording("room", site, bench)), calibrationStage("room"),
                            site, progress);
    };
    stage.solve = solveRoom;
    stage.apply = stages::applyPlaces;
    // That of the projector about which least is known.
    stage.origin = [](const Installation& room) {
        const Origin* least = nullptr;
        for (const InstalledProjector& projector : room.projectors) {
            if (!projector.enabled) continue;
            const bool isLess = !least || (least->isCalibrated() &&
                                           (!projector.pose.isCalibrated() || projector.pose.date < least->date));
            if (isLess) least = &projector.pose;
        }
        return least;
    };
    return stage;
}

CalibrationStage mirrorStage() {
    CalibrationStage stage;
    stage.key = "mirror";
    stage.title = "Projector in a mirror";
    stage.isWanted = isNeverWanted;
    stage.measure = [](const StageSite& site, Bench& bench, const Progress& progress) {
        const auto capture = bench.recordMirror(site, progress.part(0.0, 0.8));
        return solvedBoards(recordingOf(capture, stages::emptyRecording("mirror", site, bench)),
                            calibrationStage("mirror"), site, progress);
    };
    stage.solve = solveMirror;
    stage.apply = stages::applyPlaces;
    stage.origin = [](const Installation& room) { return stages::originByMethod(room, kMirrorMethod); };
    return stage;
}

} // namespace stages

} // namespace lumorph

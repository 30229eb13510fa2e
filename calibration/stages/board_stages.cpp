#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>

#include "calibration/doctor/view_check.h"
#include "calibration/report/calibrated_room.h"
#include "calibration/solve/first_guess.h"
#include "calibration/solve/installation_calibration.h"
#include "calibration/stages/stage_rows.h"
#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// All projectors and cameras at once by boards, and a projector that the camera sees in a mirror alone. The last pose
// is held out: it checks what the others tell.

namespace lumorph {

namespace {

constexpr double kMetresPerUnit = 0.001; // boards are named in millimetres

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

Installation roomWith(const Installation& room, const InstallationCalibration& solved,
                      const stages::RecordedBoards& read, const CalibrationBoard& board, const std::string& method) {
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

/// Throws CaptureRefused where a camera saw a projector's light in mirror images, as folders of pictures are refused.
void requireUnmirrored(const BoardsCapture& read) {
    for (std::size_t c = 0; c < read.cameras.size(); ++c)
        for (std::size_t p = 0; p < read.projectors.size(); ++p) {
            std::vector<ViewObservations> lit;
            for (const InstallationView& view : read.views)
                if (!view.light[c][p].empty())
                    lit.push_back({view.name + "/" + read.cameras[c].name + "/" + read.projectors[p].name,
                                   view.corners[c], view.light[c][p]});
            if (const auto mirrored = checkMirrored(lit)) throw CaptureRefused(*mirrored);
        }
}

double shiftOf(const PoseVector& sigma) { return kMetresPerUnit * std::hypot(sigma[3], sigma[4], sigma[5]); }

StageResult solveRoom(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    PlacedDevices result;
    result.room = site.room;
    const stages::RecordedBoards read = stages::boardsOf(recording);
    const CalibrationBoard board = parseCalibrationBoard(recording.method);
    std::vector<InstallationView> used, held;
    for (std::size_t v = 0; v < read.views.size(); ++v) (read.isCheck[v] ? held : used).push_back(read.views[v]);
    try {
        requireUnmirrored(read);
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
    const stages::RecordedBoards read = stages::boardsOf(recording);
    const CalibrationBoard board = parseCalibrationBoard(recording.method);
    std::vector<MirrorView> used, held;
    for (std::size_t v = 0; v < read.views.size(); ++v)
        (read.isCheck[v] ? held : used)
            .push_back({read.views[v].name, read.views[v].corners.front(), read.views[v].light.front().front(),
                        read.direct[v]});
    try {
        std::vector<ViewObservations> turned;
        for (const InstallationView& view : read.views) {
            const MirrorView back = mirrorView({view.name, view.corners.front(), view.light.front().front()},
                                               read.cameras.front().size.width);
            if (!back.light.empty()) turned.push_back({back.name, back.mirrored, back.light});
        }
        requireMirrored(turned);
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
        return solvedBoards(stages::recordingOf(capture, stages::emptyRecording("room", site, bench)),
                            calibrationStage("room"), site, progress);
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
        return solvedBoards(stages::recordingOf(capture, stages::emptyRecording("mirror", site, bench)),
                            calibrationStage("mirror"), site, progress);
    };
    stage.solve = solveMirror;
    stage.apply = stages::applyPlaces;
    stage.origin = [](const Installation& room) { return stages::originByMethod(room, kMirrorMethod); };
    return stage;
}

} // namespace stages

} // namespace lumorph

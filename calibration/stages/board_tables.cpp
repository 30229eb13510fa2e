#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// A recording of boards has the devices, the board's points as each camera saw them in each pose, and the light that
// was decoded on it. The last pose is held out: it checks what the others tell.

namespace lumorph {

namespace {

const std::vector<std::string> kViewColumns{"check"};
const std::vector<std::string> kCornerColumns{"pose", "camera", "direct", "x", "y", "camera_column", "camera_row"};
const std::vector<std::string> kBoardLightColumns{"pose",       "camera",       "projector", "camera_column",
                                                  "camera_row", "light_column", "light_row"};
constexpr std::size_t kFewestPoses = 4, kMostPoses = 1000; // three to solve, one to check

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
    for (const ProjectorPoint& point : stages::asRecorded(light))
        table.add({static_cast<double>(pose), static_cast<double>(camera), static_cast<double>(projector),
                   point.camera.x, point.camera.y, point.projector.x, point.projector.y});
}

/// The tables that both kinds have.
struct BoardTables {
    RecordedTable devices{stages::kDeviceColumns, {}, {}}, poses{kViewColumns, {}, {}}, corners{kCornerColumns, {}, {}},
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

} // namespace

namespace stages {

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

RecordedBoards boardsOf(const StageRecording& recording) {
    const RecordedTable& devices = tableOf(recording, "devices", kDeviceColumns);
    const RecordedTable& poses = tableOf(recording, "poses", kViewColumns);
    const RecordedTable& corners = tableOf(recording, "corners", kCornerColumns);
    const RecordedTable& light = tableOf(recording, "light", kBoardLightColumns);
    const std::string place = "recording of " + recording.stage;
    for (const RecordedTable* table : {&devices, &poses, &corners, &light}) requireSound(recording, *table);
    auto [cameras, projectors] = namedDevicesOf(devices, place);
    if (poses.names.size() != poses.rows() || poses.rows() < kFewestPoses || poses.rows() > kMostPoses)
        throw DataError(place, "its poses have no names, or are fewer than four or more than a thousand",
                        "record the stage again");
    RecordedBoards read{
        emptyBoardsCapture(recording.method, std::move(cameras), std::move(projectors), poses.names), {}, {}};
    read.direct.resize(poses.rows());
    for (std::size_t i = 0; i < poses.rows(); ++i) read.isCheck.push_back(poses.row(i)[0] != 0.0);
    for (std::size_t i = 0; i < corners.rows(); ++i) {
        const auto row = corners.row(i);
        const std::size_t pose = indexIn(row[0], read.views.size(), "a pose"),
                          camera = indexIn(row[1], read.cameras.size(), "a camera");
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
        const std::size_t pose = indexIn(row[0], read.views.size(), "a pose"),
                          camera = indexIn(row[1], read.cameras.size(), "a camera"),
                          projector = indexIn(row[2], read.projectors.size(), "a projector");
        read.views[pose].light[camera][projector].push_back({{row[3], row[4]}, {row[5], row[6]}});
    }
    return read;
}

} // namespace stages

} // namespace lumorph

#include "calibration/report/calibrated_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

bool isKnown(const PoseVector& pose) {
    return std::ranges::all_of(pose, [](double number) { return std::isfinite(number); }) && pose[5] > 0.0;
}

glm::dvec3 middleOf(const CalibrationBoard& board) {
    glm::dvec3 low(1e300), high(-1e300);
    for (const cv::Point3d& point : pointsOf(board)) {
        low = glm::min(low, glm::dvec3(point.x, point.y, 0.0));
        high = glm::max(high, glm::dvec3(point.x, point.y, 0.0));
    }
    return 0.5 * (low + high);
}

/// The world from the camera with the board turned by so much.
glm::dmat4 turnedWorld(const PoseVector& cameraFromBoard, const glm::dvec3& middle, double turn,
                       const RoomPlacement& placement) {
    const Rigid board = Rigid::exp(cameraFromBoard);
    const glm::dmat3& boardInCamera = board.rotation;
    const glm::dvec3 centre = board * middle;
    // Whoever sees the printed side is above it; z of a board's frame points into it.
    const glm::dvec3 up = glm::dot(boardInCamera[2], centre) > 0.0 ? -boardInCamera[2] : boardInCamera[2];
    const glm::dvec3 along = boardInCamera[0];
    const glm::dvec3 towards = glm::cross(along, up);
    // The board's x axis lies at (cos, 0, -sin) of the world.
    const glm::dvec3 worldX = std::cos(turn) * along + std::sin(turn) * towards;
    const glm::dmat3 world = glm::transpose(glm::dmat3(worldX, up, glm::cross(worldX, up)));
    const glm::dvec3 place(placement.middle.x, 0.0, placement.middle.y);
    return Rigid(world, place - placement.metresPerUnit * (world * centre)).matrix();
}

/// The projector's frame from the world, metres.
glm::dmat4 projectorFromWorld(const ProcamCalibration& result, const glm::dmat4& world, double metresPerUnit) {
    Rigid rig = Rigid::exp(result.projectorFromCamera);
    rig.translation *= metresPerUnit;
    return (rig * Rigid(world).inverse()).matrix();
}

template <typename Device> Device& deviceAt(std::vector<Device>& devices, std::size_t index, const char* what) {
    if (index > devices.size())
        throw InvalidInput(what + std::string(" ") + std::to_string(index + 1),
                           "the installation has only " + std::to_string(devices.size()), "choose one that is there");
    if (index == devices.size()) {
        devices.emplace_back();
        if (index > 0) devices.back().name += " " + std::to_string(index + 1);
    }
    return devices[index];
}

void requireAboveTable(const CalibratedCamera& camera, const char* what) {
    if (positionOf(camera).y > 0.0) return;
    throw InvalidInput(what, "would stand below the table",
                       "choose the pose whose board lay flat on the table, printed side up");
}

} // namespace

std::vector<std::string> tableViewsOf(const ProcamCalibration& result) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(result.views.size(), result.state.cameraFromBoard.size()); ++i)
        if (isKnown(result.state.cameraFromBoard[i])) names.push_back(result.views[i].name);
    return names;
}

glm::dmat4 worldFromCamera(const ProcamCalibration& result, const CalibrationBoard& board,
                           const Installation& installation, const RoomPlacement& placement) {
    if (!(placement.metresPerUnit > 1e-9 && placement.metresPerUnit < 1e6))
        throw InvalidInput("unit of the board", "is no length", "use 0.001 for millimetres");
    const std::vector<std::string> known = tableViewsOf(result);
    const std::string wanted = placement.tableView.value_or(known.empty() ? "" : known.front());
    const auto view = std::ranges::find(result.views, wanted, &ViewQuality::name);
    if (std::ranges::find(known, wanted) == known.end() || view == result.views.end())
        throw InvalidInput("pose " + inQuotes(wanted), "has no known board", "choose a pose of the calibration");
    const PoseVector& pose = result.state.cameraFromBoard[static_cast<std::size_t>(view - result.views.begin())];
    const glm::dvec3 middle = middleOf(board);
    if (placement.turn) return turnedWorld(pose, middle, *placement.turn, placement);
    const glm::dmat4 one = turnedWorld(pose, middle, 0.0, placement);
    const glm::dmat4 other = turnedWorld(pose, middle, std::numbers::pi, placement);
    if (placement.projector >= installation.projectors.size()) return one;
    const glm::dvec3 believed = positionOf(installation.projectors[placement.projector].camera);
    const auto distance = [&](const glm::dmat4& world) {
        const Rigid projector(projectorFromWorld(result, world, placement.metresPerUnit));
        return glm::length(projector.inverse().translation - believed);
    };
    return distance(other) < distance(one) ? other : one;
}

CalibratedCamera cameraOf(const CalibratedDevice& device) {
    const Lens& lens = device.lens;
    CalibratedCamera camera;
    camera.size = {device.size.width, device.size.height};
    camera.focal = {lens[kFocalLength], lens[kFocalLength] * lens[kAspect]};
    camera.principal = {lens[kPrincipalX], lens[kPrincipalY]};
    camera.distortion = {lens[kK1], lens[kK2], lens[kP1], lens[kP2], lens[kK3]};
    return camera;
}

Installation withCalibration(Installation installation, const ProcamCalibration& result, const CalibrationBoard& board,
                             const RoomPlacement& placement) {
    const glm::dmat4 world = worldFromCamera(result, board, installation, placement);
    const auto boards = std::to_string(result.views.size()) + (result.views.size() == 1 ? " board" : " boards");
    const std::string date = placement.date.empty() ? utcDate() : placement.date;
    const bool hasProjector = !result.projector.size.empty();
    const Origin origin{Origin::Way::measured, (hasProjector ? "structured light, " : "pictures of a board, ") + boards,
                        date};
    InstalledCamera& camera = deviceAt(installation.cameras, placement.camera, "camera");
    camera.camera = cameraOf(result.camera);
    camera.camera.cameraFromWorld = Rigid(world).inverse().matrix();
    camera.lens = camera.pose = origin;
    requireAboveTable(camera.camera, "camera");
    if (hasProjector) {
        InstalledProjector& projector = deviceAt(installation.projectors, placement.projector, "projector");
        projector.camera = cameraOf(result.projector);
        projector.camera.cameraFromWorld = projectorFromWorld(result, world, placement.metresPerUnit);
        projector.lens = projector.pose = origin;
        requireAboveTable(projector.camera, "projector");
    }
    checkInstallation(installation);
    return installation;
}

Installation withImport(Installation installation, const ProcamCalibration& result, const CalibrationBoard& board,
                        const RoomPlacement& placement) {
    if (!tableViewsOf(result).empty()) return withCalibration(std::move(installation), result, board, placement);
    const Origin origin{Origin::Way::measured, "read from a file", placement.date.empty() ? utcDate() : placement.date};
    const auto takeLens = [](CalibratedCamera& camera, const CalibratedDevice& device) {
        const glm::dmat4 pose = camera.cameraFromWorld;
        camera = cameraOf(device);
        camera.cameraFromWorld = pose;
    };
    const bool hasProjector = !result.projector.size.empty();
    if (hasProjector) {
        InstalledProjector& projector = deviceAt(installation.projectors, placement.projector, "projector");
        takeLens(projector.camera, result.projector);
        projector.lens = origin;
    }
    if (!hasProjector && installation.cameras.empty()) {
        installation.cameras.emplace_back();
        const Installation usual = defaultInstallation();
        const auto& projectors = installation.projectors.empty() ? usual.projectors : installation.projectors;
        installation.cameras.front().camera.cameraFromWorld = projectors.front().camera.cameraFromWorld;
    }
    if (placement.camera < installation.cameras.size() && !result.camera.size.empty()) {
        InstalledCamera& camera = installation.cameras[placement.camera];
        takeLens(camera.camera, result.camera);
        camera.lens = origin;
    }
    checkInstallation(installation);
    return installation;
}

bool hasSameFigures(const Installation& room, const Installation& made, bool ofProjector, std::size_t index) {
    const auto isSame = [](const CalibratedCamera& one, const CalibratedCamera& other) {
        constexpr double kPixels = 1e-6, kTerms = 1e-9, kMetres = 1e-7;
        const auto near = [](const auto& a, const auto& b, int count, double tolerance) {
            for (int i = 0; i < count; ++i)
                if (!(std::abs(a[i] - b[i]) <= tolerance)) return false;
            return true;
        };
        bool same = one.size == other.size && near(one.focal, other.focal, 2, kPixels) &&
                    near(one.principal, other.principal, 2, kPixels);
        for (std::size_t i = 0; i < one.distortion.size(); ++i)
            same = same && std::abs(one.distortion[i] - other.distortion[i]) <= kTerms;
        for (int column = 0; column < 4; ++column)
            same = same && near(one.cameraFromWorld[column], other.cameraFromWorld[column], 4, kMetres);
        return same;
    };
    if (ofProjector)
        return index < room.projectors.size() && index < made.projectors.size() &&
               isSame(room.projectors[index].camera, made.projectors[index].camera);
    return index < room.cameras.size() && index < made.cameras.size() &&
           isSame(room.cameras[index].camera, made.cameras[index].camera);
}

std::optional<double> heldOutMillimetresOf(const ProcamCalibration& result) {
    constexpr double kNinetyFive = 1.731; // of a length that is spread evenly to all sides, by its root mean square
    if (result.projector.size.empty()) return std::nullopt; // without it the errors are a camera's
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < result.views.size() && i < result.state.cameraFromBoard.size(); ++i) {
        const PoseVector& pose = result.state.cameraFromBoard[i];
        if (!result.views[i].heldOut || !isKnown(pose)) continue;
        const double distance = std::hypot(pose[3], pose[4], pose[5]);
        const double length = *result.views[i].heldOut * distance / result.projector.lens[kFocalLength];
        sum += length * length;
        ++count;
    }
    if (count == 0) return std::nullopt;
    return kNinetyFive * std::sqrt(sum / count);
}

Installation withCrosshairs(Installation installation, const CrosshairCalibration& result, std::size_t points,
                            std::size_t projector, const std::string& date) {
    InstalledProjector& device = deviceAt(installation.projectors, projector, "projector");
    device.camera = cameraOf(result.projector);
    const Rigid deviceFromWorld = Rigid(glm::dmat4(installation.worldFromDevice)).inverse();
    device.camera.cameraFromWorld = (Rigid::exp(result.projectorFromWorld) * deviceFromWorld).matrix();
    requireAboveTable(device.camera, "projector");
    device.lens = {Origin::Way::measured, "crosshairs, " + std::to_string(points) + " points",
                   date.empty() ? utcDate() : date};
    device.pose = device.lens;
    checkInstallation(installation);
    return installation;
}

} // namespace lumorph

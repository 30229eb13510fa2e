#include "app/studio/calibration/room_calibration.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <opencv2/calib3d.hpp>

#include "core/base/error.h"

namespace lumorph::studio {
namespace {

glm::dmat4 matrixOf(const PoseVector& pose, double metresPerUnit) {
    cv::Matx33d rotation;
    cv::Rodrigues(cv::Vec3d(pose[0], pose[1], pose[2]), rotation);
    glm::dmat4 matrix(1.0);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) matrix[column][row] = rotation(row, column);
        matrix[3][row] = metresPerUnit * pose[static_cast<std::size_t>(3 + row)];
    }
    return matrix;
}

CalibratedCamera cameraOf(const CalibratedDevice& device, const glm::dmat4& fromWorld) {
    CalibratedCamera camera;
    const Lens& lens = device.lens;
    camera.size = {device.size.width, device.size.height};
    camera.focal = {lens[kFocalLength], lens[kFocalLength] * lens[kAspect]};
    camera.principal = {lens[kPrincipalX], lens[kPrincipalY]};
    camera.distortion = {lens[kK1], lens[kK2], lens[kP1], lens[kP2], lens[kK3]};
    camera.cameraFromWorld = fromWorld;
    return camera;
}

/// The printed side up, its long side along x; the first corner at the back, or at the front.
glm::dmat4 worldFromFlatBoard(const ViewObservations& view, double metresPerUnit, bool turned) {
    glm::dvec2 low(1e300), high(-1e300);
    for (const cv::Point3d& point : view.corners.board) {
        low = glm::min(low, glm::dvec2(point.x, point.y));
        high = glm::max(high, glm::dvec2(point.x, point.y));
    }
    const glm::dvec2 middle = 0.5 * metresPerUnit * (low + high);
    const double side = turned ? -1.0 : 1.0;
    glm::dmat4 matrix(0.0);
    matrix[0] = {side, 0.0, 0.0, 0.0};
    matrix[1] = {0.0, 0.0, side, 0.0};
    matrix[2] = {0.0, -1.0, 0.0, 0.0};
    matrix[3] = {0.0, 0.0, 0.0, 1.0};
    return matrix * glm::translate(glm::dmat4(1.0), glm::dvec3(-middle, 0.0));
}

} // namespace

Installation roomWith(const Installation& room, const ProcamCalibration& solved, const ViewObservations& flatView,
                      double metresPerUnit, std::size_t projector, const Origin& origin,
                      const std::string& cameraAddress) {
    const auto view = std::ranges::find(solved.views, flatView.name, &ViewQuality::name);
    if (view == solved.views.end() || projector >= room.projectors.size())
        throw InvalidInput("calibration", "its pose " + flatView.name + " or the projector is not there any more",
                           "choose another pose in which the board lay on the table");
    const auto index = static_cast<std::size_t>(view - solved.views.begin());
    const glm::dmat4 cameraFromBoard = matrixOf(solved.state.cameraFromBoard[index], metresPerUnit);
    const glm::dmat4 projectorFromCamera = matrixOf(solved.projectorFromCamera, metresPerUnit);
    const glm::dvec3 before = positionOf(room.projectors[projector].camera);
    Installation result = room;
    double nearest = 1e300;
    for (const bool turned : {false, true}) {
        const glm::dmat4 cameraFromWorld =
            cameraFromBoard * glm::inverse(worldFromFlatBoard(flatView, metresPerUnit, turned));
        const CalibratedCamera lamp = cameraOf(solved.projector, projectorFromCamera * cameraFromWorld);
        const double away = glm::length(positionOf(lamp) - before);
        if (away >= nearest) continue;
        nearest = away;
        InstalledProjector& installed = result.projectors[projector];
        installed.camera = lamp;
        installed.enabled = true;
        installed.lens = installed.pose = origin;
        if (result.cameras.empty()) result.cameras.resize(1);
        InstalledCamera& camera = result.cameras.front();
        camera.camera = cameraOf(solved.camera, cameraFromWorld);
        camera.address = cameraAddress;
        camera.lens = camera.pose = origin;
    }
    if (positionOf(result.projectors[projector].camera).y <= 0.0 || positionOf(result.cameras.front().camera).y <= 0.0)
        throw InvalidInput("pose " + flatView.name, "camera or projector would stand below the table",
                           "choose the pose in which the board lay flat on the table, printed side up");
    checkInstallation(result);
    return result;
}

std::optional<double> lightError(const CalibratedCamera& believed, const CalibratedCamera& truth, double side) {
    constexpr int kSteps = 9;
    double sum = 0.0;
    int count = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const glm::dvec3 point(side * (i / (kSteps - 1.0) - 0.5), 0.0, side * (j / (kSteps - 1.0) - 0.5));
            const auto pixel = pixelOf(believed, point);
            if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x >= believed.size.x ||
                pixel->y >= believed.size.y)
                continue;
            // The pixel that is meant for this point truly lights another.
            const glm::dvec3 from = positionOf(truth);
            const glm::dvec3 direction = directionOf(truth, *pixel);
            if (direction.y > -1e-6) continue;
            const glm::dvec3 hit = from - (from.y / direction.y) * direction;
            const glm::dvec3 off = hit - point;
            sum += glm::dot(off, off);
            ++count;
        }
    if (count == 0) return std::nullopt;
    return std::sqrt(sum / count);
}

} // namespace lumorph::studio

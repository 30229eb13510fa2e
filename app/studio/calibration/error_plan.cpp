#include "app/studio/calibration/error_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/calib3d.hpp>

namespace lumorph::studio {
namespace {

constexpr double kPerMetre = 1000.0; // millimetres, in which boards are measured here
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The error at each place of one height that the projector lights.
std::vector<double> planeOf(const ErrorPlan& plan, double height, const ProcamCalibration& solved,
                            const WorldPose& world) {
    std::vector<LitPlace> places;
    for (int row = 0; row < ErrorPlan::kRows; ++row)
        for (int column = 0; column < ErrorPlan::kColumns; ++column) {
            const glm::dvec2 at = plan.placeOf(column, row);
            places.push_back({{kPerMetre * at.x, kPerMetre * height, kPerMetre * at.y}, {0.0, 1.0, 0.0}});
        }
    std::vector<double> errors = errorMap(solved, world, places);
    cv::Matx33d turn;
    const PoseVector& pose = world.cameraFromWorld;
    cv::Rodrigues(cv::Vec3d(pose[0], pose[1], pose[2]), turn);
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const cv::Vec3d point = turn * cv::Vec3d(places[i].point) + cv::Vec3d(pose[3], pose[4], pose[5]);
        const cv::Point2d pixel = projectorPixel(cv::Point3d(point), solved.state);
        const cv::Size size = solved.projector.size;
        if (!(pixel.x > -0.5 && pixel.y > -0.5 && pixel.x < size.width - 0.5 && pixel.y < size.height - 0.5))
            errors[i] = kNone;
    }
    return errors;
}

} // namespace

ErrorPlan errorPlanOf(const ProcamCalibration& solved, const BoardPoints& flat, const CalibrationBoard& board,
                      const Installation& room, const RoomPlacement& placement, const Progress& progress) {
    const glm::dmat4 worldFromCam = worldFromCamera(solved, board, room, placement);
    const auto view = std::ranges::find(solved.views, placement.tableView.value_or(""), &ViewQuality::name);
    const PoseVector& pose = solved.state.cameraFromBoard.at(static_cast<std::size_t>(view - solved.views.begin()));
    cv::Matx33d turn;
    cv::Rodrigues(cv::Vec3d(pose[0], pose[1], pose[2]), turn);
    BoardPoints seen;
    seen.seen = flat.seen;
    for (const cv::Point3d& point : flat.board) {
        const cv::Vec3d inCamera =
            placement.metresPerUnit * (turn * cv::Vec3d(point) + cv::Vec3d(pose[3], pose[4], pose[5]));
        const glm::dvec4 world = worldFromCam * glm::dvec4(inCamera[0], inCamera[1], inCamera[2], 1.0);
        seen.board.emplace_back(kPerMetre * world.x, kPerMetre * world.y, kPerMetre * world.z);
    }
    const WorldPose world = worldPoseFrom(solved, seen, std::max(0.02, solved.camera.rms / std::sqrt(2.0)));
    ErrorPlan plan;
    plan.size = glm::dvec2(room.tableSize);
    progress.report(0.2, "working out where light can be trusted");
    plan.table = planeOf(plan, 0.0, solved, world);
    progress.throwIfCancelled();
    progress.report(0.6, "working out where light can be trusted");
    plan.device = planeOf(plan, plan.height, solved, world);
    double sum = 0.0;
    int count = 0;
    for (const std::vector<double>* plane : {&plan.table, &plan.device})
        for (std::size_t i = 0; i < plane->size(); ++i) {
            const glm::dvec2 at =
                plan.placeOf(static_cast<int>(i) % ErrorPlan::kColumns, static_cast<int>(i) / ErrorPlan::kColumns);
            const double error = (*plane)[i];
            if (!std::isfinite(error) || std::max(std::abs(at.x), std::abs(at.y)) > 0.5 * ErrorPlan::kMiddle) continue;
            sum += error;
            plan.worst = std::max(plan.worst, error);
            ++count;
        }
    plan.mean = count > 0 ? sum / count : kNone;
    if (count == 0) plan.worst = kNone;
    return plan;
}

} // namespace lumorph::studio

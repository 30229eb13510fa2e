#include "calibration/doctor/repeated_poses.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>

namespace lumorph {

namespace {

constexpr double kSameCorners = 0.5; // camera pixels, root mean square: noise is below, hands never are
constexpr double kSameLight = 1.5;   // projector pixels

/// Whether the board's points that both show lie in the same places of the camera's picture.
bool showSameBoard(const BoardPoints& one, const BoardPoints& other) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < one.board.size(); ++i)
        for (std::size_t k = 0; k < other.board.size(); ++k)
            if (one.board[i] == other.board[k]) {
                const cv::Point2d apart = one.seen[i] - other.seen[k];
                sum += apart.dot(apart);
                count += 1.0;
                break;
            }
    const auto least = static_cast<double>(std::min(one.board.size(), other.board.size()));
    return count >= 0.5 * least && std::sqrt(sum / count) < kSameCorners;
}

/// Whether the same camera pixels are lit by the same pixels of the projector: else something else has moved.
bool showSameLight(const std::vector<ProjectorPoint>& one, const std::vector<ProjectorPoint>& other) {
    if (one.size() < 8 || other.size() < 8) return true;
    std::vector<cv::Point2d> from, to;
    for (const ProjectorPoint& point : one) {
        from.push_back(point.camera);
        to.push_back(point.projector);
    }
    const cv::Mat plane = cv::findHomography(from, to, cv::RANSAC, 2.0 * kSameLight);
    if (plane.empty()) return false;
    std::vector<double> errors;
    std::vector<cv::Point2d> at, lit;
    for (const ProjectorPoint& point : other) at.push_back(point.camera);
    cv::perspectiveTransform(at, lit, plane);
    for (std::size_t i = 0; i < other.size(); ++i) errors.push_back(cv::norm(lit[i] - other[i].projector));
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::ranges::nth_element(errors, middle);
    return *middle < kSameLight;
}

} // namespace

std::vector<std::size_t> firstLike(const std::vector<ViewObservations>& views) {
    std::vector<std::size_t> first;
    for (std::size_t v = 0; v < views.size(); ++v) {
        std::size_t like = 0;
        while (like < v && (first[like] != like || !showSameBoard(views[like].corners, views[v].corners) ||
                            !showSameLight(views[like].projector, views[v].projector)))
            ++like;
        first.push_back(like);
    }
    return first;
}

void repeatFor(const std::vector<ViewObservations>& views, const std::vector<std::size_t>& first,
               ProcamCalibration& result) {
    std::vector<std::size_t> place; // of each view among those that were solved
    std::size_t distinct = 0;
    for (std::size_t v = 0; v < views.size(); ++v) place.push_back(first[v] == v ? distinct++ : place[first[v]]);
    if (distinct == views.size()) return;
    const std::vector<ViewQuality> qualities = std::move(result.views);
    const std::vector<PoseVector> poses = std::move(result.state.cameraFromBoard);
    result.views.clear();
    result.state.cameraFromBoard.clear();
    std::vector<int> from; // place of each row of the covariance in what was solved
    from.reserve(kPosePlace);
    for (int i = 0; i < kPosePlace; ++i) from.push_back(i);
    for (std::size_t v = 0; v < views.size(); ++v) {
        result.views.push_back(qualities.at(place[v]));
        result.views.back().name = views[v].name;
        result.state.cameraFromBoard.push_back(poses.at(place[v]));
        for (int i = 0; i < 6; ++i) from.push_back(kPosePlace + 6 * static_cast<int>(place[v]) + i);
    }
    if (result.covariance.rows() < kPosePlace + 6 * static_cast<Eigen::Index>(distinct)) return;
    const auto size = static_cast<Eigen::Index>(from.size());
    Eigen::MatrixXd all(size, size);
    for (Eigen::Index i = 0; i < size; ++i)
        for (Eigen::Index k = 0; k < size; ++k)
            all(i, k) = result.covariance(from[static_cast<std::size_t>(i)], from[static_cast<std::size_t>(k)]);
    result.covariance = std::move(all);
}

} // namespace lumorph

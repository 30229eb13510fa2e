#include "calibration/solve/next_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>

#include "calibration/solve/projection.h"

namespace lumorph {

namespace {

constexpr int kPointsAcross = 14, kPointsDown = 10; // of a planned view, in the projector
// Of the board that the projector must reach, where that can be; poses that are lit whole tell less.
constexpr double kLitShares[] = {0.8, 0.5};
constexpr double kMargin = 0.02;                 // of the camera's picture that stays free around the board
constexpr double kTiltsDegrees[] = {22.0, 45.0}; // more, and a board's points are hard to find
constexpr double kUnknownCorner = 0.003; // of the width: what a distortion that was left out may do at the corner

/// The grid of camera pixels and depths over which both devices see.
struct Grid {
    int across, down, deep;
};
constexpr Grid kPlaces{5, 4, 3};
constexpr Grid kMiddles{5, 4, 3};

bool isInside(const cv::Point2d& pixel, cv::Size size, double margin) {
    return pixel.x >= margin && pixel.y >= margin && pixel.x <= size.width - 1 - margin &&
           pixel.y <= size.height - 1 - margin;
}

/// Points in the camera's frame, evenly over its picture between two depths.
std::vector<Eigen::Vector3d> gridOf(const Grid& grid, const ProcamCalibration& calibration, double nearest,
                                    double farthest) {
    std::vector<Eigen::Vector3d> points;
    for (int z = 0; z < grid.deep; ++z)
        for (int y = 0; y < grid.down; ++y)
            for (int x = 0; x < grid.across; ++x) {
                const cv::Size size = calibration.camera.size;
                const auto [a, b] = directionOfPixel(calibration.camera.lens, (x + 0.5) / grid.across * size.width,
                                                     (y + 0.5) / grid.down * size.height);
                const double depth = std::lerp(nearest, farthest, grid.deep > 1 ? z / (grid.deep - 1.0) : 0.5);
                points.emplace_back(depth * a, depth * b, depth);
            }
    return points;
}

std::vector<LitPlace> litPlaces(const ProcamCalibration& calibration, double nearest, double farthest) {
    std::vector<LitPlace> places;
    for (const Eigen::Vector3d& point : gridOf(kPlaces, calibration, nearest, farthest)) {
        const cv::Point3d at(point.x(), point.y(), point.z());
        if (isInside(projectorPixel(at, calibration.state), calibration.projector.size, 0.0)) places.push_back({at});
    }
    return places;
}

/// Views that might be captured, and what they would tell.
class Planner {
public:
    Planner(const ProcamCalibration& calibration, const CalibrationBoard& board)
        : calibration_(calibration), points_(pointsOf(board)), options_(calibration.bundle) {
        low_ = high_ = points_.front();
        for (const cv::Point3d& point : points_) {
            low_ = {std::min(low_.x, point.x), std::min(low_.y, point.y), 0.0};
            high_ = {std::max(high_.x, point.x), std::max(high_.y, point.y), 0.0};
        }
        // As many points as a view had so far, but fewer and heavier ones.
        const double planned = kPointsAcross * kPointsDown;
        options_.independentPoints = 1.0;
        options_.projectorSigma *= std::sqrt(planned / std::max(1.0, calibration.pointsOfView));
        chooseUnknowns();
    }

    /// The board's middle at `middle`, tilted around x and y; nothing where one of the devices cannot see it.
    [[nodiscard]] std::optional<PoseVector> poseAt(const Eigen::Vector3d& middle, double tiltX, double tiltY,
                                                   double litShare) const {
        const glm::dvec3 centre(0.5 * (low_.x + high_.x), 0.5 * (low_.y + high_.y), 0.0);
        const glm::dvec3 way =
            glm::dvec3(middle.x(), middle.y(), middle.z()) - Rigid::exp({tiltX, tiltY, 0.0, 0.0, 0.0, 0.0}) * centre;
        const PoseVector pose = {tiltX, tiltY, 0.0, way.x, way.y, way.z};
        const ViewObservations view = planned(pose);
        const double margin = kMargin * calibration_.camera.size.width;
        for (const cv::Point2d& seen : view.corners.seen)
            if (!isInside(seen, calibration_.camera.size, margin)) return std::nullopt;
        if (static_cast<double>(view.projector.size()) < litShare * kPointsAcross * kPointsDown) return std::nullopt;
        return pose;
    }

    /// Covariance of what is unknown, without and with a view at a pose.
    [[nodiscard]] Eigen::MatrixXd covariance(const std::optional<PoseVector>& pose) const {
        Eigen::MatrixXd information = calibration_.information;
        if (pose) information += informationOf(planned(*pose), options_, calibration_.state, *pose);
        for (int i = 0; i < kPosePlace; ++i)
            if (prior_[i] > 0.0) information(i, i) += 1.0 / (prior_[i] * prior_[i]);
        const Eigen::MatrixXd kept = information(unknown_, unknown_);
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(kPosePlace, kPosePlace);
        const Eigen::VectorXd scale = kept.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
        const Eigen::MatrixXd scaled = scale.asDiagonal() * kept * scale.asDiagonal();
        const Eigen::MatrixXd eye = Eigen::MatrixXd::Identity(kept.rows(), kept.cols());
        all(unknown_, unknown_) = scale.asDiagonal() * (scaled + 1e-12 * eye).ldlt().solve(eye) * scale.asDiagonal();
        return all;
    }

    [[nodiscard]] std::vector<cv::Point2d> outlineAt(const PoseVector& pose) const {
        const PoseMatrix place(pose);
        std::vector<cv::Point2d> outline;
        for (const auto& [x, y] : {std::pair(low_.x, low_.y), {high_.x, low_.y}, {high_.x, high_.y}, {low_.x, high_.y}})
            outline.push_back(cameraPixel(place * Eigen::Vector3d(x, y, 0.0)));
        return outline;
    }

private:
    /// What was solved for, and the terms a lens most likely has besides.
    void chooseUnknowns() {
        const auto add = [this](const CalibratedDevice& device, int place) {
            const double corner = 0.5 * std::hypot(device.size.width, device.size.height) / device.lens[kFocalLength];
            const double most = kUnknownCorner * device.size.width / device.lens[kFocalLength];
            for (int i = 0; i < kLensParameters; ++i) {
                const bool free = device.free[static_cast<std::size_t>(i)];
                if (!free && (i == kK1 || i == kK2)) prior_[place + i] = most / std::pow(corner, i == kK1 ? 3.0 : 5.0);
                if (free || prior_[place + i] > 0.0) unknown_.push_back(place + i);
            }
        };
        add(calibration_.camera, 0);
        add(calibration_.projector, kProjectorPlace);
        for (int i = 0; i < 6; ++i) unknown_.push_back(kRigPlace + i);
        for (int i = 0; i < kBoardParameters; ++i)
            if (calibration_.bundle.board[static_cast<std::size_t>(i)]) unknown_.push_back(kBoardPlace + i);
    }

    [[nodiscard]] cv::Point2d cameraPixel(const Eigen::Vector3d& point) const {
        cv::Point2d pixel;
        double numbers[2];
        if (point.z() <= 0.0) return {-1e9, -1e9};
        projectPoint(calibration_.camera.lens.data(), point.data(), numbers);
        return {numbers[0], numbers[1]};
    }

    [[nodiscard]] ViewObservations planned(const PoseVector& pose) const {
        const PoseMatrix place(pose);
        ViewObservations view;
        view.corners.board = points_;
        for (const cv::Point3d& point : points_)
            view.corners.seen.push_back(cameraPixel(place * Eigen::Vector3d(point.x, point.y, point.z)));
        for (int row = 0; row < kPointsDown; ++row)
            for (int column = 0; column < kPointsAcross; ++column) {
                const Eigen::Vector3d at =
                    place * Eigen::Vector3d(std::lerp(low_.x, high_.x, column / (kPointsAcross - 1.0)),
                                            std::lerp(low_.y, high_.y, row / (kPointsDown - 1.0)), 0.0);
                const cv::Point2d lit = projectorPixel({at.x(), at.y(), at.z()}, calibration_.state);
                if (isInside(lit, calibration_.projector.size, 0.0)) view.projector.push_back({cameraPixel(at), lit});
            }
        return view;
    }

    const ProcamCalibration& calibration_;
    std::vector<cv::Point3d> points_;
    cv::Point3d low_, high_;
    BundleOptions options_;
    std::vector<int> unknown_;
    double prior_[kPosePlace] = {}; ///< standard deviations; 0: none
};

/// Mean and largest 95 % error.
struct Errors {
    double mean = 0.0, worst = 0.0;
};

Errors errorsOf(const std::vector<Eigen::Matrix2d>& uncertainty) {
    Errors errors;
    for (const Eigen::Matrix2d& covariance : uncertainty) {
        const double error = radiusOf(covariance, kErrorShare);
        errors.mean += error / static_cast<double>(uncertainty.size());
        errors.worst = std::max(errors.worst, error);
    }
    return errors;
}

/// Quicker than `errorsOf`, and good enough to compare.
double roughError(const std::vector<Eigen::Matrix2d>& uncertainty) {
    double sum = 0.0;
    for (const Eigen::Matrix2d& covariance : uncertainty) sum += std::sqrt(covariance.trace());
    return sum;
}

} // namespace

std::optional<NextPose> suggestNextPose(const ProcamCalibration& calibration, const CalibrationBoard& board,
                                        const PoseSearch& wanted, const Progress& progress) {
    double nearest = wanted.nearest;
    double farthest = wanted.farthest;
    for (const PoseVector& pose : calibration.state.cameraFromBoard) {
        if (!(wanted.nearest > 0.0)) nearest = nearest > 0.0 ? std::min(nearest, pose[5]) : pose[5];
        if (!(wanted.farthest > 0.0)) farthest = std::max(farthest, pose[5]);
    }
    std::vector<LitPlace> places = wanted.places;
    if (places.empty()) places = litPlaces(calibration, nearest, farthest);
    const WorldPose world;
    std::erase_if(places, [&](const LitPlace& place) {
        return !lightUncertainty(calibration, calibration.covariance, world, {place}).front().allFinite();
    });
    if (places.empty()) return std::nullopt;

    const Planner planner(calibration, board);
    std::vector<std::pair<double, double>> tilts = {{0.0, 0.0}};
    for (const double degrees : kTiltsDegrees)
        for (int side = 0; side < 8; ++side) {
            const double tilt = degrees * std::numbers::pi / 180.0;
            tilts.emplace_back(tilt * std::cos(side * std::numbers::pi / 4.0),
                               tilt * std::sin(side * std::numbers::pi / 4.0));
        }
    std::optional<PoseVector> best;
    double least = 0.0;
    const std::vector<Eigen::Vector3d> middles = gridOf(kMiddles, calibration, nearest, farthest);
    const auto search = [&](double litShare) {
        for (std::size_t i = 0; i < middles.size(); ++i) {
            progress.throwIfCancelled();
            progress.report(static_cast<double>(i) / static_cast<double>(middles.size()), "looking for the next pose");
            for (const auto& [x, y] : tilts) {
                const std::optional<PoseVector> pose = planner.poseAt(middles[i], x, y, litShare);
                if (!pose) continue;
                const double error = roughError(lightUncertainty(calibration, planner.covariance(pose), world, places));
                if (best && error >= least) continue;
                best = pose;
                least = error;
            }
        }
    };
    for (const double litShare : kLitShares)
        if (!best) search(litShare);
    if (!best) return std::nullopt;
    const Errors before = errorsOf(lightUncertainty(calibration, planner.covariance({}), world, places));
    const Errors after = errorsOf(lightUncertainty(calibration, planner.covariance(best), world, places));
    return NextPose{*best,
                    planner.outlineAt(*best),
                    before.mean,
                    after.mean,
                    before.worst,
                    after.worst,
                    after.mean < (1.0 - wanted.worthwhile) * before.mean};
}

} // namespace lumorph

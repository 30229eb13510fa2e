#include "calibration/solve/error_map.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>

#include "calibration/solve/first_guess.h"
#include "calibration/solve/projection.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr std::size_t kFewestWorldPoints = 4;
constexpr double kEdgeOn = 0.02; // cosine between the light and the surface's normal

/// All that light depends on: both lenses, rig, world.
constexpr int kLightNumbers = kBoardPlace + 6;
using LightCovariance = Eigen::Matrix<double, kLightNumbers, kLightNumbers>;

LightCovariance lightCovariance(const Eigen::MatrixXd& covariance, const WorldPose& world) {
    const Eigen::MatrixXd known = covariance.topLeftCorner<kBoardPlace, kBoardPlace>();
    Eigen::Matrix<double, 6, kBoardPlace> follows = Eigen::Matrix<double, 6, kBoardPlace>::Zero();
    follows.leftCols<kLensParameters>() = world.byCamera;
    LightCovariance all;
    all.topLeftCorner<kBoardPlace, kBoardPlace>() = known;
    all.bottomLeftCorner<6, kBoardPlace>() = follows * known;
    all.topRightCorner<kBoardPlace, 6>() = all.bottomLeftCorner<6, kBoardPlace>().transpose();
    all.bottomRightCorner<6, 6>() = follows * known * follows.transpose() + world.covariance;
    return all;
}

/// Two directions along a surface.
Eigen::Matrix<double, 3, 2> alongSurface(const Eigen::Vector3d& normal) {
    Eigen::Matrix<double, 3, 2> along;
    along.col(0) = normal.unitOrthogonal();
    along.col(1) = normal.normalized().cross(along.col(0));
    return along;
}

} // namespace

WorldPose worldPoseFrom(const ProcamCalibration& calibration, const BoardPoints& seen, double sigma) {
    if (seen.seen.size() < kFewestWorldPoints || seen.board.size() != seen.seen.size())
        throw InvalidInput("the world's pose", "fewer than four points were seen", "name more of them");
    ViewObservations view{"world", seen, {}};
    BundleState state;
    state.camera = calibration.camera.lens;
    state.cameraFromBoard = {poseFromCamera(view, state.camera)};
    BundleOptions options;
    options.projectorPoints = false;
    options.cameraSigma = sigma;
    refine({view}, {0}, options, state);
    // What the least squares would do were the camera another: the pose's normal matrix against the mixed one.
    BundleOptions all = options;
    all.camera.fill(true);
    const Eigen::MatrixXd normal = normalMatrixOf({view}, {0}, all, state);
    const Eigen::Matrix<double, 6, 6> own = normal.block<6, 6>(kPosePlace, kPosePlace);
    const Eigen::Matrix<double, 6, kLensParameters> mixed = normal.block<6, kLensParameters>(kPosePlace, 0);
    WorldPose world;
    world.cameraFromWorld = state.cameraFromBoard.front();
    world.covariance = own.inverse();
    world.byCamera = -own.ldlt().solve(mixed);
    return world;
}

std::vector<Eigen::Matrix2d> lightUncertainty(const ProcamCalibration& calibration, const Eigen::MatrixXd& covariance,
                                              const WorldPose& world, const std::vector<LitPlace>& places) {
    const LightCovariance known = lightCovariance(covariance, world);
    const PoseMatrix camera(world.cameraFromWorld);
    const PoseMatrix rig(calibration.projectorFromCamera);
    std::vector<Eigen::Matrix2d> all;
    for (const LitPlace& place : places) {
        all.emplace_back(Eigen::Matrix2d::Identity() * std::numeric_limits<double>::infinity());
        const Eigen::Vector3d inWorld(place.point.x, place.point.y, place.point.z);
        const Eigen::Vector3d inCamera = camera * inWorld;
        const Eigen::Vector3d inProjector = rig * inCamera;
        const Eigen::Vector3d given(place.normal[0], place.normal[1], place.normal[2]);
        const Eigen::Vector3d normal = given.squaredNorm() > 0.0
                                           ? Eigen::Vector3d(rig.rotation * (camera.rotation * given.normalized()))
                                           : inProjector.normalized();
        if (!(inProjector.z() > 0.0) || std::abs(normal.dot(inProjector.normalized())) < kEdgeOn) continue;
        const Projected light = project(calibration.projector.lens, inProjector);
        const PixelByPoint byCameraPoint = light.byPoint * rig.rotation;
        Eigen::Matrix<double, 2, kLightNumbers> slopes = Eigen::Matrix<double, 2, kLightNumbers>::Zero();
        slopes.middleCols<kLensParameters>(kProjectorPlace) = light.byLens;
        slopes.middleCols<3>(kRigPlace) = -byCameraPoint * crossOf(inCamera) * rig.turn;
        slopes.middleCols<3>(kRigPlace + 3) = light.byPoint;
        slopes.middleCols<3>(kBoardPlace) = -byCameraPoint * camera.rotation * crossOf(inWorld) * camera.turn;
        slopes.middleCols<3>(kBoardPlace + 3) = byCameraPoint;
        const Eigen::Matrix2d acrossSurface = light.byPoint * alongSurface(normal);
        const Eigen::Matrix<double, 2, kLightNumbers> onSurface = acrossSurface.inverse() * slopes;
        all.back() = onSurface * known * onSurface.transpose();
    }
    return all;
}

std::vector<double> errorMap(const ProcamCalibration& calibration, const WorldPose& world,
                             const std::vector<LitPlace>& places) {
    std::vector<double> errors;
    for (const Eigen::Matrix2d& covariance : lightUncertainty(calibration, calibration.covariance, world, places))
        errors.push_back(covariance.allFinite() ? radiusOf(covariance, kErrorShare)
                                                : std::numeric_limits<double>::infinity());
    return errors;
}

std::vector<Eigen::Matrix2d> cameraUncertainty(const ProcamCalibration& calibration,
                                               const std::vector<cv::Point3d>& points) {
    const BundleState& state = calibration.state;
    const auto count = static_cast<double>(state.cameraFromBoard.size());
    std::vector<Eigen::Matrix2d> all;
    for (const cv::Point3d& point : points) {
        const Eigen::Vector3d inCamera(point.x, point.y, point.z);
        const Projected seen = project(state.camera, inCamera);
        Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(2, calibration.covariance.cols());
        slopes.leftCols<kLensParameters>() = seen.byLens;
        for (std::size_t v = 0; v < state.cameraFromBoard.size(); ++v) {
            const PoseMatrix pose(state.cameraFromBoard[v]);
            const Eigen::Vector3d onBoard = pose.rotation.transpose() * (inCamera - pose.shift);
            const auto place = static_cast<Eigen::Index>(kPosePlace + 6 * v);
            slopes.middleCols<3>(place) = -seen.byPoint * pose.rotation * crossOf(onBoard) * pose.turn / count;
            slopes.middleCols<3>(place + 3) = seen.byPoint / count;
        }
        all.emplace_back(slopes * calibration.covariance * slopes.transpose());
    }
    return all;
}

double radiusOf(const Eigen::Matrix2d& covariance, double share) {
    const double mean = 0.5 * covariance.trace();
    const double spread = std::sqrt(std::max(0.0, mean * mean - covariance.determinant()));
    const double large = std::sqrt(std::max(0.0, mean + spread));
    const double small = std::sqrt(std::max(0.0, mean - spread));
    if (!(large > 0.0)) return 0.0;
    // Strips across the longer axis: x = r sin(a), each with what the shorter axis has within the circle.
    const auto inside = [&](double radius) {
        constexpr int kSteps = 64; // the integrand is smooth
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double angle = ((i + 0.5) / kSteps - 0.5) * std::numbers::pi;
            const double x = radius * std::sin(angle) / large;
            const double y = radius * std::cos(angle);
            sum += std::exp(-0.5 * x * x) * std::erf(y / (std::numbers::sqrt2 * std::max(small, 1e-9 * large))) * y;
        }
        return sum * std::sqrt(0.5 * std::numbers::pi) / (kSteps * large);
    };
    double low = 0.0;
    double high = 10.0 * large;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (inside(middle) < share ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

} // namespace lumorph

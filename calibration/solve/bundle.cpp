#include "calibration/solve/bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

namespace lumorph {

namespace {

constexpr double kRobust = 3.0;   // standard deviations
constexpr double kUnseen = 1e-14; // of the largest eigenvalue: a direction that the data do not tell

template <typename T> void toFrame(const T* pose, const T* point, T* out) {
    ceres::AngleAxisRotatePoint(pose, point, out);
    for (int i = 0; i < 3; ++i) out[i] += pose[3 + i];
}

/// A camera pixel's ray, cut with the plane z = 0 of the board.
template <typename T> void cutWithBoard(const cv::Point2d& pixel, const T* lens, const T* pose, T* point) {
    const T zAxis[3] = {T(0.0), T(0.0), T(1.0)};
    T normal[3];
    ceres::AngleAxisRotatePoint(pose, zAxis, normal);
    T x, y;
    directionOfPixel<T>(lens, pixel.x, pixel.y, x, y);
    const T distance = normal[0] * pose[3] + normal[1] * pose[4] + normal[2] * pose[5];
    const T depth = distance / (normal[0] * x + normal[1] * y + normal[2]);
    point[0] = depth * x;
    point[1] = depth * y;
    point[2] = depth;
}

/// Reprojection error of a board point in the camera, in standard deviations.
struct CornerError {
    cv::Point3d board;
    cv::Point2d seen;
    double weight = 1.0;

    template <typename T> bool operator()(const T* lens, const T* pose, T* error) const {
        const T point[3] = {T(board.x), T(board.y), T(board.z)};
        T inCamera[3], pixel[2];
        toFrame(pose, point, inCamera);
        if (inCamera[2] < T(1e-9)) return false;
        projectPoint(lens, inCamera, pixel);
        error[0] = T(weight) * (pixel[0] - T(seen.x));
        error[1] = T(weight) * (pixel[1] - T(seen.y));
        return true;
    }
};

/// Error of a decoded camera pixel in the projector, in standard deviations.
struct TransferError {
    ProjectorPoint seen;
    double weight = 1.0;

    template <typename T>
    bool operator()(const T* camera, const T* pose, const T* rig, const T* projector, T* error) const {
        T inCamera[3], inProjector[3], pixel[2];
        cutWithBoard(seen.camera, camera, pose, inCamera);
        toFrame(rig, inCamera, inProjector);
        projectPoint(projector, inProjector, pixel);
        error[0] = T(weight) * (pixel[0] - T(seen.projector.x));
        error[1] = T(weight) * (pixel[1] - T(seen.projector.y));
        return ceres::isfinite(error[0]) && ceres::isfinite(error[1]);
    }
};

/// The problem of some views around one state.
class BundleProblem {
public:
    BundleProblem(const std::vector<ViewObservations>& views, const ViewChoice& use, const BundleOptions& options,
                  BundleState& state)
        : options_(options), state_(state) {
        addLens(state.camera, options.camera);
        if (options.projectorPoints) {
            addLens(state.projector, options.projector);
            problem_.AddParameterBlock(state.projectorFromCamera.data(), 6);
            if (!options.rig) problem_.SetParameterBlockConstant(state.projectorFromCamera.data());
        }
        for (const int i : use) addView(views[static_cast<std::size_t>(i)], i);
    }

    double solve() {
        ceres::Solver::Options how;
        how.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
        how.max_num_iterations = 100;
        how.function_tolerance = 1e-9;
        how.logging_type = ceres::SILENT;
        how.num_threads = 2;
        ceres::Solver::Summary summary;
        ceres::Solve(how, &problem_, &summary);
        return summary.termination_type == ceres::FAILURE ? std::numeric_limits<double>::infinity()
                                                          : summary.final_cost;
    }

    /// The normal matrix of what may move, blocks in the order of `blocks`.
    Eigen::MatrixXd normalMatrix(const std::vector<double*>& blocks) {
        ceres::Problem::EvaluateOptions how;
        how.parameter_blocks = blocks;
        ceres::CRSMatrix jacobian;
        problem_.Evaluate(how, nullptr, nullptr, nullptr, &jacobian);
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(jacobian.num_cols, jacobian.num_cols);
        for (int row = 0; row < jacobian.num_rows; ++row)
            for (int i = jacobian.rows[rowIndex(row)]; i < jacobian.rows[rowIndex(row + 1)]; ++i)
                for (int k = jacobian.rows[rowIndex(row)]; k < jacobian.rows[rowIndex(row + 1)]; ++k)
                    normal(jacobian.cols[rowIndex(i)], jacobian.cols[rowIndex(k)]) +=
                        jacobian.values[rowIndex(i)] * jacobian.values[rowIndex(k)];
        return normal;
    }

private:
    static std::size_t rowIndex(int i) { return static_cast<std::size_t>(i); }

    void addLens(Lens& lens, const LensMask& free) {
        std::vector<int> held;
        for (int i = 0; i < kLensParameters; ++i)
            if (!free[static_cast<std::size_t>(i)]) held.push_back(i);
        problem_.AddParameterBlock(lens.data(), kLensParameters);
        if (held.size() == kLensParameters)
            problem_.SetParameterBlockConstant(lens.data());
        else if (!held.empty())
            problem_.SetManifold(lens.data(), new ceres::SubsetManifold(kLensParameters, held));
    }

    void addView(const ViewObservations& view, int index) {
        double* pose = state_.cameraFromBoard[static_cast<std::size_t>(index)].data();
        problem_.AddParameterBlock(pose, 6);
        if (!options_.poses) problem_.SetParameterBlockConstant(pose);
        for (std::size_t i = 0; i < view.corners.seen.size(); ++i)
            problem_.AddResidualBlock(
                new ceres::AutoDiffCostFunction<CornerError, 2, kLensParameters, 6>(
                    new CornerError{view.corners.board[i], view.corners.seen[i], 1.0 / options_.cameraSigma}),
                new ceres::HuberLoss(kRobust), state_.camera.data(), pose);
        if (!options_.projectorPoints) return;
        const std::size_t count = view.projector.size();
        const std::size_t used = std::min(count, static_cast<std::size_t>(options_.most));
        const double share =
            options_.independent * static_cast<double>(count) / std::max<double>(1.0, static_cast<double>(used));
        const double weight = std::sqrt(std::min(share, 1.0)) / options_.projectorSigma;
        for (std::size_t i = 0; i < used; ++i)
            problem_.AddResidualBlock(
                new ceres::AutoDiffCostFunction<TransferError, 2, kLensParameters, 6, 6, kLensParameters>(
                    new TransferError{view.projector[i * count / used], weight}),
                new ceres::CauchyLoss(kRobust), state_.camera.data(), pose, state_.projectorFromCamera.data(),
                state_.projector.data());
    }

    const BundleOptions& options_;
    BundleState& state_;
    ceres::Problem problem_;
};

/// The inverse of a normal matrix, whose parameters have very different units.
Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& normal) {
    const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(scale.asDiagonal() * normal * scale.asDiagonal());
    const Eigen::VectorXd values = solved.eigenvalues().cwiseMax(kUnseen * solved.eigenvalues().maxCoeff());
    return scale.asDiagonal() * solved.eigenvectors() * values.cwiseInverse().asDiagonal() *
           solved.eigenvectors().transpose() * scale.asDiagonal();
}

} // namespace

double refine(const std::vector<ViewObservations>& views, const ViewChoice& use, const BundleOptions& options,
              BundleState& state) {
    return BundleProblem(views, use, options, state).solve();
}

Eigen::Matrix<double, 24, 24> covarianceOf(const std::vector<ViewObservations>& views, const ViewChoice& use,
                                           const BundleOptions& options, const BundleState& state) {
    BundleState here = state;
    BundleProblem problem(views, use, options, here);
    std::vector<double*> blocks;
    std::vector<int> places; // of each column among the 24
    const auto addLens = [&](Lens& lens, const LensMask& free, int first) {
        if (std::ranges::find(free, true) == free.end()) return;
        blocks.push_back(lens.data());
        for (int i = 0; i < kLensParameters; ++i)
            if (free[static_cast<std::size_t>(i)]) places.push_back(first + i);
    };
    addLens(here.camera, options.camera, 0);
    if (options.projectorPoints) addLens(here.projector, options.projector, kLensParameters);
    if (options.projectorPoints && options.rig) {
        blocks.push_back(here.projectorFromCamera.data());
        for (int i = 0; i < 6; ++i) places.push_back(2 * kLensParameters + i);
    }
    if (options.poses)
        for (const int i : use) blocks.push_back(here.cameraFromBoard[static_cast<std::size_t>(i)].data());
    const Eigen::MatrixXd inverse = inverseOf(problem.normalMatrix(blocks));
    Eigen::Matrix<double, 24, 24> covariance = Eigen::Matrix<double, 24, 24>::Zero();
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t k = 0; k < places.size(); ++k)
            covariance(places[i], places[k]) = inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
    return covariance;
}

std::vector<cv::Point2d> cameraErrors(const ViewObservations& view, const Lens& camera,
                                      const PoseVector& cameraFromBoard) {
    std::vector<cv::Point2d> errors;
    for (std::size_t i = 0; i < view.corners.seen.size(); ++i) {
        std::array<double, 2> error{};
        CornerError{view.corners.board[i], view.corners.seen[i], 1.0}(camera.data(), cameraFromBoard.data(),
                                                                      error.data());
        errors.emplace_back(error[0], error[1]);
    }
    return errors;
}

cv::Point3d pointOnBoard(const cv::Point2d& pixel, const Lens& camera, const PoseVector& cameraFromBoard) {
    double point[3];
    cutWithBoard(pixel, camera.data(), cameraFromBoard.data(), point);
    return {point[0], point[1], point[2]};
}

cv::Point2d projectorPixel(const cv::Point3d& point, const BundleState& state) {
    const double inCamera[3] = {point.x, point.y, point.z};
    double inProjector[3], pixel[2];
    toFrame(state.projectorFromCamera.data(), inCamera, inProjector);
    projectPoint(state.projector.data(), inProjector, pixel);
    return {pixel[0], pixel[1]};
}

std::vector<cv::Point2d> projectorErrors(const ViewObservations& view, const BundleState& state,
                                         const PoseVector& cameraFromBoard) {
    std::vector<cv::Point2d> errors;
    for (const ProjectorPoint& point : view.projector)
        errors.push_back(projectorPixel(pointOnBoard(point.camera, state.camera, cameraFromBoard), state) -
                         point.projector);
    return errors;
}

double rmsOf(const std::vector<cv::Point2d>& errors) {
    double sum = 0.0;
    for (const cv::Point2d& error : errors) sum += error.dot(error);
    return errors.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(errors.size()));
}

} // namespace lumorph

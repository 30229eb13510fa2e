#include "calibration/solve/bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include <Eigen/Dense>
#include <ceres/ceres.h>

#include "calibration/solve/projection.h"

namespace lumorph {

namespace {

constexpr double kRobust = 3.0;     // standard deviations
constexpr double kUnseen = 1e-14;   // of the largest eigenvalue: a direction that the data do not tell
constexpr double kNearest = 1e-9;   // a point nearer than that, or behind, is not seen
constexpr double kMissed = 1e3;     // pixels, or standard deviations: the error of a point that its ray misses
constexpr double kMostMissed = 0.1; // of a view's points of one kind: with more the state itself is impossible
constexpr int kBlockSizes[] = {kLensParameters, 6, kBoardParameters, 6, kLensParameters};
constexpr int kColumns = 2 * kLensParameters + 12 + kBoardParameters; // of one view

/// What one view's errors depend on, side by side.
enum ViewColumn {
    kCameraColumn = 0,
    kPoseColumn = kCameraColumn + kLensParameters,
    kBoardColumn = kPoseColumn + 6,
    kStretchColumn = kBoardColumn + kBoardParameters - 1,
    kRigColumn,
    kProjectorColumn = kRigColumn + 6,
};

using Slopes = Eigen::Matrix<double, 2, kColumns>;
Lens lensAt(const double* numbers) {
    Lens lens;
    std::copy_n(numbers, kLensParameters, lens.begin());
    return lens;
}

PoseVector poseAt(const double* numbers) {
    PoseVector pose;
    std::copy_n(numbers, pose.size(), pose.begin());
    return pose;
}

/// A board's height over its plane, its slope, and how it moves with the terms.
struct Height {
    double value = 0.0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 7, 1> byTerm;
};

Height heightOf(const BoardShape& board, double x, double y) {
    const double u = (x - board.middle.x) / board.half;
    const double v = (y - board.middle.y) / board.half;
    Height height;
    height.byTerm << u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v;
    const Eigen::Map<const Eigen::Matrix<double, 7, 1>> terms(board.terms.data());
    height.value = terms.dot(height.byTerm);
    Eigen::Matrix<double, 7, 2> slopes;
    slopes << 2.0 * u, 0.0, v, u, 0.0, 2.0 * v, 3.0 * u * u, 0.0, 2.0 * u * v, u * u, v * v, 2.0 * u * v, 0.0,
        3.0 * v * v;
    height.slope = slopes.transpose() * terms / board.half;
    return height;
}

bool isFlat(const BoardShape& board) {
    return std::all_of(board.terms.begin(), board.terms.begin() + kBoardStretch, [](double t) { return t == 0.0; });
}

/// How far along `direction` from the camera the board is met.
double depthOfBoard(const Eigen::Vector3d& direction, const PoseMatrix& pose, const BoardShape& board) {
    constexpr int kSteps = 4;
    const Eigen::Vector3d way = pose.rotation.transpose() * direction;
    const Eigen::Vector3d from = -pose.rotation.transpose() * pose.shift;
    double depth = -from.z() / way.z();
    if (isFlat(board)) return depth;
    for (int step = 0; step < kSteps; ++step) {
        const Eigen::Vector3d at = from + depth * way;
        const Height height = heightOf(board, at.x(), at.y());
        depth -= (at.z() - height.value) / (way.z() - height.slope.dot(way.head<2>()));
    }
    return depth;
}

/// One of a view's errors in standard deviations and, if wanted, its slopes.
struct ViewTerms {
    const ViewObservations& view;
    const Lens camera, projector;
    const PoseMatrix pose, rig;
    const BoardShape board;

    bool corner(std::size_t i, Eigen::Vector2d& error, Slopes* slopes) const {
        const cv::Point3d& printed = view.corners.board[i];
        const cv::Point3d placed = onBoard(board, printed);
        const Eigen::Vector3d point(placed.x, placed.y, placed.z);
        const Eigen::Vector3d seen = pose * point;
        if (seen.z() < kNearest) return false;
        const Projected projected = project(camera, seen);
        error = projected.pixel - Eigen::Vector2d(view.corners.seen[i].x, view.corners.seen[i].y);
        if (!slopes) return error.allFinite();
        slopes->setZero();
        slopes->middleCols<kLensParameters>(kCameraColumn) = projected.byLens;
        const PixelByPoint byBoard = projected.byPoint * pose.rotation;
        slopes->middleCols<3>(kPoseColumn) = -byBoard * crossOf(point) * pose.turn;
        slopes->middleCols<3>(kPoseColumn + 3) = projected.byPoint;
        const Height height = heightOf(board, point.x(), point.y());
        slopes->middleCols<7>(kBoardColumn) = byBoard.col(2) * height.byTerm.transpose();
        const Eigen::Vector3d stretch(1.0, 0.0, height.slope.x());
        slopes->col(kStretchColumn) = byBoard * stretch * (printed.x - board.middle.x);
        return error.allFinite();
    }

    bool transfer(const ProjectorPoint& at, Eigen::Vector2d& error, Slopes* slopes) const {
        const auto [x, y] = directionOfPixel(camera, at.camera.x, at.camera.y);
        const Eigen::Vector3d direction(x, y, 1.0);
        const double depth = depthOfBoard(direction, pose, board);
        if (!(depth > kNearest)) return false;
        const Eigen::Vector3d inCamera = depth * direction;
        const Eigen::Vector3d inProjector = rig * inCamera;
        const Projected projected = project(projector, inProjector);
        error = projected.pixel - Eigen::Vector2d(at.projector.x, at.projector.y);
        if (!error.allFinite()) return false;
        if (!slopes) return true;
        const PixelByPoint byPoint = projected.byPoint * rig.rotation; // by the point in the camera's frame
        const Eigen::Vector3d inBoard = pose.rotation.transpose() * (inCamera - pose.shift);
        const Height height = heightOf(board, inBoard.x(), inBoard.y());
        const Eigen::Vector3d upward(-height.slope.x(), -height.slope.y(), 1.0);
        const Eigen::Vector3d normal = pose.rotation * upward;
        const double facing = normal.dot(direction);
        // The point moves along its ray by what the board moves through it, and with the ray.
        const Eigen::Vector2d alongRay = byPoint * direction / facing;
        const Eigen::Matrix<double, 2, 2> byDirection =
            depth * (byPoint.leftCols<2>() - alongRay * normal.head<2>().transpose());
        slopes->middleCols<kLensParameters>(kCameraColumn) =
            byDirection * directionByLens(camera, at.camera.x, at.camera.y, x, y);
        slopes->middleCols<3>(kPoseColumn) = -alongRay * upward.cross(inBoard).transpose() * pose.turn;
        slopes->middleCols<3>(kPoseColumn + 3) = alongRay * normal.transpose();
        slopes->middleCols<7>(kBoardColumn) = alongRay * height.byTerm.transpose();
        slopes->col(kStretchColumn).setZero();
        slopes->middleCols<3>(kRigColumn) = -byPoint * crossOf(inCamera) * rig.turn;
        slopes->middleCols<3>(kRigColumn + 3) = projected.byPoint;
        slopes->middleCols<kLensParameters>(kProjectorColumn) = projected.byLens;
        return true;
    }
};

/// A loss of a squared error, and its derivative.
struct Loss {
    double value, slope;
};

Loss huber(double s) {
    constexpr double kBend = kRobust * kRobust;
    if (s <= kBend) return {s, 1.0};
    const double root = std::sqrt(s);
    return {2.0 * kRobust * root - kBend, kRobust / root};
}

Loss cauchy(double s) {
    constexpr double kBend = kRobust * kRobust;
    return {kBend * std::log1p(s / kBend), 1.0 / (1.0 + s / kBend)};
}

/// What the loss lets an error of `s` count, in units of what errors of normal noise count in the mean: so noise alone
/// counts in full, and what is far off next to nothing. Both coordinates together, s is exponential with mean 2; for
/// Cauchy's loss the mean of 1 / (1 + s / 9) is 4.5 exp(4.5) E1(4.5).
double weightOf(Loss (*loss)(double), double s) {
    constexpr double kCauchyMean = 0.8399;
    return loss == cauchy ? loss(s).slope / kCauchyMean : loss(s).slope;
}

/// Makes the half square of an error its loss: error and slopes, scaled.
void applyLoss(Loss (*loss)(double), Eigen::Vector2d& error, Slopes* slopes) {
    const double s = error.squaredNorm();
    if (s < 1e-12) return;
    const auto [value, slope] = loss(s);
    const double scale = std::sqrt(value / s);
    if (slopes) {
        const double bend = (slope * s - value) / (s * s) / scale; // twice the derivative of `scale` by s
        *slopes = scale * *slopes + (bend * error) * (error.transpose() * *slopes);
    }
    error *= scale;
}

/// All errors of one view in standard deviations, as one block: its rotations are worked out once.
class ViewError : public ceres::CostFunction {
public:
    ViewError(const ViewObservations& view, const BundleOptions& options, const BoardShape& frame)
        : view_(view), options_(options), frame_(frame),
          cornerShare_(std::sqrt(std::min(options.independentCorners, 1.0))) {
        const std::size_t count = options.projectorPoints ? view.projector.size() : 0;
        points_ = std::min(count, static_cast<std::size_t>(options.most));
        const double share = options.independentPoints * static_cast<double>(count) /
                             std::max<double>(1.0, static_cast<double>(points_));
        pointShare_ = std::sqrt(std::min(share, 1.0));
        set_num_residuals(static_cast<int>(2 * (view.corners.seen.size() + points_)));
        const std::size_t blocks = options.projectorPoints ? 5 : 3;
        for (std::size_t i = 0; i < blocks; ++i) mutable_parameter_block_sizes()->push_back(kBlockSizes[i]);
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        int row = 0;
        return forEach(parameters, Counts::byLoss, jacobians != nullptr,
                       [&](const Eigen::Vector2d& error, const Slopes& slopes, bool) {
                           residuals[row] = error.x();
                           residuals[row + 1] = error.y();
                           if (jacobians) copy(slopes, row, jacobians);
                           row += 2;
                       });
    }

    /// How much an error counts: by its loss, where it is to become small; by the weight that the loss gives it, for
    /// what it tells; or in full, for what a planned point would tell.
    enum class Counts { byLoss, byWeight, inFull };

    /// Normal matrices of corners and of projector points.
    void addNormal(double const* const* parameters, Counts counts, Eigen::MatrixXd& corners,
                   Eigen::MatrixXd& points) const {
        forEach(parameters, counts, true, [&](const Eigen::Vector2d&, const Slopes& slopes, bool ofCamera) {
            if (ofCamera)
                corners.noalias() += slopes.transpose() * slopes;
            else
                points.noalias() += slopes.transpose() * slopes;
        });
    }

private:
    template <typename Take>
    bool forEach(double const* const* parameters, Counts counts, bool wantSlopes, const Take& take) const {
        BoardShape board = frame_;
        std::copy_n(parameters[2], kBoardParameters, board.terms.begin());
        const ViewTerms terms{view_,
                              lensAt(parameters[0]),
                              points_ ? lensAt(parameters[4]) : Lens{},
                              PoseMatrix(poseAt(parameters[1])),
                              PoseMatrix(points_ ? poseAt(parameters[3]) : PoseVector{}),
                              board};
        Eigen::Vector2d error;
        Slopes storage;
        Slopes* slopes = wantSlopes ? &storage : nullptr;
        const auto finish = [&](double sigma, Loss (*loss)(double), double share, bool ofCamera) {
            error /= sigma;
            if (slopes) *slopes /= sigma;
            if (counts == Counts::byLoss) applyLoss(loss, error, slopes);
            if (counts == Counts::byWeight) {
                const double root = std::sqrt(weightOf(loss, error.squaredNorm()));
                error *= root;
                if (slopes) *slopes *= root;
            }
            if (share != 1.0) {
                error *= share;
                if (slopes) *slopes *= share;
            }
            take(error, storage, ofCamera);
        };
        // A single point that cannot be there counts as one far off, which no small step mends.
        const auto miss = [&](double sigma) {
            error = {kMissed * sigma, 0.0};
            if (slopes) slopes->setZero();
        };
        const auto isTooMuch = [](std::size_t missed, std::size_t count) {
            return static_cast<double>(missed) > kMostMissed * static_cast<double>(count);
        };
        std::size_t missed = 0;
        for (std::size_t i = 0; i < view_.corners.seen.size(); ++i) {
            if (!terms.corner(i, error, slopes)) {
                if (isTooMuch(++missed, view_.corners.seen.size())) return false;
                miss(options_.cameraSigma);
            }
            finish(options_.cameraSigma, huber, cornerShare_, true);
        }
        missed = 0;
        for (std::size_t i = 0; i < points_; ++i) {
            if (!terms.transfer(view_.projector[i * view_.projector.size() / points_], error, slopes)) {
                if (isTooMuch(++missed, points_)) return false;
                miss(options_.projectorSigma);
            }
            finish(options_.projectorSigma, cauchy, pointShare_, false);
        }
        return true;
    }

    void copy(const Slopes& slopes, int row, double** jacobians) const {
        int column = 0;
        for (std::size_t block = 0; block < parameter_block_sizes().size(); ++block) {
            const int size = kBlockSizes[block];
            if (jacobians[block])
                for (int r = 0; r < 2; ++r)
                    for (int c = 0; c < size; ++c) jacobians[block][(row + r) * size + c] = slopes(r, column + c);
            column += size;
        }
    }

    const ViewObservations& view_;
    const BundleOptions& options_;
    const BoardShape frame_;
    std::size_t points_ = 0;
    double cornerShare_ = 1.0, pointShare_ = 1.0;
};

/// The problem of some views around one state.
class BundleProblem {
public:
    BundleProblem(const std::vector<ViewObservations>& views, const ViewChoice& use, const BundleOptions& options,
                  BundleState& state)
        : options_(options), state_(state) {
        addBlock(state.camera, options.camera);
        addBlock(state.board.terms, options.board);
        order_->AddElementToGroup(state.camera.data(), 1);
        order_->AddElementToGroup(state.board.terms.data(), 1);
        if (options.projectorPoints) {
            addBlock(state.projector, options.projector);
            problem_.AddParameterBlock(state.projectorFromCamera.data(), 6);
            if (!options.rig) problem_.SetParameterBlockConstant(state.projectorFromCamera.data());
            order_->AddElementToGroup(state.projector.data(), 1);
            order_->AddElementToGroup(state.projectorFromCamera.data(), 1);
        }
        for (const int i : use) addView(views[static_cast<std::size_t>(i)], i);
    }

    double solve() {
        ceres::Solver::Options how;
        how.linear_solver_type = options_.poses ? ceres::DENSE_SCHUR : ceres::DENSE_NORMAL_CHOLESKY;
        if (options_.poses) how.linear_solver_ordering = order_;
        how.max_num_iterations = 100;
        how.function_tolerance = 1e-9;
        how.logging_type = ceres::SILENT;
        how.num_threads = 1;
        ceres::Solver::Summary summary;
        ceres::Solve(how, &problem_, &summary);
        return summary.termination_type == ceres::FAILURE ? std::numeric_limits<double>::infinity()
                                                          : summary.final_cost;
    }

private:
    template <std::size_t Size> void addBlock(std::array<double, Size>& block, const std::array<bool, Size>& free) {
        std::vector<int> held;
        for (std::size_t i = 0; i < Size; ++i)
            if (!free[i]) held.push_back(static_cast<int>(i));
        problem_.AddParameterBlock(block.data(), static_cast<int>(Size));
        if (held.size() == Size)
            problem_.SetParameterBlockConstant(block.data());
        else if (!held.empty())
            problem_.SetManifold(block.data(), new ceres::SubsetManifold(static_cast<int>(Size), held));
    }

    void addView(const ViewObservations& view, int index) {
        double* pose = state_.cameraFromBoard[static_cast<std::size_t>(index)].data();
        problem_.AddParameterBlock(pose, 6);
        order_->AddElementToGroup(pose, 0);
        if (!options_.poses) problem_.SetParameterBlockConstant(pose);
        std::vector<double*> blocks = {state_.camera.data(), pose, state_.board.terms.data()};
        if (options_.projectorPoints) {
            blocks.push_back(state_.projectorFromCamera.data());
            blocks.push_back(state_.projector.data());
        }
        problem_.AddResidualBlock(new ViewError(view, options_, state_.board), nullptr, blocks);
    }

    const BundleOptions& options_;
    BundleState& state_;
    ceres::Problem problem_;
    std::shared_ptr<ceres::ParameterBlockOrdering> order_ = std::make_shared<ceres::ParameterBlockOrdering>();
};

/// Places in a covariance of the columns of a view.
std::array<int, kColumns> placesOf(int view) {
    std::array<int, kColumns> places;
    const auto fill = [&places](int column, int size, int place) {
        for (int i = 0; i < size; ++i) places[static_cast<std::size_t>(column + i)] = place + i;
    };
    fill(kCameraColumn, kLensParameters, 0);
    fill(kPoseColumn, 6, kPosePlace + 6 * view);
    fill(kBoardColumn, kBoardParameters, kBoardPlace);
    fill(kRigColumn, 6, kRigPlace);
    fill(kProjectorColumn, kLensParameters, kProjectorPlace);
    return places;
}

/// Normal matrices of some views, by kind of observation.
struct Normals {
    Eigen::MatrixXd corners, points;
};

Normals normalsOf(const std::vector<ViewObservations>& views, const ViewChoice& use, const BundleOptions& options,
                  const BundleState& state, ViewError::Counts counts) {
    const auto size = static_cast<Eigen::Index>(kPosePlace + 6 * state.cameraFromBoard.size());
    Normals all{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size)};
    for (const int v : use) {
        const auto index = static_cast<std::size_t>(v);
        const double* parameters[] = {state.camera.data(), state.cameraFromBoard[index].data(),
                                      state.board.terms.data(), state.projectorFromCamera.data(),
                                      state.projector.data()};
        Eigen::MatrixXd corners = Eigen::MatrixXd::Zero(kColumns, kColumns);
        Eigen::MatrixXd points = corners;
        ViewError(views[index], options, state.board).addNormal(parameters, counts, corners, points);
        const std::array<int, kColumns> places = placesOf(v);
        for (int i = 0; i < kColumns; ++i)
            for (int k = 0; k < kColumns; ++k) {
                const int row = places[static_cast<std::size_t>(i)];
                const int column = places[static_cast<std::size_t>(k)];
                all.corners(row, column) += corners(i, k);
                all.points(row, column) += points(i, k);
            }
    }
    return all;
}

/// Places of what may move.
std::vector<int> freePlaces(const ViewChoice& use, const BundleOptions& options) {
    std::vector<int> places;
    const auto add = [&places](const auto& mask, int first) {
        for (std::size_t i = 0; i < mask.size(); ++i)
            if (mask[i]) places.push_back(first + static_cast<int>(i));
    };
    add(options.camera, 0);
    if (options.projectorPoints) add(options.projector, kProjectorPlace);
    if (options.projectorPoints && options.rig)
        for (int i = 0; i < 6; ++i) places.push_back(kRigPlace + i);
    add(options.board, kBoardPlace);
    if (options.poses)
        for (const int v : use)
            for (int i = 0; i < 6; ++i) places.push_back(kPosePlace + 6 * v + i);
    return places;
}

/// The inverse of a normal matrix, whose parameters have very different units.
Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& normal) {
    const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(scale.asDiagonal() * normal * scale.asDiagonal());
    const Eigen::VectorXd values = solved.eigenvalues().cwiseMax(kUnseen * solved.eigenvalues().maxCoeff());
    return scale.asDiagonal() * solved.eigenvectors() * values.cwiseInverse().asDiagonal() *
           solved.eigenvectors().transpose() * scale.asDiagonal();
}

} // namespace

BoardShape flatBoard(const std::vector<ViewObservations>& views) {
    cv::Point2d low(1e300, 1e300);
    cv::Point2d high = -low;
    for (const ViewObservations& view : views)
        for (const cv::Point3d& point : view.corners.board) {
            low = {std::min(low.x, point.x), std::min(low.y, point.y)};
            high = {std::max(high.x, point.x), std::max(high.y, point.y)};
        }
    BoardShape board;
    if (!(low.x < high.x)) return board;
    board.middle = 0.5 * (low + high);
    board.half = 0.5 * std::max(high.x - low.x, high.y - low.y);
    return board;
}

cv::Point3d onBoard(const BoardShape& board, const cv::Point3d& printed) {
    const double x = printed.x + board.terms[kBoardStretch] * (printed.x - board.middle.x);
    if (isFlat(board)) return {x, printed.y, printed.z};
    return {x, printed.y, printed.z + heightOf(board, x, printed.y).value};
}

double refine(const std::vector<ViewObservations>& views, const ViewChoice& use, const BundleOptions& options,
              BundleState& state) {
    return BundleProblem(views, use, options, state).solve();
}

BundleCovariance covarianceOf(const std::vector<ViewObservations>& views, const ViewChoice& use,
                              const BundleOptions& options, const BundleState& state) {
    const Normals normals = normalsOf(views, use, options, state, ViewError::Counts::byWeight);
    const std::vector<int> places = freePlaces(use, options);
    const Eigen::MatrixXd corners = normals.corners(places, places);
    const Eigen::MatrixXd points = normals.points(places, places);
    const Eigen::MatrixXd inverse = inverseOf(corners + points);
    BundleCovariance covariance;
    covariance.matrix = Eigen::MatrixXd::Zero(normals.corners.rows(), normals.corners.cols());
    covariance.matrix(places, places) = inverse;
    covariance.cameraFreedom = corners.cwiseProduct(inverse).sum();
    covariance.projectorFreedom = points.cwiseProduct(inverse).sum();
    return covariance;
}

Eigen::MatrixXd normalMatrixOf(const std::vector<ViewObservations>& views, const ViewChoice& use,
                               const BundleOptions& options, const BundleState& state) {
    const Normals normals = normalsOf(views, use, options, state, ViewError::Counts::inFull);
    return normals.corners + normals.points;
}

Eigen::MatrixXd informationOf(const ViewObservations& view, const BundleOptions& options, const BundleState& state,
                              const PoseVector& cameraFromBoard) {
    BundleState alone = state;
    alone.cameraFromBoard = {cameraFromBoard};
    const Eigen::MatrixXd all = normalMatrixOf({view}, {0}, options, alone);
    const Eigen::MatrixXd mixed = all.bottomLeftCorner(6, kPosePlace);
    return all.topLeftCorner(kPosePlace, kPosePlace) -
           mixed.transpose() * inverseOf(all.bottomRightCorner(6, 6)) * mixed;
}

std::vector<cv::Point2d> cameraErrors(const ViewObservations& view, const BundleState& state,
                                      const PoseVector& cameraFromBoard) {
    const PoseMatrix pose(cameraFromBoard);
    const ViewTerms terms{view, state.camera, {}, pose, pose, state.board};
    std::vector<cv::Point2d> errors;
    for (std::size_t i = 0; i < view.corners.seen.size(); ++i) {
        Eigen::Vector2d error = Eigen::Vector2d::Zero();
        if (!terms.corner(i, error, nullptr)) error = {kMissed, 0.0};
        errors.emplace_back(error.x(), error.y());
    }
    return errors;
}

cv::Point3d pointOnBoard(const cv::Point2d& pixel, const Lens& camera, const PoseVector& cameraFromBoard,
                         const BoardShape& board) {
    const auto [x, y] = directionOfPixel(camera, pixel.x, pixel.y);
    const double depth = depthOfBoard({x, y, 1.0}, PoseMatrix(cameraFromBoard), board);
    return {depth * x, depth * y, depth};
}

cv::Point2d projectorPixel(const cv::Point3d& point, const BundleState& state) {
    const Eigen::Vector3d inProjector =
        PoseMatrix(state.projectorFromCamera) * Eigen::Vector3d(point.x, point.y, point.z);
    double pixel[2];
    projectPoint(state.projector.data(), inProjector.data(), pixel);
    return {pixel[0], pixel[1]};
}

std::vector<cv::Point2d> projectorErrors(const ViewObservations& view, const BundleState& state,
                                         const PoseVector& cameraFromBoard) {
    const ViewTerms terms{
        view,       state.camera, state.projector, PoseMatrix(cameraFromBoard), PoseMatrix(state.projectorFromCamera),
        state.board};
    std::vector<cv::Point2d> errors;
    for (const ProjectorPoint& point : view.projector) {
        Eigen::Vector2d error = Eigen::Vector2d::Zero();
        if (!terms.transfer(point, error, nullptr)) error = {kMissed, 0.0};
        errors.emplace_back(error.x(), error.y());
    }
    return errors;
}

double sigmaOf(const std::vector<cv::Point2d>& errors, double freedom) {
    constexpr double kStray = 12.0; // standard deviations
    std::vector<double> squares;
    for (const cv::Point2d& error : errors) squares.push_back(error.dot(error));
    if (squares.empty()) return 0.0;
    const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::ranges::nth_element(squares, middle);
    const double most = kStray * kStray * *middle / (2.0 * std::numbers::ln2); // of normal noise, from the median
    double sum = 0.0;
    for (const double square : squares) sum += std::min(square, most);
    return std::sqrt(sum / std::max(1.0, 2.0 * static_cast<double>(squares.size()) - freedom));
}

double rmsOf(const std::vector<cv::Point2d>& errors) {
    double sum = 0.0;
    for (const cv::Point2d& error : errors) sum += error.dot(error);
    return errors.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(errors.size()));
}

} // namespace lumorph

#include "calibration/solve/first_guess.h"

#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>

#include "calibration/decode/refusal.h"

namespace lumorph {

namespace {

constexpr int kPointsOfView = 120; // enough to begin with

LensMask firstMask() {
    LensMask mask{};
    mask[kFocalLength] = mask[kPrincipalX] = mask[kPrincipalY] = mask[kK1] = true;
    return mask;
}

Lens plainLens(double focal, double x, double y) { return {focal, 1.0, x, y, 0.0, 0.0, 0.0, 0.0, 0.0}; }

cv::Matx33d matrixOf(const Lens& lens) {
    return {lens[kFocalLength],
            0.0,
            lens[kPrincipalX],
            0.0,
            lens[kFocalLength] * lens[kAspect],
            lens[kPrincipalY],
            0.0,
            0.0,
            1.0};
}

PoseVector poseOf(const cv::Mat& turn, const cv::Mat& way) {
    PoseVector pose;
    for (int i = 0; i < 3; ++i) {
        pose[static_cast<std::size_t>(i)] = turn.at<double>(i);
        pose[static_cast<std::size_t>(3 + i)] = way.at<double>(i);
    }
    return pose;
}

/// Points in the camera's frame, and the projector pixels that light them.
struct LitPoints {
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> pixels;
};

LitPoints litPoints(const std::vector<ViewObservations>& views, const ViewChoice& use, const BundleState& state) {
    LitPoints lit;
    for (const int v : use) {
        const auto& all = views[static_cast<std::size_t>(v)].projector;
        const std::size_t step = std::max<std::size_t>(1, all.size() / kPointsOfView);
        for (std::size_t i = 0; i < all.size(); i += step) {
            lit.points.push_back(
                pointOnBoard(all[i].camera, state.camera, state.cameraFromBoard[static_cast<std::size_t>(v)]));
            lit.pixels.push_back(all[i].projector);
        }
    }
    return lit;
}

/// The direct linear transform: the projection that explains the points best in the algebraic sense, both sides moved
/// to their middle and scaled. Points that lie in one plane have many; any of them is returned.
Eigen::Matrix<double, 3, 4> projectionOf(const LitPoints& lit) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    const auto count = static_cast<double>(lit.points.size());
    for (std::size_t i = 0; i < lit.points.size(); ++i) {
        middle += Eigen::Vector3d(lit.points[i].x, lit.points[i].y, lit.points[i].z) / count;
        centre += Eigen::Vector2d(lit.pixels[i].x, lit.pixels[i].y) / count;
    }
    double spread = 0.0;
    double wide = 0.0;
    for (std::size_t i = 0; i < lit.points.size(); ++i) {
        spread += (Eigen::Vector3d(lit.points[i].x, lit.points[i].y, lit.points[i].z) - middle).norm() / count;
        wide += (Eigen::Vector2d(lit.pixels[i].x, lit.pixels[i].y) - centre).norm() / count;
    }
    Eigen::Matrix<double, 12, 12> normal = Eigen::Matrix<double, 12, 12>::Zero();
    for (std::size_t i = 0; i < lit.points.size(); ++i) {
        Eigen::Vector4d point;
        point << (Eigen::Vector3d(lit.points[i].x, lit.points[i].y, lit.points[i].z) - middle) / spread, 1.0;
        const Eigen::Vector2d pixel = (Eigen::Vector2d(lit.pixels[i].x, lit.pixels[i].y) - centre) / wide;
        Eigen::Matrix<double, 2, 12> rows = Eigen::Matrix<double, 2, 12>::Zero();
        rows.block<1, 4>(0, 0) = point.transpose();
        rows.block<1, 4>(1, 4) = point.transpose();
        rows.block<2, 4>(0, 8) = -pixel * point.transpose();
        normal += rows.transpose() * rows;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 12, 12>> solved(normal);
    const Eigen::Matrix<double, 12, 1> least = solved.eigenvectors().col(0);
    Eigen::Matrix<double, 3, 4> scaled;
    for (int row = 0; row < 3; ++row) scaled.row(row) = least.segment<4>(4 * row).transpose();
    Eigen::Matrix3d pixelsBack;
    pixelsBack << wide, 0.0, centre.x(), 0.0, wide, centre.y(), 0.0, 0.0, 1.0;
    Eigen::Matrix4d toScaled = Eigen::Matrix4d::Identity();
    toScaled.topLeftCorner<3, 3>() /= spread;
    toScaled.topRightCorner<3, 1>() = -middle / spread;
    return pixelsBack * scaled * toScaled;
}

/// A projection as a lens and a pose; nothing where it is none that looks at the points.
bool decompose(Eigen::Matrix<double, 3, 4> projection, const LitPoints& lit, BundleState& state) {
    const cv::Point3d& any = lit.points.front();
    const double scale = projection.block<1, 3>(2, 0).norm();
    if (!(scale > 0.0)) return false;
    projection /= scale;
    if ((projection.row(2) * Eigen::Vector4d(any.x, any.y, any.z, 1.0)).value() < 0.0) projection = -projection;
    cv::Matx33d left, upper, turn;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) left(row, column) = projection(row, column);
    if (cv::determinant(left) <= 0.0) return false; // a mirror image
    cv::RQDecomp3x3(left, upper, turn);
    for (int i = 0; i < 3; ++i) // a lens has positive lengths
        if (upper(i, i) < 0.0)
            for (int k = 0; k < 3; ++k) {
                upper(k, i) = -upper(k, i);
                turn(i, k) = -turn(i, k);
            }
    const cv::Vec3d way = upper.inv() * cv::Vec3d(projection(0, 3), projection(1, 3), projection(2, 3));
    cv::Vec3d axis;
    cv::Rodrigues(turn, axis);
    const double unit = upper(2, 2);
    state.projector = plainLens(0.5 * (upper(0, 0) + upper(1, 1)) / unit, upper(0, 2) / unit, upper(1, 2) / unit);
    state.projectorFromCamera = {axis[0], axis[1], axis[2], way[0], way[1], way[2]};
    return std::isfinite(state.projector[kFocalLength]) && state.projector[kFocalLength] > 0.0;
}

/// Keeps the better of two states.
class BestStart {
public:
    void offer(const BundleState& state, double cost) {
        if (!(cost < cost_) || !(state.camera[kFocalLength] > 0.0) || state.projector[kFocalLength] < 0.0) return;
        cost_ = cost;
        state_ = state;
    }
    [[nodiscard]] bool found() const { return std::isfinite(cost_); }
    [[nodiscard]] const BundleState& state() const { return state_; }

private:
    double cost_ = std::numeric_limits<double>::infinity();
    BundleState state_;
};

} // namespace

PoseVector poseFromCamera(const ViewObservations& view, const Lens& camera) {
    const cv::Matx<double, 1, 5> distortion(camera[kK1], camera[kK2], camera[kP1], camera[kP2], camera[kK3]);
    cv::Mat turn, way;
    cv::solvePnP(view.corners.board, view.corners.seen, matrixOf(camera), distortion, turn, way, false,
                 cv::SOLVEPNP_ITERATIVE);
    return poseOf(turn, way);
}

BundleState firstCamera(const std::vector<ViewObservations>& views, const ViewChoice& use, cv::Size camera,
                        const std::optional<double>& focal) {
    std::vector<double> starts = {0.6, 1.2, 2.4, 4.8};
    for (double& start : starts) start *= std::max(camera.width, camera.height);
    if (focal) starts.push_back(*focal); // one more: a guess that is off must not cost the others
    BundleOptions options;
    options.camera = firstMask();
    options.projectorPoints = false;
    options.cameraSigma = 0.5;
    BestStart best;
    for (const double start : starts) {
        BundleState state;
        state.board = flatBoard(views);
        state.camera = plainLens(start, 0.5 * (camera.width - 1), 0.5 * (camera.height - 1));
        state.cameraFromBoard.resize(views.size());
        for (const int v : use)
            state.cameraFromBoard[static_cast<std::size_t>(v)] =
                poseFromCamera(views[static_cast<std::size_t>(v)], state.camera);
        const double cost = refine(views, use, options, state);
        best.offer(state, cost);
    }
    if (!best.found())
        throw CaptureRefused({Cause::modelDoesNotFit, "", "", "no camera explains where the board was seen",
                              "check that the board is the one that was named"});
    return best.state();
}

void addFirstProjector(const std::vector<ViewObservations>& views, const ViewChoice& use, cv::Size projector,
                       const std::optional<double>& focal, BundleState& state) {
    const LitPoints lit = litPoints(views, use, state);
    BundleOptions options;
    options.projector = firstMask();
    options.poses = false;
    options.projectorSigma = 2.0;
    options.most = kPointsOfView;
    BestStart best;
    const auto tryStart = [&](BundleState start) {
        const double cost = refine(views, use, options, start);
        best.offer(start, cost);
    };
    BundleState linear = state;
    if (decompose(projectionOf(lit), lit, linear)) tryStart(linear);
    std::vector<double> focals = {1.0 * projector.width, 2.0 * projector.width};
    if (focal) focals.push_back(*focal);
    for (const double start : focals)
        for (const double shift : {0.5, 1.1, -0.1}) { // where the principal point lies, of the height
            BundleState guess = state;
            guess.projector = plainLens(start, 0.5 * projector.width, shift * projector.height);
            cv::Mat turn, way;
            if (!cv::solvePnP(lit.points, lit.pixels, matrixOf(guess.projector), cv::noArray(), turn, way, false,
                              cv::SOLVEPNP_SQPNP))
                continue;
            guess.projectorFromCamera = poseOf(turn, way);
            tryStart(guess);
        }
    if (!best.found())
        throw CaptureRefused({Cause::modelDoesNotFit, "", "", "no projector explains the patterns on the boards",
                              "check the projector's size and the order of the images"});
    state = best.state();
}

} // namespace lumorph

#include "calibration/doctor/alternatives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <Eigen/Dense>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

namespace lumorph {

namespace {

constexpr std::size_t kPointsOfView = 250; // that are used
constexpr double kRobustLoss = 3.0;        // standard deviations
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// What the causes do, one number each: of the whole capture.
enum CommonParameter {
    kSkew,       ///< of the projector: columns that its rows add
    kBendAcross, ///< height of the board at its edge, its unit
    kBendTwist,
    kBendDown,
    kBoardAspect, ///< by which its squares are too high
    kColumnSine,  ///< projector pixels that a gamma adds, by the phase
    kColumnCosine,
    kRowSine,
    kRowCosine,
    kCommonParameters
};
using Common = std::array<double, kCommonParameters>;

/// The board's outline, for heights over it.
struct BoardExtent {
    double middleX = 0.0, middleY = 0.0, halfX = 1.0, halfY = 1.0;

    template <typename T> T height(const T* common, const T& x, const T& y) const {
        const T u = (x - middleX) / halfX;
        const T v = (y - middleY) / halfY;
        return common[kBendAcross] * u * u + common[kBendTwist] * u * v + common[kBendDown] * v * v;
    }
};

/// A camera lens refocused by a share.
template <typename T> std::array<T, kLensParameters> refocused(const T* lens, const T* share) {
    std::array<T, kLensParameters> changed;
    std::copy(lens, lens + kLensParameters, changed.begin());
    changed[kFocalLength] *= T(1.0) + share[0];
    return changed;
}

struct AlternativeCorner {
    cv::Point3d board;
    cv::Point2d seen;
    BoardExtent extent;
    double weight = 1.0;

    template <typename T>
    bool operator()(const T* lens, const T* pose, const T* common, const T* focus, T* error) const {
        const T x(board.x);
        const T y = T(board.y) * (T(1.0) + common[kBoardAspect]);
        const T point[3] = {x, y, extent.height(common, T(board.x), T(board.y))};
        T inCamera[3], pixel[2];
        ceres::AngleAxisRotatePoint(pose, point, inCamera);
        for (int i = 0; i < 3; ++i) inCamera[i] += pose[3 + i];
        if (inCamera[2] < T(1e-9)) return false;
        projectPoint(refocused(lens, focus).data(), inCamera, pixel);
        error[0] = T(weight) * (pixel[0] - T(seen.x));
        error[1] = T(weight) * (pixel[1] - T(seen.y));
        return true;
    }
};

struct AlternativeTransfer {
    ProjectorPoint seen;
    BoardExtent extent;
    double weight = 1.0;
    std::array<double, 4> ripple{}; ///< sine and cosine by which gamma bends columns, then rows

    template <typename T>
    bool operator()(const T* camera, const T* pose, const T* rig, const T* projector, const T* common, const T* focus,
                    T* error) const {
        T way[3];
        directionOfPixel<T>(refocused(camera, focus).data(), seen.camera.x, seen.camera.y, way[0], way[1]);
        way[2] = T(1.0);
        // In the board's frame.
        const T back[3] = {-pose[0], -pose[1], -pose[2]};
        const T away[3] = {-pose[3], -pose[4], -pose[5]};
        T from[3], along[3];
        ceres::AngleAxisRotatePoint(back, away, from);
        ceres::AngleAxisRotatePoint(back, way, along);
        T depth = -from[2] / along[2];
        for (int i = 0; i < 3; ++i) // onto the bent sheet
            depth =
                (extent.height(common, from[0] + depth * along[0], from[1] + depth * along[1]) - from[2]) / along[2];
        const T inCamera[3] = {depth * way[0], depth * way[1], depth};
        T inProjector[3];
        ceres::AngleAxisRotatePoint(rig, inCamera, inProjector);
        for (int i = 0; i < 3; ++i) inProjector[i] += rig[3 + i];
        T x, y;
        distort<T>(projector, inProjector[0] / inProjector[2], inProjector[1] / inProjector[2], x, y);
        const T column = projector[kPrincipalX] + projector[kFocalLength] * (x + common[kSkew] * y);
        const T row = projector[kPrincipalY] + projector[kFocalLength] * projector[kAspect] * y;
        error[0] = T(weight) *
                   (column + common[kColumnSine] * ripple[0] + common[kColumnCosine] * ripple[1] - T(seen.projector.x));
        error[1] =
            T(weight) * (row + common[kRowSine] * ripple[2] + common[kRowCosine] * ripple[3] - T(seen.projector.y));
        return ceres::isfinite(error[0]) && ceres::isfinite(error[1]);
    }
};

/// The finest phases of an axis: how often gamma's ripple repeats over the projector's length.
double ripplesOf(const CaptureOrder& order, PatternAxis axis) {
    int periods = 0;
    int steps = 0;
    for (const PatternImage& image : order.images)
        if (const auto* phase = std::get_if<PhaseStep>(&image); phase != nullptr && phase->axis == axis)
            if (phase->periods > periods) periods = phase->periods, steps = phase->steps;
    return static_cast<double>(periods) * steps;
}

/// All that is solved for under one cause.
struct AlternativeState {
    BundleState bundle;
    Common common{};
    std::vector<double> focus; ///< of each view
    double squares = 0.0;      ///< of all errors, in standard deviations
};

/// Which numbers a cause sets free.
struct Freedom {
    std::vector<int> common;
    bool projectorAspect = false;
    bool focus = false;
};

class AlternativeSolver {
public:
    AlternativeSolver(const std::vector<ViewObservations>& views, const ProcamCalibration& result,
                      const CaptureOrder& order)
        : views_(views), result_(result), order_(order), extent_(extentOf(views)) {
        cameraSigma_ = std::max(0.02, result.camera.rms / std::numbers::sqrt2);
        projectorSigma_ = std::max(0.02, result.projector.rms / std::numbers::sqrt2);
    }

    [[nodiscard]] const BoardExtent& extent() const { return extent_; }

    [[nodiscard]] AlternativeState solve(const Freedom& freedom) const {
        AlternativeState state{result_.state, {}, std::vector<double>(views_.size(), 0.0), 0.0};
        ceres::Problem problem;
        addTo(problem, state, freedom);
        ceres::Solver::Options how;
        how.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
        how.max_num_iterations = 60;
        how.function_tolerance = 1e-7;
        how.logging_type = ceres::SILENT;
        how.num_threads = 2;
        ceres::Solver::Summary summary;
        ceres::Solve(how, &problem, &summary);
        ceres::Problem::EvaluateOptions plain;
        plain.apply_loss_function = true;
        double cost = 0.0;
        problem.Evaluate(plain, &cost, nullptr, nullptr, nullptr);
        state.squares = 2.0 * cost;
        return state;
    }

private:
    static BoardExtent extentOf(const std::vector<ViewObservations>& views) {
        double left = 1e300;
        double right = -1e300;
        double top = 1e300;
        double bottom = -1e300;
        for (const ViewObservations& view : views)
            for (const cv::Point3d& point : view.corners.board) {
                left = std::min(left, point.x);
                right = std::max(right, point.x);
                top = std::min(top, point.y);
                bottom = std::max(bottom, point.y);
            }
        return {0.5 * (left + right), 0.5 * (top + bottom), 0.5 * (right - left), 0.5 * (bottom - top)};
    }

    static void hold(ceres::Problem& problem, double* block, int size, const std::vector<bool>& free) {
        std::vector<int> held;
        for (int i = 0; i < size; ++i)
            if (!free[static_cast<std::size_t>(i)]) held.push_back(i);
        problem.AddParameterBlock(block, size);
        if (static_cast<int>(held.size()) == size)
            problem.SetParameterBlockConstant(block);
        else if (!held.empty())
            problem.SetManifold(block, new ceres::SubsetManifold(size, held));
    }

    void addTo(ceres::Problem& problem, AlternativeState& state, const Freedom& freedom) const {
        std::vector<bool> camera(result_.camera.free.begin(), result_.camera.free.end());
        std::vector<bool> projector(result_.projector.free.begin(), result_.projector.free.end());
        camera[kPrincipalX] = camera[kPrincipalY] = true;
        projector[kAspect] = projector[kAspect] || freedom.projectorAspect;
        hold(problem, state.bundle.camera.data(), kLensParameters, camera);
        hold(problem, state.bundle.projector.data(), kLensParameters, projector);
        std::vector<bool> common(kCommonParameters, false);
        for (const int i : freedom.common) common[static_cast<std::size_t>(i)] = true;
        hold(problem, state.common.data(), kCommonParameters, common);
        const double columns = ripplesOf(order_, PatternAxis::columns);
        const double rows = ripplesOf(order_, PatternAxis::rows);
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const ViewObservations& view = views_[v];
            double* pose = state.bundle.cameraFromBoard[v].data();
            double* focus = &state.focus[v];
            problem.AddParameterBlock(focus, 1);
            if (!freedom.focus || v == 0) problem.SetParameterBlockConstant(focus);
            for (std::size_t i = 0; i < view.corners.seen.size(); ++i)
                problem.AddResidualBlock(
                    new ceres::AutoDiffCostFunction<AlternativeCorner, 2, kLensParameters, 6, kCommonParameters, 1>(
                        new AlternativeCorner{view.corners.board[i], view.corners.seen[i], extent_,
                                              1.0 / cameraSigma_}),
                    new ceres::HuberLoss(kRobustLoss), state.bundle.camera.data(), pose, state.common.data(), focus);
            const std::size_t count = view.projector.size();
            const std::size_t used = std::min(count, kPointsOfView);
            for (std::size_t i = 0; i < used; ++i) {
                const ProjectorPoint& point = view.projector[i * count / used];
                const double c = kTwoPi * columns * (point.projector.x + 0.5) / order_.projector.width;
                const double r = kTwoPi * rows * (point.projector.y + 0.5) / order_.projector.height;
                problem.AddResidualBlock(
                    new ceres::AutoDiffCostFunction<AlternativeTransfer, 2, kLensParameters, 6, 6, kLensParameters,
                                                    kCommonParameters, 1>(new AlternativeTransfer{
                        point, extent_, 1.0 / projectorSigma_, {std::sin(c), std::cos(c), std::sin(r), std::cos(r)}}),
                    new ceres::HuberLoss(kRobustLoss), state.bundle.camera.data(), pose,
                    state.bundle.projectorFromCamera.data(), state.bundle.projector.data(), state.common.data(), focus);
            }
        }
    }

    const std::vector<ViewObservations>& views_;
    const ProcamCalibration& result_;
    const CaptureOrder& order_;
    BoardExtent extent_;
    double cameraSigma_ = 1.0, projectorSigma_ = 1.0;
};

std::string number(double value, int digits) {
    char text[48];
    std::snprintf(text, sizeof(text), "%.*f", digits, value);
    return text;
}

/// A place in an image and the error there.
struct PlacedError {
    cv::Point2d place, error;
    int view = 0;
};

/// Smooth fields over an image: products of cosines, the lowest aside.
constexpr int kWaves = 5; // along each side
Eigen::VectorXd wavesAt(const cv::Point2d& place, cv::Size size) {
    Eigen::VectorXd waves(kWaves * kWaves);
    for (int row = 0; row < kWaves; ++row)
        for (int column = 0; column < kWaves; ++column)
            waves[row * kWaves + column] = std::cos(std::numbers::pi * column * (place.x + 0.5) / size.width) *
                                           std::cos(std::numbers::pi * row * (place.y + 0.5) / size.height);
    return waves;
}

/// How much of the errors of each view a field over the image explains that was fitted to the others. At most 0 where
/// errors have nothing to do with the place.
double fieldShare(const std::vector<PlacedError>& errors, cv::Size size, int views) {
    constexpr int kCount = kWaves * kWaves;
    std::vector<Eigen::MatrixXd> normals(static_cast<std::size_t>(views), Eigen::MatrixXd::Zero(kCount, kCount));
    std::vector<Eigen::MatrixXd> sums(static_cast<std::size_t>(views), Eigen::MatrixXd::Zero(kCount, 2));
    for (const PlacedError& at : errors) {
        const Eigen::VectorXd waves = wavesAt(at.place, size);
        const auto v = static_cast<std::size_t>(at.view);
        normals[v] += waves * waves.transpose();
        sums[v] += waves * Eigen::RowVector2d(at.error.x, at.error.y);
    }
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kCount, kCount);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(kCount, 2);
    for (std::size_t v = 0; v < normals.size(); ++v) normal += normals[v], sum += sums[v];
    const double ridge = 1e-3 * normal.trace() / kCount;
    std::vector<Eigen::MatrixXd> fields;
    for (std::size_t v = 0; v < normals.size(); ++v)
        fields.push_back(
            (normal - normals[v] + ridge * Eigen::MatrixXd::Identity(kCount, kCount)).ldlt().solve(sum - sums[v]));
    double before = 0.0;
    double after = 0.0;
    for (const PlacedError& at : errors) {
        const Eigen::Vector2d error(at.error.x, at.error.y);
        const Eigen::Vector2d field = fields[static_cast<std::size_t>(at.view)].transpose() * wavesAt(at.place, size);
        before += error.squaredNorm();
        after += (error - field).squaredNorm();
    }
    return before > 0.0 ? 1.0 - after / before : 0.0;
}

Alternative strangeLens(const std::vector<ViewObservations>& views, const ProcamCalibration& result) {
    std::vector<PlacedError> camera, projector;
    for (std::size_t v = 0; v < views.size(); ++v) {
        const ViewObservations& view = views[v];
        const auto corners = cameraErrors(view, result.state, result.state.cameraFromBoard[v]);
        for (std::size_t i = 0; i < corners.size(); ++i)
            camera.push_back({view.corners.seen[i], corners[i], static_cast<int>(v)});
        const auto points = projectorErrors(view, result.state, result.state.cameraFromBoard[v]);
        for (std::size_t i = 0; i < points.size(); ++i)
            projector.push_back({view.projector[i].projector, points[i], static_cast<int>(v)});
    }
    const auto count = static_cast<int>(views.size());
    const double inCamera = fieldShare(camera, result.camera.size, count);
    const double inProjector = fieldShare(projector, result.projector.size, count);
    const bool isCamera = inCamera * result.camera.rms > inProjector * result.projector.rms;
    const double rms = isCamera ? result.camera.rms : result.projector.rms;
    const double share = std::max(0.0, isCamera ? inCamera : inProjector);
    constexpr double kBearable = 0.12; // pixels
    const double field = rms * std::sqrt(share);
    return {Cause::strangeLens, field / kBearable, share, "",
            std::string("the ") + (isCamera ? "camera" : "projector") + "'s lens bends its picture by " +
                number(field, 2) + " pixels in a way that no radial or tangential distortion has"};
}

/// The pose at which focal lengths change most.
std::size_t changeOf(const std::vector<double>& focus) {
    std::size_t at = 1;
    double most = 0.0;
    for (std::size_t i = 1; i < focus.size(); ++i) {
        double before = 0.0;
        double after = 0.0;
        for (std::size_t k = 0; k < i; ++k) before += focus[k] / static_cast<double>(i);
        for (std::size_t k = i; k < focus.size(); ++k) after += focus[k] / static_cast<double>(focus.size() - i);
        if (std::abs(after - before) > most) most = std::abs(after - before), at = i;
    }
    return at;
}

double spreadOfFocus(const std::vector<double>& focus) {
    const auto [least, most] = std::ranges::minmax(focus);
    return most - least;
}

bool hasPhases(const CaptureOrder& order) { return ripplesOf(order, PatternAxis::columns) > 0.0; }

} // namespace

std::vector<Alternative> alternativesOf(const std::vector<ViewObservations>& views, const ProcamCalibration& result,
                                        const CaptureOrder& order, const Progress& progress) {
    const AlternativeSolver solver(views, result, order);
    const double before = solver.solve({}).squares;
    std::vector<Alternative> all;
    const auto add = [&](Cause cause, const AlternativeState& state, double amount, const std::string& words,
                         const std::string& view = "") {
        all.push_back({cause, amount, 1.0 - state.squares / before, view, words});
        progress.throwIfCancelled();
        progress.report(static_cast<double>(all.size()) / 7.0, "comparing causes");
    };
    constexpr double kSquarePixels = 0.015; // by which a projector's may differ
    constexpr double kStraight = 0.002;     // skew
    constexpr double kSquareSquares = 0.003;
    constexpr double kSteadyFocus = 0.003;
    constexpr double kFlatBoard = 0.004; // of half its diagonal
    constexpr double kRipple = 0.15;     // projector pixels

    const AlternativeState stretched = solver.solve({{}, true, false});
    const double aspect = stretched.bundle.projector[kAspect];
    add(Cause::projectorSize, stretched, std::abs(aspect - 1.0) / kSquarePixels,
        "the projector's pixels would be " + number(aspect, 3) +
            " times as high as wide: its picture is stretched, or its size is not as said");
    const AlternativeState warped = solver.solve({{kSkew}, true, false});
    const double skew = warped.common[kSkew];
    add(Cause::keystone, warped, std::abs(skew) / kStraight,
        "the projector's picture is skewed by " + number(100.0 * std::abs(skew), 1) +
            " %: a keystone correction or scaling is on");
    const BoardExtent& extent = solver.extent();
    const AlternativeState bent = solver.solve({{kBendAcross, kBendTwist, kBendDown}, false, false});
    const double height = std::max(
        {std::abs(bent.common[kBendAcross]), std::abs(bent.common[kBendTwist]), std::abs(bent.common[kBendDown])});
    add(Cause::boardWarped, bent, height / (kFlatBoard * std::hypot(extent.halfX, extent.halfY)),
        "the board is bent by " + number(height, 2) + " of its units between middle and edge");
    const AlternativeState high = solver.solve({{kBoardAspect}, false, false});
    add(Cause::squareSize, high, std::abs(high.common[kBoardAspect]) / kSquareSquares,
        "the board's squares are " + number(100.0 * std::abs(high.common[kBoardAspect]), 1) +
            (high.common[kBoardAspect] > 0.0 ? " % higher than wide" : " % wider than high"));
    const AlternativeState focused = solver.solve({{}, false, true});
    add(Cause::cameraRefocused, focused, spreadOfFocus(focused.focus) / kSteadyFocus,
        "the camera's focal length differs by " + number(100.0 * spreadOfFocus(focused.focus), 1) + " % between poses",
        views[changeOf(focused.focus)].name);
    if (hasPhases(order)) {
        const AlternativeState rippled =
            solver.solve({{kColumnSine, kColumnCosine, kRowSine, kRowCosine}, false, false});
        const double ripple = std::max(std::hypot(rippled.common[kColumnSine], rippled.common[kColumnCosine]),
                                       std::hypot(rippled.common[kRowSine], rippled.common[kRowCosine]));
        add(Cause::projectorGamma, rippled, ripple / kRipple,
            "phases are bent by " + number(ripple, 2) + " pixels in the rhythm of the steps: the projector's gamma");
    }
    all.push_back(strangeLens(views, result));
    std::ranges::sort(all, std::greater<>(), &Alternative::explained);
    return all;
}

std::optional<Finding> explanationOf(const std::vector<Alternative>& alternatives) {
    (void)alternatives;
    return std::nullopt;
}

} // namespace lumorph

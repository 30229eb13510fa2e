#include "calibration/doctor/alternatives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <numeric>

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "calibration/solve/first_guess.h"

namespace lumorph {

namespace {

constexpr std::size_t kPointsOfView = 250; // that are used
constexpr std::size_t kPointsForFields = 120;
constexpr double kSigma = 0.1;      // pixels, of sound observations: what is above calls for an explanation
constexpr double kRobustLoss = 3.0; // standard deviations
constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kExplains = 0.35; // of the squares of errors that a cause must take away
constexpr double kSureMove = 12.0; // standard deviations, the best of several trials
constexpr double kAsGood = 1.3;    // times the squares that remain: a cause with fewer numbers is as likely
constexpr double kRefused = 2.0;   // times what is bearable: above, a capture is refused
constexpr double kNoise = 0.3;     // pixels: errors that need no explanation
constexpr double kLost = 5.0;      // pixels: above, the camera was not found at all
constexpr double kOutright = 0.5;  // of the squares, where nothing is known of the camera
// No lens makes a projector's pixels askew, so that little tells: other terms may have made up for most of the errors.
constexpr double kSomeSkew = 0.3; // of what is bearable
constexpr double kSureSkew = 8.0; // standard deviations

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

constexpr int kWaves = 12; ///< cosines over an image, beyond shift and tilt
using Waves = std::array<double, kWaves>;
using Field = std::array<double, 2 * kWaves>; ///< of columns, then of rows; pixels

Waves wavesAt(const cv::Point2d& place, cv::Size size) {
    Waves waves{};
    std::size_t i = 0;
    for (int row = 0; row <= 4; ++row)
        for (int column = 0; column + row <= 4; ++column)
            if (column + row > 1)
                waves[i++] = std::cos(std::numbers::pi * column * (place.x + 0.5) / size.width) *
                             std::cos(std::numbers::pi * row * (place.y + 0.5) / size.height);
    return waves;
}

/// A lens whose picture is moved by a field, here by `waves`.
template <typename T> void moveBy(const T* field, const Waves& waves, T* lens) {
    for (int i = 0; i < kWaves; ++i) {
        lens[kPrincipalX] += field[i] * waves[static_cast<std::size_t>(i)];
        lens[kPrincipalY] += field[kWaves + i] * waves[static_cast<std::size_t>(i)];
    }
}

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
    Waves waves{};

    template <typename T>
    bool operator()(const T* lens, const T* pose, const T* common, const T* focus, const T* field, T* error) const {
        std::array<T, kLensParameters> moved;
        std::copy(lens, lens + kLensParameters, moved.begin());
        moveBy(field, waves, moved.data());
        return (*this)(moved.data(), pose, common, focus, error);
    }

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
    Waves cameraWaves{}, projectorWaves{};

    template <typename T>
    bool operator()(const T* camera, const T* pose, const T* rig, const T* projector, const T* common, const T* focus,
                    const T* cameraField, const T* projectorField, T* error) const {
        std::array<T, kLensParameters> one, other;
        std::copy(camera, camera + kLensParameters, one.begin());
        std::copy(projector, projector + kLensParameters, other.begin());
        moveBy(cameraField, cameraWaves, one.data());
        moveBy(projectorField, projectorWaves, other.data());
        return (*this)(one.data(), pose, rig, other.data(), common, focus, error);
    }

    template <typename T>
    bool operator()(const T* camera, const T* pose, const T* rig, const T* projector, const T* common, const T* focus,
                    T* error) const {
        const T still[6] = {T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
        return (*this)(camera, pose, rig, projector, common, focus, still, error);
    }

    /// `moved`: from the camera's frame of this view to that of those before it.
    template <typename T>
    bool operator()(const T* camera, const T* pose, const T* rig, const T* projector, const T* common, const T* focus,
                    const T* moved, T* error) const {
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
        const T seenThere[3] = {depth * way[0], depth * way[1], depth};
        T inCamera[3], inProjector[3];
        ceres::AngleAxisRotatePoint(moved, seenThere, inCamera);
        for (int i = 0; i < 3; ++i) inCamera[i] += moved[3 + i];
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
    Field cameraField{}, projectorField{};
    PoseVector moved{};   ///< of the camera, in views that are said to have it elsewhere
    double squares = 0.0; ///< of all errors, in standard deviations
};

/// Which numbers a cause sets free.
struct Freedom {
    std::vector<int> common{};
    bool projectorAspect = false;
    bool focus = false;
    bool cameraField = false;
    bool projectorField = false;
    std::vector<bool> moved{}; ///< views in which the camera stands elsewhere than in the others; empty: none
};

class AlternativeSolver {
public:
    AlternativeSolver(const std::vector<ViewObservations>& views, const ProcamCalibration& result,
                      const CaptureOrder& order)
        : views_(views), result_(result), order_(order), extent_(extentOf(views)) {}

    [[nodiscard]] const BoardExtent& extent() const { return extent_; }

    /// How many coordinates of errors are independent of their neighbours.
    [[nodiscard]] double independentErrors() const {
        double count = 0.0;
        for (const ViewObservations& view : views_)
            count += static_cast<double>(view.corners.seen.size()) * result_.bundle.independentCorners +
                     static_cast<double>(pointsOf(view, kPointsOfView)) * result_.bundle.independentPoints;
        return 2.0 * count;
    }

    [[nodiscard]] AlternativeState solve(const Freedom& freedom) const {
        AlternativeState state{result_.state, {}, std::vector<double>(views_.size(), 0.0), {}, {}, {}, 0.0};
        // Real lenses have square pixels: what a model has made of other faults is taken back.
        state.bundle.camera[kAspect] = 1.0;
        if (!freedom.projectorAspect) state.bundle.projector[kAspect] = 1.0;
        ceres::Problem problem;
        addTo(problem, state, freedom);
        ceres::Solver::Options how;
        how.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
        how.max_num_iterations = 40;
        how.function_tolerance = 1e-5;
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

    /// How many of a view's projector points are used; none where there is no projector.
    [[nodiscard]] std::size_t pointsOf(const ViewObservations& view, std::size_t most) const {
        return result_.projector.size.empty() ? 0 : std::min(view.projector.size(), most);
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
        camera[kAspect] = false;
        projector[kAspect] = freedom.projectorAspect;
        hold(problem, state.bundle.camera.data(), kLensParameters, camera);
        hold(problem, state.bundle.projector.data(), kLensParameters, projector);
        std::vector<bool> common(kCommonParameters, false);
        for (const int i : freedom.common) common[static_cast<std::size_t>(i)] = true;
        hold(problem, state.common.data(), kCommonParameters, common);
        if (freedom.cameraField || freedom.projectorField) {
            hold(problem, state.cameraField.data(), 2 * kWaves, std::vector<bool>(2 * kWaves, freedom.cameraField));
            hold(problem, state.projectorField.data(), 2 * kWaves,
                 std::vector<bool>(2 * kWaves, freedom.projectorField));
        }
        for (std::size_t v = 0; v < views_.size(); ++v) {
            const ViewObservations& view = views_[v];
            double* focus = &state.focus[v];
            problem.AddParameterBlock(focus, 1);
            if (!freedom.focus || v == 0) problem.SetParameterBlockConstant(focus);
            for (std::size_t i = 0; i < view.corners.seen.size(); ++i) addCorner(problem, state, freedom, v, i);
            const std::size_t count = view.projector.size();
            const std::size_t used =
                pointsOf(view, freedom.cameraField || freedom.projectorField ? kPointsForFields : kPointsOfView);
            for (std::size_t i = 0; i < used; ++i) addPoint(problem, state, freedom, v, i * count / used);
        }
    }

    void addCorner(ceres::Problem& problem, AlternativeState& state, const Freedom& freedom, std::size_t v,
                   std::size_t i) const {
        const BoardPoints& points = views_[v].corners;
        auto* corner = new AlternativeCorner{points.board[i], points.seen[i], extent_, 1.0 / kSigma, {}};
        double* pose = state.bundle.cameraFromBoard[v].data();
        auto* loss = new ceres::HuberLoss(kRobustLoss);
        if (!freedom.cameraField) {
            problem.AddResidualBlock(
                new ceres::AutoDiffCostFunction<AlternativeCorner, 2, kLensParameters, 6, kCommonParameters, 1>(corner),
                loss, state.bundle.camera.data(), pose, state.common.data(), &state.focus[v]);
            return;
        }
        corner->waves = wavesAt(points.seen[i], result_.camera.size);
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<AlternativeCorner, 2, kLensParameters, 6, kCommonParameters, 1, 2 * kWaves>(
                corner),
            loss, state.bundle.camera.data(), pose, state.common.data(), &state.focus[v], state.cameraField.data());
    }

    void addPoint(ceres::Problem& problem, AlternativeState& state, const Freedom& freedom, std::size_t v,
                  std::size_t i) const {
        const ProjectorPoint& seen = views_[v].projector[i];
        const double c =
            kTwoPi * ripplesOf(order_, PatternAxis::columns) * (seen.projector.x + 0.5) / order_.projector.width;
        const double r =
            kTwoPi * ripplesOf(order_, PatternAxis::rows) * (seen.projector.y + 0.5) / order_.projector.height;
        auto* point = new AlternativeTransfer{
            seen, extent_, 1.0 / kSigma, {std::sin(c), std::cos(c), std::sin(r), std::cos(r)}, {}, {}};
        double* pose = state.bundle.cameraFromBoard[v].data();
        auto* loss = new ceres::HuberLoss(kRobustLoss);
        if (!freedom.moved.empty() && freedom.moved[v]) {
            problem.AddResidualBlock(new ceres::AutoDiffCostFunction<AlternativeTransfer, 2, kLensParameters, 6, 6,
                                                                     kLensParameters, kCommonParameters, 1, 6>(point),
                                     loss, state.bundle.camera.data(), pose, state.bundle.projectorFromCamera.data(),
                                     state.bundle.projector.data(), state.common.data(), &state.focus[v],
                                     state.moved.data());
            return;
        }
        if (!freedom.cameraField && !freedom.projectorField) {
            problem.AddResidualBlock(new ceres::AutoDiffCostFunction<AlternativeTransfer, 2, kLensParameters, 6, 6,
                                                                     kLensParameters, kCommonParameters, 1>(point),
                                     loss, state.bundle.camera.data(), pose, state.bundle.projectorFromCamera.data(),
                                     state.bundle.projector.data(), state.common.data(), &state.focus[v]);
            return;
        }
        point->cameraWaves = wavesAt(seen.camera, result_.camera.size);
        point->projectorWaves = wavesAt(seen.projector, result_.projector.size);
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<AlternativeTransfer, 2, kLensParameters, 6, 6, kLensParameters,
                                            kCommonParameters, 1, 2 * kWaves, 2 * kWaves>(point),
            loss, state.bundle.camera.data(), pose, state.bundle.projectorFromCamera.data(),
            state.bundle.projector.data(), state.common.data(), &state.focus[v], state.cameraField.data(),
            state.projectorField.data());
    }

    const std::vector<ViewObservations>& views_;
    const ProcamCalibration& result_;
    const CaptureOrder& order_;
    BoardExtent extent_;
};

std::string number(double value, int digits) {
    char text[48];
    std::snprintf(text, sizeof(text), "%.*f", digits, value);
    return text;
}

/// Root mean square of what a field does at the places where light was seen, without what a shift does; pixels.
double strengthOf(const Field& field, const std::vector<cv::Point2d>& places, cv::Size size) {
    std::vector<cv::Point2d> moves;
    cv::Point2d mean;
    for (const cv::Point2d& place : places) {
        std::array<double, kLensParameters> lens{};
        moveBy(field.data(), wavesAt(place, size), lens.data());
        moves.emplace_back(lens[kPrincipalX], lens[kPrincipalY]);
        mean += moves.back() / static_cast<double>(places.size());
    }
    for (cv::Point2d& move : moves) move -= mean;
    return rmsOf(moves);
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

/// What each cause does when a capture is solved with it.
class CauseTrials {
public:
    CauseTrials(const std::vector<ViewObservations>& views, const ProcamCalibration& result, const CaptureOrder& order,
                const Progress& progress)
        : views_(views), result_(result), order_(order), progress_(progress), solver_(views, result, order),
          before_(solver_.solve({}).squares) {}

    /// Squares of all errors without any cause, in standard deviations.
    [[nodiscard]] double before() const { return before_; }

    std::vector<Alternative> all() {
        tryPicture();
        tryBoard();
        if (views_.size() >= kFewestForFocus) tryFocus();
        if (views_.size() >= kFewestForFocus) tryMotion();
        if (ripplesOf(order_, PatternAxis::columns) > 0.0) tryGamma();
        std::ranges::sort(all_, std::greater<>(), &Alternative::explained);
        return std::move(all_);
    }

    /// Those that boards in a camera alone can have.
    std::vector<Alternative> ofCamera() {
        tryBoard();
        if (views_.size() >= kFewestForFocus) tryFocus();
        return std::move(all_);
    }

    /// A lens that may bend its picture in any smooth way explains much; it is for what nothing else does.
    Alternative anyLens() {
        const AlternativeState camera = solver_.solve({.cameraField = true});
        const AlternativeState projector = solver_.solve({.projectorField = true});
        const bool isCamera = camera.squares < projector.squares;
        std::vector<cv::Point2d> places;
        for (const ViewObservations& view : views_) {
            if (isCamera) places.insert(places.end(), view.corners.seen.begin(), view.corners.seen.end());
            if (!isCamera)
                for (const ProjectorPoint& point : view.projector) places.push_back(point.projector);
        }
        const std::string name = isCamera ? "camera" : "projector";
        const double strength = isCamera ? strengthOf(camera.cameraField, places, result_.camera.size)
                                         : strengthOf(projector.projectorField, places, result_.projector.size);
        add(Cause::strangeLens, isCamera ? camera : projector, strength / kSmoothLens,
            "the " + name + "'s lens bends its picture by about " + number(strength, 1) +
                " pixels in a way that no radial or tangential distortion has",
            "use another lens, or keep to the middle of its picture; a mirror or a pane in the way does the same");
        return all_.back();
    }

private:
    static constexpr double kSquarePixels = 0.015; // by which a projector's may differ
    static constexpr double kStraight = 0.003;     // skew
    static constexpr double kSquareSquares = 0.003;
    static constexpr double kSteadyFocus = 0.003;
    static constexpr double kMostFocus = 0.3;
    static constexpr std::size_t kMostTrials = 10;
    static constexpr double kMostTurn = 30.0;    // degrees: more is no bump, the solution was lost
    static constexpr double kSteadyLight = 0.25; // projector pixels by which a moved camera shifts it
    /// With three poses each may have the focal length that its noise likes, at another distance.
    static constexpr std::size_t kFewestForFocus = 4;
    static constexpr double kFlatBoard = 0.004; // of half its diagonal
    static constexpr double kRipple = 0.15;     // projector pixels
    static constexpr double kSmoothLens = 0.3;  // pixels

    void add(Cause cause, const AlternativeState& state, double amount, const std::string& words,
             const std::string& remedy, const std::string& view = "") {
        all_.push_back({cause, amount, 1.0 - state.squares / before_, sigmasOf(state, before_), view, words, remedy});
        progress_.throwIfCancelled();
        progress_.report(static_cast<double>(all_.size()) / 8.0, "comparing causes");
    }

    /// By how many standard deviations a state is better than one that leaves so many squares.
    [[nodiscard]] double sigmasOf(const AlternativeState& state, double without) const {
        return std::sqrt(solver_.independentErrors() * std::max(0.0, without / state.squares - 1.0));
    }

    void tryPicture() {
        const AlternativeState stretched = solver_.solve({.projectorAspect = true});
        const double aspect = stretched.bundle.projector[kAspect];
        const double shape = static_cast<double>(result_.projector.size.width) / result_.projector.size.height;
        const double turned = std::abs(std::log(aspect) / (2.0 * std::log(shape)));
        const bool isTurned = std::abs(turned - 1.0) < 0.15 && std::abs(shape - 1.0) > 0.05;
        add(isTurned ? Cause::widthHeightSwapped : Cause::projectorSize, stretched,
            std::abs(aspect - 1.0) / kSquarePixels,
            "the projector's pixels would be " + number(1.0 / aspect, 3) + " times as high as wide: " +
                (isTurned ? "width and height of the patterns are exchanged"
                          : "its picture is stretched, or its size is not as said"),
            isTurned ? "exchange width and height"
                     : "give the size that the patterns were made for, and let the projector show it pixel by pixel");
        const AlternativeState warped = solver_.solve({.common = {kSkew}, .projectorAspect = true});
        const double skew = std::abs(warped.common[kSkew]);
        add(Cause::keystone, warped, skew / kStraight,
            "the projector's picture is skewed by " + number(100.0 * skew, 1) +
                " %: it warps what it is sent, by a keystone correction or scaling",
            "switch off keystone, corner and zoom corrections in the projector, and capture again");
        all_.back().sigmas = sigmasOf(warped, stretched.squares); // the skew's own part
    }

    void tryBoard() {
        const BoardExtent& extent = solver_.extent();
        const AlternativeState bent = solver_.solve({.common = {kBendAcross, kBendTwist, kBendDown}});
        const double height = std::max(
            {std::abs(bent.common[kBendAcross]), std::abs(bent.common[kBendTwist]), std::abs(bent.common[kBendDown])});
        add(Cause::boardWarped, bent, height / (kFlatBoard * std::hypot(extent.halfX, extent.halfY)),
            "the board is not flat: it bends by " + number(height, 2) + " of its units from the middle to the edge",
            "fix the sheet to a flat plate, and capture again");
        const AlternativeState high = solver_.solve({.common = {kBoardAspect}});
        const double aspect = high.common[kBoardAspect];
        add(Cause::squareSize, high, std::abs(aspect) / kSquareSquares,
            "the board's squares are " + number(100.0 * std::abs(aspect), 1) +
                (aspect > 0.0 ? " % higher than wide" : " % wider than high"),
            "print the board without scaling, and measure its squares along both sides");
    }

    void tryFocus() {
        const AlternativeState focused = solver_.solve({.focus = true});
        const double spread = spreadOf(focused.focus);
        if (!(spread < kMostFocus)) return; // no autofocus does that: the solution was lost
        add(Cause::cameraRefocused, focused, spread / kSteadyFocus,
            "the camera's focal length differs by " + number(100.0 * spread, 1) + " % between poses",
            "switch off autofocus and zoom, touch neither between poses, and capture all again",
            views_[changeOf(focused.focus)].name);
    }

    /// The camera, or the projector, stands elsewhere in one pose, or from one on.
    void tryMotion() {
        const std::size_t count = views_.size();
        AlternativeState best;
        std::vector<bool> bestMoved;
        const auto attempt = [&](std::size_t from, std::size_t end) {
            std::vector<bool> moved(count, false);
            std::fill(moved.begin() + static_cast<std::ptrdiff_t>(from),
                      moved.begin() + static_cast<std::ptrdiff_t>(end), true);
            AlternativeState state = solver_.solve({.moved = moved});
            progress_.throwIfCancelled();
            if (bestMoved.empty() || state.squares < best.squares)
                best = std::move(state), bestMoved = std::move(moved);
        };
        // Of many poses the worst alone, and some of the places between them.
        std::vector<std::size_t> worst(count);
        std::iota(worst.begin(), worst.end(), std::size_t{0});
        std::ranges::stable_sort(worst, std::greater<>(), [this](std::size_t v) {
            if (v >= result_.views.size()) return 0.0; // a solution that was begun anew
            return result_.views[v].heldOut.value_or(result_.views[v].projectorRms);
        });
        for (std::size_t i = 0; i < std::min(count, kMostTrials); ++i) attempt(worst[i], worst[i] + 1);
        const std::size_t step = 1 + count / kMostTrials;
        for (std::size_t v = 2; v + 2 <= count; v += step) attempt(v, count);
        const double shift = shiftOf(best, bestMoved);
        const auto first = static_cast<std::size_t>(std::ranges::find(bestMoved, true) - bestMoved.begin());
        const bool isLater = std::ranges::count(bestMoved, true) > 1;
        const double turn = std::hypot(best.moved[0], best.moved[1], best.moved[2]) * 180.0 / std::numbers::pi;
        const double apart = std::hypot(best.moved[3], best.moved[4], best.moved[5]);
        if (!(turn < kMostTurn)) return;
        add(Cause::cameraMoved, best, shift / kSteadyLight,
            std::string("camera or projector stands elsewhere ") + (isLater ? "from this pose on" : "in this pose") +
                ", turned by " + number(turn, 2) + " degrees and " + number(apart, 1) + " units away: light moves by " +
                number(shift, 1) + " pixels",
            isLater ? "tighten both, and capture the poses before or after it again"
                    : "leave this pose out; tighten both, and capture it again",
            views_[first].name);
    }

    /// How far a moved camera shifts the light in the projector, root mean square over the views that have it, pixels.
    [[nodiscard]] double shiftOf(const AlternativeState& state, const std::vector<bool>& moved) const {
        const Rigid motion = Rigid::exp(state.moved);
        std::vector<cv::Point2d> shifts;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            if (!moved[v]) continue;
            const Rigid pose = Rigid::exp(state.bundle.cameraFromBoard[v]);
            for (const cv::Point3d& point : views_[v].corners.board) {
                const glm::dvec3 at = pose * glm::dvec3(point.x, point.y, point.z);
                const glm::dvec3 there = motion * at;
                shifts.push_back(projectorPixel({there.x, there.y, there.z}, state.bundle) -
                                 projectorPixel({at.x, at.y, at.z}, state.bundle));
            }
        }
        return rmsOf(shifts);
    }

    void tryGamma() {
        const AlternativeState rippled = solver_.solve({.common = {kColumnSine, kColumnCosine, kRowSine, kRowCosine}});
        const double ripple = std::max(std::hypot(rippled.common[kColumnSine], rippled.common[kColumnCosine]),
                                       std::hypot(rippled.common[kRowSine], rippled.common[kRowCosine]));
        add(Cause::projectorGamma, rippled, ripple / kRipple,
            "phases are bent by " + number(ripple, 2) + " pixels in the rhythm of the steps, as a gamma does",
            "set the projector's response to linear, use more steps (phase:16x8+1x8), or Gray code");
    }

    static double spreadOf(const std::vector<double>& focus) {
        const auto [least, most] = std::ranges::minmax(focus);
        return most - least;
    }

    const std::vector<ViewObservations>& views_;
    const ProcamCalibration& result_;
    const CaptureOrder& order_;
    const Progress& progress_;
    AlternativeSolver solver_;
    double before_;
    std::vector<Alternative> all_;
};

/// A camera of which nothing is known but a focal length, and the boards as it sees them.
ProcamCalibration cameraOfFocal(const std::vector<ViewObservations>& views, cv::Size size, double focal) {
    ProcamCalibration camera;
    camera.camera.size = size;
    for (const LensParameter free : {kFocalLength, kPrincipalX, kPrincipalY, kK1, kK2})
        camera.camera.free[static_cast<std::size_t>(free)] = true;
    camera.state.board = flatBoard(views);
    camera.state.camera = {focal, 1.0, 0.5 * (size.width - 1), 0.5 * (size.height - 1), 0.0, 0.0, 0.0, 0.0, 0.0};
    for (const ViewObservations& view : views)
        camera.state.cameraFromBoard.push_back(poseFromCamera(view, camera.state.camera));
    return camera;
}

constexpr std::array kFocalStarts = {0.6, 1.2, 2.4, 4.8}; ///< shares of a picture's longer side

/// Camera and projector begun anew, for where a solution got lost: of the camera's lens the focal length alone is taken
/// from the boards, since all else may have followed a fault.
ProcamCalibration begunAnew(const std::vector<ViewObservations>& views, cv::Size camera, cv::Size projector) {
    ViewChoice use(views.size());
    std::iota(use.begin(), use.end(), 0);
    BundleOptions focalAlone;
    focalAlone.camera[kFocalLength] = true;
    focalAlone.projectorPoints = false;
    ProcamCalibration best;
    double least = std::numeric_limits<double>::infinity();
    for (const double share : kFocalStarts) {
        ProcamCalibration start = cameraOfFocal(views, camera, share * std::max(camera.width, camera.height));
        const double cost = refine(views, use, focalAlone, start.state);
        if (cost < least) least = cost, best = std::move(start);
    }
    if (!std::isfinite(least)) best = cameraOfFocal(views, camera, std::max(camera.width, camera.height));
    best.projector.size = projector;
    best.projector.free = best.camera.free;
    addFirstProjector(views, use, projector, std::nullopt, best.state);
    return best;
}

} // namespace

std::optional<Finding> causeInCamera(const std::vector<ViewObservations>& views, cv::Size camera,
                                     const Progress& progress) {
    // From each focal length to begin with: where the plain camera ended, the others may not start.
    double plain = std::numeric_limits<double>::infinity();
    double least = plain;
    std::optional<Alternative> best;
    const CaptureOrder nothing; // trials keep a reference
    for (const double share : kFocalStarts) {
        const ProcamCalibration start = cameraOfFocal(views, camera, share * std::max(camera.width, camera.height));
        CauseTrials trials(views, start, nothing, progress);
        plain = std::min(plain, trials.before());
        for (const Alternative& by : trials.ofCamera()) {
            const double squares = (1.0 - by.explained) * trials.before();
            if (by.amount >= kRefused && squares < least) least = squares, best = by;
        }
    }
    if (!best || least > (1.0 - kOutright) * plain) return std::nullopt;
    return Finding{best->cause, best->view, "", best->words, best->remedy};
}

std::vector<Alternative> alternativesOf(const std::vector<ViewObservations>& views, const ProcamCalibration& result,
                                        const CaptureOrder& order, const Progress& progress) {
    return CauseTrials(views, result, order, progress).all();
}

std::optional<Explanation> explanationOf(const std::vector<ViewObservations>& views, const ProcamCalibration& result,
                                         const CaptureOrder& order, const Progress& progress) {
    if (result.camera.rms > kLost) {
        if (const auto cause = causeInCamera(views, result.camera.size, progress)) return Explanation{*cause};
        const ProcamCalibration anew = begunAnew(views, result.camera.size, result.projector.size);
        for (const Alternative& by : CauseTrials(views, anew, order, progress).all())
            if (by.amount >= kRefused && by.explained >= kOutright)
                return Explanation{{by.cause, by.view, "", by.words, by.remedy}};
    }
    CauseTrials trials(views, result, order, progress);
    const std::vector<Alternative> all = trials.all();
    const auto told = [](const Alternative& by) {
        // What certainly moved between poses is no quality of a device, but two set-ups in one.
        const double refused = by.cause == Cause::cameraMoved && by.sigmas >= kSureMove ? 1.0 : kRefused;
        return Explanation{{by.cause, by.view, "", by.words, by.remedy}, by.amount >= refused};
    };
    const auto counts = [](const Alternative& by) { return by.amount >= 1.0 && by.explained >= kExplains; };
    for (const Alternative& by : all) { // the one that explains most first
        if (!counts(by)) continue;
        // Of a few poses another focal length is much like another place of the camera, which has more to adjust.
        const auto focus = std::ranges::find(all, Cause::cameraRefocused, &Alternative::cause);
        if (by.cause == Cause::cameraMoved && focus != all.end() && counts(*focus) &&
            1.0 - focus->explained < kAsGood * (1.0 - by.explained))
            return told(*focus);
        return told(by);
    }
    if (result.camera.rms >= kNoise || result.projector.rms >= kNoise) {
        const Alternative lens = trials.anyLens(); // explains much: it is for what nothing else does
        if (lens.amount >= 1.0 && lens.explained >= kExplains) return told(lens);
    }
    const auto skewed = std::ranges::find(all, Cause::keystone, &Alternative::cause);
    if (skewed->amount >= kSomeSkew && skewed->sigmas >= kSureSkew) return told(*skewed);
    return std::nullopt;
}

} // namespace lumorph

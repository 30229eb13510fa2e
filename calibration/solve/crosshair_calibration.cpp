#include "calibration/solve/crosshair_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include <Eigen/Dense>
#include <ceres/jet.h>
#include <ceres/rotation.h>
#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>
#include <opencv2/calib3d.hpp>

namespace lumorph {

namespace {

constexpr std::size_t kFewestPoints = 6;
constexpr std::size_t kFewestOfKnownLens = 4;
constexpr std::size_t kManyPoints = 12; // from which aspect and k1 can be told
constexpr double kSamePoint = 1e-4;     // metres
constexpr double kThinnest = 0.02;      // share of the points' extent that must lie across their plane, or line
constexpr double kLargest = 1e4;        // metres; beyond it is no room
constexpr double kContradiction = 13.8; // chi-square of two coordinates that chance passes once in a thousand
constexpr double kAlike = 6.0;          // likewise, in twenty: as good an explanation
constexpr double kUntold = 0.7;         // of what is known beforehand: an observation that leaves more tells nothing
constexpr int kFirstSteps = 8;          // of each start, before the best goes on
constexpr int kMostSteps = 60;
constexpr int kSize = kLensParameters + 6;

using CrosshairParameters = Eigen::Matrix<double, kSize, 1>;

constexpr const char* kLensNames[] = {
    "focal length", "aspect", "principal point across", "principal point down", "k1", "k2", "p1", "p2", "k3"};

/// What holds for projectors in general, and how much they differ: throw ratios from 0.5 to 5, pictures shifted up or
/// down by about their height, and little to the sides.
struct UsualLens {
    Lens middle, spread; // the first of both as logarithms
};

UsualLens usualLens(cv::Size size) {
    UsualLens usual{};
    usual.middle = {std::log(1.8 * size.width), 1.0, 0.5 * (size.width - 1), 0.5 * (size.height - 1), 0, 0, 0, 0, 0};
    usual.spread = {0.7, 0.01, 0.12 * size.width, 0.7 * size.height, 0.05, 0.05, 0.002, 0.002, 0.05};
    return usual;
}

/// A lens of which some parameters are free, each counted in its usual spread.
struct FreeLens {
    Lens held{};
    LensMask free{};
    UsualLens usual;

    template <typename T> void lensOf(const T* numbers, T* lens) const {
        using std::exp;
        for (int i = 0; i < kLensParameters; ++i) {
            const auto at = static_cast<std::size_t>(i);
            lens[i] = free[at] ? T(usual.middle[at]) + T(usual.spread[at]) * numbers[i] : T(held[at]);
            if (free[at] && i == kFocalLength) lens[i] = exp(lens[i]);
        }
    }
};

template <typename T> bool pixelFrom(const FreeLens& model, const T* numbers, const cv::Point3d& at, T* pixel) {
    T lens[kLensParameters];
    model.lensOf(numbers, lens);
    const T point[3] = {T(at.x), T(at.y), T(at.z)};
    T inProjector[3];
    ceres::AngleAxisRotatePoint(numbers + kLensParameters, point, inProjector);
    for (int i = 0; i < 3; ++i) inProjector[i] += numbers[kLensParameters + 3 + i];
    if (!(inProjector[2] > T(1e-3))) return false;
    projectPoint(lens, inProjector, pixel);
    return true;
}

/// Errors of all crosshairs and how unusual the lens is, in standard deviations.
class AimErrors {
public:
    using Scalar = double;
    enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = kSize };

    AimErrors(std::vector<Crosshair> crosshairs, const FreeLens& model, double sigma)
        : crosshairs_(std::move(crosshairs)), model_(model), sigma_(sigma) {}

    [[nodiscard]] int NumResiduals() const { // as Ceres calls it
        return static_cast<int>(2 * crosshairs_.size()) + kLensParameters;
    }
    template <typename T> bool operator()(const T* numbers, T* errors) const {
        for (std::size_t i = 0; i < crosshairs_.size(); ++i) {
            T pixel[2];
            if (pixelFrom(model_, numbers, crosshairs_[i].point, pixel)) {
                errors[2 * i] = (pixel[0] - T(crosshairs_[i].pixel.x)) / T(sigma_);
                errors[2 * i + 1] = (pixel[1] - T(crosshairs_[i].pixel.y)) / T(sigma_);
            } else { // behind the projector: far off, and no way from there
                errors[2 * i] = errors[2 * i + 1] = T(1e6);
            }
        }
        for (int i = 0; i < kLensParameters; ++i)
            errors[2 * crosshairs_.size() + static_cast<std::size_t>(i)] = numbers[i];
        return true;
    }
    [[nodiscard]] const std::vector<Crosshair>& crosshairs() const { return crosshairs_; }

private:
    std::vector<Crosshair> crosshairs_;
    const FreeLens& model_;
    double sigma_;
};

/// The least sum of squares near `numbers`, which move there.
double descend(const AimErrors& errors, CrosshairParameters& numbers, int steps) {
    using Function = ceres::TinySolverAutoDiffFunction<AimErrors, Eigen::Dynamic, kSize>;
    const Function function(errors);
    ceres::TinySolver<Function> solver;
    solver.options.max_num_iterations = steps;
    solver.options.function_tolerance = 1e-7;
    const double cost = 2.0 * solver.Solve(function, &numbers).final_cost;
    return numbers.allFinite() && std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

/// Extents of points along their main axes, root mean square, the largest first.
Eigen::Vector3d extentsOf(const std::vector<Crosshair>& crosshairs) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    const auto place = [](const Crosshair& c) { return Eigen::Vector3d(c.point.x, c.point.y, c.point.z); };
    const auto count = static_cast<double>(crosshairs.size());
    for (const Crosshair& crosshair : crosshairs) middle += place(crosshair) / count;
    for (const Crosshair& crosshair : crosshairs)
        spread += (place(crosshair) - middle) * (place(crosshair) - middle).transpose() / count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(spread, Eigen::EigenvaluesOnly);
    return solved.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
}

std::size_t differentPoints(const std::vector<Crosshair>& crosshairs) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < crosshairs.size(); ++i)
        count += std::none_of(crosshairs.begin(), crosshairs.begin() + static_cast<std::ptrdiff_t>(i),
                              [&](const auto& c) { return cv::norm(c.point - crosshairs[i].point) < kSamePoint; });
    return count;
}

void checkNumbers(const std::vector<Crosshair>& crosshairs, cv::Size size, const CrosshairOptions& options) {
    if (size.width < 2 || size.height < 2 || size.width > 16384 || size.height > 16384)
        throw InvalidInput("projector", "its size is none", "give its pixels, such as 1920x1080");
    if (!(options.aimingSigma > 0.0) || !std::isfinite(options.aimingSigma))
        throw InvalidInput("aiming", "its uncertainty must be above 0", "give pixels; 1 is usual");
    if (options.lens && (!std::ranges::all_of(*options.lens, [](double v) { return std::isfinite(v); }) ||
                         !((*options.lens)[kFocalLength] > 0.0) || !((*options.lens)[kAspect] > 0.0)))
        throw InvalidInput("lens", "it has numbers that make no lens", "calibrate the projector with its lens");
    const auto tooFar = [](double metres) { return !(std::abs(metres) < kLargest); };
    const double most = 4.0 * std::max(size.width, size.height);
    for (const Crosshair& c : crosshairs)
        if (tooFar(c.point.x) || tooFar(c.point.y) || tooFar(c.point.z) || !(std::abs(c.pixel.x) < most) ||
            !(std::abs(c.pixel.y) < most))
            throw InvalidInput("point " + c.name, "it has numbers that are not finite or far out of range",
                               "give its place in metres and its crosshair in projector pixels");
}

void requireLayout(const std::vector<Crosshair>& crosshairs, bool lensKnown) {
    const std::size_t needed = lensKnown ? kFewestOfKnownLens : kFewestPoints;
    const std::size_t different = differentPoints(crosshairs);
    if (different < needed)
        throw CaptureRefused({Cause::tooFewPoints, "", "",
                              std::to_string(different) + " different points are aimed at, but " +
                                  std::to_string(needed) + " are needed",
                              "aim at " + std::to_string(needed - different) + " more; eight are good"});
    const Eigen::Vector3d extents = extentsOf(crosshairs);
    if (extents[1] < kThinnest * extents[0])
        throw CaptureRefused({Cause::pointsDegenerate, "", "", "all points lie nearly on one line",
                              "add points beside it, such as corners of the other side of the device"});
    if (!lensKnown && extents[2] < kThinnest * extents[0])
        throw CaptureRefused({Cause::pointsDegenerate, "", "",
                              "all points lie nearly in one plane, in which every focal length fits",
                              "lift flaps and add their corners: points must differ in height"});
}

/// Finds lens and pose for one set of crosshairs.
class CrosshairSolver {
public:
    CrosshairSolver(std::vector<Crosshair> crosshairs, cv::Size size, const CrosshairOptions& options)
        : size_(size), options_(options) {
        for (const Crosshair& c : crosshairs) middle_ += (1.0 / static_cast<double>(crosshairs.size())) * c.point;
        for (Crosshair& c : crosshairs) c.point -= middle_;
        model_.usual = usualLens(size);
        model_.held = model_.usual.middle;
        model_.held[kFocalLength] = std::exp(model_.held[kFocalLength]);
        if (options.lens) {
            model_.held = *options.lens;
        } else {
            model_.free[kFocalLength] = model_.free[kPrincipalX] = model_.free[kPrincipalY] = true;
            model_.free[kAspect] = model_.free[kK1] = crosshairs.size() >= kManyPoints;
        }
        all_.emplace(std::move(crosshairs), model_, options.aimingSigma);
    }

    CrosshairCalibration solve() {
        cost_ = start();
        if (!std::isfinite(cost_)) throw doesNotFit(std::numeric_limits<double>::infinity());
        CrosshairCalibration result;
        takeState(result);
        judgePoints(result);
        nameWhatWasHeld(result);
        return result;
    }

private:
    static CaptureRefused doesNotFit(double rms) { return CaptureRefused(misfit(rms, "")); }

    static Finding misfit(double rms, const std::string& names) {
        std::ostringstream why;
        why.precision(1);
        why << std::fixed << "the crosshairs contradict one another";
        if (std::isfinite(rms)) why << ": " << rms << " pixels remain";
        return {Cause::modelDoesNotFit, names, "", why.str(),
                "aim anew at the points with the longest arrows; check that flaps stand as they are said to, and that "
                "the projector's keystone correction is off"};
    }

    /// From several lenses, as the points' pose follows from each; the best descent.
    double start() {
        std::vector<cv::Point3d> points;
        std::vector<cv::Point2d> pixels;
        for (const Crosshair& c : all_->crosshairs()) {
            points.push_back(c.point);
            pixels.push_back(c.pixel);
        }
        double best = std::numeric_limits<double>::infinity();
        const auto tryLens = [&](const Lens& lens) {
            const cv::Matx33d matrix(lens[kFocalLength], 0, lens[kPrincipalX], 0, lens[kFocalLength] * lens[kAspect],
                                     lens[kPrincipalY], 0, 0, 1);
            const cv::Matx<double, 1, 5> distortion(lens[kK1], lens[kK2], lens[kP1], lens[kP2], lens[kK3]);
            cv::Mat turn, way;
            try {
                if (!cv::solvePnP(points, pixels, matrix, distortion, turn, way, false, cv::SOLVEPNP_SQPNP)) return;
            } catch (const cv::Exception&) { // of a start that leads nowhere
                return;
            }
            CrosshairParameters numbers = CrosshairParameters::Zero();
            if (!options_.lens) {
                numbers[kFocalLength] = (std::log(lens[kFocalLength]) - model_.usual.middle[kFocalLength]) /
                                        model_.usual.spread[kFocalLength];
                numbers[kPrincipalY] =
                    (lens[kPrincipalY] - model_.usual.middle[kPrincipalY]) / model_.usual.spread[kPrincipalY];
            }
            for (int i = 0; i < 3; ++i) {
                numbers[kLensParameters + i] = turn.at<double>(i);
                numbers[kLensParameters + 3 + i] = way.at<double>(i);
            }
            const double cost = descend(*all_, numbers, kFirstSteps);
            if (!(cost < best)) return;
            best = cost;
            numbers_ = numbers;
        };
        if (options_.lens) {
            tryLens(*options_.lens);
        } else {
            for (const double focal : {0.8, 2.0, 5.0})
                for (const double shift : {0.5, 1.1, -0.1}) {
                    Lens lens = model_.held;
                    lens[kFocalLength] = focal * size_.width;
                    lens[kPrincipalY] = shift * size_.height;
                    tryLens(lens);
                }
        }
        return std::isfinite(best) ? descend(*all_, numbers_, kMostSteps) : best;
    }

    void takeState(CrosshairCalibration& result) const {
        result.projector.size = size_;
        result.projector.model = model_.free[kK1] ? "k1" : options_.lens ? "as it was known" : "pinhole";
        model_.lensOf(numbers_.data(), result.projector.lens.data());
        result.middle = middle_;
        result.projectorFromWorld = middlePose();
        const double minus[3] = {-middle_.x, -middle_.y, -middle_.z};
        const glm::dvec3 shift = Rigid::exp(middlePose()) * glm::dvec3(minus[0], minus[1], minus[2]);
        for (int i = 0; i < 3; ++i) result.projectorFromWorld[static_cast<std::size_t>(3 + i)] = shift[i];
        result.covariance = covariance();
        for (int i = 0; i < kLensParameters; ++i) {
            const auto at = static_cast<std::size_t>(i);
            if (!model_.free[at]) continue;
            const double scale = i == kFocalLength ? result.projector.lens[kFocalLength] : 1.0;
            result.projector.sigma[at] = scale * model_.usual.spread[at] * std::sqrt(result.covariance(i, i));
        }
        takePoseSigma(result, minus);
        std::vector<cv::Point2d> errors;
        for (const Crosshair& c : all_->crosshairs()) {
            double pixel[2] = {};
            pixelFrom(model_, numbers_.data(), c.point, pixel);
            errors.emplace_back(pixel[0] - c.pixel.x, pixel[1] - c.pixel.y);
            result.points.push_back({errors.back(), 0.0, false});
        }
        result.projector.rms = rmsOf(errors);
    }

    [[nodiscard]] PoseVector middlePose() const {
        PoseVector pose;
        for (int i = 0; i < 6; ++i) pose[static_cast<std::size_t>(i)] = numbers_[kLensParameters + i];
        return pose;
    }

    [[nodiscard]] Eigen::Matrix<double, kSize, kSize> covariance() const {
        Eigen::Matrix<double, kSize, kSize> normal = Eigen::Matrix<double, kSize, kSize>::Zero();
        Lens lens;
        model_.lensOf(numbers_.data(), lens.data());
        for (const Crosshair& c : all_->crosshairs()) {
            const auto rows = crosshairJacobian(lens, model_.free, size_, middlePose(), c.point);
            normal += rows.transpose() * rows / (options_.aimingSigma * options_.aimingSigma);
        }
        for (int i = 0; i < kLensParameters; ++i) normal(i, i) += 1.0;
        return normal.ldlt().solve(Eigen::Matrix<double, kSize, kSize>::Identity());
    }

    /// The translation of the world is that of the middle, and what a turn about the middle makes of the way to it.
    void takePoseSigma(CrosshairCalibration& result, const double* minusMiddle) const {
        using Jet = ceres::Jet<double, 3>;
        Jet turn[3], point[3], out[3];
        for (int i = 0; i < 3; ++i) {
            turn[i] = Jet(numbers_[kLensParameters + i], i);
            point[i] = Jet(minusMiddle[i]);
        }
        ceres::AngleAxisRotatePoint(turn, point, out);
        Eigen::Matrix<double, 3, 6> rows = Eigen::Matrix<double, 3, 6>::Zero();
        for (int i = 0; i < 3; ++i) {
            rows.block<1, 3>(i, 0) = out[i].v.transpose();
            rows(i, 3 + i) = 1.0;
        }
        const Eigen::Matrix<double, 6, 6> pose = result.covariance.bottomRightCorner<6, 6>();
        const Eigen::Matrix3d place = rows * pose * rows.transpose();
        for (int i = 0; i < 3; ++i) {
            result.projectorFromWorldSigma[static_cast<std::size_t>(i)] = std::sqrt(std::max(0.0, pose(i, i)));
            result.projectorFromWorldSigma[static_cast<std::size_t>(3 + i)] = std::sqrt(std::max(0.0, place(i, i)));
        }
    }

    /// Each error against how far it may lie from zero, the point itself having drawn the solution to it.
    void takeContradictions(CrosshairCalibration& result) const {
        for (std::size_t i = 0; i < result.points.size(); ++i) {
            const auto rows =
                crosshairJacobian(result.projector.lens, model_.free, size_, middlePose(), all_->crosshairs()[i].point);
            const double variance = options_.aimingSigma * options_.aimingSigma;
            const Eigen::Matrix2d left =
                variance * Eigen::Matrix2d::Identity() - rows * result.covariance * rows.transpose();
            const Eigen::Vector2d error(result.points[i].error.x, result.points[i].error.y);
            result.points[i].contradiction = std::sqrt(std::max(0.0, error.dot(left.ldlt().solve(error))));
        }
    }

    /// Leaves out one point after another: one whose absence makes the rest agree is suspicious.
    void judgePoints(CrosshairCalibration& result) const {
        const std::size_t count = all_->crosshairs().size();
        const double parameters = 6.0 + static_cast<double>(std::ranges::count(model_.free, true));
        takeContradictions(result);
        std::vector<double> without(count, cost_);
        for (std::size_t left = 0; left < count && cost_ > kContradiction; ++left) {
            std::vector<Crosshair> rest = all_->crosshairs();
            rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left));
            CrosshairParameters numbers = numbers_;
            without[left] = descend(AimErrors(std::move(rest), model_, options_.aimingSigma), numbers, kMostSteps);
        }
        const double least = *std::ranges::min_element(without);
        const double freedom = std::max(1.0, 2.0 * static_cast<double>(count) - 2.0 - parameters);
        const double noise = std::max(1.0, least / freedom); // a user may aim worse than was said
        std::string names;
        if (cost_ - least > kContradiction * noise)
            for (std::size_t i = 0; i < count; ++i) {
                if (without[i] - least > kAlike * noise) continue;
                result.points[i].suspicious = true;
                names += (names.empty() ? "" : " or ") + all_->crosshairs()[i].name;
            }
        const double all = std::max(1.0, 2.0 * static_cast<double>(count) - parameters);
        const double sigma = std::sqrt(cost_ / all); // in those that were said
        if (!names.empty())
            result.warnings.push_back({Cause::pointSuspicious, names, "", "the other points say that it lies elsewhere",
                                       "aim at it again, and check that it is the point that is meant"});
        if (sigma > kTooFar) result.refusal = misfit(result.projector.rms, names);
    }

    void nameWhatWasHeld(CrosshairCalibration& result) const {
        if (options_.lens) return;
        const auto warn = [&](const std::string& what, const char* value) {
            result.warnings.push_back({Cause::undetermined, "", "",
                                       "the points cannot tell " + what + " of the projector, which was " + value,
                                       "add points that differ more in height, or lie farther apart"});
        };
        for (int i = 0; i < kLensParameters; ++i) {
            const auto at = static_cast<std::size_t>(i);
            result.projector.free[at] = model_.free[at] && std::sqrt(result.covariance(i, i)) < kUntold;
            if (model_.free[at] && !result.projector.free[at])
                warn(std::string("the ") + kLensNames[at], "held near the usual");
        }
        if (!model_.free[kAspect])
            result.warnings.push_back(
                {Cause::undetermined, "", "",
                 "fewer than " + std::to_string(kManyPoints) +
                     " points tell neither aspect nor distortion of the projector, which were locked",
                 "add points if straight lines look bent on the device"});
    }

    static constexpr double kTooFar = 8.0; // times worse than aimed: no solution to be used

    cv::Size size_;
    CrosshairOptions options_;
    cv::Point3d middle_;
    FreeLens model_;
    std::optional<AimErrors> all_;
    CrosshairParameters numbers_ = CrosshairParameters::Zero();
    double cost_ = 0.0;
};

} // namespace

Eigen::Matrix<double, 2, 15> crosshairJacobian(const Lens& lens, const LensMask& free, cv::Size projector,
                                               const PoseVector& projectorFromMiddle, const cv::Point3d& fromMiddle) {
    using Jet = ceres::Jet<double, kSize>;
    FreeLens model{lens, free, usualLens(projector)};
    for (int i = 0; i < kLensParameters; ++i) // around this very lens
        model.usual.middle[static_cast<std::size_t>(i)] =
            i == kFocalLength ? std::log(lens[kFocalLength]) : lens[static_cast<std::size_t>(i)];
    Jet numbers[kSize], pixel[2];
    for (int i = 0; i < kSize; ++i)
        numbers[i] =
            Jet(i < kLensParameters ? 0.0 : projectorFromMiddle[static_cast<std::size_t>(i - kLensParameters)], i);
    Eigen::Matrix<double, 2, 15> rows = Eigen::Matrix<double, 2, 15>::Zero();
    if (!pixelFrom(model, numbers, fromMiddle, pixel)) return rows;
    rows.row(0) = pixel[0].v.transpose();
    rows.row(1) = pixel[1].v.transpose();
    return rows;
}

cv::Point2d CrosshairCalibration::pixelOf(const cv::Point3d& point) const {
    const glm::dvec3 inProjector = Rigid::exp(projectorFromWorld) * glm::dvec3(point.x, point.y, point.z);
    double pixel[2];
    projectPoint(projector.lens.data(), &inProjector.x, pixel);
    return {pixel[0], pixel[1]};
}

double CrosshairCalibration::error95At(const cv::Point3d& point) const {
    const cv::Point3d from = point - middle;
    const Rigid fromMiddle = Rigid::exp(projectorFromWorld) * Rigid(glm::dmat3(1.0), {middle.x, middle.y, middle.z});
    PoseVector pose = projectorFromWorld; // its turn to the last digit
    for (int i = 0; i < 3; ++i) pose[static_cast<std::size_t>(3 + i)] = fromMiddle.translation[i];
    // What was held is no better known: the mask of what was solved for stands in the covariance.
    LensMask moved{};
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = projector.sigma[i] > 0.0;
    const auto rows = crosshairJacobian(projector.lens, moved, projector.size, pose, from);
    const Eigen::Matrix2d pixels = rows * covariance * rows.transpose();
    const double depth = (fromMiddle * glm::dvec3(from.x, from.y, from.z)).z;
    const Eigen::Vector2d axes =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(pixels).eigenvalues().cwiseMax(0.0).cwiseSqrt();
    // 95 % of a normal distribution in the plane: 1.96 standard deviations where it is a line, 2.45 where it is round;
    // between them this is within 0.01 of Harter's table (Circular error probabilities, 1960).
    const double k95 = axes[1] > 0.0 ? 1.96 + 0.488 * std::pow(axes[0] / axes[1], 2.7) : 0.0;
    return k95 * axes[1] * depth / projector.lens[kFocalLength];
}

CrosshairCalibration calibrateCrosshairs(const std::vector<Crosshair>& crosshairs, cv::Size projector,
                                         const CrosshairOptions& options) {
    checkNumbers(crosshairs, projector, options);
    std::vector<Crosshair> aimed;
    for (const Crosshair& c : crosshairs)
        if (c.aimed) aimed.push_back(c);
    requireLayout(aimed, options.lens.has_value());
    CrosshairCalibration result = CrosshairSolver(aimed, projector, options).solve();
    std::vector<CrosshairFit> fits(crosshairs.size());
    for (std::size_t i = 0, k = 0; i < crosshairs.size(); ++i)
        if (crosshairs[i].aimed) fits[i] = result.points[k++];
    result.points = std::move(fits);
    return result;
}

CrosshairSession::CrosshairSession(cv::Size projector, CrosshairOptions options)
    : projector_(projector), options_(std::move(options)) {
    checkNumbers({}, projector_, options_);
    solve();
}

std::size_t CrosshairSession::add(const std::string& name, const cv::Point3d& point) {
    Crosshair crosshair{name, point, {0.5 * (projector_.width - 1), 0.5 * (projector_.height - 1)}, false};
    checkNumbers({crosshair}, projector_, options_);
    if (result_) {
        const cv::Point2d guess = result_->pixelOf(point);
        if (std::isfinite(guess.x) && std::isfinite(guess.y))
            crosshair.pixel = {std::clamp(guess.x, 0.0, projector_.width - 1.0),
                               std::clamp(guess.y, 0.0, projector_.height - 1.0)};
    }
    crosshairs_.push_back(crosshair);
    solve();
    return crosshairs_.size() - 1;
}

Crosshair& CrosshairSession::at(std::size_t index) {
    if (index >= crosshairs_.size())
        throw InvalidInput("crosshair " + std::to_string(index), "there is none of that number",
                           "choose one of the list");
    return crosshairs_[index];
}

void CrosshairSession::move(std::size_t index, const cv::Point2d& by) { aimAt(index, at(index).pixel + by); }

void CrosshairSession::aimAt(std::size_t index, const cv::Point2d& pixel) {
    Crosshair& crosshair = at(index);
    if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y))
        throw InvalidInput("crosshair " + crosshair.name, "its pixel is no number", "move it within the picture");
    crosshair.pixel = {std::clamp(pixel.x, 0.0, projector_.width - 1.0),
                       std::clamp(pixel.y, 0.0, projector_.height - 1.0)};
    crosshair.aimed = true;
    solve();
}

void CrosshairSession::setAimed(std::size_t index, bool aimed) {
    at(index).aimed = aimed;
    solve();
}

void CrosshairSession::remove(std::size_t index) {
    (void)at(index);
    crosshairs_.erase(crosshairs_.begin() + static_cast<std::ptrdiff_t>(index));
    solve();
}

void CrosshairSession::solve() {
    result_.reset();
    missing_.reset();
    try {
        result_ = calibrateCrosshairs(crosshairs_, projector_, options_);
    } catch (const CaptureRefused& refused) {
        missing_ = refused.finding();
    }
}

} // namespace lumorph

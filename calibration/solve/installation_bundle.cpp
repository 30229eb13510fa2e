#include "calibration/solve/installation_bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Eigenvalues>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

namespace lumorph {

namespace {

constexpr double kNearestPoint = 1e-9;      // before a lens
constexpr double kHidden = 1e-14;           // of the largest eigenvalue: a direction that nothing tells of
constexpr double kLeastInformation = 1e-30; // of a parameter
constexpr double kMostMissing = 0.1;        // of all that was seen

template <typename T> void poseForward(const T* pose, const T* point, T* out) {
    ceres::AngleAxisRotatePoint(pose, point, out);
    for (int i = 0; i < 3; ++i) out[i] += pose[3 + i];
}

template <typename T> void turnBack(const T* pose, const T* way, T* out) {
    const T back[3] = {-pose[0], -pose[1], -pose[2]};
    ceres::AngleAxisRotatePoint(back, way, out);
}

template <typename T> T dotOf(const T* a, const T* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Reflects a place, or with `place` 0 a direction, at the plane whose nearest point to the origin is `mirror`.
template <typename T> void reflect(const T* mirror, double place, T* what) {
    const T square = dotOf(mirror, mirror);
    const T off = T(2.0) * (dotOf(mirror, what) / square - T(place));
    for (int i = 0; i < 3; ++i) what[i] -= off * mirror[i];
}

/// Of a known point in a camera.
struct PointError {
    SeenPoint seen;
    double weight = 1.0;

    template <typename T>
    bool operator()(const T* lens, const T* camera, const T* body, const T* mirror, T* error) const {
        const T point[3] = {T(seen.point.x), T(seen.point.y), T(seen.point.z)};
        T inWorld[3], inCamera[3], pixel[2];
        poseForward(body, point, inWorld);
        if (seen.mirrored) reflect(mirror, 1.0, inWorld);
        poseForward(camera, inWorld, inCamera);
        if (inCamera[2] < T(kNearestPoint)) return false;
        projectPoint(lens, inCamera, pixel);
        error[0] = T(weight) * (pixel[0] - T(seen.pixel.x));
        error[1] = T(weight) * (pixel[1] - T(seen.pixel.y));
        return ceres::isfinite(error[0]) && ceres::isfinite(error[1]);
    }
};

/// Of light: the camera's ray, by way of the mirror where it is so, cut with the body's plane and put into the
/// projector.
struct LightError {
    SeenLight seen;
    double weight = 1.0;

    template <typename T>
    bool operator()(const T* lens, const T* camera, const T* body, const T* projectorLens, const T* projector,
                    const T* mirror, T* error) const {
        T way[3], ray[3], minus[3], from[3];
        directionOfPixel<T>(lens, seen.pixels.camera.x, seen.pixels.camera.y, way[0], way[1]);
        way[2] = T(1.0);
        turnBack(camera, way, ray);
        for (int i = 0; i < 3; ++i) minus[i] = -camera[3 + i];
        turnBack(camera, minus, from);
        if (seen.mirrored) {
            reflect(mirror, 1.0, from);
            reflect(mirror, 0.0, ray);
        }
        const T normal[3] = {T(seen.normal[0]), T(seen.normal[1]), T(seen.normal[2])};
        T n[3], inProjector[3], pixel[2], place[3];
        ceres::AngleAxisRotatePoint(body, normal, n);
        const T along = (T(seen.distance) + dotOf(n, body + 3) - dotOf(n, from)) / dotOf(n, ray);
        if (!(along > T(kNearestPoint))) return false;
        for (int i = 0; i < 3; ++i) place[i] = from[i] + along * ray[i];
        poseForward(projector, place, inProjector);
        if (inProjector[2] < T(kNearestPoint)) return false;
        projectPoint(projectorLens, inProjector, pixel);
        error[0] = T(weight) * (pixel[0] - T(seen.pixels.projector.x));
        error[1] = T(weight) * (pixel[1] - T(seen.pixels.projector.y));
        return ceres::isfinite(error[0]) && ceres::isfinite(error[1]);
    }
};

/// How far a lens lies from what was known of it.
struct KnownError {
    InstallationNoise::Known known;

    template <typename T> bool operator()(const T* lens, T* error) const {
        for (int i = 0; i < kLensParameters; ++i) {
            const auto at = static_cast<std::size_t>(i);
            error[i] = known.sigma[at] > 0.0 ? (lens[i] - T(known.lens[at])) / T(known.sigma[at]) : T(0.0);
        }
        return true;
    }
};

/// The problem around one state, whose numbers it moves.
class InstallationProblem {
public:
    InstallationProblem(const InstallationObservations& observations, const InstallationFree& free,
                        const InstallationNoise& noise, InstallationState& state)
        : state_(state) {
        addDevices(state.cameras, free.cameras, noise.cameras);
        addDevices(state.projectors, free.projectors, noise.projectors);
        for (std::size_t i = 0; i < state.worldFromBody.size(); ++i)
            addPose(state.worldFromBody[i].data(), i < free.bodies.size() && free.bodies[i]);
        problem_.AddParameterBlock(state.mirror.data(), 3);
        if (!free.mirror) problem_.SetParameterBlockConstant(state.mirror.data());
        addSeen(observations.points, [&](const SeenPoint& seen) { addPoint(seen, noise); });
        addSeen(observations.lights, [&](const SeenLight& seen) { addLight(seen, noise); });
    }

    double solve(int steps) {
        ceres::Solver::Options how;
        how.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
        how.max_num_iterations = steps;
        how.function_tolerance = 1e-9;
        how.logging_type = ceres::SILENT;
        how.num_threads = 2;
        ceres::Solver::Summary summary;
        ceres::Solve(how, &problem_, &summary);
        return summary.termination_type == ceres::FAILURE ? std::numeric_limits<double>::infinity()
                                                          : summary.final_cost;
    }

    /// Standard deviations, each where its number stands in `into`, a copy of the state.
    void sigmas(InstallationState& into) {
        std::vector<double*> blocks;
        std::vector<double*> places; // of the columns
        const auto addBlock = [&](double* block, double* place, int size, const auto& isFree) {
            if (problem_.IsParameterBlockConstant(block)) return;
            blocks.push_back(block);
            for (int i = 0; i < size; ++i)
                if (isFree(i)) places.push_back(place + i);
        };
        const auto all = [](int) { return true; };
        const auto addAll = [&](auto& devices, auto& outs) {
            for (std::size_t i = 0; i < devices.size(); ++i) {
                const LensMask& mask = masks_.at(devices[i].lens.data());
                addBlock(devices[i].lens.data(), outs[i].lens.data(), kLensParameters,
                         [&](int k) { return mask[static_cast<std::size_t>(k)]; });
                addBlock(devices[i].fromWorld.data(), outs[i].fromWorld.data(), 6, all);
            }
        };
        addAll(state_.cameras, into.cameras);
        addAll(state_.projectors, into.projectors);
        for (std::size_t i = 0; i < state_.worldFromBody.size(); ++i)
            addBlock(state_.worldFromBody[i].data(), into.worldFromBody[i].data(), 6, all);
        addBlock(state_.mirror.data(), into.mirror.data(), 3, all);
        if (blocks.empty()) return;
        const Eigen::VectorXd variances = variancesOf(blocks);
        for (std::size_t i = 0; i < places.size(); ++i)
            *places[i] = std::sqrt(std::max(0.0, variances[static_cast<Eigen::Index>(i)]));
    }

private:
    void addDevices(std::vector<InstallationState::Device>& devices, const std::vector<InstallationFree::Device>& free,
                    const std::vector<InstallationNoise::Known>& known) {
        for (std::size_t i = 0; i < devices.size(); ++i) {
            const InstallationFree::Device what = i < free.size() ? free[i] : InstallationFree::Device{};
            double* lens = devices[i].lens.data();
            masks_[lens] = what.lens;
            std::vector<int> held;
            for (int k = 0; k < kLensParameters; ++k)
                if (!what.lens[static_cast<std::size_t>(k)]) held.push_back(k);
            problem_.AddParameterBlock(lens, kLensParameters);
            if (held.size() == kLensParameters)
                problem_.SetParameterBlockConstant(lens);
            else if (!held.empty())
                problem_.SetManifold(lens, new ceres::SubsetManifold(kLensParameters, held));
            if (i < known.size() && held.size() < kLensParameters)
                problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<KnownError, kLensParameters, kLensParameters>(
                                              new KnownError{known[i]}),
                                          nullptr, lens);
            addPose(devices[i].fromWorld.data(), what.pose);
        }
    }

    /// Without single ones that cannot be there, such as light whose ray misses its plane: each would make the whole
    /// impossible. Where they are many, so it is.
    template <typename Seen, typename Add> void addSeen(const std::vector<Seen>& all, const Add& add) {
        const auto isThere = [this](const Seen& seen) { return errorOf(seen, state_).has_value(); };
        const auto missed = all.size() - static_cast<std::size_t>(std::ranges::count_if(all, isThere));
        const bool isFew = static_cast<double>(missed) <= kMostMissing * static_cast<double>(all.size());
        for (const Seen& seen : all)
            if (missed == 0 || !isFew || isThere(seen)) add(seen);
    }

    void addPose(double* pose, bool free) {
        problem_.AddParameterBlock(pose, 6);
        if (!free) problem_.SetParameterBlockConstant(pose);
    }

    static std::size_t at(int index) { return static_cast<std::size_t>(index); }

    void addPoint(const SeenPoint& seen, const InstallationNoise& noise) {
        auto& camera = state_.cameras[at(seen.camera)];
        problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<PointError, 2, kLensParameters, 6, 6, 3>(
                                      new PointError{seen, 1.0 / noise.camera}),
                                  new ceres::HuberLoss(noise.robust), camera.lens.data(), camera.fromWorld.data(),
                                  state_.worldFromBody[at(seen.body)].data(), state_.mirror.data());
    }

    void addLight(const SeenLight& seen, const InstallationNoise& noise) {
        auto& camera = state_.cameras[at(seen.camera)];
        auto& projector = state_.projectors[at(seen.projector)];
        problem_.AddResidualBlock(
            new ceres::AutoDiffCostFunction<LightError, 2, kLensParameters, 6, 6, kLensParameters, 6, 3>(
                new LightError{seen, std::sqrt(seen.weight) / noise.projector}),
            new ceres::CauchyLoss(noise.robust), camera.lens.data(), camera.fromWorld.data(),
            state_.worldFromBody[at(seen.body)].data(), projector.lens.data(), projector.fromWorld.data(),
            state_.mirror.data());
    }

    /// The diagonal of the inverse of the normal matrix, whose parameters have very different units.
    Eigen::VectorXd variancesOf(const std::vector<double*>& blocks) {
        ceres::Problem::EvaluateOptions how;
        how.parameter_blocks = blocks;
        ceres::CRSMatrix jacobian;
        problem_.Evaluate(how, nullptr, nullptr, nullptr, &jacobian);
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(jacobian.num_cols, jacobian.num_cols);
        for (int row = 0; row < jacobian.num_rows; ++row)
            for (int i = jacobian.rows[at(row)]; i < jacobian.rows[at(row + 1)]; ++i)
                for (int k = jacobian.rows[at(row)]; k < jacobian.rows[at(row + 1)]; ++k)
                    normal(jacobian.cols[at(i)], jacobian.cols[at(k)]) +=
                        jacobian.values[at(i)] * jacobian.values[at(k)];
        const Eigen::VectorXd scale = normal.diagonal().cwiseMax(kLeastInformation).cwiseSqrt().cwiseInverse();
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(scale.asDiagonal() * normal * scale.asDiagonal());
        const Eigen::VectorXd values = solved.eigenvalues().cwiseMax(kHidden * solved.eigenvalues().maxCoeff());
        const Eigen::MatrixXd half =
            scale.asDiagonal() * solved.eigenvectors() * values.cwiseInverse().cwiseSqrt().asDiagonal();
        return half.rowwise().squaredNorm();
    }

    InstallationState& state_;
    std::map<const double*, LensMask> masks_;
    ceres::Problem problem_;
};

template <std::size_t Size> void fillZero(std::array<double, Size>& numbers) { numbers.fill(0.0); }

} // namespace

double refineInstallation(const InstallationObservations& observations, const InstallationFree& free,
                          const InstallationNoise& noise, InstallationState& state, int steps) {
    return InstallationProblem(observations, free, noise, state).solve(steps);
}

InstallationState installationSigmas(const InstallationObservations& observations, const InstallationFree& free,
                                     const InstallationNoise& noise, const InstallationState& state) {
    InstallationState here = state;
    InstallationState result = state;
    for (auto* devices : {&result.cameras, &result.projectors})
        for (InstallationState::Device& device : *devices) {
            fillZero(device.lens);
            fillZero(device.fromWorld);
        }
    for (PoseVector& pose : result.worldFromBody) fillZero(pose);
    fillZero(result.mirror);
    InstallationProblem(observations, free, noise, here).sigmas(result);
    return result;
}

std::optional<cv::Point2d> errorOf(const SeenPoint& seen, const InstallationState& state) {
    const auto& camera = state.cameras[static_cast<std::size_t>(seen.camera)];
    double error[2];
    if (!PointError{seen, 1.0}(camera.lens.data(), camera.fromWorld.data(),
                               state.worldFromBody[static_cast<std::size_t>(seen.body)].data(), state.mirror.data(),
                               error))
        return std::nullopt;
    return cv::Point2d(error[0], error[1]);
}

std::optional<cv::Point2d> errorOf(const SeenLight& seen, const InstallationState& state) {
    const auto& camera = state.cameras[static_cast<std::size_t>(seen.camera)];
    const auto& projector = state.projectors[static_cast<std::size_t>(seen.projector)];
    double error[2];
    if (!LightError{seen, 1.0}(camera.lens.data(), camera.fromWorld.data(),
                               state.worldFromBody[static_cast<std::size_t>(seen.body)].data(), projector.lens.data(),
                               projector.fromWorld.data(), state.mirror.data(), error))
        return std::nullopt;
    return cv::Point2d(error[0], error[1]);
}

SeenLight lightOnBoard(const ProjectorPoint& pixels, const Lens& camera, const PoseVector& cameraFromBoard,
                       const BoardShape& board) {
    const cv::Point3d seen = pointOnBoard(pixels.camera, camera, cameraFromBoard, board);
    const glm::dvec3 place = Rigid::exp(cameraFromBoard).inverse() * glm::dvec3(seen.x, seen.y, seen.z);
    const double step = 1e-4 * board.half;
    const cv::Vec3d at = onBoard(board, {place[0], place[1], 0.0});
    const cv::Vec3d across = cv::Vec3d(onBoard(board, {place[0] + step, place[1], 0.0})) - at;
    const cv::Vec3d along = cv::Vec3d(onBoard(board, {place[0], place[1] + step, 0.0})) - at;
    SeenLight light;
    light.normal = cv::normalize(across.cross(along));
    light.distance = light.normal.dot(at);
    light.pixels = pixels;
    return light;
}

std::optional<std::vector<cv::Point3d>> turnedBoard(const std::vector<cv::Point3d>& board) {
    cv::Point3d sum(0, 0, 0);
    for (const cv::Point3d& point : board) sum += (2.0 / static_cast<double>(board.size())) * point;
    std::vector<cv::Point3d> turned;
    double extent = 0.0;
    for (const cv::Point3d& point : board) {
        turned.push_back({sum.x - point.x, sum.y - point.y, point.z});
        extent = std::max(extent, cv::norm(point - 0.5 * sum));
    }
    for (const cv::Point3d& point : turned)
        if (std::ranges::none_of(board, [&](const auto& other) { return cv::norm(other - point) < 1e-6 * extent; }))
            return std::nullopt;
    return turned;
}

} // namespace lumorph

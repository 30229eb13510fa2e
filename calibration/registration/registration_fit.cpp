#include "calibration/registration/registration_fit.h"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calibration/registration/refusing.h"

namespace lumorph::registration {

namespace {

constexpr double kLoss = 2.0; ///< sigmas from which on a row counts for less
constexpr double kOpen = std::numeric_limits<double>::infinity();

template <typename T> using Vector3 = Eigen::Matrix<T, 3, 1>;

Eigen::Matrix3d matrixOf(const glm::dquat& q) { return Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix(); }

/// A constant pose between values that are solved for.
struct Fixed {
    explicit Fixed(const Pose& pose) : rotation(matrixOf(pose.rotation)), shift(eigen(pose.position)) {}
    template <typename T> [[nodiscard]] Vector3<T> operator*(const Vector3<T>& p) const {
        return rotation.cast<T>() * p + shift.cast<T>();
    }
    Eigen::Matrix3d rotation;
    Eigen::Vector3d shift;
};

/// A pose near a start, by six numbers: a turn about `middle` (where what was measured lies, so that turn and shift
/// hardly depend on one another) and a shift.
struct Near {
    Near(const Pose& from, const glm::dvec3& about) : start(from), middle(eigen(about)) {}
    template <typename T> [[nodiscard]] Vector3<T> of(const T* step, const Vector3<T>& p) const {
        const Vector3<T> from = p - middle.cast<T>();
        Vector3<T> turned;
        ceres::AngleAxisRotatePoint(step, from.data(), turned.data());
        return start * Vector3<T>(turned + middle.cast<T>()) + Eigen::Map<const Vector3<T>>(step + 3);
    }
    template <typename T> [[nodiscard]] Vector3<T> back(const T* step, const Vector3<T>& p) const {
        const Vector3<T> moved = p - Eigen::Map<const Vector3<T>>(step + 3) - start.shift.cast<T>();
        const Vector3<T> from = start.rotation.transpose().cast<T>() * moved - middle.cast<T>();
        const T reverse[3] = {-step[0], -step[1], -step[2]};
        Vector3<T> turned;
        ceres::AngleAxisRotatePoint(reverse, from.data(), turned.data());
        return turned + middle.cast<T>();
    }
    [[nodiscard]] Pose at(const double* step) const {
        const Eigen::Quaterniond s(start.rotation);
        const glm::dquat turned = glm::dquat(s.w(), s.x(), s.y(), s.z()) * rotationOfTurn({step[0], step[1], step[2]});
        const Eigen::Vector3d origin = of<double>(step, Eigen::Vector3d::Zero());
        return {{origin.x(), origin.y(), origin.z()}, glm::normalize(turned)};
    }
    Fixed start;
    Eigen::Vector3d middle;
};

struct RayError {
    Near world;
    Fixed pointer;
    Eigen::Vector3d origin, across, along;
    double height, heightWeight, weight;

    RayError(const RayRow& row, const Near& near)
        : world(near), pointer(row.pointer), origin(eigen(row.origin)), height(row.height.value_or(0.0)),
          heightWeight(row.height ? 1.0 / row.sigma : 0.0), weight(1.0 / row.sigma) {
        const Eigen::Vector3d direction = eigen(row.direction).normalized();
        across = direction.unitOrthogonal();
        along = direction.cross(across);
    }
    template <typename T> bool operator()(const T* step, const T* tip, T* error) const {
        const Vector3<T> point = world.of<T>(step, pointer * Vector3<T>(Eigen::Map<const Vector3<T>>(tip)));
        const Vector3<T> from = point - origin.cast<T>();
        error[0] = across.cast<T>().dot(from) * weight;
        error[1] = along.cast<T>().dot(from) * weight;
        error[2] = (point.y() - height) * heightWeight;
        return true;
    }
};

struct ModelError {
    Near device;
    Fixed pointer;
    Eigen::Vector3d onModel;
    double weight;
    ModelError(const ModelRow& row, const Near& near)
        : device(near), pointer(row.pointer), onModel(eigen(row.onModel)), weight(1.0 / row.sigma) {}
    template <typename T> bool operator()(const T* step, const T* tip, T* error) const {
        Eigen::Map<Vector3<T>>{error} =
            (device.of<T>(step, onModel.cast<T>()) - pointer * Vector3<T>(Eigen::Map<const Vector3<T>>(tip))) *
            T(weight);
        return true;
    }
};

/// The angle at the eye between mark and tip.
struct SightError {
    Near world;
    Fixed pointer;
    Pose headFromTracker;
    Eigen::Vector3d mark;
    double aimSigma, tipSigma;
    SightError(const SightRow& row, const Near& near)
        : world(near), pointer(row.pointer), headFromTracker(inverseOf(row.head)), mark(eigen(row.mark)),
          aimSigma(row.aimSigma), tipSigma(row.tipSigma) {}
    template <typename T> bool operator()(const T* step, const T* tip, const T* eye, T* error) const {
        const Eigen::Map<const Vector3<T>> from(eye);
        const Vector3<T> toTip = pointer * Vector3<T>(Eigen::Map<const Vector3<T>>(tip)) - from;
        const Vector3<T> toMark = Fixed(headFromTracker) * world.back<T>(step, mark.cast<T>()) - from;
        const T far = toTip.norm();
        const T sigma = sqrt(T(aimSigma * aimSigma) + T(tipSigma * tipSigma) / (far * far));
        Eigen::Map<Vector3<T>>{error} = toTip.cross(toMark) / (far * toMark.norm() * sigma);
        return true;
    }
};

struct TipError {
    TipRow row;
    template <typename T> bool operator()(const T* tip, T* error) const {
        for (int i = 0; i < 3; ++i) error[i] = (tip[i] - T(row.tip[i])) / T(row.sigma[i]);
        return true;
    }
};

glm::dvec3 middleOfRays(const Rows& rows, const Figures& start) {
    glm::dvec3 sum(0.0);
    for (const RayRow& row : rows.rays) sum += row.pointer * start.tip;
    return rows.rays.empty() ? inverseOf(start.worldFromTracker).position : sum / double(rows.rays.size());
}

glm::dvec3 middleOfModel(const Rows& rows) {
    glm::dvec3 sum(0.0);
    for (const ModelRow& row : rows.models) sum += row.onModel;
    return rows.models.empty() ? sum : sum / double(rows.models.size());
}

class Solver {
public:
    Solver(const Rows& rows, const Figures& start, const Free& free)
        : rows_(rows), free_(free), world_(start.worldFromTracker, middleOfRays(rows, start)),
          device_(start.bodyFromDevice, middleOfModel(rows)), tip_{start.tip.x, start.tip.y, start.tip.z},
          eye_{start.eyeFromHead.x, start.eyeFromHead.y, start.eyeFromHead.z} {
        addBlock(worldStep_.data(), 6, free.tracker);
        addBlock(deviceStep_.data(), 6, free.device);
        addBlock(tip_.data(), 3, free.tip);
        addBlock(eye_.data(), 3, free.eye);
        addRows();
    }

    Refined solved() {
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::DENSE_QR;
        options.max_num_iterations = 50;
        options.function_tolerance = 1e-10;
        options.parameter_tolerance = 1e-12;
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem_, &summary);
        Refined refined;
        refined.figures = {world_.at(worldStep_.data()),
                           {tip_[0], tip_[1], tip_[2]},
                           device_.at(deviceStep_.data()),
                           {eye_[0], eye_[1], eye_[2]}};
        refined.sigmas = sigmas();
        return refined;
    }

private:
    void addBlock(double* values, int size, bool isFree) {
        problem_.AddParameterBlock(values, size);
        if (!isFree) problem_.SetParameterBlockConstant(values);
    }

    void addRows() {
        using ceres::AutoDiffCostFunction;
        const auto loss = [] { return new ceres::CauchyLoss(kLoss); };
        for (const RayRow& row : rows_.rays)
            problem_.AddResidualBlock(new AutoDiffCostFunction<RayError, 3, 6, 3>(new RayError(row, world_)), loss(),
                                      worldStep_.data(), tip_.data());
        for (const ModelRow& row : rows_.models)
            problem_.AddResidualBlock(new AutoDiffCostFunction<ModelError, 3, 6, 3>(new ModelError(row, device_)),
                                      loss(), deviceStep_.data(), tip_.data());
        for (const SightRow& row : rows_.sights)
            problem_.AddResidualBlock(new AutoDiffCostFunction<SightError, 3, 6, 3, 3>(new SightError(row, world_)),
                                      loss(), worldStep_.data(), tip_.data(), eye_.data());
        if (rows_.tip)
            problem_.AddResidualBlock(new AutoDiffCostFunction<TipError, 3, 3>(new TipError{*rows_.tip}), nullptr,
                                      tip_.data());
    }

    /// Rows may err more than their sigmas say; never are they believed to be better.
    [[nodiscard]] double excess() {
        double cost = 0.0;
        ceres::Problem::EvaluateOptions plain;
        plain.apply_loss_function = true;
        problem_.Evaluate(plain, &cost, nullptr, nullptr, nullptr);
        const double unknowns =
            6.0 * (int(free_.tracker) + int(free_.device)) + 3.0 * (int(free_.tip) + int(free_.eye));
        double told = 2.0 * double(rows_.sights.size()) + 3.0 * double(rows_.models.size()) + (rows_.tip ? 3.0 : 0.0);
        for (const RayRow& row : rows_.rays) told += row.height ? 3.0 : 2.0;
        return std::sqrt(std::max(1.0, 2.0 * cost / std::max(1.0, told - unknowns)));
    }

    Sigmas sigmas() {
        std::vector<const double*> blocks;
        if (free_.tracker) blocks.push_back(worldStep_.data());
        if (free_.device) blocks.push_back(deviceStep_.data());
        if (free_.tip) blocks.push_back(tip_.data());
        if (free_.eye) blocks.push_back(eye_.data());
        ceres::Covariance::Options options;
        options.algorithm_type = ceres::DENSE_SVD;
        ceres::Covariance covariance(options);
        const bool known = covariance.Compute(blocks, &problem_);
        const double scale = excess();
        const auto deviations = [&](const double* block, int size, bool isFree) {
            std::array<double, 6> result{};
            if (!isFree) return result;
            if (!known) {
                result.fill(kOpen);
                return result;
            }
            std::array<double, 36> values{};
            covariance.GetCovarianceBlock(block, block, values.data());
            for (int i = 0; i < size; ++i)
                result[std::size_t(i)] = scale * std::sqrt(std::max(0.0, values[std::size_t(i * size + i)]));
            return result;
        };
        const auto norm = [](const std::array<double, 6>& d, std::size_t first) {
            return std::sqrt(d[first] * d[first] + d[first + 1] * d[first + 1] + d[first + 2] * d[first + 2]);
        };
        const auto ofTip = [&](const double* block, int size, bool isFree) {
            if (!isFree || !free_.tip || !rows_.tip || !known) return 0.0;
            std::array<double, 18> values{};
            covariance.GetCovarianceBlock(block, tip_.data(), values.data());
            const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> both(values.data(), size,
                                                                                                   3);
            // Estimates are linear in what they are made of: the row of the tip moves them by this times its error,
            // in units of its sigma.
            const Eigen::Matrix3d moves = both.bottomRows<3>() * eigen(rows_.tip->sigma).cwiseInverse().asDiagonal();
            return moves.norm();
        };
        const auto world = deviations(worldStep_.data(), 6, free_.tracker);
        const auto device = deviations(deviceStep_.data(), 6, free_.device);
        const auto tip = deviations(tip_.data(), 3, free_.tip), eye = deviations(eye_.data(), 3, free_.eye);
        return {norm(world, 0),
                norm(world, 3),
                norm(device, 0),
                norm(device, 3),
                {tip[0], tip[1], tip[2]},
                {eye[0], eye[1], eye[2]},
                ofTip(worldStep_.data(), 6, free_.tracker),
                ofTip(deviceStep_.data(), 6, free_.device),
                ofTip(eye_.data(), 3, free_.eye)};
    }

    const Rows& rows_;
    Free free_;
    Near world_, device_;
    std::array<double, 6> worldStep_{}, deviceStep_{};
    std::array<double, 3> tip_, eye_;
    ceres::Problem problem_;
};

} // namespace

Refined refine(const Rows& rows, const Figures& start, const Free& free, const Progress& progress) {
    progress.throwIfCancelled();
    return Solver(rows, start, free).solved();
}

double missOf(const RayRow& row, const Figures& figures) {
    const glm::dvec3 point = figures.worldFromTracker * (row.pointer * figures.tip);
    const glm::dvec3 from = point - row.origin, direction = glm::normalize(row.direction);
    const double aside = glm::length(from - glm::dot(from, direction) * direction);
    return row.height ? std::hypot(aside, point.y - *row.height) : aside;
}

double missOf(const ModelRow& row, const Figures& figures) {
    return glm::distance(figures.bodyFromDevice * row.onModel, row.pointer * figures.tip);
}

double missOf(const SightRow& row, const Figures& figures) {
    const glm::dvec3 tip = row.pointer * figures.tip;
    const glm::dvec3 mark = inverseOf(figures.worldFromTracker * row.head) * row.mark;
    const glm::dvec3 from = figures.eyeFromHead - tip;
    return glm::length(glm::cross(from, glm::normalize(tip - mark)));
}

} // namespace lumorph::registration

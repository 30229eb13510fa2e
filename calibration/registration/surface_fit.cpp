#include "calibration/registration/surface_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "calibration/registration/nearest_surface.h"
#include "calibration/registration/refusing.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::number;
using SixVector = Eigen::Matrix<double, 6, 1>;
using SixMatrix = Eigen::Matrix<double, 6, 6>;

constexpr const char* kSurface = "points on the device's surface";

constexpr double kFirstReach = 0.04; ///< metres at which a point may be of the surface in the first round
constexpr double kLastReach = 0.002;
constexpr double kShrinks = 0.8; ///< from round to round
constexpr int kSurfaceRounds = 40;
constexpr std::size_t kFewestOnIt = 200;
constexpr double kLeastHold = 0.0015;    ///< mean square by which the points hold the way they hold least
constexpr double kNeighboursAlike = 5.0; ///< points near one another err alike
constexpr double kMostRms = 0.004;       ///< metres

/// Sums over the points that lie on the surface.
struct Sums {
    SixMatrix normal = SixMatrix::Zero();
    SixVector right = SixVector::Zero();
    double squares = 0.0, weights = 0.0;
    std::size_t count = 0;
};

class SurfaceFitter {
public:
    SurfaceFitter(const TriangleMesh& model, std::span<const glm::dvec3> points) : surface_(model), points_(points) {
        glm::dvec3 low(1e9), high(-1e9);
        for (const glm::vec3& p : model.positions) {
            low = glm::min(low, glm::dvec3(p));
            high = glm::max(high, glm::dvec3(p));
        }
        middle_ = 0.5 * (low + high);
        size_ = std::max(1e-3, 0.25 * glm::distance(low, high));
    }

    /// Turns about the model's middle in units of its size, so that turns and shifts compare.
    [[nodiscard]] Sums sumsAt(const Pose& worldFromModel, double reach) const {
        Sums sums;
        const Pose modelFromWorld = inverseOf(worldFromModel);
        for (const glm::dvec3& point : points_) {
            const glm::dvec3 at = modelFromWorld * point;
            const auto near = surface_.of(at, reach);
            if (!near) continue;
            const double error = glm::dot(near->normal, at - near->point);
            const double far = error / (0.5 * reach);
            const double weight = 1.0 / (1.0 + far * far);
            const glm::dvec3 turn = glm::cross(at - middle_, near->normal) / size_;
            SixVector row;
            row << turn.x, turn.y, turn.z, near->normal.x, near->normal.y, near->normal.z;
            sums.normal += weight * row * row.transpose();
            sums.right += weight * error * row;
            sums.squares += weight * error * error;
            sums.weights += weight;
            ++sums.count;
        }
        return sums;
    }

    /// The points move by the step in the model's frame, so the model moves back in the world's.
    [[nodiscard]] Pose moved(const Pose& worldFromModel, const SixVector& step) const {
        const glm::dquat turn = rotationOfTurn(glm::dvec3(step[0], step[1], step[2]) / size_);
        const Pose modelMoved{middle_ - turn * middle_ + glm::dvec3(step[3], step[4], step[5]), turn};
        return worldFromModel * modelMoved;
    }
    [[nodiscard]] double size() const noexcept { return size_; }

private:
    NearestSurface surface_;
    std::span<const glm::dvec3> points_;
    glm::dvec3 middle_{0.0};
    double size_ = 0.1;
};

/// The triangles whose outer side a camera sees, or would with the model turned by a little.
TriangleMesh facing(TriangleMesh mesh, const glm::dvec3& camera) {
    constexpr double kLeastCosine = -0.3;
    std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 normal = glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
        return glm::dot(normal, camera - a) < kLeastCosine * glm::length(normal) * glm::distance(camera, a);
    });
    return mesh;
}

void checkPoints(std::span<const glm::dvec3> points) {
    for (const glm::dvec3& p : points)
        if (!std::isfinite(p.x + p.y + p.z))
            registration::refuse(Cause::notANumber, kSurface, "a point is no number", "leave out what was not decoded");
}

void checkCount(const Sums& sums) {
    if (sums.count < kFewestOnIt)
        registration::refuse(Cause::tooFewPoints, kSurface, std::to_string(sums.count) + " points lie on the device",
                             "light the device, let the camera see it, and say where it roughly lies");
}

/// What the points hold least: in which way the surface may slide or turn along itself.
void checkHold(const Sums& sums) {
    const Eigen::SelfAdjointEigenSolver<SixMatrix> ways(sums.normal / std::max(1.0, sums.weights));
    if (ways.eigenvalues()[0] >= kLeastHold) return;
    const SixVector way = ways.eigenvectors().col(0);
    const bool slides = way.tail<3>().norm() > way.head<3>().norm();
    registration::refuse(Cause::pointsDegenerate, kSurface,
                         slides ? "what was seen is so flat that the device could slide along itself"
                                : "what was seen is so round or flat that the device could turn on itself",
                         "raise flaps while it is measured, let a camera see its sides too, or touch its corners");
}

} // namespace

SurfaceFit fitSurface(const TriangleMesh& model, std::span<const glm::dvec3> points, const glm::dvec3& seenFrom,
                      const Pose& start, const Progress& progress) {
    checkPoints(points);
    const SurfaceFitter fitter(facing(model, inverseOf(start) * seenFrom), points);
    SurfaceFit fit;
    fit.worldFromModel = start;
    double reach = kFirstReach;
    for (int round = 0; round < kSurfaceRounds; ++round) {
        progress.throwIfCancelled();
        progress.report(double(round) / kSurfaceRounds, "fitting the surface");
        const Sums sums = fitter.sumsAt(fit.worldFromModel, reach);
        checkCount(sums);
        SixMatrix damped = sums.normal;
        damped.diagonal().array() += 1e-9 * sums.weights;
        const SixVector step = damped.ldlt().solve(sums.right);
        fit.worldFromModel = fitter.moved(fit.worldFromModel, step);
        if (reach <= kLastReach && step.cwiseAbs().maxCoeff() < 1e-7) break;
        reach = std::max(kLastReach, kShrinks * reach);
    }
    const Sums sums = fitter.sumsAt(fit.worldFromModel, reach);
    checkCount(sums);
    checkHold(sums);
    fit.rms = std::sqrt(sums.squares / sums.weights);
    fit.share = double(sums.count) / double(points.size());
    if (fit.rms > kMostRms)
        registration::refuse(Cause::modelDoesNotFit, kSurface,
                             "they lie " + number(1000.0 * fit.rms, 1) + " mm off the model's surface",
                             "see that the model is that of this device, and that it rests");
    const SixMatrix inverse = sums.normal.inverse();
    const double sigma = kNeighboursAlike * fit.rms;
    fit.turnSigma = sigma * std::sqrt(inverse.topLeftCorner<3, 3>().trace()) / fitter.size();
    fit.shiftSigma = sigma * std::sqrt(inverse.bottomRightCorner<3, 3>().trace());
    return fit;
}

registration::FittedPlace placeDeviceBySurface(const SurfaceFit& fit, const PoseTrack& body,
                                               const Pose& worldFromTracker) {
    std::vector<Pose> poses;
    for (const TimedPose& at : soundTrack(body, "body of the device").poses) poses.push_back(at.pose);
    registration::FittedPlace place;
    place.figures.bodyFromDevice = inverseOf(worldFromTracker * meanPose(poses)) * fit.worldFromModel;
    place.rms = fit.rms;
    place.turnSigma = fit.turnSigma;
    place.shiftSigma = fit.shiftSigma;
    return place;
}

} // namespace lumorph

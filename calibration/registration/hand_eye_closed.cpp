#include "calibration/registration/hand_eye_closed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "calibration/registration/refusing.h"
#include "core/base/statistics.h"

namespace lumorph::hand_eye {

namespace {

using registration::eigen;
using registration::kDegree;
using registration::number;

constexpr double kLeastTurned = 8.0 * kDegree; ///< spread of relative turns about the axis of most
constexpr double kLeastAcross = 5.0 * kDegree; ///< and about the second
constexpr std::size_t kMostPairs = 6000;

/// Relative motions of both between two moments: X A = B X.
struct Motion {
    Pose a, b;
    glm::dvec3 turnA{0.0}, turnB{0.0};
};

/// All pairs of few moments; of many pairs at many distances in time.
std::vector<Motion> motionsOf(std::span<const Both> both) {
    std::vector<Motion> motions;
    const std::size_t n = both.size();
    const auto add = [&](std::size_t i, std::size_t j) {
        Motion m;
        m.a = inverseOf(both[i].a) * both[j].a;
        m.b = inverseOf(both[i].b) * both[j].b;
        m.turnA = turnOf(m.a.rotation);
        m.turnB = turnOf(m.b.rotation);
        if (glm::length(m.turnA) < 3.0) motions.push_back(m); // near a half turn the axis may be either
    };
    const bool isFew = n * n / 2 < kMostPairs;
    const std::size_t stride = std::max<std::size_t>(1, n * 10 / kMostPairs);
    for (std::size_t i = 0; i < n; i += isFew ? 1 : stride)
        for (std::size_t k = 1; isFew ? i + k < n : k <= 10; ++k) {
            const std::size_t j = i + (isFew ? k : std::max<std::size_t>(k, k * k * n / 200));
            if (j >= n) break;
            add(i, j);
        }
    return motions;
}

/// Turning about one axis alone tells neither the other angle nor the place along it.
void checkTurns(const std::vector<Motion>& motions, std::span<const Both> both) {
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Motion& m : motions) spread += eigen(m.turnA) * eigen(m.turnA).transpose();
    spread /= std::max<double>(1.0, double(motions.size()));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    const double most = std::sqrt(std::max(0.0, axes.eigenvalues()[2]));
    const double second = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
    if (most < kLeastTurned)
        registration::refuse(Cause::motionDegenerate, kBodies,
                             "the bodies hardly turned, " + number(most / kDegree, 1) + " degrees",
                             "turn them by 30 degrees and more about two axes, not only move them");
    if (second >= kLeastAcross) return;
    // Named in the world of A where it is upright or lies; worlds of ours have Y up.
    glm::dvec3 axis(axes.eigenvectors()(0, 2), axes.eigenvectors()(1, 2), axes.eigenvectors()(2, 2));
    axis = both.front().a.rotation * axis;
    const bool upright = std::abs(axis.y) > 0.94;
    registration::refuse(Cause::motionDegenerate, kBodies,
                         "the bodies turned about one axis alone, (" + number(axis.x, 2) + ", " + number(axis.y, 2) +
                             ", " + number(axis.z, 2) + ") in the world of the first" +
                             (upright ? ", which is upright" : ""),
                         upright ? "also tilt them forwards and sideways by 20 degrees and more"
                                 : "also turn them about the vertical axis by 30 degrees and more");
}

/// Motions whose turns have the same angle: only those can be of one body.
std::vector<Motion> agreeing(const std::vector<Motion>& motions) {
    std::vector<double> differences;
    const auto difference = [](const Motion& m) { return std::abs(glm::length(m.turnA) - glm::length(m.turnB)); };
    differences.reserve(motions.size());
    for (const Motion& m : motions) differences.push_back(difference(m));
    const double usual = std::max(0.2 * kDegree, median(differences));
    std::vector<Motion> kept;
    std::ranges::copy_if(motions, std::back_inserter(kept),
                         [&](const Motion& m) { return difference(m) < 3.0 * usual; });
    if (usual > 10.0 * kDegree)
        registration::refuse(Cause::modelDoesNotFit, kBodies,
                             "they do not turn alike: angles differ by " + number(usual / kDegree, 0) + " degrees",
                             "record two bodies that are joined rigidly, and see that the tracker does not swap them");
    return kept;
}

/// turnB = R turnA, in closed form; motions that contradict it are left out of `motions`.
glm::dquat rotationOf(std::vector<Motion>& motions) {
    glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
    double limit = 1e9;
    for (int round = 0; round < 3; ++round) {
        Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
        std::vector<double> left;
        for (const Motion& m : motions) {
            const double error = glm::length(m.turnB - rotation * m.turnA);
            if (error < limit) cross += eigen(m.turnB) * eigen(m.turnA).transpose();
        }
        const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
        const double hand = (svd.matrixU() * svd.matrixV().transpose()).determinant();
        const Eigen::Quaterniond q(
            Eigen::Matrix3d(svd.matrixU() * Eigen::Vector3d(1.0, 1.0, hand).asDiagonal() * svd.matrixV().transpose()));
        rotation = {q.w(), q.x(), q.y(), q.z()};
        left.reserve(motions.size());
        for (const Motion& m : motions) left.push_back(glm::length(m.turnB - rotation * m.turnA));
        limit = 3.0 * std::max(0.1 * kDegree, median(left));
    }
    std::erase_if(motions, [&](const Motion& m) { return glm::length(m.turnB - rotation * m.turnA) >= limit; });
    return rotation;
}

/// The place of A in B, and by how much A's unit of length is too long: (R_B - 1) t - s R t_A = -t_B, least squares
/// with weights that spare what fits badly; `unit` keeps s = 1.
struct PlaceFit {
    glm::dvec3 place{0.0};
    double scale = 1.0, scaleSigma = 0.0;
    double left = 0.0; ///< median of what is left, metres
};
PlaceFit placeOf(const std::vector<Motion>& motions, const glm::dquat& bFromA, bool unit = false) {
    PlaceFit fit;
    double usual = 1e9;
    for (int round = 0; round < 6; ++round) {
        Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
        Eigen::Vector4d right = Eigen::Vector4d::Zero();
        Eigen::Vector4d solution(fit.place.x, fit.place.y, fit.place.z, fit.scale);
        const auto rowsOf = [&](const Motion& m) {
            Eigen::Matrix<double, 3, 4> rows;
            const Eigen::Quaterniond turn(m.b.rotation.w, m.b.rotation.x, m.b.rotation.y, m.b.rotation.z);
            rows.leftCols<3>() = turn.toRotationMatrix() - Eigen::Matrix3d::Identity();
            rows.col(3) = -eigen(bFromA * m.a.position);
            return rows;
        };
        for (const Motion& m : motions) {
            const auto rows = rowsOf(m);
            const double error = round == 0 ? 0.0 : (rows * solution + eigen(m.b.position)).norm() / usual;
            const double weight = 1.0 / (1.0 + error * error);
            normal += weight * rows.transpose() * rows;
            right -= weight * rows.transpose() * eigen(m.b.position);
        }
        if (unit) {
            solution.head<3>() =
                normal.topLeftCorner<3, 3>().ldlt().solve(right.head<3>() - normal.topRightCorner<3, 1>());
            solution[3] = 1.0;
        } else {
            solution = normal.ldlt().solve(right);
        }
        std::vector<double> left;
        left.reserve(motions.size());
        for (const Motion& m : motions) left.push_back((rowsOf(m) * solution + eigen(m.b.position)).norm());
        usual = std::max(1e-6, median(left));
        fit = {{solution[0], solution[1], solution[2]}, solution[3], 0.0, usual};
        // Pairs share poses: as if a tenth of them were independent.
        fit.scaleSigma = usual * std::sqrt(10.0 * std::max(0.0, normal.inverse()(3, 3)));
    }
    return fit;
}

Pose worldsOf(std::span<const Both> both, const Pose& bFromA) {
    std::vector<double> x, y, z;
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    for (const Both& at : both) {
        const Pose world = at.b * bFromA * inverseOf(at.a);
        x.push_back(world.position.x);
        y.push_back(world.position.y);
        z.push_back(world.position.z);
        const Eigen::Vector4d q(world.rotation.w, world.rotation.x, world.rotation.y, world.rotation.z);
        sum += q * q.transpose();
    }
    // The mean of rotations whatever their signs (Markley et al. 2007).
    const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(sum).eigenvectors().col(3);
    return {{median(x), median(y), median(z)}, {q[0], q[1], q[2], q[3]}};
}

/// How far a body's origin moves about in its world: half of the time farther than this from its middle, metres.
double rangeOf(std::span<const Both> both, Pose Both::*body) {
    std::array<std::vector<double>, 3> along;
    for (const Both& at : both)
        for (int axis = 0; axis < 3; ++axis) along.at(std::size_t(axis)).push_back((at.*body).position[axis]);
    const glm::dvec3 middle(median(along[0]), median(along[1]), median(along[2]));
    std::vector<double> from;
    for (const Both& at : both) from.push_back(glm::distance((at.*body).position, middle));
    return median(std::move(from));
}

/// Units whose metres are so many times another's.
struct Ratio {
    double value;
    const char* of;
};
constexpr std::array kRatios{
    Ratio{10.0, "as millimetres are to centimetres"},
    Ratio{100.0, "as centimetres are to metres"},
    Ratio{1000.0, "as millimetres are to metres"},
    Ratio{1.0 / 0.3048, "as feet are to metres"},
    Ratio{1.0 / 0.0254, "as inches are to metres"},
    Ratio{1.0 / 0.9144, "as yards are to metres"},
    Ratio{30.48, "as centimetres are to feet"},
    Ratio{304.8, "as millimetres are to feet"},
    Ratio{2.54, "as centimetres are to inches"},
    Ratio{25.4, "as millimetres are to inches"},
    Ratio{12.0, "as inches are to feet"},
    Ratio{1e6, "as micrometres are to metres"},
};
constexpr double kNearRatio = 0.04;
constexpr double kOneUnit = 0.1; ///< of 1: noise of short motions

/// Places that fit well, but at another scale than 1.
[[noreturn]] void refuseScale(const PlaceFit& place, const Names& names) {
    if (place.scale <= 0.0)
        registration::refuse(Cause::modelDoesNotFit, kBodies, "they turn alike, but their places fit at no scale",
                             "record two bodies that are joined rigidly");
    const bool isLarger = std::abs(place.scale) > 1.0; // the second's
    const double ratio = isLarger ? place.scale : 1.0 / place.scale;
    const std::string larger = isLarger ? names.b : names.a, smaller = isLarger ? names.a : names.b;
    const std::string why =
        "the " + larger + "'s places are " + number(ratio, 2) + " times as large as the " + smaller + "'s";
    const double tolerance = std::max(kNearRatio, std::min(0.1, 3.0 * place.scaleSigma / std::abs(place.scale)));
    for (const Ratio& known : kRatios)
        if (std::abs(ratio / known.value - 1.0) < tolerance)
            registration::refuse(Cause::wrongUnits, kBodies, why + ", " + known.of, "write both in metres");
    registration::refuse(Cause::modelDoesNotFit, kBodies, why + ", which is the ratio of no two units",
                         "look what gives each its scale: the side of a board's squares, the distance of markers, or a "
                         "camera alone, which knows none");
}

/// Whether places tell a scale, and whether that is 1. Where a body turns about its own origin, or the places fit at no
/// scale, they tell none.
void checkScale(const PlaceFit& place, const Names& names, ClosedForm& found, std::span<const Both> both) {
    constexpr double kTells = 5.0; // times what is left
    found.aInPlace = rangeOf(both, &Both::a) * std::abs(place.scale) <= kTells * place.left;
    found.bInPlace = rangeOf(both, &Both::b) <= kTells * place.left;
    if (found.aInPlace || found.bInPlace) return;
    if (place.scale < -3.0 * place.scaleSigma && place.scale < -0.5)
        registration::refuse(Cause::mirrored, kBodies,
                             "they fit only as mirror images: one of the two worlds is left-handed",
                             "turn one of them into right-handed coordinates: negate z, qx and qy");
    if (std::abs(place.scale - 1.0) > std::max(kOneUnit, 6.0 * place.scaleSigma)) refuseScale(place, names);
}

} // namespace

std::vector<Both> together(const PoseTrack& a, const PoseTrack& b, const ClockOffset& clocks) {
    std::vector<Both> both;
    for (const TimedPose& pose : b.poses)
        if (const auto at = poseAt(a, clocks.toA(pose.seconds))) both.push_back({*at, pose.pose});
    return both;
}

ClosedForm closedForm(std::span<const Both> both, const Names& names) {
    const std::vector<Motion> all = motionsOf(both);
    checkTurns(all, both);
    std::vector<Motion> motions = agreeing(all);
    const glm::dquat rotation = rotationOf(motions);
    PlaceFit place = placeOf(motions, rotation);
    ClosedForm found;
    checkScale(place, names, found, both);
    if (found.aInPlace || found.bInPlace) place = placeOf(motions, rotation, true);
    found.bFromA = {place.place, rotation};
    found.worldBFromWorldA = worldsOf(both, found.bFromA);
    return found;
}

} // namespace lumorph::hand_eye

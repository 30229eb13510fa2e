#include "calibration/registration/rigid_fit.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "calibration/registration/pose_track.h"
#include "calibration/registration/refusing.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

using registration::eigen;

constexpr double kLine = 1e-3; ///< second spread over the first: less is a line

struct Moments {
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
    Eigen::Matrix3d spreadFrom = Eigen::Matrix3d::Zero(), spreadTo = Eigen::Matrix3d::Zero(),
                    cross = Eigen::Matrix3d::Zero();
};

Moments momentsOf(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to, std::span<const double> weights) {
    Moments m;
    double sum = 0.0;
    const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
    for (std::size_t i = 0; i < from.size(); ++i) {
        m.from += weight(i) * eigen(from[i]);
        m.to += weight(i) * eigen(to[i]);
        sum += weight(i);
    }
    m.from /= sum;
    m.to /= sum;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Eigen::Vector3d a = eigen(from[i]) - m.from, b = eigen(to[i]) - m.to;
        m.spreadFrom += weight(i) / sum * a * a.transpose();
        m.spreadTo += weight(i) / sum * b * b.transpose();
        m.cross += weight(i) / sum * b * a.transpose();
    }
    return m;
}

} // namespace

RigidFit fitRigid(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to, std::span<const double> weights) {
    if (from.size() != to.size() || from.size() < 3 || (!weights.empty() && weights.size() != from.size()))
        throw InvalidInput("rigid fit", "needs three pairs of points or more", "give as many of one as of the other");
    const Moments m = momentsOf(from, to, weights);
    const Eigen::Vector3d spread = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m.spreadFrom).eigenvalues();
    if (!(spread[1] > kLine * kLine * spread[2]))
        throw InvalidInput("rigid fit", "all points lie on a line", "take a point beside it");

    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m.cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double hand = (svd.matrixU() * svd.matrixV().transpose()).determinant();
    Eigen::Vector3d signs(1.0, 1.0, hand < 0.0 ? -1.0 : 1.0);
    const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    const Eigen::Vector3d shift = m.to - rotation * m.from;
    const Eigen::Quaterniond q(rotation);

    RigidFit fit;
    fit.toFromFrom = {{shift.x(), shift.y(), shift.z()}, {q.w(), q.x(), q.y(), q.z()}};
    const double explained = svd.singularValues().dot(signs);
    fit.rms = std::sqrt(std::max(0.0, m.spreadFrom.trace() + m.spreadTo.trace() - 2.0 * explained));
    fit.scale = std::sqrt(m.spreadTo.trace() / m.spreadFrom.trace());
    // The sum of all singular values is what a reflection explains.
    const double leftMirrored = m.spreadFrom.trace() + m.spreadTo.trace() - 2.0 * svd.singularValues().sum();
    fit.mirrored = hand < 0.0 && leftMirrored < 0.01 * fit.rms * fit.rms;
    return fit;
}

} // namespace lumorph

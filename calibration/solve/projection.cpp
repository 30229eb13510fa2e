#include "calibration/solve/projection.h"

#include <cmath>

#include <Eigen/Dense>

namespace lumorph {

namespace {

/// How a distorted direction moves with k1, k2, p1, p2 and k3.
Eigen::Matrix<double, 2, 5> byDistortion(double x, double y) {
    const double r2 = x * x + y * y;
    Eigen::Matrix<double, 2, 5> slopes;
    slopes << x * r2, x * r2 * r2, 2.0 * x * y, r2 + 2.0 * x * x, x * r2 * r2 * r2, //
        y * r2, y * r2 * r2, r2 + 2.0 * y * y, 2.0 * x * y, y * r2 * r2 * r2;
    return slopes;
}

Eigen::Matrix2d distortionSlopes(const Lens& lens, double x, double y) {
    const auto [a, b, c, d] = lens_detail::distortionJacobian(lens, x, y);
    return (Eigen::Matrix2d() << a, b, c, d).finished();
}

} // namespace

Eigen::Matrix3d crossOf(const Eigen::Vector3d& v) {
    Eigen::Matrix3d cross;
    cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return cross;
}

PoseMatrix::PoseMatrix(const PoseVector& pose) : shift(pose[3], pose[4], pose[5]) {
    const Eigen::Vector3d w(pose[0], pose[1], pose[2]);
    const double angle = w.norm();
    const Eigen::Matrix3d cross = crossOf(w);
    const bool small = angle < 1e-4;
    const double a2 = angle * angle;
    const double second = small ? 0.5 - a2 / 24.0 : (1.0 - std::cos(angle)) / a2;
    const double third = small ? 1.0 / 6.0 - a2 / 120.0 : (angle - std::sin(angle)) / (a2 * angle);
    rotation = Eigen::Map<const Eigen::Matrix3d>(&Rigid::exp(pose).rotation[0][0]);
    turn = Eigen::Matrix3d::Identity() - second * cross + third * cross * cross;
}

Projected project(const Lens& lens, const Eigen::Vector3d& point) {
    const double x = point.x() / point.z();
    const double y = point.y() / point.z();
    Eigen::Vector2d distorted;
    distort(lens.data(), x, y, distorted.x(), distorted.y());
    const double focal = lens[kFocalLength];
    const Eigen::Vector2d scale(focal, focal * lens[kAspect]);
    Projected out;
    out.pixel = Eigen::Vector2d(lens[kPrincipalX], lens[kPrincipalY]) + scale.cwiseProduct(distorted);
    PixelByPoint direction;
    direction << 1.0, 0.0, -x, 0.0, 1.0, -y;
    out.byPoint = scale.asDiagonal() * distortionSlopes(lens, x, y) * direction / point.z();
    out.byLens.setZero();
    out.byLens.col(kFocalLength) << distorted.x(), lens[kAspect] * distorted.y();
    out.byLens(1, kAspect) = focal * distorted.y();
    out.byLens(0, kPrincipalX) = out.byLens(1, kPrincipalY) = 1.0;
    out.byLens.rightCols<5>() = scale.asDiagonal() * byDistortion(x, y);
    return out;
}

PixelByLens directionByLens(const Lens& lens, double u, double v, double x, double y) {
    const double focal = lens[kFocalLength];
    const double across = (u - lens[kPrincipalX]) / focal;
    const double down = (v - lens[kPrincipalY]) / (focal * lens[kAspect]);
    PixelByLens wanted = PixelByLens::Zero(); // distort(direction) stays what the pixel says
    wanted.col(kFocalLength) << -across / focal, -down / focal;
    wanted(1, kAspect) = -down / lens[kAspect];
    wanted(0, kPrincipalX) = -1.0 / focal;
    wanted(1, kPrincipalY) = -1.0 / (focal * lens[kAspect]);
    wanted.rightCols<5>() = -byDistortion(x, y);
    return distortionSlopes(lens, x, y).inverse() * wanted;
}

} // namespace lumorph

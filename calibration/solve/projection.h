#pragma once

#include <Eigen/Core>

#include "calibration/solve/lens_model.h"
#include "core/geometry/rigid.h"

namespace lumorph {

using PixelByPoint = Eigen::Matrix<double, 2, 3>;
using PixelByLens = Eigen::Matrix<double, 2, kLensParameters>;

/// The matrix that makes a cross product with `v` from the left.
[[nodiscard]] Eigen::Matrix3d crossOf(const Eigen::Vector3d& v);

/// A pose vector (radians, unit of length) as a rotation, and the rotation's right Jacobian: R(w + d) = R(w) exp(J d)
/// (Sola, Deray, Atchuthan, "A micro Lie theory", eq. 143).
struct PoseMatrix {
    Eigen::Matrix3d rotation, turn;
    Eigen::Vector3d shift;

    explicit PoseMatrix(const PoseVector& pose);
    [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + shift; }
};

/// A point's pixel, and how it moves with point and lens.
struct Projected {
    Eigen::Vector2d pixel;
    PixelByPoint byPoint;
    PixelByLens byLens;
};
/// Of a point in the lens's frame; its z must not be 0.
[[nodiscard]] Projected project(const Lens& lens, const Eigen::Vector3d& point);

/// How the direction (x, y, 1) of a pixel moves with the lens, the pixel being (u, v).
[[nodiscard]] PixelByLens directionByLens(const Lens& lens, double u, double v, double x, double y);

} // namespace lumorph

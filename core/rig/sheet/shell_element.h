#pragma once

#include <array>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/rig/sheet/sheet_material.h"

// One triangle of the discrete shell. Its shape is known by six numbers: the squared lengths l of its edges and the
// heights h of its corners above the tangent planes at the middles of the opposite edges,
//     h_k = (x_k - m_k) . n_k,    n_k the director of edge k, m_k its middle.
// With the gradients g of the barycentric coordinates of the flat triangle the second fundamental form of mid-edge
// normals is the sum of 2 h_k g_k (x) g_k, and Green strain the sum of -(q_k - q0_k)/2 sym(g_i (x) g_j), where q_k is
// the squared length of the arc above edge k: l_k + (h_i + h_j)^2 / 3, because the form takes the value 2 (h_i + h_j)
// for edge k. Indices i, j are the two others of k.

namespace lumorph {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Rest shape and stiffness of a triangle.
struct ShellElement {
    Matrix3 strainOf;    ///< Green strain (xx, zz, 2 xz) from squared arc lengths less those at rest
    Matrix3 curvatureOf; ///< second fundamental form (xx, zz, 2 xz) from heights
    Matrix3 membrane;    ///< energy = q' membrane q / 2
    Matrix3 bending;     ///< energy = h' bending h / 2
    Vector3 restLengths; ///< squared
    Vector3 edgeSign;    ///< -1 where the triangle runs an edge from its upper node to the lower
};

/// Unknowns are the corners x, and for each edge an angle by which its director is turned about the edge.
struct ShellCorners {
    std::array<Vector3, 3> x;
    std::array<Vector3, 3> director;
};

/// Flat triangle with these corners (x, z), of these layers.
ShellElement shellElement(const std::array<Eigen::Vector2d, 3>& corners, const Vector3& edgeSign,
                          std::span<const SheetLayer> layers);

/// Heights of the corners.
Vector3 heightsOf(const ShellCorners& corners);
/// Squared arc lengths of the edges less those at rest.
Vector3 arcLengthsOf(const ShellElement& element, const ShellCorners& corners, const Vector3& heights);

double shellEnergy(const ShellElement& element, const ShellCorners& corners);

/// Work conjugates of squared arc lengths and of heights.
struct ShellStress {
    Vector3 membrane;
    Vector3 bending;
};
ShellStress stressOf(const ShellElement& element, const ShellCorners& corners);
/// Of the strains that a step of x_0, x_1, x_2 and the three angles would give if they were linear in it.
ShellStress stressAfter(const ShellElement& element, const ShellCorners& corners, const Vector12& step);

/// Derivative of the energy by x_0, x_1, x_2 and the three angles.
Vector12 shellGradient(const ShellElement& element, const ShellCorners& corners);
/// The same, and the Hessian with a geometric stiffness of this stress.
Vector12 shellGradient(const ShellElement& element, const ShellCorners& corners, const ShellStress& stress,
                       Matrix12& hessian);

} // namespace lumorph

#include "core/rig/sheet/shell_element.h"

namespace lumorph {
namespace {

using Matrix34 = Eigen::Matrix<double, 3, 4>;
using Matrix3x12 = Eigen::Matrix<double, 3, 12>;

/// Sums over the two others of an index.
const Matrix3 kOthers = Matrix3::Ones() - Matrix3::Identity();

Matrix3 crossMatrix(const Vector3& v) {
    Matrix3 m;
    m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return m;
}

/// Plane stress, for strains (xx, zz, 2 xz).
Matrix3 planeStress(const SheetMaterial& material) {
    const double nu = material.poissonRatio;
    Matrix3 m;
    m << 1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu);
    return material.youngsModulus / (1.0 - nu * nu) * m;
}

/// Weights of the corners in the vector from the middle of edge k to corner k.
double apexWeight(int k, int corner) { return corner == k ? 1.0 : -0.5; }
/// Weights of the corners in edge k, which runs from corner k + 1 to corner k + 2.
double edgeWeight(int k, int corner) { return corner == k ? 0.0 : corner == (k + 1) % 3 ? -1.0 : 1.0; }

Vector3 apexOf(const ShellCorners& c, int k) { return c.x[k] - 0.5 * (c.x[(k + 1) % 3] + c.x[(k + 2) % 3]); }
Vector3 edgeOf(const ShellCorners& c, int k) { return c.x[(k + 2) % 3] - c.x[(k + 1) % 3]; }

/// A height a . n as a function of apex a, edge e and angle t, with n = w/|w| and w = e x (c + t n0). The conormal
/// c = n0 x e/|e| is fixed, so that n is n0 for t = 0 and stays perpendicular to the edge as that turns.
struct Height {
    Height(const Vector3& apex, const Vector3& edge, const Vector3& director, double edgeSign)
        : a(apex), n(director), e(edge), conormal(director.cross(edge).normalized()), sign(edgeSign),
          length(edge.norm()), value(apex.dot(director)) {
        byW = (a - value * n) / length;
        wByEdge.leftCols<3>() = -crossMatrix(conormal);
        wByEdge.col(3) = sign * e.cross(n);
    }
    /// Derivative by edge and angle.
    [[nodiscard]] Eigen::Vector4d byEdge() const { return wByEdge.transpose() * byW; }
    /// Second derivative by apex, and edge and angle.
    [[nodiscard]] Matrix34 byApexAndEdge() const { return (wByEdge - n * (n.transpose() * wByEdge)) / length; }
    /// Second derivative by edge and angle.
    [[nodiscard]] Eigen::Matrix4d byEdgeTwice() const {
        const Matrix3 byWTwice = -(n * byW.transpose() + byW * n.transpose()) / length -
                                 value / (length * length) * (Matrix3::Identity() - n * n.transpose());
        Eigen::Matrix4d m = wByEdge.transpose() * byWTwice * wByEdge;
        const Vector3 mixed = sign * n.cross(byW); // of w . byW by edge and angle
        m.topRightCorner<3, 1>() += mixed;
        m.bottomLeftCorner<1, 3>() += mixed.transpose();
        return m;
    }

    Vector3 a;
    Vector3 n;
    Vector3 e;
    Vector3 conormal;
    double sign;
    double length;
    double value;
    Vector3 byW;
    Matrix34 wByEdge;
};

/// Adds weight x the second derivative of height k.
void addHeightHessian(const Height& height, int k, double weight, Matrix12& hessian) {
    const Matrix34 cross = weight * height.byApexAndEdge();
    const Eigen::Matrix4d twice = weight * height.byEdgeTwice();
    const Matrix3 apexEdge = cross.leftCols<3>();
    const Matrix3 edgeEdge = twice.topLeftCorner<3, 3>();
    for (int p = 0; p < 3; ++p) {
        for (int q = 0; q < 3; ++q)
            hessian.block<3, 3>(3 * p, 3 * q) += apexWeight(k, p) * edgeWeight(k, q) * apexEdge +
                                                 edgeWeight(k, p) * apexWeight(k, q) * apexEdge.transpose() +
                                                 edgeWeight(k, p) * edgeWeight(k, q) * edgeEdge;
        const Vector3 byAngle = apexWeight(k, p) * cross.col(3) + edgeWeight(k, p) * twice.topRightCorner<3, 1>();
        hessian.block<3, 1>(3 * p, 9 + k) += byAngle;
        hessian.block<1, 3>(9 + k, 3 * p) += byAngle.transpose();
    }
    hessian(9 + k, 9 + k) += twice(3, 3);
}

/// Adds weight x the second derivative of the squared length of edge k.
void addLengthHessian(int k, double weight, Matrix12& hessian) {
    for (int p = 0; p < 3; ++p)
        for (int q = 0; q < 3; ++q)
            hessian.block<3, 3>(3 * p, 3 * q).diagonal().array() += 2.0 * weight * edgeWeight(k, p) * edgeWeight(k, q);
}

/// First derivatives of squared arc lengths and heights by the twelve unknowns.
struct Jacobians {
    Jacobians(const ShellElement& element, const ShellCorners& corners)
        : heights{heightAt(element, corners, 0), heightAt(element, corners, 1), heightAt(element, corners, 2)} {
        const Vector3 h(heights[0].value, heights[1].value, heights[2].value);
        arcByHeight = 2.0 / 3.0 * (kOthers * h).asDiagonal() * kOthers;
        turns.setZero();
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector4d byEdge = heights[k].byEdge();
            for (int p = 0; p < 3; ++p)
                turns.block<1, 3>(k, 3 * p) =
                    (apexWeight(k, p) * heights[k].n + edgeWeight(k, p) * byEdge.head<3>()).transpose();
            turns(k, 9 + k) = byEdge[3];
        }
        arcs = arcByHeight * turns;
        for (int k = 0; k < 3; ++k)
            for (int p = 0; p < 3; ++p) arcs.block<1, 3>(k, 3 * p) += 2.0 * edgeWeight(k, p) * heights[k].e.transpose();
    }

    static Height heightAt(const ShellElement& element, const ShellCorners& corners, int k) {
        return Height(apexOf(corners, k), edgeOf(corners, k), corners.director[k], element.edgeSign[k]);
    }

    std::array<Height, 3> heights;
    Matrix3 arcByHeight;
    Matrix3x12 turns; ///< of heights
    Matrix3x12 arcs;  ///< of squared arc lengths
};

} // namespace

ShellElement shellElement(const std::array<Eigen::Vector2d, 3>& corners, const Vector3& edgeSign,
                          std::span<const SheetLayer> layers) {
    ShellElement element;
    element.edgeSign = edgeSign;
    std::array<Eigen::Vector2d, 3> g;
    const auto edge = [&](int k) -> Eigen::Vector2d { return corners[(k + 2) % 3] - corners[(k + 1) % 3]; };
    const double twiceArea = edge(2).x() * edge(1).y() - edge(2).y() * edge(1).x();
    for (int k = 0; k < 3; ++k) {
        element.restLengths[k] = edge(k).squaredNorm();
        g[k] = Eigen::Vector2d(edge(k).y(), -edge(k).x()) / twiceArea;
        if (g[k].dot(corners[k] - corners[(k + 1) % 3]) < 0.0) g[k] = -g[k];
    }
    for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d& i = g[(k + 1) % 3];
        const Eigen::Vector2d& j = g[(k + 2) % 3];
        element.strainOf.col(k) = -0.5 * Vector3(i.x() * j.x(), i.y() * j.y(), i.x() * j.y() + i.y() * j.x());
        element.curvatureOf.col(k) = 2.0 * Vector3(g[k].x() * g[k].x(), g[k].y() * g[k].y(), 2.0 * g[k].x() * g[k].y());
    }
    Matrix3 membrane = Matrix3::Zero();
    Matrix3 bending = Matrix3::Zero();
    for (const auto& [material, thickness, loose] : layers) {
        if (!loose) membrane += thickness * planeStress(material);
        bending += thickness * thickness * thickness / 12.0 * planeStress(material);
    }
    const double area = 0.5 * std::abs(twiceArea);
    element.membrane = area * element.strainOf.transpose() * membrane * element.strainOf;
    element.bending = area * element.curvatureOf.transpose() * bending * element.curvatureOf;
    return element;
}

Vector3 heightsOf(const ShellCorners& corners) {
    return {apexOf(corners, 0).dot(corners.director[0]), apexOf(corners, 1).dot(corners.director[1]),
            apexOf(corners, 2).dot(corners.director[2])};
}

Vector3 arcLengthsOf(const ShellElement& element, const ShellCorners& corners, const Vector3& heights) {
    const Vector3 others = kOthers * heights;
    Vector3 q;
    for (int k = 0; k < 3; ++k)
        q[k] = edgeOf(corners, k).squaredNorm() + others[k] * others[k] / 3.0 - element.restLengths[k];
    return q;
}

double shellEnergy(const ShellElement& element, const ShellCorners& corners) {
    const Vector3 h = heightsOf(corners);
    const Vector3 q = arcLengthsOf(element, corners, h);
    return 0.5 * q.dot(element.membrane * q) + 0.5 * h.dot(element.bending * h);
}

ShellStress stressOf(const ShellElement& element, const ShellCorners& corners) {
    const Vector3 heights = heightsOf(corners);
    return {element.membrane * arcLengthsOf(element, corners, heights), element.bending * heights};
}

ShellStress stressAfter(const ShellElement& element, const ShellCorners& corners, const Vector12& step) {
    const Jacobians by(element, corners);
    const ShellStress stress = stressOf(element, corners);
    return {stress.membrane + element.membrane * (by.arcs * step),
            stress.bending + element.bending * (by.turns * step)};
}

Vector12 shellGradient(const ShellElement& element, const ShellCorners& corners) {
    const Jacobians by(element, corners);
    const ShellStress stress = stressOf(element, corners);
    return by.arcs.transpose() * stress.membrane + by.turns.transpose() * stress.bending;
}

Vector12 shellGradient(const ShellElement& element, const ShellCorners& corners, const ShellStress& stress,
                       Matrix12& hessian) {
    const Jacobians by(element, corners);
    const Matrix3 arcs = 2.0 / 3.0 * kOthers * stress.membrane.asDiagonal() * kOthers;
    hessian =
        by.arcs.transpose() * element.membrane * by.arcs + by.turns.transpose() * (element.bending + arcs) * by.turns;
    const Vector3 byHeight = stress.bending + by.arcByHeight.transpose() * stress.membrane;
    for (int k = 0; k < 3; ++k) {
        addLengthHessian(k, stress.membrane[k], hessian);
        addHeightHessian(by.heights[k], k, byHeight[k], hessian);
    }
    const ShellStress now = stressOf(element, corners);
    return by.arcs.transpose() * now.membrane + by.turns.transpose() * now.bending;
}

} // namespace lumorph

#include "calibration/lab/lab_lens.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr double kWidestSlope = 20.0; ///< about 87 degrees; nothing useful is seen beyond

/// How the distorted radius grows with the true one: d(r (1 + k1 r^2 + k2 r^4 + k3 r^6)) / dr.
double radialGrowth(const LabLens& lens, double radius) {
    const double r2 = radius * radius;
    return 1.0 + r2 * (3.0 * lens.k1 + r2 * (5.0 * lens.k2 + r2 * 7.0 * lens.k3));
}

/// The first radius at which the growth ends, by small steps and bisection.
double foldingRadius(const LabLens& lens) {
    constexpr double kStep = 0.01;
    for (double radius = kStep; radius < kWidestSlope; radius += kStep) {
        if (radialGrowth(lens, radius) > 0.0) continue;
        double low = radius - kStep;
        double high = radius;
        for (int i = 0; i < 40; ++i) (radialGrowth(lens, 0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
        return low;
    }
    return kWidestSlope;
}

/// Brown's model on the plane at distance 1.
glm::dvec2 distorted(const LabLens& lens, const glm::dvec2& slope) {
    const double x = slope.x;
    const double y = slope.y;
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
    return {x * radial + 2.0 * lens.p1 * x * y + lens.p2 * (r2 + 2.0 * x * x),
            y * radial + lens.p1 * (r2 + 2.0 * y * y) + 2.0 * lens.p2 * x * y};
}

/// The derivative of `distorted`, column by column.
glm::dmat2 distortionSlope(const LabLens& lens, const glm::dvec2& slope) {
    const double x = slope.x;
    const double y = slope.y;
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
    const double growth = 2.0 * (lens.k1 + r2 * (2.0 * lens.k2 + r2 * 3.0 * lens.k3)); // d(radial)/dx = growth * x
    const double across = growth * x * y + 2.0 * lens.p1 * x + 2.0 * lens.p2 * y;
    return {radial + growth * x * x + 2.0 * lens.p1 * y + 6.0 * lens.p2 * x, across, across,
            radial + growth * y * y + 6.0 * lens.p1 * y + 2.0 * lens.p2 * x};
}

bool isFinite(const LabLens& lens) {
    double sum = lens.k1 + lens.k2 + lens.k3 + lens.p1 + lens.p2;
    for (int axis = 0; axis < 2; ++axis) sum += lens.focal[axis] + lens.principal[axis];
    for (int axis = 0; axis < 3; ++axis)
        sum += lens.position[axis] + glm::dot(lens.worldFromLens[axis], lens.worldFromLens[axis]);
    return std::isfinite(sum);
}

} // namespace

LabLens lensOf(const CalibratedCamera& camera, const char* what) {
    LabLens lens{camera.size, camera.focal, camera.principal};
    lens.k1 = camera.distortion[0];
    lens.k2 = camera.distortion[1];
    lens.p1 = camera.distortion[2];
    lens.p2 = camera.distortion[3];
    lens.k3 = camera.distortion[4];
    lens.worldFromLens = glm::transpose(glm::dmat3(camera.cameraFromWorld));
    lens.position = -(lens.worldFromLens * glm::dvec3(camera.cameraFromWorld[3]));
    if (camera.size.x < 1 || camera.size.y < 1 || !(camera.focal.x > 0.0) || !(camera.focal.y > 0.0) || !isFinite(lens))
        throw InvalidInput(what, "its size, focal length or pose is no usable number", "calibrate it again");
    lens.steepestSlope = foldingRadius(lens);
    return lens;
}

std::optional<glm::dvec2> imageOf(const LabLens& lens, const glm::dvec3& point) noexcept {
    const glm::dvec3 local = (point - lens.position) * lens.worldFromLens;
    if (!(local.z > 0.0)) return std::nullopt;
    const glm::dvec2 slope(local.x / local.z, local.y / local.z);
    if (glm::dot(slope, slope) >= lens.steepestSlope * lens.steepestSlope) return std::nullopt;
    return lens.focal * distorted(lens, slope) + lens.principal;
}

std::optional<glm::dvec3> rayThrough(const LabLens& lens, const glm::dvec2& pixel) noexcept {
    const glm::dvec2 wanted = (pixel - lens.principal) / lens.focal;
    glm::dvec2 slope = wanted;
    for (int i = 0; i < 25; ++i) {
        const glm::dvec2 miss = distorted(lens, slope) - wanted;
        if (glm::dot(miss, miss) < 1e-28) break;
        const glm::dmat2 steep = distortionSlope(lens, slope);
        const double determinant = steep[0][0] * steep[1][1] - steep[1][0] * steep[0][1];
        if (!(determinant > 0.0)) return std::nullopt;
        slope -= glm::dvec2(steep[1][1] * miss.x - steep[1][0] * miss.y, steep[0][0] * miss.y - steep[0][1] * miss.x) /
                 determinant;
    }
    const glm::dvec2 miss = distorted(lens, slope) - wanted;
    if (!(glm::dot(miss, miss) < 1e-20) || glm::dot(slope, slope) >= lens.steepestSlope * lens.steepestSlope)
        return std::nullopt;
    return lens.worldFromLens * glm::normalize(glm::dvec3(slope, 1.0));
}

bool inImage(const LabLens& lens, const glm::dvec2& pixel) noexcept {
    return pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x < lens.size.x - 0.5 && pixel.y < lens.size.y - 0.5;
}

} // namespace lumorph

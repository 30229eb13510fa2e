#include "core/geometry/calibrated_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/error.h"
#include "core/geometry/rigid.h"
#include "core/geometry/triangle_mesh.h"

namespace lumorph {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Beyond this radius (at distance 1) no lens sees anything; roots out there mean nothing.
constexpr double kWidestRadius = 1000.0;
constexpr int kLargestSide = 16'384;

// Coefficients of a polynomial in the radius, lowest first.
using Polynomial = std::vector<double>;

double valueOf(const Polynomial& polynomial, double x) {
    double value = 0.0;
    for (auto coefficient = polynomial.rbegin(); coefficient != polynomial.rend(); ++coefficient)
        value = value * x + *coefficient;
    return value;
}

double rootBetween(const Polynomial& polynomial, double low, double high) {
    const bool rising = valueOf(polynomial, low) < 0.0;
    for (int step = 0; step < 80; ++step) {
        const double middle = 0.5 * (low + high);
        ((valueOf(polynomial, middle) < 0.0) == rising ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

// All roots in (0, kWidestRadius): between neighbouring roots of its derivative a polynomial is monotonic.
std::vector<double> positiveRoots(const Polynomial& polynomial) {
    if (polynomial.size() < 2) return {};
    Polynomial derivative;
    for (std::size_t i = 1; i < polynomial.size(); ++i) derivative.push_back(static_cast<double>(i) * polynomial[i]);
    std::vector<double> bounds = positiveRoots(derivative);
    bounds.insert(bounds.begin(), 0.0);
    bounds.push_back(kWidestRadius);
    std::vector<double> roots;
    for (std::size_t i = 1; i < bounds.size(); ++i)
        if ((valueOf(polynomial, bounds[i - 1]) < 0.0) != (valueOf(polynomial, bounds[i]) < 0.0))
            roots.push_back(rootBetween(polynomial, bounds[i - 1], bounds[i]));
    return roots;
}

// The distortion is the gradient of a scalar field, so it is one-to-one on a disc on which its (symmetric) derivative
// is positive. The radial part stretches by 1 + 3 k1 r^2 + ... along the radius and by 1 + k1 r^2 + ... across; the
// tangential part takes at most 6 |p| r off either.
bool surelyMonotonic(const std::array<double, 5>& k, double r2) {
    const double lost = 3.0 * std::min(k[0], 0.0) * r2 + 5.0 * std::min(k[1], 0.0) * r2 * r2 +
                        7.0 * std::min(k[4], 0.0) * r2 * r2 * r2 - 6.0 * std::hypot(k[2], k[3]) * std::sqrt(r2);
    return 1.0 + lost > 0.0;
}

glm::dvec2 distort(const std::array<double, 5>& k, const glm::dvec2& at) {
    const double r2 = glm::dot(at, at);
    const double radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    return at * radial + glm::dvec2(2.0 * k[2] * at.x * at.y + k[3] * (r2 + 2.0 * at.x * at.x),
                                    k[2] * (r2 + 2.0 * at.y * at.y) + 2.0 * k[3] * at.x * at.y);
}

glm::dmat2 derivativeOf(const std::array<double, 5>& k, const glm::dvec2& at) {
    const double r2 = glm::dot(at, at);
    const double radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    const double slope = 2.0 * (k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[4]));
    const double cross = slope * at.x * at.y + 2.0 * k[2] * at.x + 2.0 * k[3] * at.y;
    return {radial + slope * at.x * at.x + 2.0 * k[2] * at.y + 6.0 * k[3] * at.x, cross, cross,
            radial + slope * at.y * at.y + 6.0 * k[2] * at.y + 2.0 * k[3] * at.x};
}

// Newton with a step that shrinks until the residual does. What lies beyond the folding radius ends on it.
glm::dvec2 undistort(const CalibratedCamera& camera, const glm::dvec2& distorted) {
    const auto& k = camera.distortion;
    if (k == std::array<double, 5>{}) return distorted;
    std::optional<double> limit; // dear to find, and only far out it is asked for
    const auto inside = [&](const glm::dvec2& at) {
        if (surelyMonotonic(k, glm::dot(at, at))) return at;
        if (!limit) limit = std::sqrt(distortionLimit(camera)) * (1.0 - 1e-12);
        const double radius = glm::length(at);
        return radius > *limit ? at * (*limit / radius) : at;
    };
    glm::dvec2 at = inside(distorted);
    double residual = glm::length(distort(k, at) - distorted);
    for (int step = 0; step < 100 && residual > 1e-15; ++step) {
        const glm::dvec2 move = glm::inverse(derivativeOf(k, at)) * (distorted - distort(k, at));
        double share = 1.0;
        glm::dvec2 next = inside(at + move);
        double left = glm::length(distort(k, next) - distorted);
        for (; !(left < residual) && share > 1e-6; left = glm::length(distort(k, next) - distorted))
            next = inside(at + (share *= 0.5) * move);
        if (!(left < residual)) break;
        at = next;
        residual = left;
    }
    return at;
}

glm::dvec3 inCamera(const CalibratedCamera& camera, const glm::dvec3& point) {
    return glm::dvec3(camera.cameraFromWorld * glm::dvec4(point, 1.0));
}

[[noreturn]] void refuse(const std::string& why, const std::string& remedy) {
    throw InvalidInput("camera", why, remedy);
}

bool allFinite(const CalibratedCamera& camera) {
    bool finite = std::isfinite(camera.focal.x) && std::isfinite(camera.focal.y) && std::isfinite(camera.principal.x) &&
                  std::isfinite(camera.principal.y);
    for (const double k : camera.distortion) finite = finite && std::isfinite(k);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) finite = finite && std::isfinite(camera.cameraFromWorld[column][row]);
    return finite;
}

bool isRigid(const glm::dmat4& pose) {
    constexpr double kTolerance = 1e-5;
    const glm::dmat3 rotation(pose);
    const glm::dmat3 product = glm::transpose(rotation) * rotation;
    double error = std::abs(glm::determinant(rotation) - 1.0);
    for (int column = 0; column < 3; ++column) {
        error = std::max(error, std::abs(pose[column][3]));
        for (int row = 0; row < 3; ++row)
            error = std::max(error, std::abs(product[column][row] - (column == row ? 1.0 : 0.0)));
    }
    return error < kTolerance && std::abs(pose[3][3] - 1.0) < kTolerance;
}

} // namespace

glm::dvec3 positionOf(const CalibratedCamera& camera) { return Rigid(camera.cameraFromWorld).inverse().translation; }

std::optional<glm::dvec2> pixelOf(const CalibratedCamera& camera, const glm::dvec3& point) {
    const glm::dvec3 local = inCamera(camera, point);
    if (!(local.z > 0.0)) return std::nullopt;
    const glm::dvec2 at = glm::dvec2(local) / local.z;
    const double r2 = glm::dot(at, at);
    if (!surelyMonotonic(camera.distortion, r2) && !(r2 < distortionLimit(camera))) return std::nullopt;
    return camera.focal * distort(camera.distortion, at) + camera.principal;
}

glm::dvec3 directionOf(const CalibratedCamera& camera, const glm::dvec2& pixel) {
    const glm::dvec2 at = undistort(camera, (pixel - camera.principal) / camera.focal);
    return glm::normalize(glm::transpose(glm::dmat3(camera.cameraFromWorld)) * glm::dvec3(at, 1.0));
}

double distortionLimit(const CalibratedCamera& camera) {
    const auto& k = camera.distortion;
    if (surelyMonotonic(k, kWidestRadius * kWidestRadius)) return kInfinite;
    const double tangential = 6.0 * std::hypot(k[2], k[3]);
    double limit = kInfinite;
    for (const Polynomial& stretch : {Polynomial{1.0, -tangential, 3.0 * k[0], 0.0, 5.0 * k[1], 0.0, 7.0 * k[4]},
                                      Polynomial{1.0, -tangential, k[0], 0.0, k[1], 0.0, k[4]}}) {
        const std::vector<double> roots = positiveRoots(stretch);
        if (!roots.empty()) limit = std::min(limit, roots.front() * roots.front());
    }
    return limit;
}

glm::dmat4 clipFromCamera(const CalibratedCamera& camera, double near, double far) {
    const glm::dvec2 size(camera.size);
    const glm::dvec2 scale = 2.0 * camera.focal / size;
    const glm::dvec2 shift = (2.0 * camera.principal + 1.0) / size - 1.0;
    glm::dmat4 clip(0.0);
    clip[0][0] = scale.x;
    clip[1][1] = -scale.y;
    clip[2] = {shift.x, -shift.y, (far + near) / (far - near), 1.0};
    clip[3][2] = -2.0 * far * near / (far - near);
    return clip;
}

CalibratedCamera cameraLookingAt(const glm::dvec3& position, const glm::dvec3& centre, glm::ivec2 size, double focal) {
    const glm::dvec3 way = centre - position;
    if (!(glm::length(way) > 1e-9) || !std::isfinite(glm::length(way)))
        refuse("it stands where it should look", "move the eye or its aim");
    const glm::dvec3 forward = glm::normalize(way);
    const bool vertical = std::abs(forward.y) > 1.0 - 1e-9;
    const glm::dvec3 up = vertical ? glm::dvec3(0.0, 0.0, forward.y) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    const glm::dmat3 cameraFromWorld = glm::transpose(glm::dmat3(right, glm::cross(forward, right), forward));
    CalibratedCamera camera;
    camera.size = size;
    camera.focal = glm::dvec2(focal);
    camera.principal = 0.5 * glm::dvec2(size - 1);
    camera.cameraFromWorld = glm::dmat4(cameraFromWorld);
    camera.cameraFromWorld[3] = glm::dvec4(-(cameraFromWorld * position), 1.0);
    return camera;
}

CalibratedCamera eyeCamera(const glm::dvec3& eye, std::span<const glm::vec3> points, glm::ivec2 size, double margin) {
    if (points.empty()) throw InvalidInput("eye", "there is nothing to look at", "give it some points");
    CalibratedCamera camera = cameraLookingAt(eye, glm::dvec3(boundingBox(points).centre()), size, 1.0);
    glm::dvec2 low(kInfinite);
    glm::dvec2 high(-kInfinite);
    for (const glm::vec3& point : points) {
        const glm::dvec3 local = inCamera(camera, glm::dvec3(point));
        if (!(local.z > 1e-3 * glm::length(local)))
            throw InvalidInput("eye", "part of what it should see lies beside or behind it",
                               "move the eye away from it");
        low = glm::min(low, glm::dvec2(local) / local.z);
        high = glm::max(high, glm::dvec2(local) / local.z);
    }
    const glm::dvec2 extent = glm::max((high - low) * (1.0 + 2.0 * margin), glm::dvec2(1e-9));
    const double focal = std::min(size.x / extent.x, size.y / extent.y);
    camera.focal = glm::dvec2(focal);
    camera.principal = 0.5 * glm::dvec2(size - 1) - 0.5 * focal * (low + high);
    return camera;
}

void checkCamera(const CalibratedCamera& camera) {
    if (camera.size.x < 1 || camera.size.y < 1 || camera.size.x > kLargestSide || camera.size.y > kLargestSide)
        refuse("its image of " + std::to_string(camera.size.x) + "x" + std::to_string(camera.size.y) +
                   " pixels is out of range",
               "use 1 to " + std::to_string(kLargestSide) + " pixels a side");
    if (!allFinite(camera)) refuse("it holds a number that is not finite", "calibrate again or correct its values");
    if (!(camera.focal.x > 0.0 && camera.focal.y > 0.0))
        refuse("its focal length is not positive", "calibrate again or give its focal length in pixels");
    if (!isRigid(camera.cameraFromWorld))
        refuse("its pose is not a rotation and a translation", "calibrate again or correct its pose");
}

} // namespace lumorph

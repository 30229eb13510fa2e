#include "core/render/viewport/view_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

namespace lumorph {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNearestDistance = 1e-3;
constexpr double kFarthestDistance = 100.0;
// Rays of parallel projections start this far behind the eye: what lies there is drawn too.
constexpr double kBehindParallelEye = 10.0;

// The axes of the picture in the world; `back` leads from the pivot to the eye.
struct Axes {
    glm::dvec3 right, up, back;
};

Axes axesOf(const ViewCamera& camera) {
    const double yaw = camera.yaw.inRadians();
    const double pitch = camera.pitch.inRadians();
    Axes axes;
    axes.back = {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
    axes.right = {std::cos(yaw), 0.0, -std::sin(yaw)};
    axes.up = glm::cross(axes.back, axes.right);
    return axes;
}

double tanHalf(const ViewCamera& camera) { return std::tan(0.5 * camera.fieldOfView.inRadians()); }

glm::dvec3 exactEye(const ViewCamera& camera) {
    return glm::dvec3(camera.pivot) + camera.distance * axesOf(camera).back;
}

double pixelAtPivot(const ViewCamera& camera, glm::vec2 size) {
    return 2.0 * camera.distance * tanHalf(camera) / static_cast<double>(size.y);
}

// A corner of a box from its centre: place across an axis of the picture in units of what is seen
// at depth 1, and how much nearer to the eye it is.
struct Reach {
    double side, nearer;
};
using Reaches = std::array<Reach, 8>;

// The distance at which an axis binds: the two sides of the view meet at the axis.
double distanceFor(const Reaches& reaches, bool parallel) {
    double low = 1e300;
    double high = -1e300;
    for (const Reach& r : reaches) {
        high = std::max(high, r.side + (parallel ? 0.0 : r.nearer));
        low = std::min(low, r.side - (parallel ? 0.0 : r.nearer));
    }
    return 0.5 * (high - low);
}

// Where the middle of the view must be for the corners to reach equally far to both sides.
double middleFor(const Reaches& reaches, double distance, bool parallel) {
    double low = -1e3 * distance;
    double high = 1e3 * distance;
    for (int i = 0; i < 80; ++i) {
        const double middle = 0.5 * (low + high);
        double least = 1e300;
        double most = -1e300;
        for (const Reach& r : reaches) {
            const double seen = (r.side - middle) / (parallel ? distance : std::max(distance - r.nearer, 1e-9));
            least = std::min(least, seen);
            most = std::max(most, seen);
        }
        (least + most > 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double shorterTurn(double from, double to) { return std::remainder(to - from, 2.0 * kPi); }

} // namespace

glm::vec3 eyeOf(const ViewCamera& camera) { return glm::vec3(exactEye(camera)); }

glm::mat4 viewFromWorld(const ViewCamera& camera) {
    const Axes axes = axesOf(camera);
    const glm::dmat3 turn = glm::transpose(glm::dmat3(axes.right, axes.up, axes.back));
    glm::dmat4 view(turn);
    view[3] = glm::dvec4(-(turn * exactEye(camera)), 1.0);
    return glm::mat4(view);
}

glm::mat4 clipFromWorld(const ViewCamera& camera, float aspect, const Box& scene) {
    const Axes axes = axesOf(camera);
    const glm::dvec3 eye = exactEye(camera);
    double nearest = camera.distance;
    double farthest = camera.distance;
    if (!scene.empty())
        for (const glm::vec3& corner : cornersOf(scene)) {
            const double depth = glm::dot(eye - glm::dvec3(corner), axes.back);
            nearest = std::min(nearest, depth);
            farthest = std::max(farthest, depth);
        }
    const double margin = 0.01 * (farthest - nearest) + 0.01 * camera.distance;
    nearest -= margin;
    farthest += margin;
    const double up = tanHalf(camera);
    const double side = up * static_cast<double>(aspect);
    glm::dmat4 clip;
    if (camera.orthographic) {
        const double d = camera.distance;
        clip = glm::ortho(-d * side, d * side, -d * up, d * up, nearest, farthest);
    } else {
        nearest = std::max(nearest, std::max(0.02 * camera.distance, 1e-4 * farthest));
        clip = glm::frustum(-nearest * side, nearest * side, -nearest * up, nearest * up, nearest,
                            std::max(farthest, 1.01 * nearest));
    }
    return glm::mat4(clip) * viewFromWorld(camera);
}

Ray rayThrough(const ViewCamera& camera, glm::vec2 pixel, glm::vec2 size) {
    const Axes axes = axesOf(camera);
    const glm::dvec2 offset = glm::dvec2(pixel) - 0.5 * glm::dvec2(size);
    const double unit = pixelAtPivot(camera, size);
    const glm::dvec3 across = unit * (offset.x * axes.right - offset.y * axes.up);
    const glm::dvec3 eye = exactEye(camera);
    if (camera.orthographic) return {glm::vec3(eye + across + kBehindParallelEye * axes.back), glm::vec3(-axes.back)};
    return {glm::vec3(eye), glm::vec3(glm::normalize(across - camera.distance * axes.back))};
}

std::optional<glm::vec2> pixelOf(const ViewCamera& camera, const glm::vec3& point, glm::vec2 size) {
    const Axes axes = axesOf(camera);
    const glm::dvec3 offset = glm::dvec3(point) - exactEye(camera);
    const double depth = camera.orthographic ? camera.distance : -glm::dot(offset, axes.back);
    if (!(depth > 1e-9)) return std::nullopt;
    const double scale = 0.5 * static_cast<double>(size.y) / (tanHalf(camera) * depth);
    return glm::vec2(0.5 * glm::dvec2(size) +
                     scale * glm::dvec2(glm::dot(offset, axes.right), -glm::dot(offset, axes.up)));
}

float metresPerPixel(const ViewCamera& camera, const glm::vec3& point, glm::vec2 size) {
    const double atPivot = pixelAtPivot(camera, size);
    if (camera.orthographic) return static_cast<float>(atPivot);
    const double depth = glm::dot(exactEye(camera) - glm::dvec3(point), axesOf(camera).back);
    return static_cast<float>(atPivot * std::max(depth, 0.0) / camera.distance);
}

ViewCamera orbited(ViewCamera camera, glm::vec2 pixels, glm::vec2 size) {
    const glm::dvec2 turn = kPi * glm::dvec2(pixels) / static_cast<double>(size.y);
    camera.yaw = Angle::radians(std::remainder(camera.yaw.inRadians() - turn.x, 2.0 * kPi));
    camera.pitch = Angle::radians(std::clamp(camera.pitch.inRadians() + turn.y, -0.5 * kPi, 0.5 * kPi));
    return camera;
}

ViewCamera panned(ViewCamera camera, glm::vec2 pixels, glm::vec2 size) {
    const Axes axes = axesOf(camera);
    const glm::dvec2 metres = pixelAtPivot(camera, size) * glm::dvec2(pixels);
    camera.pivot = glm::vec3(glm::dvec3(camera.pivot) - metres.x * axes.right + metres.y * axes.up);
    return camera;
}

ViewCamera zoomed(ViewCamera camera, double factor, glm::vec2 pixel, glm::vec2 size) {
    if (!(factor > 0.0)) return camera;
    const Axes axes = axesOf(camera);
    const glm::dvec2 metres = pixelAtPivot(camera, size) * (glm::dvec2(pixel) - 0.5 * glm::dvec2(size));
    const double distance = std::clamp(camera.distance / factor, kNearestDistance, kFarthestDistance);
    const glm::dvec3 held = metres.x * axes.right - metres.y * axes.up;
    camera.pivot = glm::vec3(glm::dvec3(camera.pivot) + (1.0 - distance / camera.distance) * held);
    camera.distance = distance;
    return camera;
}

ViewCamera framed(ViewCamera camera, const Box& box, float aspect, float fill) {
    const glm::dvec3 centre = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
    const double extent = glm::distance(glm::dvec3(box.min), glm::dvec3(box.max));
    if (box.empty() || !std::isfinite(extent + glm::length(centre)) || !(fill > 0.0F) || !(aspect > 0.0F))
        return camera;
    camera.pivot = glm::vec3(centre);
    if (!(extent > 0.0)) return camera;
    const Axes axes = axesOf(camera);
    const double up = static_cast<double>(fill) * tanHalf(camera);
    const double right = up * static_cast<double>(aspect);
    Reaches across;
    Reaches upward;
    const auto corners = cornersOf(box);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 p = glm::dvec3(corners[i]) - centre;
        across[i] = {glm::dot(p, axes.right) / right, glm::dot(p, axes.back)};
        upward[i] = {glm::dot(p, axes.up) / up, glm::dot(p, axes.back)};
    }
    const bool parallel = camera.orthographic;
    const double wanted = std::max(distanceFor(across, parallel), distanceFor(upward, parallel));
    camera.distance = std::clamp(wanted, kNearestDistance, kFarthestDistance);
    camera.pivot = glm::vec3(centre + right * middleFor(across, camera.distance, parallel) * axes.right +
                             up * middleFor(upward, camera.distance, parallel) * axes.up);
    return camera;
}

ViewCamera lookingFrom(ViewCamera camera, const glm::vec3& side) {
    const glm::dvec3 back = glm::dvec3(side);
    const double level = std::hypot(back.x, back.z);
    // Straight down and up show +X to the right, as from the front.
    camera.yaw = Angle::radians(level > 1e-6 * glm::length(back) ? std::atan2(back.x, back.z) : 0.0);
    camera.pitch = Angle::radians(std::atan2(back.y, level));
    return camera;
}

ViewCamera between(const ViewCamera& from, const ViewCamera& to, double t) {
    if (t <= 0.0) return from;
    if (t >= 1.0) return to;
    const auto mixed = [&](Angle a, double turn) { return Angle::radians(a.inRadians() + t * turn); };
    ViewCamera camera = t < 0.5 ? from : to;
    camera.pivot = glm::vec3(glm::mix(glm::dvec3(from.pivot), glm::dvec3(to.pivot), t));
    camera.yaw = mixed(from.yaw, shorterTurn(from.yaw.inRadians(), to.yaw.inRadians()));
    camera.pitch = mixed(from.pitch, to.pitch.inRadians() - from.pitch.inRadians());
    camera.fieldOfView = mixed(from.fieldOfView, to.fieldOfView.inRadians() - from.fieldOfView.inRadians());
    camera.distance = from.distance * std::pow(to.distance / from.distance, t);
    return camera;
}

} // namespace lumorph

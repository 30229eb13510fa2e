#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "app/studio/viewport/gizmo_shape.h"

namespace lumorph::studio {
namespace {

// A plane seen flatter than this (sine of the angle) cannot be dragged in by its depth.
constexpr double kFlatPlane = 0.06;
constexpr double kFlatRing = 0.17;
// How many times the object's distance a drag towards the horizon may reach.
constexpr double kFarthest = 20.0;

double snapped(double value, double step, bool coarse) { return coarse ? step * std::round(value / step) : value; }

std::string text(const char* format, double value) {
    char written[64];
    std::snprintf(written, sizeof written, format, value);
    const std::string result(written);
    // No "-0.0".
    return result.front() == '-' && result.find_first_of("123456789") == std::string::npos ? result.substr(1) : result;
}
std::string centimetres(const char* axis, double metres) { return axis + text("%.1f cm", 100.0 * metres); }

// The camera as a projection in double precision: pixels from the centre of the view.
class Projection {
public:
    Projection(const ViewCamera& camera, glm::vec2 size)
        : camera_(camera), size_(size), axes_(pictureAxes(camera)), eye_(eyeOf(camera)),
          focal_(0.5 * static_cast<double>(size.y) / std::tan(0.5 * camera.fieldOfView.inRadians())) {}

    double depthOf(const glm::dvec3& point) const { return glm::dot(eye_ - point, glm::dvec3(axes_.back)); }
    const glm::dvec3& eye() const { return eye_; }
    const PictureAxes& axes() const { return axes_; }
    double pixelsPerMetre(const glm::dvec3& point) const {
        return focal_ / (camera_.orthographic ? camera_.distance : std::max(depthOf(point), 1e-9));
    }
    glm::dvec2 across(const glm::dvec3& v) const {
        return {glm::dot(v, glm::dvec3(axes_.right)), -glm::dot(v, glm::dvec3(axes_.up))};
    }
    glm::dvec2 pixelOf(const glm::dvec3& point) const {
        return 0.5 * glm::dvec2(size_) + pixelsPerMetre(point) * across(point - eye_);
    }
    // Through a pixel, from the plane of the eye; of any length.
    void ray(glm::dvec2 pixel, glm::dvec3& origin, glm::dvec3& direction) const {
        const glm::dvec2 offset = (pixel - 0.5 * glm::dvec2(size_)) / focal_;
        const glm::dvec3 aside = offset.x * glm::dvec3(axes_.right) - offset.y * glm::dvec3(axes_.up);
        const glm::dvec3 forwards = -glm::dvec3(axes_.back);
        origin = camera_.orthographic ? eye_ + camera_.distance * aside : eye_;
        direction = camera_.orthographic ? forwards : glm::normalize(forwards + aside);
    }
    bool parallel() const { return camera_.orthographic; }

private:
    const ViewCamera& camera_;
    glm::vec2 size_;
    PictureAxes axes_;
    glm::dvec3 eye_;
    double focal_;
};

// The place along an axis whose picture is nearest to the pixel, metres from `origin`. On the picture the axis is a
// line along which u = g s d / (d - s b): s the place, g pixels a metre at the origin, d its depth, b how fast the
// axis comes nearer.
class AxisRuler {
public:
    AxisRuler(const Projection& view, const glm::dvec3& origin, const glm::dvec3& axis) : start_(view.pixelOf(origin)) {
        depth_ = view.depthOf(origin);
        nearing_ = view.parallel() ? 0.0 : glm::dot(axis, glm::dvec3(view.axes().back));
        glm::dvec2 slope = view.across(axis);
        if (!view.parallel()) slope += view.across(origin - view.eye()) * (nearing_ / depth_);
        slope *= view.pixelsPerMetre(origin);
        pixels_ = glm::length(slope);
        direction_ = slope / pixels_;
    }
    double placeOf(glm::dvec2 pixel) const {
        const double u = glm::dot(pixel - start_, direction_);
        if (nearing_ == 0.0) return u / pixels_;
        // Near the point where the axis vanishes a pixel is worth metres without end.
        const double whole = pixels_ * depth_;
        return u * depth_ / std::max(whole + u * nearing_, 0.1 * whole);
    }

private:
    glm::dvec2 start_;
    glm::dvec2 direction_{0.0};
    double depth_ = 0.0;
    double nearing_ = 0.0;
    double pixels_ = 0.0;
};

double alongAxis(const Projection& view, const Gizmo& start, const ViewCamera& camera, const glm::vec3& axis,
                 glm::vec2 from, glm::vec2 to) {
    if (pointsAtCamera(axis, start.centre, camera)) return 0.0;
    const AxisRuler ruler(view, start.centre, axis);
    return ruler.placeOf(to) - ruler.placeOf(from);
}

// Where the ray through a pixel meets the level of the gizmo, from its centre.
glm::dvec3 onGround(const Projection& view, const Gizmo& start, glm::dvec2 pixel) {
    glm::dvec3 origin;
    glm::dvec3 direction;
    view.ray(pixel, origin, direction);
    const glm::dvec3 centre(start.centre);
    const double farthest = kFarthest * std::max(glm::distance(origin, centre), 1e-6);
    double reach = (centre.y - origin.y) / direction.y;
    // An orthographic ray has no beginning; a perspective one above the horizon never comes down.
    if (!view.parallel() && !(reach >= 0.0)) reach = farthest;
    reach = std::clamp(reach, -farthest, farthest);
    const glm::dvec3 met = origin + reach * direction - centre;
    return {met.x, 0.0, met.z};
}

GizmoDrag moved(const Gizmo& start, const glm::dvec3& by, std::string label) {
    GizmoDrag drag{start.placement, std::move(label), start.centre + glm::vec3(by)};
    drag.placement.translation = glm::vec3(glm::dvec3(start.placement.translation) + by);
    return drag;
}

GizmoDrag movedAlong(const Projection& view, const Gizmo& start, GizmoHandle arrow, const ViewCamera& camera,
                     glm::vec2 from, glm::vec2 to, bool coarse) {
    const glm::vec3 axis = axisOf(arrow);
    const double by = snapped(alongAxis(view, start, camera, axis, from, to), kCoarseMove, coarse);
    const char* name = arrow == GizmoHandle::moveX ? "x " : arrow == GizmoHandle::moveY ? "y " : "z ";
    return moved(start, by * glm::dvec3(axis), centimetres(name, by));
}

GizmoDrag movedOnGround(const Projection& view, const Gizmo& start, glm::vec2 from, glm::vec2 to, bool coarse) {
    const glm::dvec3 towards =
        view.parallel() ? glm::dvec3(view.axes().back) : glm::normalize(view.eye() - glm::dvec3(start.centre));
    glm::dvec3 by;
    if (std::abs(towards.y) < kFlatPlane)
        // Seen from the side the ground is a line: only what is across the picture can be meant.
        by = glm::dvec3(view.axes().right) * (static_cast<double>(to.x - from.x) / view.pixelsPerMetre(start.centre));
    else
        by = onGround(view, start, to) - onGround(view, start, from);
    by = {snapped(by.x, kCoarseMove, coarse), 0.0, snapped(by.z, kCoarseMove, coarse)};
    return moved(start, by, centimetres("x ", by.x) + ", " + centimetres("z ", by.z));
}

GizmoDrag turned(const Projection& view, const Gizmo& start, glm::vec2 from, glm::vec2 to, bool coarse) {
    const glm::dvec3 towards =
        view.parallel() ? glm::dvec3(view.axes().back) : glm::normalize(view.eye() - glm::dvec3(start.centre));
    double by;
    if (std::abs(towards.y) < kFlatRing) {
        // Seen from the side the ring is rolled by its near half.
        by = static_cast<double>(to.x - from.x) / (kGizmoReach * static_cast<double>(kRingRadius));
    } else {
        const glm::dvec3 a = onGround(view, start, from);
        const glm::dvec3 b = onGround(view, start, to);
        by = std::remainder(std::atan2(b.x, b.z) - std::atan2(a.x, a.z), 2.0 * std::numbers::pi);
    }
    by = snapped(by, kCoarseTurn, coarse);
    GizmoDrag drag{start.placement, text("%.0f deg", Angle::radians(by).inDegrees()), start.centre};
    drag.placement.yaw = Angle::radians(start.placement.yaw.inRadians() + by);
    const glm::dvec3 arm = glm::dvec3(start.placement.translation) - glm::dvec3(start.centre);
    const double c = std::cos(by);
    const double s = std::sin(by);
    drag.placement.translation =
        start.centre + glm::vec3(glm::dvec3(c * arm.x + s * arm.z, arm.y, c * arm.z - s * arm.x));
    return drag;
}

GizmoDrag sized(const Projection& view, const Gizmo& start, glm::vec2 from, glm::vec2 to, bool coarse) {
    const glm::dvec2 centre = view.pixelOf(start.centre);
    const glm::dvec2 outwards = glm::normalize(glm::dvec2(1.0, -1.0));
    const double grabbed = std::max(glm::dot(glm::dvec2(from) - centre, outwards), 0.25 * kGizmoReach);
    double factor = 1.0 + glm::dot(glm::dvec2(to) - glm::dvec2(from), outwards) / grabbed;
    factor = std::clamp(snapped(factor, kCoarseShare, coarse), coarse ? kCoarseShare : 0.01, 100.0);
    GizmoDrag drag{start.placement, text("%.0f %%", 100.0 * factor), start.centre};
    drag.placement.scale = factor * start.placement.scale;
    const glm::dvec3 arm = glm::dvec3(start.placement.translation) - glm::dvec3(start.centre);
    drag.placement.translation = start.centre + glm::vec3(factor * arm);
    return drag;
}

} // namespace

double placeAlongAxis(const glm::vec3& origin, const glm::vec3& axis, const ViewCamera& camera, glm::vec2 pixel,
                      glm::vec2 size) {
    const Projection view(camera, size);
    if (pointsAtCamera(axis, origin, camera) || (!view.parallel() && !(view.depthOf(origin) > 1e-6))) return 0.0;
    return AxisRuler(view, origin, axis).placeOf(pixel);
}

GizmoDrag dragGizmo(const Gizmo& start, GizmoHandle handle, const ViewCamera& camera, glm::vec2 from, glm::vec2 to,
                    glm::vec2 size, bool coarse) {
    const Projection view(camera, size);
    // What has come to lie behind the eye cannot be dragged.
    if (!view.parallel() && !(view.depthOf(start.centre) > 1e-6)) return {start.placement, "", start.centre};
    switch (handle) {
    case GizmoHandle::moveGround:
        return movedOnGround(view, start, from, to, coarse);
    case GizmoHandle::turn:
        return turned(view, start, from, to, coarse);
    case GizmoHandle::size:
        return sized(view, start, from, to, coarse);
    default:
        return movedAlong(view, start, handle, camera, from, to, coarse);
    }
}

} // namespace lumorph::studio

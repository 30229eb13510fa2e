#include "app/workspaces/rig/actuator_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include "app/studio/viewport/gizmo_shape.h"

namespace lumorph::studio {

namespace {

using Motion = ActuatorRange::Motion;

constexpr float kLeastHalf = 0.005F;  // metres of a line to either side
constexpr float kLeastRadius = 64.0F; // pixels of an arc
constexpr float kReachShare = 0.85F;  // of the part's reach
// A plane seen flatter than this (sine of the angle) cannot be pointed at.
constexpr float kFlatPlane = 0.12F;
constexpr float kPointerAside = 18.0F; // pixels from the arc or the way to the pointer of the stroke
// The sine of an arm that still counts as level: skirts below a sheet pull its middle down.
constexpr float kLevelArm = 0.5F;

glm::vec3 anyAcross(const glm::vec3& axis) {
    const glm::vec3 other = std::abs(axis.y) < 0.9F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
    return glm::normalize(glm::cross(axis, other));
}

glm::vec3 across(const glm::vec3& v, const glm::vec3& axis) { return v - glm::dot(v, axis) * axis; }

glm::mat4 deviceFromJoint(const Skeleton& skeleton, int joint) {
    glm::mat4 pose(1.0F);
    for (; joint >= 0; joint = skeleton.joints[joint].parent) pose = skeleton.joints[joint].localRest * pose;
    return pose;
}

/// Fills in what follows from where the part is.
class GuideMaker {
public:
    GuideMaker(const RigParts& parts, const Actuator& actuator, std::span<const std::uint32_t> vertices)
        : parts_(parts), actuator_(actuator), vertices_(vertices) {
        for (const std::uint32_t v : vertices) middle_ += glm::dvec3(parts.restMesh.positions[v]);
        middle_ /= static_cast<double>(vertices.size());
    }

    ActuatorGuide make() {
        guide_.range = rangeOf(actuator_);
        guide_.rest = guide_.range.min;
        std::visit(*this, actuator_.deformer);
        return guide_;
    }

    void operator()(const Hinge& hinge) {
        turnAbout(hinge.origin, hinge.axis);
        guide_.hasLine = guide_.hasFrom = guide_.hasTo = true;
    }
    void operator()(const Bend& bend) {
        turnAbout(bend.origin, bend.axis);
        guide_.arm = glm::normalize(across(bend.direction, guide_.axis));
        guide_.bendLength = bend.length;
        guide_.hasLine = guide_.hasTo = true; // it begins flat
    }
    void operator()(const Slide& slide) {
        moveAlong(glm::vec3(middle_), glm::normalize(slide.direction));
        guide_.hasWay = guide_.hasFrom = guide_.hasTo = true;
    }
    void operator()(const MorphTarget& morph) {
        // Shown at the vertex that moves farthest.
        std::size_t farthest = 0;
        const auto& last = morph.displacements.back();
        for (std::size_t i = 0; i < last.size(); ++i)
            if (glm::length(last[i]) > glm::length(last[farthest])) farthest = i;
        if (last.empty()) return;
        moveAlong(parts_.restMesh.positions[actuator_.influences[farthest].vertex], last[farthest]);
    }
    void operator()(const SheetLift& lift) {
        // Where a lever stands is not the rig's to know: shown, as a stroke, at the vertex that it moves farthest.
        guide_.range = {};
        guide_.rest = guide_.range.min;
        const SheetMotion& sheet = *parts_.sheet;
        std::vector<double> strokes(sheet.modes.strokes.size(), 0.0);
        strokes[static_cast<std::size_t>(lift.axis)] = 1.0;
        glm::vec3 way(0.0F);
        for (const std::uint32_t v : vertices_) {
            const auto [row, share] = sheet.followers[v];
            if (row == SheetMotion::kNoRow || share < 1.0F) continue;
            const glm::vec3 moved = rowDisplacement(sheet.modes, row, strokes);
            if (glm::length(moved) > glm::length(way)) moveAlong(parts_.restMesh.positions[v], way = moved);
        }
    }
    void operator()(const SkinJoint& joint) {
        const glm::mat4 pose = deviceFromJoint(*parts_.skeleton, joint.joint);
        const glm::vec3 axis = glm::normalize(glm::mat3(pose) * joint.axis);
        if (joint.motion == SkinJoint::Motion::rotate)
            turnAbout(glm::vec3(pose[3]), axis);
        else
            moveAlong(glm::vec3(middle_), axis);
        guide_.hasFrom = guide_.hasTo = true;
    }

private:
    void moveAlong(const glm::vec3& from, const glm::vec3& way) {
        guide_.pivot = from;
        guide_.axis = way;
    }
    void turnAbout(const glm::vec3& origin, const glm::vec3& direction) {
        const glm::vec3 axis = glm::normalize(direction);
        float low = std::numeric_limits<float>::infinity();
        float high = -low;
        for (const std::uint32_t v : vertices_) {
            const glm::vec3 from = parts_.restMesh.positions[v] - origin;
            low = std::min(low, glm::dot(from, axis));
            high = std::max(high, glm::dot(from, axis));
            guide_.reach = std::max(guide_.reach, glm::length(across(from, axis)));
        }
        guide_.axis = axis;
        guide_.pivot = origin + 0.5F * (low + high) * axis;
        guide_.half = std::max(0.5F * (high - low), kLeastHalf);
        glm::vec3 arm = across(glm::vec3(middle_) - origin, axis);
        if (std::abs(axis.y) < 1e-3F && std::abs(arm.y) < kLevelArm * glm::length(arm)) arm.y = 0.0F;
        arm = across(arm, axis);
        guide_.arm = glm::length(arm) > 1e-5F ? glm::normalize(arm) : anyAcross(axis);
    }

    const RigParts& parts_;
    const Actuator& actuator_;
    std::span<const std::uint32_t> vertices_;
    glm::dvec3 middle_{0.0};
    ActuatorGuide guide_;
};

/// Where a pixel's ray meets a plane; where that is seen from its edge, what is seen nearest to it.
glm::dvec3 onPlane(const glm::vec3& at, const glm::vec3& normal, const ViewCamera& camera, glm::vec2 pixel,
                   glm::vec2 size) {
    const Ray ray = rayThrough(camera, pixel, size);
    const glm::dvec3 origin(ray.origin), direction(ray.direction), n(normal), p(at);
    const double facing = glm::dot(direction, n);
    if (std::abs(facing) > kFlatPlane) {
        const double far = glm::dot(p - origin, n) / facing;
        if (far > 0.0 || camera.orthographic) return origin + far * direction;
    }
    const glm::dvec3 back(pictureAxes(camera).back);
    const glm::dvec3 seen = origin + glm::dot(p - origin, back) / glm::dot(direction, back) * direction;
    return seen - glm::dot(seen - p, n) * n;
}

/// For an arc that is seen from its edge: the value of which a pixel shows the most.
double nearestSeen(const ActuatorGuide& guide, const ViewCamera& camera, glm::vec2 pixel, glm::vec2 size, double near) {
    constexpr int kSteps = 180; // half a degree each, to either side
    const float radius = arcRadius(guide, camera, size);
    double best = near;
    float least = std::numeric_limits<float>::infinity();
    for (int i = -kSteps; i <= kSteps; ++i) {
        const double value = near + i * 0.5 * std::numbers::pi / kSteps;
        const auto seen = pixelOf(camera, placeOf(guide, value, radius), size);
        if (!seen || glm::distance(*seen, pixel) >= least) continue;
        least = glm::distance(*seen, pixel);
        best = value;
    }
    return best;
}

glm::vec3 normalOf(const ActuatorGuide& guide) { return glm::cross(guide.axis, guide.arm); }

void setLineOf(glm::vec3& origin, glm::vec3& axis, const ActuatorGuide& guide, const std::array<glm::vec3, 2>& ends) {
    const float share = 0.5F + glm::dot(origin - guide.pivot, guide.axis) / (2.0F * guide.half);
    origin = ends[0] + share * (ends[1] - ends[0]);
    axis = glm::length(axis) * glm::normalize(ends[1] - ends[0]);
}

/// Whether an actuator has the joint, axis or displacements of which it speaks; while they are edited it may not.
bool hasParts(const RigParts& parts, const Actuator& actuator) {
    if (const auto* joint = std::get_if<SkinJoint>(&actuator.deformer))
        return parts.skeleton && joint->joint >= 0 &&
               static_cast<std::size_t>(joint->joint) < parts.skeleton->joints.size();
    if (const auto* lift = std::get_if<SheetLift>(&actuator.deformer))
        return parts.sheet && lift->axis >= 0 &&
               static_cast<std::size_t>(lift->axis) < parts.sheet->modes.strokes.size();
    const auto* morph = std::get_if<MorphTarget>(&actuator.deformer);
    return !morph ||
           (!morph->displacements.empty() && morph->displacements.back().size() == actuator.influences.size() &&
            std::ranges::all_of(actuator.influences, [&](const Influence& influence) {
                return influence.vertex < parts.restMesh.positions.size();
            }));
}

} // namespace

std::optional<ActuatorGuide> guideOf(const RigParts& parts, std::size_t index,
                                     std::span<const std::uint32_t> vertices) {
    if (index >= parts.actuators.size() || vertices.empty()) return std::nullopt;
    if (std::ranges::max(vertices) >= parts.restMesh.positions.size()) return std::nullopt;
    if (!hasParts(parts, parts.actuators[index])) return std::nullopt;
    return GuideMaker(parts, parts.actuators[index], vertices).make();
}

std::array<glm::vec3, 2> endsOf(const ActuatorGuide& guide) {
    return {guide.pivot - guide.half * guide.axis, guide.pivot + guide.half * guide.axis};
}

float arcRadius(const ActuatorGuide& guide, const ViewCamera& camera, glm::vec2 size) {
    return std::max(kReachShare * guide.reach, kLeastRadius * metresPerPixel(camera, guide.pivot, size));
}

glm::vec3 placeOf(const ActuatorGuide& guide, double value, float radius) {
    const auto by = static_cast<float>(value - guide.rest);
    if (guide.range.motion != Motion::turning) return guide.pivot + by * guide.axis;
    return guide.pivot + radius * (std::cos(by) * guide.arm + std::sin(by) * normalOf(guide));
}

double valueAt(const ActuatorGuide& guide, const ViewCamera& camera, glm::vec2 pixel, glm::vec2 size, double near) {
    if (guide.range.motion != Motion::turning) {
        const float unit = glm::length(guide.axis);
        if (!(unit > 0.0F) || pointsAtCamera(guide.axis / unit, guide.pivot, camera)) return near;
        return guide.rest + placeAlongAxis(guide.pivot, guide.axis / unit, camera, pixel, size) / unit;
    }
    const glm::vec3 towards =
        camera.orthographic ? pictureAxes(camera).back : glm::normalize(eyeOf(camera) - guide.pivot);
    if (std::abs(glm::dot(towards, guide.axis)) < kFlatPlane) return nearestSeen(guide, camera, pixel, size, near);
    const glm::dvec3 from = onPlane(guide.pivot, guide.axis, camera, pixel, size) - glm::dvec3(guide.pivot);
    const double angle =
        std::atan2(glm::dot(from, glm::dvec3(normalOf(guide))), glm::dot(from, glm::dvec3(guide.arm))) + guide.rest;
    return near + std::remainder(angle - near, 2.0 * std::numbers::pi);
}

glm::vec3 onSheet(const ActuatorGuide& guide, const ViewCamera& camera, glm::vec2 pixel, glm::vec2 size) {
    return {onPlane(guide.pivot, normalOf(guide), camera, pixel, size)};
}

void setLine(Actuator& actuator, const ActuatorGuide& guide, const std::array<glm::vec3, 2>& ends) {
    if (auto* hinge = std::get_if<Hinge>(&actuator.deformer)) setLineOf(hinge->origin, hinge->axis, guide, ends);
    if (auto* bend = std::get_if<Bend>(&actuator.deformer)) {
        setLineOf(bend->origin, bend->axis, guide, ends);
        bend->direction = glm::cross(normalOf(guide), glm::normalize(bend->axis));
    }
}

void moveLine(Actuator& actuator, const glm::vec3& by) {
    if (auto* hinge = std::get_if<Hinge>(&actuator.deformer)) hinge->origin += by;
    if (auto* bend = std::get_if<Bend>(&actuator.deformer)) bend->origin += by;
}

std::vector<SeenHandle> seenHandles(const ActuatorGuide& guide, double stroke, const ViewCamera& camera,
                                    glm::vec2 size) {
    std::vector<SeenHandle> seen;
    const auto add = [&](RigHandle handle, const glm::vec3& place) {
        if (const auto pixel = pixelOf(camera, place, size)) seen.push_back({handle, *pixel});
    };
    const ActuatorRange& range = guide.range;
    const bool turns = range.motion == Motion::turning;
    const float radius = arcRadius(guide, camera, size);
    const double value = range.min + stroke * (range.max - range.min);
    const float aside = kPointerAside * metresPerPixel(camera, guide.pivot, size);
    const glm::vec3 from = placeOf(guide, range.min, radius), to = placeOf(guide, range.max, radius);
    const auto a = pixelOf(camera, from, size), b = pixelOf(camera, to, size);
    if (turns) {
        add(RigHandle::stroke, placeOf(guide, value, radius - aside));
    } else if (const auto at = pixelOf(camera, placeOf(guide, value, radius), size); at && a && b) {
        const glm::vec2 way = *b - *a;
        const glm::vec2 beside = glm::length(way) > 1.0F ? glm::normalize(glm::vec2(-way.y, way.x)) : glm::vec2(1, 0);
        seen.push_back({RigHandle::stroke, *at - kPointerAside * beside});
    }
    if (guide.hasTo) add(RigHandle::to, to);
    if (guide.hasFrom) add(RigHandle::from, from);
    if (guide.hasLine) {
        const auto ends = endsOf(guide);
        add(RigHandle::lineStart, ends[0]);
        add(RigHandle::lineEnd, ends[1]);
    }
    if (guide.bendLength) add(RigHandle::bendEnd, endsOf(guide)[1] + static_cast<float>(*guide.bendLength) * guide.arm);
    if (guide.hasWay) add(RigHandle::direction, to + kDirectionAhead * metresPerPixel(camera, to, size) * guide.axis);
    return seen;
}

} // namespace lumorph::studio

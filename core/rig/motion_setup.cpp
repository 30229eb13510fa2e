#include "core/rig/motion_setup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

namespace lumorph {
namespace {

constexpr double kSmallestAngle = 1e-9; // moves a metre-long part by a nanometre

void setUpHinge(const CompiledActuator& hinge, double angle, MotionSetup& setup) noexcept {
    const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(angle, glm::normalize(glm::dvec3(hinge.axis))));
    setup.turn = glm::mat3(turn);
    setup.shift = glm::vec3(glm::dvec3(hinge.origin) - turn * glm::dvec3(hinge.origin));
}

void setUpBend(const CompiledActuator& bend, double angle, MotionSetup& setup) noexcept {
    setup.radius = static_cast<float>(bend.length / angle);
    setup.curvature = static_cast<float>(angle / bend.length);
    setup.length = static_cast<float>(bend.length);
    const double half = std::sin(0.5 * angle);
    setup.sinEnd = static_cast<float>(std::sin(angle));
    setup.versinEnd = static_cast<float>(2.0 * half * half);
}

KeyPlace placeOf(const MorphTarget& morph, double stroke) noexcept {
    const auto& keys = morph.keys;
    const auto upper = std::upper_bound(keys.begin(), keys.end(), stroke) - keys.begin();
    if (static_cast<std::size_t>(upper) == keys.size()) return {static_cast<int>(upper) - 1, 0.0F};
    const double low = upper == 0 ? 0.0 : keys[upper - 1];
    return {static_cast<int>(upper) - 1, static_cast<float>((stroke - low) / (keys[upper] - low))};
}

struct Compiler {
    CompiledActuator& out;
    void operator()(const Hinge& hinge) const {
        out.kind = CompiledActuator::Kind::hinge;
        out.range = hinge.max.inRadians() - hinge.min.inRadians();
        out.origin = hinge.origin;
        out.axis = glm::normalize(hinge.axis);
    }
    void operator()(const Bend& bend) const {
        out.kind = CompiledActuator::Kind::bend;
        out.range = bend.max.inRadians() - bend.min.inRadians();
        out.length = bend.length;
        out.origin = bend.origin;
        // The frame must be orthonormal to double precision, or a bend would stretch the sheet.
        const glm::dvec3 axis = glm::normalize(glm::dvec3(bend.axis));
        const glm::dvec3 direction = glm::dvec3(bend.direction);
        const glm::dvec3 across = glm::normalize(direction - glm::dot(direction, axis) * axis);
        out.axis = glm::vec3(axis);
        out.direction = glm::vec3(across);
        out.normal = glm::vec3(glm::cross(axis, across));
    }
    void operator()(const Slide& slide) const {
        out.kind = CompiledActuator::Kind::slide;
        out.range = slide.max - slide.min;
        out.direction = glm::normalize(slide.direction);
    }
    void operator()(const MorphTarget&) const {
        out.kind = CompiledActuator::Kind::morph;
        out.range = 1.0;
    }
    void operator()(const SkinJoint& joint) const {
        out.kind = CompiledActuator::Kind::skin;
        out.range = joint.max - joint.min;
        out.axis = glm::normalize(joint.axis);
    }
    void operator()(const SheetLift&) const {
        out.kind = CompiledActuator::Kind::lever;
        out.range = 1.0;
    }
};

} // namespace

CompiledActuator compileActuator(const Actuator& actuator) {
    CompiledActuator compiled;
    std::visit(Compiler{compiled}, actuator.deformer);
    return compiled;
}

MotionSetup setUp(const Actuator& actuator, const CompiledActuator& compiled, double stroke, float weight) noexcept {
    MotionSetup setup;
    const double amount = compiled.range * stroke * static_cast<double>(weight);
    switch (compiled.kind) {
    case CompiledActuator::Kind::hinge:
        setup.still = std::abs(amount) < kSmallestAngle;
        if (!setup.still) setUpHinge(compiled, amount, setup);
        break;
    case CompiledActuator::Kind::bend:
        setup.still = std::abs(amount) < kSmallestAngle;
        if (!setup.still) setUpBend(compiled, amount, setup);
        break;
    case CompiledActuator::Kind::slide:
        setup.still = amount == 0.0;
        setup.shift = compiled.direction * static_cast<float>(amount);
        break;
    case CompiledActuator::Kind::morph:
        setup.still = amount == 0.0;
        setup.keys = placeOf(std::get<MorphTarget>(actuator.deformer), amount);
        break;
    case CompiledActuator::Kind::skin:
    case CompiledActuator::Kind::lever:
        break; // posed as a whole, see poseSkin and CompiledSheet
    }
    return setup;
}

glm::vec3 morphDisplacement(const MorphTarget& morph, KeyPlace place, std::uint32_t influence) noexcept {
    const glm::vec3 low = place.lower < 0 ? glm::vec3(0.0F) : morph.displacements[place.lower][influence];
    if (place.share == 0.0F) return low;
    return low + place.share * (morph.displacements[place.lower + 1][influence] - low);
}

glm::vec3 applySpace(const CompiledActuator& compiled, const MotionSetup& setup, const glm::vec3& point) noexcept {
    if (compiled.kind == CompiledActuator::Kind::slide) return point + setup.shift;
    if (compiled.kind == CompiledActuator::Kind::hinge) return setup.turn * point + setup.shift;
    const float u = glm::dot(point - compiled.origin, compiled.direction);
    if (u <= 0.0F) return point;
    const float h = glm::dot(point - compiled.origin, compiled.normal);
    const glm::vec3 base = point - u * compiled.direction - h * compiled.normal;
    const glm::vec2 bent = u <= setup.length ? bendArc(setup, u, h) : bendStraight(setup, u, h);
    return base + bent.x * compiled.direction + bent.y * compiled.normal;
}

void poseSkin(const Skeleton& skeleton, std::span<const Actuator> actuators,
              std::span<const std::uint16_t> skinActuators, std::span<const double> strokes, SkinPose& pose) noexcept {
    pose.still = std::all_of(skinActuators.begin(), skinActuators.end(), [&](auto a) { return strokes[a] == 0.0; });
    if (pose.still) return;
    std::array<glm::dmat4, kMaxJoints> rest;
    std::array<glm::dmat4, kMaxJoints> now;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const Skeleton::Joint& joint = skeleton.joints[j];
        glm::dmat4 local(joint.localRest);
        rest[j] = joint.parent < 0 ? local : rest[joint.parent] * local;
        for (const std::uint16_t a : skinActuators) {
            const auto& deformer = std::get<SkinJoint>(actuators[a].deformer);
            if (deformer.joint != static_cast<int>(j)) continue;
            const double amount = (deformer.max - deformer.min) * strokes[a];
            const glm::dvec3 axis = glm::normalize(glm::dvec3(deformer.axis));
            local = deformer.motion == SkinJoint::Motion::rotate ? glm::rotate(local, amount, axis)
                                                                 : glm::translate(local, amount * axis);
        }
        now[j] = joint.parent < 0 ? local : now[joint.parent] * local;
        pose.moved[j] = glm::mat4x3(now[j] * glm::inverse(rest[j]));
    }
}

} // namespace lumorph

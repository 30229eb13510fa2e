#include "app/workspaces/field/actuator_scale.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace lumorph::studio {

namespace {

struct ScaleOf {
    ActuatorScale operator()(const Hinge& hinge) const {
        return {Quantity::angle, hinge.min.inRadians(), hinge.max.inRadians()};
    }
    ActuatorScale operator()(const Bend& bend) const {
        return {Quantity::angle, bend.min.inRadians(), bend.max.inRadians()};
    }
    ActuatorScale operator()(const Slide& slide) const { return {Quantity::length, slide.min, slide.max}; }
    ActuatorScale operator()(const MorphTarget&) const { return {Quantity::share, 0.0, 1.0}; }
    ActuatorScale operator()(const SkinJoint& joint) const {
        const bool turns = joint.motion == SkinJoint::Motion::rotate;
        return {turns ? Quantity::angle : Quantity::length, joint.min, joint.max};
    }
    ActuatorScale operator()(const SheetLift& lift) const {
        return {Quantity::angle, lift.min.inRadians(), lift.max.inRadians()};
    }
};

} // namespace

double ActuatorScale::strokeOf(double value) const noexcept {
    const double range = atEnd - atRest;
    if (range == 0.0 || !std::isfinite(value)) return 0.0;
    return std::clamp((value - atRest) / range, 0.0, 1.0);
}

ActuatorScale scaleOf(const Actuator& actuator) { return std::visit(ScaleOf{}, actuator.deformer); }

int nearestLevel(double stroke, int levels) noexcept {
    return std::clamp(static_cast<int>(std::lround(stroke * (levels - 1))), 0, std::max(levels - 1, 0));
}

} // namespace lumorph::studio

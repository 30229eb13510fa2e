#include "core/rig/parts/lever.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

// Millimetres.
constexpr double kHornWall = 1.4;
constexpr double kBase = 1.6;       ///< of the lever, under the horn
constexpr double kShaftHole = 4.8;  ///< diameter, for the screw of the horn and its driver
constexpr double kMargin = 2.2;     ///< of flap beyond the nose at rest
constexpr double kArmTop = 0.3;     ///< of the arm above the line from shaft to nose
constexpr double kArmBelow = 2.7;   ///< of the arm below it, near the shaft
constexpr double kClear = 0.2;      ///< from arm to arc
constexpr double kBeyond = 1.0;     ///< of straight flap that the nose reaches at least at the end
constexpr double kInsideSlot = 2.5; ///< from the line that the nose holds at rest to the nose, so that the lid has room
constexpr double kLeastLift = 20.0; ///< degrees
constexpr double kMostLean = 25.0;  ///< degrees between flap and arm at the end
constexpr int kCurveSteps = 16;

/// From the shaft to the middle of the horn's round end; a horn that is too long for the lever is cut off.
double hornEnd(double length, const ServoBody& body) {
    return std::min(body.hornReach - 0.5 * body.hornTip, 0.4 * length);
}
/// Radius of the bed there.
double hornTip(const ServoBody& body, double tolerance) { return 0.5 * body.hornTip + tolerance; }

double distanceToSegment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const double share = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(p, a + share * (b - a));
}

/// The underside of a flap beyond its arc, in a lever's plane: where it begins, and the ways along it and out of it.
struct Underside {
    glm::dvec2 begin, along, out;

    Underside(double arc, double angle, double thickness)
        : along(std::cos(angle), std::sin(angle)), out(along.y, -along.x) {
        const double radius = arc / angle;
        begin = glm::dvec2(0.0, 0.5 * thickness) + radius * glm::dvec2(along.y, 1.0 - along.x) + 0.5 * thickness * out;
    }
};

/// The lever of a given length that holds the flap at an angle, itself leaning back from it by `lean`. `horn`: how far
/// along the lever the horn ends, and the radius there.
std::optional<Lever> leverAlong(const SheetFlap& flap, double thickness, double below, double angle, double lean,
                                double length, const glm::dvec2& horn) {
    const double rise = below - Lever::kNose;
    if (rise >= length || rise < 0.0) return std::nullopt;
    const double rest = std::asin(rise / length);
    if (rest >= angle - lean) return std::nullopt;
    const Underside under(flap.arc, angle, thickness);
    const glm::dvec2 arm(std::cos(angle - lean), std::sin(angle - lean));
    // (nose - begin) . out = kNose, where nose = (pivot, -below) + length * arm.
    Lever lever;
    lever.pivot = (Lever::kNose + glm::dot(under.begin - length * arm, under.out) + below * under.out.y) / under.out.x;
    lever.below = below;
    lever.length = length;
    lever.rest = Angle::radians(rest);
    lever.end = Angle::radians(angle - lean);
    lever.lifted = Angle::radians(angle);
    const glm::dvec2 shaft(lever.pivot, -below);
    const glm::dvec2 nose = shaft + length * arm;
    const double radius = flap.arc / angle;
    const glm::dvec2 centre(0.0, 0.5 * thickness + radius);
    const double outside = radius + 0.5 * thickness + kClear;
    if (distanceToSegment(centre, shaft, nose) < outside + kArmTop) return std::nullopt;
    if (glm::distance(centre, shaft + horn.x * arm) < outside + horn.y) return std::nullopt;
    return glm::dot(nose - under.begin, under.along) >= kBeyond ? std::optional(lever) : std::nullopt;
}

} // namespace

double Lever::reach() const { return pivot + length * std::cos(rest.inRadians()) + kNose; }

std::optional<Lever> leverFor(const SheetFlap& flap, double thickness, double depth, double below,
                              const ServoBody& body, double tolerance) {
    const double most = std::min(90.0, flap.angle.inDegrees());
    for (double degrees = most; degrees >= kLeastLift; degrees -= 5.0) {
        std::optional<Lever> best;
        for (double lean = 0.0; lean <= kMostLean; lean += 5.0)
            for (double length = 12.0; length <= 120.0; length += 0.5) {
                const auto lever = leverAlong(flap, thickness, below, Angle::degrees(degrees).inRadians(),
                                              Angle::degrees(lean).inRadians(), length,
                                              {hornEnd(length, body), hornTip(body, tolerance) + kHornWall});
                if (!lever) continue;
                if (!best || lever->reach() < best->reach()) best = lever;
                break; // longer ones reach farther
            }
        if (best && best->reach() <= depth - kMargin) return best;
    }
    return std::nullopt;
}

std::optional<Lever> captiveLever(const SheetFlap::Captive& captive, double below) {
    const double rise = below - Lever::kNose;
    if (rise < 0.0 || rise + captive.lift >= captive.arm) return std::nullopt;
    Lever lever;
    lever.below = below;
    lever.length = captive.arm;
    lever.rest = Angle::radians(std::asin(rise / captive.arm));
    lever.end = Angle::radians(std::asin((rise + captive.lift) / captive.arm));
    lever.lifted = lever.end;
    lever.pivot = -captive.arm * std::cos(lever.rest.inRadians()) - kInsideSlot;
    return lever;
}

PulseCurve pulseCurveOf(const Lever& lever, const SheetFlap& flap, double thickness) {
    PulseCurve curve{0.0};
    const glm::dvec2 shaft(lever.pivot, -lever.below);
    for (int step = 1; step < kCurveSteps; ++step) {
        const double angle = lever.lifted.inRadians() * step / kCurveSteps;
        const Underside under(flap.arc, angle, thickness);
        // (shaft + length x arm - begin) . out = kNose, where arm . out = sin(angle - the lever's).
        const double off = (Lever::kNose + glm::dot(under.begin - shaft, under.out)) / lever.length;
        const double turned = angle - std::asin(std::clamp(off, -1.0, 1.0)) - lever.rest.inRadians();
        curve.push_back(turned / lever.turn().inRadians());
    }
    curve.push_back(1.0);
    return curve;
}

double leverPlane(const ServoBody& body) { return body.hornTop + kBase - 0.5 * Lever::kThickness; }

double leverHub(const ServoBody& body, double tolerance) { return 0.5 * body.hornHub + tolerance + kHornWall; }

std::vector<PlanePolygon> leverShapes(const Lever& lever, const ServoBody& body, double tolerance) {
    const glm::dvec2 tip(hornEnd(lever.length, body), 0.0);
    const glm::dvec2 nose(lever.length, 0.0);
    return {arm({0.0, 0.0}, leverHub(body, tolerance), tip, hornTip(body, tolerance) + kHornWall),
            {{tip.x, kArmTop}, {tip.x, -kArmBelow}, {nose.x, -Lever::kNose}, {nose.x, kArmTop}},
            disc(nose, Lever::kNose)};
}

LayeredDrawing leverDrawing(const Lever& lever, const ServoBody& body, double tolerance, bool mirrored) {
    Region base;
    for (PlanePolygon& shape : leverShapes(lever, body, tolerance)) {
        if (mirrored)
            for (glm::dvec2& p : shape) p.y = -p.y;
        base.add(std::move(shape));
    }
    base.cut(disc({0.0, 0.0}, 0.5 * kShaftHole));
    Region bed = base;
    bed.cut(
        arm({0.0, 0.0}, 0.5 * body.hornHub + tolerance, {hornEnd(lever.length, body), 0.0}, hornTip(body, tolerance)));
    return {{{kBase, base}, {Lever::kThickness, bed}}};
}

} // namespace lumorph

#include "core/motion/view_dependence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kQuarterTurn = 90.0 * kDegree;

constexpr double kFull = 50.0 * kDegree; ///< within it of straight away from the user an edge bends wholly
/// From there to nothing: at least this, and so much a level that the steepest place of the fall takes 1 degree a
/// level.
constexpr double kFall = 50.0 * kDegree;
constexpr double kFallOfLevel = 1.52 * kDegree;

// What stays well inside the outline is no edge; shares of the way from the centre to the outline.
constexpr double kInner = 0.5;
constexpr double kOuter = 0.85;

double smoothShare(double from, double to, double value) {
    const double share = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

/// From where to where it turns, radians.
std::pair<double, double> turnOf(const Deformer& deformer) {
    if (const auto* hinge = std::get_if<Hinge>(&deformer)) return {hinge->min.inRadians(), hinge->max.inRadians()};
    if (const auto* bend = std::get_if<Bend>(&deformer)) return {bend->min.inRadians(), bend->max.inRadians()};
    const auto* joint = std::get_if<SkinJoint>(&deformer);
    if (joint && joint->motion == SkinJoint::Motion::rotate) return {joint->min, joint->max};
    return {0.0, kQuarterTurn};
}

/// What one actuator alone does at full stroke.
struct Lift {
    glm::dvec2 centre{0.0}; ///< mean place of what moves, weighted by how far it moves; from the device's centre
    double rise = 0.0;      ///< mean, metres
    double outermost = 0.0; ///< 1 at the outline
};

Lift liftOf(const Rig& rig, std::size_t actuator, const Box& box) {
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    strokes[actuator] = 1.0;
    const std::span<const std::uint32_t> vertices = rig.verticesOf(actuator);
    std::vector<glm::vec3> moved(vertices.size());
    rig.deform(strokes, vertices, moved);
    const glm::dvec3 centre(box.centre());
    const glm::dvec3 half = 0.5 * glm::dvec3(box.size());
    Lift lift;
    double ways = 0.0;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const glm::dvec3 rest(rig.restMesh().positions[vertices[k]]);
        const glm::dvec3 way = glm::dvec3(moved[k]) - rest;
        const double length = glm::length(way);
        if (!(length > 0.0)) continue;
        const glm::dvec2 place(rest.x - centre.x, rest.z - centre.z);
        lift.centre += length * place;
        lift.rise += length * way.y;
        ways += length;
        lift.outermost = std::max({lift.outermost, half.x > 0.0 ? std::abs(place.x) / half.x : 0.0,
                                   half.z > 0.0 ? std::abs(place.y) / half.z : 0.0});
    }
    if (ways > 0.0) {
        lift.centre /= ways;
        lift.rise /= ways;
    }
    return lift;
}

void requireTheta(Angle theta) {
    if (!(theta.inRadians() > 0.0) || !std::isfinite(theta.inRadians()))
        throw InvalidInput("largest bend", "it must be a finite angle above zero", "give a larger angle");
}

} // namespace

Angle viewBend(Angle elevation, Angle theta) {
    requireTheta(theta);
    if (!std::isfinite(elevation.inRadians()))
        throw InvalidInput("elevation of the viewer", "it is not a finite number", "give a finite angle");
    const double most = theta.inRadians();
    const double alpha = std::clamp(elevation.inRadians(), 0.0, most);
    return Angle::radians(most - alpha * alpha / most);
}

ViewRule::ViewRule(const Rig& rig) {
    const Box box = boundingBox(rig.restMesh().positions);
    centre_ = glm::dvec3(box.centre().x, box.max.y, box.centre().z);
    const double small = 0.05 * static_cast<double>(glm::length(box.size()));
    for (std::size_t i = 0; i < rig.actuatorCount(); ++i) {
        const Lift lift = liftOf(rig, i, box);
        Edge edge;
        const auto [min, max] = turnOf(rig.actuators()[i].deformer);
        const bool bothWays = min < 0.0 && max > 0.0;
        edge.flat = bothWays ? -min / (max - min) : 0.0;
        edge.range = bothWays ? max : max - min;
        const double fall = std::max(kFall, kFallOfLevel * (rig.actuators()[i].levels - 1) * (1.0 - edge.flat));
        edge.full = std::clamp(std::numbers::pi - fall, 0.0, kFull);
        edge.none = edge.full + std::min(fall, std::numbers::pi);
        const double distance = glm::length(lift.centre);
        if (lift.rise > 0.0 && distance > small && edge.range > 0.0) {
            edge.direction = lift.centre / distance;
            // Where half a turn is too short for so many levels it bends less.
            edge.share = smoothShare(kInner, kOuter, lift.outermost) * std::min(1.0, std::numbers::pi / fall);
        }
        edges_.push_back(edge);
    }
}

std::vector<double> ViewRule::strokes(const glm::dvec3& eyeInDevice, Angle theta) const {
    const glm::dvec3 seen = eyeInDevice - centre_;
    const double across = std::hypot(seen.x, seen.z);
    if (!std::isfinite(across) || !std::isfinite(seen.y))
        throw InvalidInput("eye", "its position is not finite", "give finite coordinates");
    requireTheta(theta);
    std::vector<double> strokes;
    for (const Edge& edge : edges_) strokes.push_back(edge.flat);
    if (!(across > 0.0)) return strokes;
    const Angle most = std::min(theta, Angle::radians(kQuarterTurn)); // so that nothing bends for a user overhead
    const double bend = viewBend(Angle::radians(std::atan2(seen.y, across)), most).inRadians();
    const glm::dvec2 away = -glm::dvec2(seen.x, seen.z) / across;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        const Edge& edge = edges_[i];
        if (edge.share == 0.0) continue;
        const double off = std::acos(std::clamp(glm::dot(edge.direction, away), -1.0, 1.0));
        const double weight = edge.share * (1.0 - smoothShare(edge.full, edge.none, off));
        strokes[i] = edge.flat + (1.0 - edge.flat) * weight * std::min(1.0, bend / edge.range);
    }
    return strokes;
}

} // namespace lumorph

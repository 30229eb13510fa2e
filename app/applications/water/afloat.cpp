#include "app/applications/water/afloat.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph::sea {
namespace {

constexpr double kCarries = 0.5;   ///< of water that runs, metres a second squared for a slope of 1
constexpr double kSlides = 0.04;   ///< down a wave, likewise: it mostly goes up and down
constexpr double kFloatDrag = 0.9; ///< 1 / s
constexpr double kBounce = 0.4;
constexpr double kFalls = 2.6;                           ///< metres a second squared: slow enough to be seen
constexpr double kSailsFrom = 0.004;                     ///< metres a second, from which on a boat turns
constexpr double kFollowsSlope = 0.85, kBoatHeels = 0.5; ///< of the water's slope: a keel rights it
constexpr double kTurns = 1.6;                           ///< 1 / s

/// Down the waves, and with the water where it runs to the low side.
void move(Float& one, const glm::dvec2& wave, const Push& push, double step) {
    one.velocity += step * (one.homesick * (one.home - one.at) + kCarries * push.slope - kSlides * wave +
                            push.ripples->pushAt(one.at) - kFloatDrag * one.velocity);
    one.at += step * one.velocity;
    if (!one.sails || glm::length(one.velocity) < kSailsFrom) return;
    const double off = std::remainder(std::atan2(one.velocity.y, one.velocity.x) - one.heading, 2.0 * 3.14159265358979);
    one.heading += off * std::min(1.0, kTurns * step);
}

} // namespace

Waterline Float::waterline() const noexcept { return {at, half, std::min({radius, half.x, half.y}), heading}; }

glm::quat alongSlope(const glm::dvec2& slope) {
    const glm::vec3 normal = glm::normalize(glm::vec3(-slope.x, 1.0, -slope.y));
    const glm::vec3 axis(normal.z, 0.0F, -normal.x);
    const float length = glm::length(axis);
    return length < 1e-6F ? glm::quat(1.0F, 0.0F, 0.0F, 0.0F)
                          : glm::angleAxis(std::asin(std::min(1.0F, length)), axis / length);
}

bool drift(Float& one, const SeaSurface& sea, const Push& push, double step) {
    const bool fell = one.above > 0.0;
    if (fell) {
        one.falls += kFalls * step;
        one.above = std::max(0.0, one.above - one.falls * step);
    }
    const glm::dvec2 slope = sea.slopeAt(one.at);
    if (one.above <= 0.0) move(one, slope - push.slope, push, step);
    one.item.position = {
        glm::dvec3(one.at.x, SeaSurface::kLevel + sea.heightAt(one.at) + one.lift + one.above, one.at.y)};
    const glm::quat yaw = glm::angleAxis(static_cast<float>(-one.heading), glm::vec3(0.0F, 1.0F, 0.0F));
    one.item.rotation = alongSlope((one.sails ? kBoatHeels : kFollowsSlope) * slope) * yaw;
    return fell && one.above <= 0.0;
}

void keepApart(std::span<Float* const> all) {
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = i + 1; j < all.size(); ++j) {
            Float &a = *all[i], &b = *all[j];
            if (a.above > 0.0 || b.above > 0.0) continue; // still falls
            const glm::dvec2 way = b.at - a.at;
            const double far = glm::length(way), least = a.radius + b.radius;
            if (far >= least || far < 1e-9) continue;
            const glm::dvec2 push = way * (0.5 * (least - far) / far);
            a.at -= push;
            b.at += push;
            if (glm::dot(b.velocity - a.velocity, way) < 0.0) std::swap(a.velocity, b.velocity);
        }
    for (Float* one : all)
        for (int axis = 0; axis < 2; ++axis) {
            const double most = Ripples::kHalf[axis] - one->radius;
            if (std::abs(one->at[axis]) <= most) continue;
            one->at[axis] = std::copysign(most, one->at[axis]);
            one->velocity[axis] *= -kBounce;
        }
}

} // namespace lumorph::sea

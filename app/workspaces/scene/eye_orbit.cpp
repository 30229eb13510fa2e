#include "app/workspaces/scene/eye_orbit.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace lumorph::studio {
namespace {

constexpr double kHalfTurn = 180.0;
constexpr double kNotch = 1.12; // nearer by this a notch

} // namespace

EyePlace placeOf(const glm::vec3& eye, const glm::vec3& centre) {
    const glm::dvec3 way = glm::dvec3(eye) - glm::dvec3(centre);
    EyePlace place;
    place.distance = glm::length(way);
    place.azimuth = Angle::radians(std::atan2(way.x, way.z));
    place.elevation = Angle::radians(std::atan2(way.y, std::hypot(way.x, way.z)));
    return place;
}

glm::vec3 eyeAt(const EyePlace& place, const glm::vec3& centre) {
    const double up =
        Angle::degrees(std::clamp(place.elevation.inDegrees(), kLowestElevation, kHighestElevation)).inRadians();
    const double distance = std::clamp(place.distance, kNearestEye, kFarthestEye);
    const double around = place.azimuth.inRadians();
    const glm::dvec3 way(std::cos(up) * std::sin(around), std::sin(up), std::cos(up) * std::cos(around));
    return glm::vec3(glm::dvec3(centre) + distance * way);
}

glm::vec3 orbitedEye(const glm::vec3& eye, const glm::vec3& centre, glm::vec2 pixels, glm::vec2 size) {
    EyePlace place = placeOf(eye, centre);
    const double degrees = kHalfTurn / std::max(static_cast<double>(size.y), 1.0);
    place.azimuth = Angle::degrees(place.azimuth.inDegrees() - degrees * static_cast<double>(pixels.x));
    place.elevation = Angle::degrees(place.elevation.inDegrees() + degrees * static_cast<double>(pixels.y));
    return eyeAt(place, centre);
}

glm::vec3 nearerEye(const glm::vec3& eye, const glm::vec3& centre, double notches) {
    EyePlace place = placeOf(eye, centre);
    place.distance *= std::pow(kNotch, -notches);
    return eyeAt(place, centre);
}

} // namespace lumorph::studio

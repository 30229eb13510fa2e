#include "core/scene/projector_response.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/srgb.h"

namespace lumorph {
namespace {

constexpr int kFloorSteps = 24;        // places along each side of the table that are asked for their black
constexpr double kDeviceHeight = 0.08; // metres above the table to which devices reach

using Points = std::vector<InstalledProjector::ResponsePoint>;

double srgbFromLinear(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
}

double mixed(double a, double b, double share) { return a + share * (b - a); }

double lightOnCurve(const Points& points, double value, int channel) {
    const auto above = std::ranges::upper_bound(points, value, {}, &InstalledProjector::ResponsePoint::value);
    if (above == points.end()) return static_cast<double>(points.back().light[channel]);
    if (above == points.begin()) return static_cast<double>(points.front().light[channel]);
    const auto below = above - 1;
    return mixed(static_cast<double>(below->light[channel]), static_cast<double>(above->light[channel]),
                 (value - below->value) / (above->value - below->value));
}

double valueOnCurve(const Points& points, double light, int channel) {
    for (std::size_t k = 1; k < points.size(); ++k) {
        const auto low = static_cast<double>(points[k - 1].light[channel]);
        const auto high = static_cast<double>(points[k].light[channel]);
        if (high < light) continue;
        const double share = high > low ? std::clamp((light - low) / (high - low), 0.0, 1.0) : 0.0;
        return mixed(points[k - 1].value, points[k].value, share);
    }
    return points.back().value;
}

bool lights(const InstalledProjector& projector, const glm::dvec3& place) {
    const auto pixel = pixelOf(projector.camera, place);
    return pixel && pixel->x > -0.5 && pixel->y > -0.5 && pixel->x < projector.camera.size.x - 0.5 &&
           pixel->y < projector.camera.size.y - 0.5;
}

/// The blacks of all projectors on the table's plane, raised by `height`; 0 where fewer than two reach.
glm::dvec3 blackAt(const Installation& installation, const glm::dvec3& place) {
    glm::dvec3 sum(0.0);
    int reaching = 0;
    for (const InstalledProjector& projector : installation.projectors) {
        if (!projector.enabled || !lights(projector, place)) continue;
        ++reaching;
        sum += glm::dvec3(projector.black) * whiteLight(projector, place, {0.0, 1.0, 0.0});
    }
    return reaching > 1 ? sum : glm::dvec3(0.0);
}

} // namespace

bool isResponseMeasured(const InstalledProjector& projector) noexcept {
    return !projector.responseCurve.empty() || projector.black != glm::vec3(0.0F);
}

glm::dvec3 lightOfValue(const InstalledProjector& projector, double value) {
    const double inside = std::clamp(value, 0.0, 1.0);
    if (projector.responseCurve.empty())
        return glm::dvec3(projector.gamma > 0.0 ? std::pow(inside, projector.gamma) : linearFromSrgb(inside));
    glm::dvec3 light;
    for (int channel = 0; channel < 3; ++channel)
        light[channel] = lightOnCurve(projector.responseCurve, inside, channel);
    return glm::clamp(light, 0.0, 1.0);
}

glm::dvec3 valueOfLight(const InstalledProjector& projector, const glm::dvec3& light) {
    const glm::dvec3 inside = glm::clamp(light, 0.0, 1.0);
    glm::dvec3 value;
    for (int channel = 0; channel < 3; ++channel) {
        if (!projector.responseCurve.empty())
            value[channel] = valueOnCurve(projector.responseCurve, inside[channel], channel);
        else
            value[channel] = projector.gamma > 0.0 ? std::pow(inside[channel], 1.0 / projector.gamma)
                                                   : srgbFromLinear(inside[channel]);
    }
    return value;
}

glm::dvec3 whiteLight(const InstalledProjector& projector, const glm::dvec3& place, const glm::dvec3& normal) {
    const glm::dvec3 way = positionOf(projector.camera) - place;
    const double square = glm::dot(way, way);
    const double cosine = std::max(glm::dot(way, normal), 0.0) / std::sqrt(square);
    const double reference = projector.referenceDistance * projector.referenceDistance;
    return projector.peak * cosine * reference / square * glm::dvec3(projector.gain);
}

glm::vec3 blackFloor(const Installation& installation) {
    glm::dvec3 floor(0.0);
    const bool dark = std::ranges::none_of(installation.projectors, [](const InstalledProjector& projector) {
        return projector.enabled && projector.black != glm::vec3(0.0F);
    });
    if (dark) return floor;
    for (const double height : {0.0, kDeviceHeight})
        for (int i = 0; i <= kFloorSteps; ++i)
            for (int j = 0; j <= kFloorSteps; ++j) {
                const glm::dvec2 share(static_cast<double>(i) / kFloorSteps - 0.5,
                                       static_cast<double>(j) / kFloorSteps - 0.5);
                const glm::dvec2 at = share * glm::dvec2(installation.tableSize);
                floor = glm::max(floor, blackAt(installation, {at.x, height, at.y}));
            }
    return floor;
}

} // namespace lumorph

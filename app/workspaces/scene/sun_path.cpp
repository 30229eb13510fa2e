#include "app/workspaces/scene/sun_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace lumorph::studio {

namespace {

constexpr double kRise = 6.0, kSet = 18.0;
constexpr double kUsualLean = -30.0 * std::numbers::pi / 180.0; ///< of the arc from upright towards +Z
constexpr double kMostLean = 80.0 * std::numbers::pi / 180.0;

} // namespace

double hourOf(const glm::vec3& direction) {
    const double above = std::hypot(static_cast<double>(direction.y), static_cast<double>(direction.z));
    const double along = std::atan2(above, static_cast<double>(direction.x));
    return kRise + (kSet - kRise) * along / std::numbers::pi;
}

glm::vec3 sunAt(double hour, const glm::vec3& now) {
    const double along = std::numbers::pi * (std::clamp(hour, kRise, kSet) - kRise) / (kSet - kRise);
    const bool leans = now.y > 1e-4F;
    const double lean =
        leans ? std::clamp(std::atan2(static_cast<double>(now.z), static_cast<double>(now.y)), -kMostLean, kMostLean)
              : kUsualLean;
    return glm::normalize(
        glm::vec3(std::cos(along), std::sin(along) * std::cos(lean), std::sin(along) * std::sin(lean)));
}

} // namespace lumorph::studio

#include "app/applications/slosh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph {
namespace {

constexpr double kOmega = 2.0 * std::numbers::pi * Slosh::kSwings;
constexpr double kStep = 1.0 / 120.0; ///< seconds, at most: a spring in longer ones gains energy
constexpr double kMostTime = 0.5;     ///< seconds: who was away longer has missed a few swings
constexpr double kFlat = 1e-5;        ///< slope

} // namespace

void Slosh::advance(double seconds, const glm::dvec2& lean) noexcept {
    if (!std::isfinite(seconds) || !std::isfinite(lean.x + lean.y)) return;
    const glm::dvec2 level = share_ * glm::tan(glm::clamp(lean, -0.35, 0.35));
    for (double left = std::clamp(seconds, 0.0, kMostTime); left > 0.0; left -= kStep)
        step(std::min(left, kStep), level);
    if (level == glm::dvec2(0.0) && rests()) slope_ = speed_ = {};
}

/// The speed first, and from it the place: a spring that gains no energy.
void Slosh::step(double seconds, const glm::dvec2& level) noexcept {
    const glm::dvec2 most(share_ * kMostSlope);
    speed_ += (kOmega * kOmega * (level - slope_) - 2.0 * kDamping * kOmega * speed_) * seconds;
    slope_ = glm::clamp(slope_ + speed_ * seconds, -most, most);
}

double Slosh::heightAt(const glm::dvec2& place) const noexcept { return glm::dot(slope_, place); }

bool Slosh::rests() const noexcept { return glm::length(slope_) < kFlat && glm::length(speed_) < kFlat * kOmega; }

} // namespace lumorph

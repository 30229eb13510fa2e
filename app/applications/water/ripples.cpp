#include "app/applications/water/ripples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph::sea {
namespace {

constexpr float kStill = 1e-12F;                     ///< metres, or metres a second
constexpr double kRippleStep = 1.0 / 120.0;          ///< seconds; a ring crosses 0.4 of the grid's spacing in it
constexpr double kMostBehind = 0.25;                 ///< seconds; after a pause the rest is left out
constexpr double kSpacing = 0.0025;                  ///< metres
constexpr double kRippleDrag = 0.55, kRimDrag = 9.0; ///< 1 / s
constexpr double kRimWide = 0.010;                   ///< metres
constexpr double kTouchLasts = 1.6;                  ///< seconds

/// What a touch drives: the radius, how often a second, how long until 1/e, and how strongly (m / s^2).
struct Drive {
    double radius, often, lasts, strength;
};
constexpr Drive kShort{0.0080, 4.0, 0.34, 13.0};
constexpr Drive kLong{0.036, 0.9, 0.60, 0.50};

constexpr double kPush = 0.22;       ///< m / s^2 on what floats in a young ring
constexpr double kFrontWide = 0.016; ///< metres
constexpr double kPushLasts = 0.8;   ///< seconds

double bell(double share) { return std::exp(-share * share); }

/// What is pushed down in the middle rises around it: its sum over the plane is 0.
double hat(double share) { return (1.0 - share * share) * bell(share); }

} // namespace

Ripples::Ripples() : heights_(std::size_t{kColumns} * kRows, 0.0F), speeds_(heights_.size(), 0.0F) {
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i) {
            const double toRim = kSpacing * std::min({i, j, kColumns - 1 - i, kRows - 1 - j});
            const double rim = std::max(0.0, 1.0 - toRim / kRimWide);
            calm_.push_back(static_cast<float>(kRippleDrag + kRimDrag * rim * rim));
        }
}

void Ripples::touch(const glm::dvec2& place, double strength) {
    if (!std::isfinite(place.x + place.y + strength)) return;
    if (touches_.size() >= kMostTouches) touches_.erase(touches_.begin());
    touches_.push_back({glm::clamp(place, -kHalf, kHalf), strength, 0.0});
}

void Ripples::advance(double seconds) {
    if (!std::isfinite(seconds)) return;
    left_ = std::min(left_ + std::max(seconds, 0.0), kMostBehind);
    for (; left_ >= kRippleStep; left_ -= kRippleStep) step(kRippleStep);
}

void Ripples::step(double seconds) {
    for (Touch& touch : touches_) {
        drive(touch, seconds);
        touch.age += seconds;
    }
    std::erase_if(touches_, [](const Touch& touch) { return touch.age > kTouchLasts; });
    const auto dt = static_cast<float>(seconds);
    const auto stiff = static_cast<float>(kSpeed * kSpeed / (kSpacing * kSpacing));
    for (int j = 0; j < kRows; ++j) {
        // A rim mirrors: its neighbour beyond is itself.
        const int above = (j > 0 ? j - 1 : j) * kColumns, below = (j + 1 < kRows ? j + 1 : j) * kColumns;
        for (int i = 0; i < kColumns; ++i) {
            const auto k = static_cast<std::size_t>(j * kColumns + i);
            const std::size_t left = i > 0 ? k - 1 : k, right = i + 1 < kColumns ? k + 1 : k;
            const float bend = heights_[left] + heights_[right] + heights_[static_cast<std::size_t>(above + i)] +
                               heights_[static_cast<std::size_t>(below + i)] - 4.0F * heights_[k];
            speeds_[k] += dt * (stiff * bend - calm_[k] * speeds_[k]);
        }
    }
    // Water that a touch has moved away comes back from all sides.
    const float kept = 1.0F - 0.5F * dt;
    for (std::size_t k = 0; k < heights_.size(); ++k) {
        heights_[k] = kept * (heights_[k] + dt * speeds_[k]);
        // What dies away would end in denormal numbers, with which processors are slow.
        if (std::abs(heights_[k]) < kStill) heights_[k] = 0.0F;
        if (std::abs(speeds_[k]) < kStill) speeds_[k] = 0.0F;
    }
}

void Ripples::drive(const Touch& touch, double seconds) {
    for (const Drive& one : {kShort, kLong}) {
        const double swing = std::sin(2.0 * std::numbers::pi * one.often * touch.age);
        const double change = -seconds * touch.strength * one.strength * swing * std::exp(-touch.age / one.lasts);
        if (std::abs(change) > 1e-7) driveWave(touch, one.radius, change);
    }
}

void Ripples::driveWave(const Touch& touch, double radius, double change) {
    const glm::dvec2 middle = (touch.place + kHalf) / kSpacing;
    const double reach = 2.5 * radius / kSpacing;
    const int left = std::max(0, static_cast<int>(middle.x - reach));
    const int right = std::min(kColumns - 1, static_cast<int>(middle.x + reach) + 1);
    const int top = std::max(0, static_cast<int>(middle.y - reach));
    const int bottom = std::min(kRows - 1, static_cast<int>(middle.y + reach) + 1);
    for (int j = top; j <= bottom; ++j)
        for (int i = left; i <= right; ++i) {
            const double share = kSpacing * glm::distance(middle, glm::dvec2(i, j)) / radius;
            speeds_[static_cast<std::size_t>(j * kColumns + i)] += static_cast<float>(change * hat(share));
        }
}

double Ripples::heightAt(const glm::dvec2& place) const noexcept {
    const glm::dvec2 at = glm::clamp((place + kHalf) / kSpacing, glm::dvec2(0.0), glm::dvec2(kColumns - 1, kRows - 1));
    const glm::ivec2 low = glm::min(glm::ivec2(at), glm::ivec2(kColumns - 2, kRows - 2));
    const glm::dvec2 f = at - glm::dvec2(low);
    const auto k = static_cast<std::size_t>(low.y * kColumns + low.x);
    const double upper = std::lerp(double{heights_[k]}, double{heights_[k + 1]}, f.x);
    const double lower = std::lerp(double{heights_[k + kColumns]}, double{heights_[k + kColumns + 1]}, f.x);
    return std::lerp(upper, lower, f.y);
}

glm::dvec2 Ripples::pushAt(const glm::dvec2& place) const noexcept {
    glm::dvec2 push(0.0);
    for (const Touch& touch : touches_) {
        const glm::dvec2 way = place - touch.place;
        const double far = glm::length(way);
        if (far < 1e-6) continue;
        const double front = bell((far - kSpeed * touch.age) / kFrontWide) * std::exp(-touch.age / kPushLasts);
        push += way * (kPush * touch.strength * front / far);
    }
    return push;
}

} // namespace lumorph::sea

#include "app/applications/navigation/map_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/shapes.h"

namespace lumorph::navigation {
namespace {

constexpr double kRho = 1.25;                     ///< how readily a flight rises instead of going straight
constexpr double kFlightSpeed = 0.62;             ///< of the way of a flight, a second
constexpr double kShortest = 1.6, kLongest = 9.0; ///< seconds of a flight

glm::dvec2 turned(const glm::dvec2& v, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * v.x - s * v.y, s * v.x + c * v.y};
}

double shorterTurn(double from, double to) { return std::remainder(to - from, 2.0 * std::numbers::pi); }

} // namespace

glm::dvec2 MapView::placeAt(const glm::dvec2& point) const noexcept { return centre + scale() * turned(point, -turn); }

glm::dvec2 MapView::pointAt(const glm::dvec2& place) const noexcept { return turned(place - centre, turn) / scale(); }

double widestView(const glm::dvec2& mapSize) noexcept {
    return 0.999 * std::min(mapSize.x, mapSize.y) * kHalf.x / glm::length(kHalf);
}

double wholeView(const glm::dvec2& mapSize) noexcept {
    return 1.04 * std::max(mapSize.x, mapSize.y * kHalf.x / kHalf.y);
}

MapView within(MapView view, const glm::dvec2& mapSize, double narrowest) noexcept {
    const double widest = wholeView(mapSize);
    view.width = std::clamp(view.width, std::min(narrowest, widest), widest);
    const double c = std::abs(std::cos(view.turn)), s = std::abs(std::sin(view.turn));
    const glm::dvec2 reach = view.scale() * glm::dvec2(c * kHalf.x + s * kHalf.y, s * kHalf.x + c * kHalf.y);
    const glm::dvec2 middle = 0.5 * mapSize;
    view.centre = glm::clamp(view.centre, glm::min(reach, middle), glm::max(mapSize - reach, middle));
    return view;
}

Flight::Flight(const MapView& from, const MapView& to) noexcept
    : from_(from), to_(to), distance_(glm::distance(from.centre, to.centre)) {
    const double w0 = from.width, w1 = to.width;
    if (distance_ > 1e-3 * std::min(w0, w1)) {
        const double square = kRho * kRho * kRho * kRho * distance_ * distance_;
        const double b0 = (w1 * w1 - w0 * w0 + square) / (2.0 * w0 * kRho * kRho * distance_);
        const double b1 = (w1 * w1 - w0 * w0 - square) / (2.0 * w1 * kRho * kRho * distance_);
        r0_ = -std::asinh(b0);
        length_ = (-std::asinh(b1) - r0_) / kRho;
    } else {
        distance_ = 0.0;
        length_ = std::abs(std::log(w1 / w0)) / kRho;
    }
    const double turning = std::abs(shorterTurn(from.turn, to.turn));
    seconds_ = std::clamp(std::max(length_ / kFlightSpeed, turning / 0.6), kShortest, kLongest);
}

MapView Flight::at(double seconds) const noexcept {
    const double share = smoothStep(0.0, seconds_, seconds);
    if (share >= 1.0) return to_;
    MapView view = from_;
    view.turn += share * shorterTurn(from_.turn, to_.turn);
    const double s = share * length_;
    if (distance_ == 0.0) {
        view.width = from_.width * std::pow(to_.width / from_.width, share);
        view.centre = glm::mix(from_.centre, to_.centre, share);
        return view;
    }
    const double w0 = from_.width;
    const double gone = w0 / (kRho * kRho) * (std::cosh(r0_) * std::tanh(kRho * s + r0_) - std::sinh(r0_));
    view.centre = from_.centre + gone / distance_ * (to_.centre - from_.centre);
    view.width = w0 * std::cosh(r0_) / std::cosh(kRho * s + r0_);
    return view;
}

} // namespace lumorph::navigation

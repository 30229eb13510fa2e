#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lumorph {

/// How far a servo has turned, as a share of its way from rest to full stroke, at equal steps of stroke: ascending
/// from 0 to 1, so that half of a pulse need not be half of an angle. Empty: servo and stroke go evenly.
using PulseCurve = std::vector<double>;

inline constexpr std::size_t kMostCurvePoints = 65;

/// Whether it is empty, or 2 to kMostCurvePoints numbers, each greater than the one before, the first 0, the last 1.
[[nodiscard]] bool isPulseCurve(std::span<const double> curve) noexcept;
/// The share of the servo's way at a stroke; straight on beyond [0, 1]. Straight between the points.
[[nodiscard]] double turnedAt(std::span<const double> curve, double stroke) noexcept;
/// The stroke at a share of the servo's way: the inverse of `turnedAt`.
[[nodiscard]] double strokeWhereTurned(std::span<const double> curve, double share) noexcept;
/// The most that it turns for a stroke, by what it turns on average: 1 of an empty one.
[[nodiscard]] double steepest(std::span<const double> curve) noexcept;
/// What is left of it when full stroke becomes what was this stroke (> 0), again from 0 to 1.
[[nodiscard]] PulseCurve upTo(std::span<const double> curve, double stroke);

} // namespace lumorph

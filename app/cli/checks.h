#pragma once

#include <string>

#include <CLI/App.hpp>

namespace lumorph::cli {

/// Checks of arguments where CLI11's own let something through: its range accepts NaN, and a number
/// without sign takes "-1" as a very large one.

/// A number from `min` to `max`.
[[nodiscard]] CLI::Validator numberBetween(double min, double max);
/// A whole number from 0 that fits 64 bits, in decimal digits.
[[nodiscard]] CLI::Validator seedNumber();

} // namespace lumorph::cli

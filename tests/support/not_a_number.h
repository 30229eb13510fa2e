#pragma once

#include <limits>

namespace lumorph {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

} // namespace lumorph

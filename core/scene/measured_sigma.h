#pragma once

#include <string>

#include "core/scene/installation.h"

namespace lumorph {

/// How sure a measured figure is, as standard deviations over all axes together; 0: not told.
struct MeasuredSigma {
    double metres = 0.0;  ///< of a place
    double radians = 0.0; ///< of a direction, or of where a servo stands
    double seconds = 0.0; ///< of a delay
    /// What of `metres` comes from the tip of the pointer by which it was measured: others that were touched with the
    /// same tip share it.
    double tipMetres = 0.0;
    bool operator==(const MeasuredSigma&) const = default;
};

/// The method of an origin with them: "touched dots, 12" becomes "touched dots, 12, ±0.21 mm, ±0.053°, ±0.1 mm of the
/// tip". So a room keeps them wherever it goes (file, project, version), and who reads the origin reads them too. What
/// is zero or infinite is left out.
[[nodiscard]] std::string withSigma(std::string method, const MeasuredSigma& sigma);

/// Those that `withSigma` wrote; zeros for a text without.
[[nodiscard]] MeasuredSigma sigmaOf(const Origin& origin);

} // namespace lumorph

#pragma once

#include <vector>

#include "core/mdf/field.h"

namespace lumorph::test {

struct LiteralVote {
    int level = 0;
    bool reached = false;
    double least = 0.0; ///< of V~ . V_T, for a level to count
    std::vector<double> errors;
    std::vector<double> intersections;
};

/// Eq. 1 word for word: every voxel of the domain, for every level of one actuator.
[[nodiscard]] LiteralVote literalVote(const Field& field, std::size_t actuator, const BitColumns& target);

/// The stroke of its optimum between the levels, where all three around it count: the lowest point of the parabola
/// through the ratios there.
[[nodiscard]] double literalStroke(const LiteralVote& vote);

} // namespace lumorph::test

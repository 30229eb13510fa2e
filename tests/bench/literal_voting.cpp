#include "tests/bench/literal_voting.h"

#include <cmath>

namespace lumorph::bench {

void literalSums(const DenseField& field, std::span<const float> target, EquationSums& sums) {
    sums.differences.resize(field.actuators * field.levels);
    sums.intersections.resize(field.actuators * field.levels);
    for (std::size_t i = 0; i < field.actuators; ++i)
        for (std::size_t j = 0; j < field.levels; ++j) {
            const std::span<const float> expected = field.grid(i, j);
            double difference = 0.0;
            double intersection = 0.0;
            for (std::size_t v = 0; v < field.voxels; ++v) {
                difference += std::fabs(expected[v] - target[v]);
                intersection += expected[v] * target[v];
            }
            sums.differences[i * field.levels + j] = difference;
            sums.intersections[i * field.levels + j] = intersection;
        }
}

} // namespace lumorph::bench

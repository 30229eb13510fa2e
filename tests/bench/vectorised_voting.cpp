// Compiled with reassociation allowed (see CMakeLists.txt), so that the sums become vector sums.
#include <algorithm>
#include <cmath>

#include "tests/bench/literal_voting.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define LUMORPH_VECTORISED __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define LUMORPH_VECTORISED
#endif

namespace lumorph::bench {

namespace {

struct BlockSums {
    float difference;
    float intersection;
};

LUMORPH_VECTORISED BlockSums blockSums(const float* expected, const float* target, std::size_t count) {
    BlockSums sums{0.0F, 0.0F};
    for (std::size_t v = 0; v < count; ++v) {
        sums.difference += std::fabs(expected[v] - target[v]);
        sums.intersection += expected[v] * target[v];
    }
    return sums;
}

} // namespace

void vectorisedSums(const DenseField& field, std::span<const float> target, EquationSums& sums) {
    // Float sums stay exact enough over a block; the blocks add up in double.
    constexpr std::size_t kBlock = 2048;
    sums.differences.assign(field.actuators * field.levels, 0.0);
    sums.intersections.assign(field.actuators * field.levels, 0.0);
    for (std::size_t i = 0; i < field.actuators; ++i)
        for (std::size_t j = 0; j < field.levels; ++j) {
            const std::size_t at = i * field.levels + j;
            const std::span<const float> expected = field.grid(i, j);
            for (std::size_t v = 0; v < field.voxels; v += kBlock) {
                const BlockSums of = blockSums(&expected[v], &target[v], std::min(kBlock, field.voxels - v));
                sums.differences[at] += static_cast<double>(of.difference);
                sums.intersections[at] += static_cast<double>(of.intersection);
            }
        }
}

} // namespace lumorph::bench

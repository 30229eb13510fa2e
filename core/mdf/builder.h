#pragma once

#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/mdf/coverage.h"
#include "core/mdf/field.h"
#include "core/rig/rig.h"

namespace lumorph {

struct BuildOptions {
    int resolution = 33; ///< voxels along the shortest side of the frame (r)
    int levels = 33;     ///< levels an actuator (m)
    int samples = 64;    ///< joint states of the others that the expectation is taken over (K)
    std::uint64_t seed = 1;
    int threads = 0; ///< 0: one a core
};

/// Builds the field of a rig (R5-R11). With at least as many samples as the rig has joint states, all
/// of them are used and the expectation is exact. The same options give the same field, bit for bit,
/// whatever the number of threads. Memory stays near the size of the result plus the kept pieces of
/// Coverage: the columns of an actuator are worked on in slabs.
/// Throws InvalidInput for options out of range, Cancelled when asked to stop.
[[nodiscard]] Field buildField(const Rig& rig, const BuildOptions& options, const Progress& progress = {});

/// The expectation V~(i,j) of every voxel that actuator `i` changes, before it is fitted by ramps;
/// what the builder fits, for reports and comparison.
struct SampledField {
    struct Voxel {
        std::uint32_t column = 0;
        int y = 0;
        std::vector<double> expectation; ///< one a level, non-decreasing
    };
    std::vector<std::vector<Voxel>> actuators;
};
[[nodiscard]] SampledField sampleField(const Coverage& coverage, const std::vector<State>& states,
                                       const Progress& progress = {});

/// The joint states that a build with these options takes the expectation over.
[[nodiscard]] std::vector<State> sampledStates(const Rig& rig, const BuildOptions& options);

} // namespace lumorph

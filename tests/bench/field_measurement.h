#pragma once

#include <cstddef>
#include <string>

#include "core/rig/rig.h"

namespace lumorph::bench {

/// What to build and match.
struct FieldJob {
    std::string model; ///< a file of resources/models
    int resolution = 33;
    int levels = 33;
    int samples = 64;
    std::size_t driven = 0; ///< only so many of the actuators, evenly chosen; 0: all
};

/// What it cost.
struct FieldMeasurement {
    std::size_t voxels = 0;
    std::size_t actuators = 0;
    std::size_t changedVoxels = 0; ///< (actuator, voxel) pairs
    std::size_t fileBytes = 0;
    std::size_t peakBytes = 0;        ///< resident, of building and packing the file
    double buildSeconds = 0.0;        ///< two threads
    double matchSeconds = 0.0;        ///< voting, the slowest of some targets; median
    double changedTargetVoxels = 0.0; ///< (actuator, voxel) pairs within that target
    double rampErrorMean = 0.0;
};

/// Does the job in a process of its own, so that no other row's memory counts. Throws
/// std::runtime_error when that fails.
[[nodiscard]] FieldMeasurement measureField(const FieldJob& job);

/// Lowest resolution at which the model's frame has at least so many voxels.
[[nodiscard]] int resolutionFor(const std::string& model, std::size_t voxels);

inline constexpr const char* kMeasureFlag = "--measure-field";
/// The other side of `measureField`: reads the job from the arguments after the flag, does it and
/// prints the measurement on stdout.
void measureFieldHere(const std::string& job);

} // namespace lumorph::bench

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/mdf/ramp.h"
#include "core/voxels/bit_columns.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// What one actuator changes: for each column it reaches one run of voxels with a ramp each. Voxels
/// inside a run that it does not change have v0 = 255.
struct ActuatorField {
    struct Run {
        std::uint32_t column = 0; ///< BitColumns::columnIndex
        std::uint16_t firstY = 0;
        std::uint16_t count = 0;
        std::uint32_t firstRamp = 0; ///< index into `ramps`
        bool operator==(const Run&) const = default;
    };
    std::string name;
    std::vector<Run> runs; ///< ascending by column
    std::vector<Ramp> ramps;
    bool operator==(const ActuatorField&) const = default;
};

/// How well the stored ramps stand for the sampled expectation.
struct FieldReport {
    double rampErrorMean = 0.0; ///< over changed voxels and levels, in coverage
    double rampErrorMax = 0.0;
    std::uint64_t changedVoxels = 0;          ///< (actuator, voxel) pairs
    std::uint64_t monotonicityViolations = 0; ///< covered at a level, not at a higher one; by sample (R10)
    bool operator==(const FieldReport&) const = default;
};

/// A mechanical distance field: for every voxel and actuator the expected coverage as the actuator
/// goes through its levels while all states of the others are equally likely (R8, R9).
struct Field {
    VoxelFrame frame;
    int levels = 0;
    std::uint64_t seed = 0;
    std::uint32_t samples = 0; ///< joint states that the expectation was taken over
    bool exhaustive = false;   ///< those were all joint states
    std::string rigName;
    std::vector<std::byte> rigGlb; ///< the rig itself, as writeRigGlb gives it
    float restSurface = 0.0F;      ///< highest point of the rig at rest, metres: what targets stand on
    BitColumns body;               ///< the zero-state body; the domain is everything else
    /// P(v) in 1/255: mean coverage over the sampled states; index = column x height + y.
    std::vector<std::uint8_t> background;
    std::vector<ActuatorField> actuators;
    FieldReport report;
    bool operator==(const Field&) const = default;

    [[nodiscard]] std::size_t voxelIndex(int x, int y, int z) const noexcept {
        return body.columnIndex(x, z) * static_cast<std::size_t>(frame.dimensions.y) + static_cast<std::size_t>(y);
    }
};

/// A dense copy of one actuator's ramps, one a voxel in Field::voxelIndex order; for export and display.
[[nodiscard]] std::vector<Ramp> denseRamps(const Field& field, std::size_t actuator);

/// The voxels that at least one actuator changes.
[[nodiscard]] BitColumns reachableVoxels(const Field& field);

} // namespace lumorph

#pragma once

#include <cstddef>
#include <memory>

#include "core/loop/match_field.h"
#include "core/voxels/bit_columns.h"

namespace lumorph {

/// Voxels of a target in the domain of a field, and how many of them an actuator can change at all.
class TargetVoxels {
public:
    /// To be written by a voxeliser, in the field's frame; then `keepDomain` must be called.
    [[nodiscard]] BitColumns& written() noexcept { return bits_; }
    /// Leaves out what lies inside the body at rest, and counts.
    void keepDomain(const std::shared_ptr<const MatchField>& field);

    [[nodiscard]] const BitColumns& bits() const noexcept { return bits_; }
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] double shareUnreachable() const noexcept { return shareUnreachable_; }

private:
    BitColumns bits_;
    BitColumns reachable_;
    std::shared_ptr<const MatchField> reachableOf_;
    std::size_t count_ = 0;
    double shareUnreachable_ = 0.0;
};

} // namespace lumorph

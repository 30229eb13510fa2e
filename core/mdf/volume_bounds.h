#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/mdf/coverage.h"

namespace lumorph {

/// One column of a box of states in which the solid has a single top, so that of its voxels first <= y < last those
/// below that height are covered: height = slopes . x + r voxels (centres at whole numbers) with x in [-1, 1] the
/// place in the box on each axis and from <= r <= to.
struct ColumnHeight {
    std::uint32_t column = 0;
    int first = 0, last = 0;
    float from = 0.0F, to = 0.0F;
};

/// What is known of V(s) for all states of a box.
struct VolumeEnclosure {
    BitColumns always;                 ///< in V of every state
    BitColumns possible;               ///< holds V of every state
    std::vector<ColumnHeight> heights; ///< columns with at most one entry; their open voxels are not in `always`
    std::vector<float> slopes;         ///< [height * axes + axis], voxels
    std::vector<double> spread; ///< of each axis how far it moves the surface within the box, all vertices summed
};

/// Encloses the covered volume V(s) over boxes of states of some actuators, the others at rest. A voxel that no surface
/// of the box passes has in every state what it has in one (its winding number does not change on the way), and the
/// surfaces lie where `MotionBounds` says. A body that does not hold its path is enclosed over intervals of t, at equal
/// t, of which each state has a sample in each: `possible` is their union, `always` the union of what each always
/// holds; the body at rest is taken away last. Immutable; safe to share between threads.
class VolumeBounds {
public:
    static constexpr std::size_t kMostAxes = 16;

    /// `columns` has a byte a column, which is 0 where no enclosure is needed: there nothing is covered. No other
    /// actuator may change the rest. Throws InvalidInput for more than kMostAxes actuators.
    VolumeBounds(const Coverage& coverage, std::vector<std::uint16_t> actuators, std::vector<std::uint8_t> columns);
    ~VolumeBounds();
    VolumeBounds(VolumeBounds&&) noexcept;
    VolumeBounds& operator=(VolumeBounds&&) noexcept;

    [[nodiscard]] std::span<const std::uint16_t> actuators() const noexcept;

    /// Buffers of one thread.
    struct Workspace;
    struct DeleteWorkspace {
        void operator()(Workspace* workspace) const noexcept;
    };
    using WorkspacePointer = std::unique_ptr<Workspace, DeleteWorkspace>;
    [[nodiscard]] static WorkspacePointer makeWorkspace();

    /// `low` and `high` have a level for each of the actuators.
    void over(std::span<const Level> low, std::span<const Level> high, VolumeEnclosure& out,
              Workspace& workspace) const;

private:
    struct Data;
    std::unique_ptr<const Data> data_;
};

} // namespace lumorph

#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/mdf/level_gains.h"
#include "core/mdf/placement.h"

namespace lumorph {

/// The inside of a target in a grid of its own, to be looked up wherever the target is put: what that costs does not
/// depend on its triangles, nor on whether it is closed. Immutable; safe to share between threads.
class TargetGrid {
public:
    /// Throws InvalidInput for a target that holds no cell of the grid, Cancelled.
    explicit TargetGrid(const Target& target, const Progress& progress = {});

    /// Voxels of the frame whose centre lies in a cell that is inside; the body is not taken out.
    /// `out` gets the frame's shape.
    void lookUp(const VoxelFrame& frame, const glm::mat4& deviceFromTarget, BitColumns& out) const;

    /// Of the cells inside, at scale 1, cubic metres.
    [[nodiscard]] double volume() const noexcept { return volume_; }
    [[nodiscard]] const Box& box() const noexcept { return box_; }
    /// Points inside, spread evenly, about a thousand.
    [[nodiscard]] std::span<const glm::vec3> samples() const noexcept { return samples_; }
    /// Corners of the hull, enough of them to tell how far the target reaches when it is turned.
    [[nodiscard]] std::span<const glm::vec3> hull() const noexcept { return hull_; }

private:
    static constexpr int kPadding = 1; ///< empty cells around
    void findHull(std::span<const glm::vec3> positions);

    Box box_;
    glm::ivec3 cells_{0}; ///< with the padding
    glm::vec3 cellsPerMetre_{0.0F};
    std::vector<std::uint8_t> inside_; ///< x first, then z, then y
    std::vector<glm::vec3> samples_;
    std::vector<glm::vec3> hull_;
    double volume_ = 0.0;
};

/// Estimates the IoU of a target's best match fast: a coarse frame, few levels, and each actuator's volume taken for
/// its own. Immutable after construction; a Workspace for each thread.
class PlacementScorer {
public:
    /// `coverage` is the device as it is matched; it is built anew, coarsely. Throws Cancelled.
    explicit PlacementScorer(const Coverage& coverage, const Progress& progress = {});

    struct Workspace {
        BitColumns wanted;
        LevelGains gains;
    };
    /// IoU of the match of what lies in the frame, in [0, 1].
    [[nodiscard]] double score(const TargetGrid& target, const glm::mat4& deviceFromTarget, Workspace& workspace) const;

    /// Where the device changes anything, all of it first, then each actuator's part, the largest first; such as are
    /// nearly equal are named once.
    [[nodiscard]] std::span<const Box> reaches() const noexcept { return reaches_; }
    [[nodiscard]] double voxelSize() const noexcept { return coverage_.frame().voxelSize; }

private:
    void findReaches();

    Coverage coverage_;
    std::vector<ActuatorLevels> actuators_;
    std::vector<Box> reaches_;
};

} // namespace lumorph

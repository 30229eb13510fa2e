#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/units.h"
#include "core/mdf/field.h"

namespace lumorph {

/// What Eq. 1 says for one actuator.
struct ActuatorVote {
    Level level;
    bool reached = false; ///< false: no level counts, so the actuator rests (R17)
    /// The same optimum between the levels, in strokes: the lowest point of the parabola through the
    /// error ratios around it, for smooth motion.
    double stroke = 0.0;
    std::vector<double> errors;        ///< |V~(i,j) - V_T| for each level, voxels
    std::vector<double> intersections; ///< V~(i,j) . V_T for each level, voxels
};

struct Votes {
    std::vector<ActuatorVote> actuators;
    std::size_t targetVoxels = 0; ///< |V_T| over the domain

    [[nodiscard]] State state() const;
};

/// Matching by voting (paper, Eq. 1; R16-R18): s_i = argmin_j |V~(i,j) - V_T| / (V~(i,j) . V_T).
///
/// All sums run over the domain (frame without the zero-state body). For a binary target
/// sum |V~ - V_T| = sum V~ + |V_T| - 2 V~.V_T, so a match only needs V~.V_T: one pass over the voxels that an
/// actuator can change, in the order of the two levels between which they rise.
/// A level counts only where V~.V_T >= max(1 voxel, 1 % of the target voxels the actuator can change).
/// Ties within 1e-9 relative go to the lower level.
/// Immutable after construction; a Workspace for each thread.
class Voting {
public:
    explicit Voting(const Field& field);

    ~Voting();
    Voting(Voting&&) noexcept;
    Voting& operator=(Voting&&) noexcept;

    /// Buffers for one thread's matches.
    struct Workspace {
        /// What the target voxels of one actuator add up to, in 1/255.
        struct Sums {
            std::vector<double> values; ///< of V~(i,j) - P, one a level
            std::uint64_t voxels = 0;
        } sums;
        std::vector<std::int8_t> bytes; ///< of the target's voxels, -1 where it has one
    };

    /// `target` has the frame's shape; voxels inside the body are ignored. Reuses the memory of `votes`.
    /// With `last`, an actuator keeps its last level unless another is better by more than `hysteresis`
    /// relative, so that a level does not flicker between two fits that are as good.
    /// Throws InvalidInput when the shapes differ.
    void match(const BitColumns& target, Votes& votes, Workspace& workspace, const State* last = nullptr,
               double hysteresis = 0.02) const;
    [[nodiscard]] Votes match(const BitColumns& target) const;

    [[nodiscard]] int levels() const noexcept;
    [[nodiscard]] std::size_t bytes() const noexcept;

private:
    struct Compiled;
    std::unique_ptr<const Compiled> compiled_;
};

} // namespace lumorph

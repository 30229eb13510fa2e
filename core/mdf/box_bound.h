#pragma once

#include <cstdint>
#include <vector>

#include "core/mdf/volume_bounds.h"

namespace lumorph {

/// An upper bound, over a box of states, of both - lambda x overfill: wanted voxels that are covered, less others that
/// are. Each open voxel counts for itself, but columns with one top are coupled: blocks of them follow a common height
/// linearly in the place in the box, what a block gains at a height is replaced by its concave hull, and the sum of the
/// hulls is maximised over the box by cutting planes (Dantzig-Wolfe decomposition; the bound is the Lagrangian dual of
/// the copies of the place that the blocks have). Keeps its buffers; one object for each thread.
class BoxBound {
public:
    /// `target` lies in the domain. Both must stay until the last `at`.
    void set(const VolumeEnclosure& enclosure, const BitColumns& target, const BitColumns& domain);

    /// The bound for lambda in [0, 1]. Stops early at one that is at most `enough`.
    [[nodiscard]] double at(double lambda, double enough);
    /// Voxels covered in every state and not wanted.
    [[nodiscard]] std::size_t overfill() const noexcept { return overfill_; }

private:
    /// Columns side by side.
    struct Block {
        std::size_t first = 0, count = 0; ///< of ordered_
        double reach = 0.0;               ///< |slopes|, summed
        std::size_t hullFirst = 0, hullCount = 0;
    };
    struct HullPoint {
        double u = 0.0, value = 0.0;
    };
    struct Cut {
        double constant = 0.0;
        std::vector<double> slopes;
    };

    void makeBlocks(int side);
    void hullOf(Block& block, double lambda);
    [[nodiscard]] Cut cutAt(const std::vector<double>& place, double& value) const;
    [[nodiscard]] double maximum(double enough);

    const VolumeEnclosure* enclosure_ = nullptr;
    const BitColumns* target_ = nullptr;
    const BitColumns* domain_ = nullptr;
    std::size_t axes_ = 0;
    std::size_t both_ = 0, overfill_ = 0, openWanted_ = 0;
    std::vector<std::size_t> ordered_; ///< heights, block after block
    std::vector<float> slack_;         ///< beside ordered_: how far a column leaves its block's height
    std::vector<Block> blocks_;
    std::vector<double> blockSlopes_; ///< [block * axes + axis]
    std::vector<HullPoint> hulls_;
    std::vector<double> gains_, sums_;
};

} // namespace lumorph

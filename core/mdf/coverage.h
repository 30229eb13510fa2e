#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/rig/rig.h"
#include "core/voxels/bit_columns.h"
#include "core/voxels/column_raster.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {

/// Buffers for evaluating coverage; one object for each thread.
struct CoverageScratch {
    std::vector<double> strokes;
    std::vector<glm::vec3> positions;
    std::vector<GridVertex> vertices;
    std::vector<std::uint64_t> parity;
    std::vector<std::uint64_t> swept;
};

/// The covered volume V(s) of a rig (R6): the voxels inside its solid at t*s for any t in [0, 1],
/// without the zero-state body. The builder, the refinement and every IoU use this one V.
///
/// The solid is the parity of crossings along each column, and parity adds up: the triangles are
/// grouped by the actuators that move them, and what a single actuator's triangles contribute at a
/// level is rasterised once and kept. A joint state is then the XOR of kept pieces.
/// Needs a rig whose pieces are closed and do not cross themselves; pieces may overlap one another.
/// Immutable to its users (the kept pieces are filled on first use); safe to share between threads.
class Coverage {
public:
    /// Throws InvalidInput for a level count outside 2..kMaxLevels.
    Coverage(Rig rig, const VoxelFrame& frame, int levels);
    ~Coverage();
    Coverage(Coverage&&) noexcept;
    Coverage& operator=(Coverage&&) noexcept;

    [[nodiscard]] const Rig& rig() const noexcept;
    [[nodiscard]] const VoxelFrame& frame() const noexcept;
    [[nodiscard]] int levels() const noexcept;
    /// The solid at rest.
    [[nodiscard]] const BitColumns& body() const noexcept;
    /// All voxels outside the body: the domain of every sum, of |V_T| and of IoU.
    [[nodiscard]] const BitColumns& domain() const noexcept;

    /// V(s). `state` has one level an actuator, each below `levels()`.
    void covered(std::span<const Level> state, BitColumns& out, CoverageScratch& scratch) const;

    /// Some columns, and the pieces of the rig that can reach them.
    struct Window {
        struct Part {
            std::size_t body;
            ColumnRange range;
            std::vector<std::size_t> groups;
        };
        ColumnRange range;
        std::vector<Part> parts;
    };
    [[nodiscard]] Window window(const ColumnRange& range) const;
    /// V(s) of a window's columns only: `out` gets `window.range.size()` x words per column, rows along x.
    void covered(std::span<const Level> state, const Window& window, std::span<std::uint64_t> out,
                 CoverageScratch& scratch) const;
    /// V at any strokes (each in [0, 1]), between the levels too; everything is deformed and rasterised
    /// anew without any kept piece.
    void coveredAt(std::span<const double> strokes, BitColumns& out, CoverageScratch& scratch) const;

    /// The columns whose coverage this actuator can change, at least.
    [[nodiscard]] const ColumnRange& columnsMovedBy(std::size_t actuator) const noexcept;
    /// The columns, one byte each, whose coverage this actuator can change: exactly where it moves its triangles alone,
    /// else at least. Rasterises its pieces at every level.
    [[nodiscard]] std::vector<std::uint8_t> columnsChangedBy(std::size_t actuator) const;
    /// Pairs of actuators that move the same triangles or sweep the same body, the lower index first.
    [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> coupledPairs() const;
    /// In how many equal steps the path from rest to `strokes` is sampled; 1 when the solid holds its path.
    [[nodiscard]] int pathSteps(std::span<const double> strokes) const noexcept;
    /// Memory held in kept pieces so far, bytes. Not while another thread evaluates.
    [[nodiscard]] std::size_t bytes() const noexcept;

private:
    struct Pieces;
    std::unique_ptr<Pieces> pieces_;
};

/// How well a covered volume meets a target, over the domain; the target must lie in the domain.
struct FitQuality {
    std::size_t both = 0;       ///< voxels covered and wanted
    std::size_t unmatched = 0;  ///< wanted, not covered
    std::size_t overfilled = 0; ///< covered, not wanted

    /// In [0, 1]; 0 where neither has a voxel, so that nothing fits better by leaving the device.
    [[nodiscard]] double iou() const noexcept {
        const std::size_t either = both + unmatched + overfilled;
        return either == 0 ? 0.0 : static_cast<double>(both) / static_cast<double>(either);
    }
};

[[nodiscard]] FitQuality compareVolumes(const BitColumns& covered, const BitColumns& target) noexcept;

} // namespace lumorph

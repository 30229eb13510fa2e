#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/mdf/coverage.h"
#include "core/mdf/target_library.h"

namespace lumorph {

/// How finely a library is matched.
struct LibraryFitOptions {
    int resolution = 33;          ///< voxels along the frame's shortest side, fewer where that is more than `voxels`
    std::size_t voxels = 400'000; ///< at most
    int levels = 33;
    TargetPlacing placing = TargetPlacing::automatic;
    Box space; ///< what the frame holds; empty: what the rig reaches

    /// For an answer while somebody drags: voxels and levels so coarse that twelve targets take a part of a second.
    [[nodiscard]] static LibraryFitOptions coarse() { return {12, 12'000, 17, TargetPlacing::automatic, {}}; }
};

/// How well a rig takes the shape of one target.
struct TargetFit {
    std::string name;
    Placement placement;
    State state;
    FitQuality quality;
    double iou = 0.0;
    double unreachable = 0.0; ///< share of the target that lies where no actuator gets alone, or beyond the frame
};

struct LibraryFit {
    VoxelFrame frame;
    int levels = 0;
    std::vector<TargetFit> targets; ///< in the library's order
    double mean = 0.0;              ///< of all IoU
    std::size_t best = 0;           ///< index of the largest IoU
    std::size_t worst = 0;
};

/// The fit that is left when some actuators stay at rest.
struct FitWithout {
    std::size_t actuators = 0;        ///< that still move
    double fit = 0.0;                 ///< mean IoU
    std::vector<std::string> leftOut; ///< names of those that went in this step
};

/// Matches a rig to a library without a mechanical distance field. Each actuator's levels are looked at with the others
/// at rest; where actuators share no voxel the best joint state follows from that exactly (`bestBySums`),
/// and `Refiner` goes on from there with the true volume of the whole device. The same on any number of threads.
/// Holds the rig and the targets' voxels; the library may go.
class LibraryMatcher {
public:
    /// Throws InvalidInput for an empty library, a rig that moves nothing upwards or options out of range; Cancelled.
    LibraryMatcher(const Rig& rig, std::span<const LibraryTarget> library, const LibraryFitOptions& options,
                   const Progress& progress = {});
    ~LibraryMatcher();
    LibraryMatcher(LibraryMatcher&&) noexcept;
    LibraryMatcher& operator=(LibraryMatcher&&) noexcept;

    /// The best joint state for each target. Throws Cancelled, within a twentieth of a second.
    [[nodiscard]] const LibraryFit& fit(const Progress& progress = {});
    /// Fit against the number of actuators: of those that still move, the one goes that is missed least where the best
    /// states leave it at rest, and the others are matched anew; down to one. At most 32 steps, so that of many
    /// actuators several go at a time. Begins with all of them; throws Cancelled.
    [[nodiscard]] std::vector<FitWithout> fitByActuators(const Progress& progress = {});

    [[nodiscard]] const Coverage& coverage() const noexcept;
    /// Voxels of a target, in the domain.
    [[nodiscard]] const BitColumns& voxelsOf(std::size_t target) const;

private:
    class Work;
    std::unique_ptr<Work> work_;
};

} // namespace lumorph

#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/mdf/coverage.h"
#include "core/mdf/placement.h"
#include "core/mdf/voting.h"

namespace lumorph {

/// Whether a target may be shown as a relief (`voxelizeRelief`).
enum class ReliefChoice {
    never,
    automatic, ///< where the best plain fit stays below 0.3 IoU and the relief gains 0.1
    always
};

/// Best IoU below which the target is hardly recognisable on the device.
inline constexpr double kFitsNowhere = 0.15;

struct AutoPlaceOptions {
    int orientations = 72; ///< spread evenly over all, beside those along the axes
    /// Relative to the scale at which the target, turned as it is, just fits the frame above the rest surface.
    double minScale = 0.15;  ///< one flap may be all that moves
    double maxScale = 4.0;   ///< what is sunk into the device may be larger
    double minInside = 0.7;  ///< share of the target's volume that must stay where the device could show it
    double minInFrame = 0.9; ///< share that must not be cut off by the frame: what is sunk into the device is not
    ReliefChoice relief = ReliefChoice::never;
};

/// A place that a climb of the search ended at.
struct PlacementCandidate {
    Placement placement;
    State state;
    double iou = 0.0;      ///< of the refined match there; with a relief, against the relief
    double iouModel = 0.0; ///< of the same state against the model as it stands there
    BitColumns wanted;     ///< what was matched, in the domain
    BitColumns covered;    ///< V(state)
};

struct AutoPlacement {
    Placement placement;
    State state;
    double iou = 0.0;      ///< of the refined match there
    double iouAtFit = 0.0; ///< of the refined match where `fitPlacement` puts it
    double iouPlain = 0.0; ///< of the best placement without a relief; 0 where none was looked for
    int placementsSeen = 0;
    std::vector<PlacementCandidate> alternatives; ///< that look different, at most three, the best (`placement`) first
};

/// Searches orientation, scale and position of a target for the best IoU of its refined match. All orientations are
/// tried over what the device reaches and over the reach of each actuator, by `PlacementScorer`; the best different
/// ones are improved by a pattern search, coarsely, then with the field itself down to a quarter of a voxel. The time
/// hardly depends on the target's triangles. Placements that leave less than `minInside` of the volume where the device
/// could show it do not count. A relief is tried in the orientations along the axes. Reports progress, from several
/// threads. Throws InvalidInput when none counts (a target thinner than a voxel), Cancelled.
[[nodiscard]] AutoPlacement autoPlace(const Field& field, const Coverage& coverage, const Voting& voting,
                                      const Target& target, const AutoPlaceOptions& options = {},
                                      const Progress& progress = {});

} // namespace lumorph

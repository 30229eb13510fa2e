#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/mdf/coverage.h"
#include "core/mdf/placement.h"
#include "core/mdf/voting.h"

namespace lumorph {

struct AutoPlaceOptions {
    int yaws = 12;          ///< headings that the search starts from
    double minScale = 0.15; ///< relative to the largest scale that fits; one flap may be all that moves
    double maxScale = 1.5;
    double minInside = 0.9; ///< share of the target's volume that must stay in the frame, outside the body; of an open
                            ///< target of what is there where `fitPlacement` puts it
};

/// A place that a climb of the search ended at.
struct PlacementCandidate {
    Placement placement;
    double iou = 0.0; ///< of the refined match there
};

struct AutoPlacement {
    Placement placement;
    State state;
    double iou = 0.0;      ///< of the refined match there
    double iouAtFit = 0.0; ///< of the refined match where `fitPlacement` puts it
    int placementsSeen = 0;
    std::vector<PlacementCandidate> alternatives; ///< different ones, at most three, the best (`placement`) first
};

/// Searches heading, scale and position of a target for the best IoU of its refined match: coarse
/// starts in the middle and over the reach of each actuator, over all headings and some scales, then a pattern search
/// of the best different ones down to a quarter of a voxel. Placements that leave less than `minInside` of the target's
/// volume where the device could show it do not count. Reports progress. Throws InvalidInput when none counts (a target
/// thinner than a voxel), Cancelled.
[[nodiscard]] AutoPlacement autoPlace(const Field& field, const Coverage& coverage, const Voting& voting,
                                      const Target& target, const AutoPlaceOptions& options = {},
                                      const Progress& progress = {});

} // namespace lumorph

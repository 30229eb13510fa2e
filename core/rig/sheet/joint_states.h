#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/rig/sheet/levered_sheet.h"
#include "core/rig/sheet_modes.h"

namespace lumorph {

struct BakeSettings {
    double edgeLength = 0.006; ///< of the mesh, metres
    int levels = 3;            ///< strokes of each lever: 3 for 0, 1/2, 1
    double truncation = 2e-4;  ///< modes are kept until no node of a grid state is farther off than this, metres
};

/// A joint state with an equilibrium besides the one that is followed from rest.
struct SecondEquilibrium {
    std::vector<double> strokes;
    double distance = 0.0;         ///< the farthest that a node is from its place in the first, metres
    double energyDifference = 0.0; ///< of the second less the first, joules
};

struct JointStates {
    SheetMesh mesh;
    SheetModes modes;                       ///< of the mesh's nodes
    std::vector<SecondEquilibrium> seconds; ///< mirror images left out
    std::vector<LeverLoad> largestLoads;    ///< of each lever over the grid, without sign
    double largestStretch = 0.0;            ///< of the middle surface over the grid, share
    double largestFaceStrain = 0.0;
    int solved = 0;     ///< states of the grid that were solved; the others are their mirror images
    int iterations = 0; ///< of Newton's method
};

/// Solves the sheet on a grid of joint states, each followed from rest along t x strokes, and reduces them to modes by
/// their singular value decomposition. Each state is also reached from a neighbour of the grid; where that ends in
/// another equilibrium, it is reported as the second. Runs on all cores. Throws InvalidInput when the sheet has no
/// lever or more than SheetModes::kMostActuators, or `LeveredSheet::moved` finds no equilibrium; Cancelled.
[[nodiscard]] JointStates bakeJointStates(const ElasticSheet& sheet, const BakeSettings& settings = {},
                                          const Progress& progress = {});

} // namespace lumorph

#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/mdf/library_fit.h"
#include "core/rig/rig.h"
#include "core/search/rig_search.h"

namespace lumorph {

/// Targets as they stand for every design of a search.
struct SearchTargets {
    std::vector<LibraryTarget> library; ///< moved to where they stand, device coordinates
    std::vector<Target> targets;        ///< the same without names
    Box box;                            ///< holds them all
};

/// Places a library where a rig's designs are judged by it: over its sheet, up to what it reaches, or half the sheet's
/// shorter side where that is more. Throws InvalidInput, Cancelled.
[[nodiscard]] SearchTargets placeForSearch(const Rig& rig, const SheetDevice& sheet, std::vector<LibraryTarget> library,
                                           TargetPlacing placing, const Progress& progress = {});

/// A design of the front, built.
struct FrontDesign {
    Rig rig;
    double price = 0.0; ///< of its servos, euros
    LibraryFit fit;     ///< by the true volume of its solid
};

/// Builds the best designs of a search as rigs, judges them by their true volume, and gives those that none beats in
/// cost and fit, the cheapest first. Of a cost the best one whose solid is sound; designs without servos are left out.
/// Throws Cancelled.
[[nodiscard]] std::vector<FrontDesign> buildFront(const SheetDesigns& designs, const DesignScorer& scorer,
                                                  SearchCost cost, const SearchState& state,
                                                  const SearchTargets& targets, const Progress& progress = {});

} // namespace lumorph

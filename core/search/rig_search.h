#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "core/base/progress.h"
#include "core/rig/servo_types.h"
#include "core/rig/shape_resolution.h"
#include "core/search/sheet_design.h"
#include "core/search/sheet_fit.h"

namespace lumorph {

/// A design as a point of `SheetDesigns`.
using DesignPoint = std::vector<double>;

/// What a design costs and what it is good for.
struct DesignScore {
    double cost = 0.0; ///< servos, or euros
    double fit = 0.0;  ///< mean IoU
    double gain = 0.0; ///< see SheetFit::Worth
    bool operator==(const DesignScore&) const = default;
};

struct ScoredDesign {
    DesignPoint point;
    DesignScore score;
    bool operator==(const ScoredDesign&) const = default;
};

/// Scores some designs at once, in their order; the same whoever works on them and in how many pieces, so that a batch
/// can be shared out among threads or machines. May throw Cancelled.
using ScoreBatch = std::function<std::vector<DesignScore>(const std::vector<DesignPoint>&)>;

/// What counts beside the fit.
enum class SearchCost {
    servos, ///< how many
    price,  ///< euros: for each flap the cheapest servo of the table that carries it
};

/// Scores one design after another. Refers to both.
class DesignScorer {
public:
    DesignScorer(const SheetDesigns& designs, const SheetFit& fit, SearchCost cost, const DeviceLoad& load = {})
        : designs_(designs), fit_(fit), cost_(cost), load_(load) {}
    [[nodiscard]] DesignScore of(const DesignPoint& point) const;
    /// Euros for the servos of some flaps; one that is too heavy for all of the table counts as three of the strongest.
    [[nodiscard]] double priceOf(const std::vector<Flap>& flaps) const;
    /// On all cores. Throws Cancelled.
    [[nodiscard]] std::vector<DesignScore> batch(const std::vector<DesignPoint>& points,
                                                 const Progress& progress = {}) const;

private:
    const SheetDesigns& designs_;
    const SheetFit& fit_;
    SearchCost cost_;
    DeviceLoad load_;
};

/// A search between two generations: all that the next ones follow from.
struct SearchState {
    std::uint64_t seed = 1;
    std::size_t dimension = 0;
    int generation = 0;
    std::uint64_t evaluations = 0;
    std::vector<ScoredDesign> population;
    /// Designs of one line each that are good ones by themselves, the best first: what lines are taken from.
    std::vector<ScoredDesign> lines;
    /// The best designs seen for each cost (in cents, or hundredths of servos), a few each, the best first.
    std::map<std::int64_t, std::vector<ScoredDesign>> best;
    bool operator==(const SearchState&) const = default;
};

/// At least 8 and a multiple of 4, as NSGA-II pairs its parents.
[[nodiscard]] int usablePopulation(int wanted) noexcept;

/// First looks for good single lines: flaps of a sheet share no voxel, so that a line which is a good one beside others
/// is one alone too. Then a population: the given designs, lines put together one by one while the fit grows, and
/// random ones. Throws what `score` throws.
[[nodiscard]] SearchState beginSearch(const SheetDesigns& designs, int population, std::uint64_t seed,
                                      const std::vector<DesignPoint>& given, const ScoreBatch& score);

/// One generation: NSGA-II (K. Deb et al., "A fast and elitist multiobjective genetic algorithm: NSGA-II", IEEE Trans.
/// Evol. Comp. 6, 2002; pagmo2's) on cost and fit, then as many moves that know what a bend line is (shift, mirror,
/// add, take away, exchange lines between the best designs), and selection by the same rule among all. Random numbers
/// follow from seed and generation alone. Leaves the state as it was when `score` throws.
void nextGeneration(SearchState& state, const ScoreBatch& score);

/// Those of the best designs that none beats both in cost and in fit, the cheapest first.
[[nodiscard]] std::vector<ScoredDesign> frontOf(const SearchState& state);

} // namespace lumorph

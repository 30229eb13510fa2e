#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/mdf/coverage.h"

namespace lumorph {

/// Columns whose coverage depends on the same actuators, with their counts in every state of those.
struct PieceTable {
    std::vector<std::size_t> actuators; ///< ascending
    std::vector<std::size_t> columns;
    std::vector<std::uint32_t> both;     ///< covered and wanted voxels; one a state, of which the last actuator varies
                                         ///< fastest
    std::vector<std::uint32_t> overfill; ///< covered and not wanted, beside it
};

/// The best state of actuators that can be taken apart column by column: tables of counts over few actuators each,
/// joined by eliminating one actuator after the other (dynamic programming; Dechter, Bucket elimination, 1999).
class PieceTables {
public:
    /// Largest table that elimination makes; beyond it the tables of an actuator are bounded apart.
    static constexpr std::size_t kMostEntries = std::size_t{1} << 22;

    /// `target` lies in the domain; both must outlive it. The tables come with actuators and columns only.
    PieceTables(const Coverage& coverage, const BitColumns& target, std::vector<PieceTable> tables);

    /// Counts until all is counted or `stop` says so; true when all is. Can be called again.
    bool count(const std::function<bool()>& stop);

    struct Best {
        double value = 0.0; ///< of both - lambda x overfill; no state has more
        bool exact = true;  ///< the state has it
    };
    /// After `count`: writes the levels of its actuators into `state`.
    [[nodiscard]] Best best(double lambda, State& state) const;
    /// Wanted voxels in its columns.
    [[nodiscard]] std::size_t wanted() const noexcept { return wanted_; }

private:
    void countState(std::size_t table, std::size_t index);

    const Coverage& coverage_;
    const BitColumns& target_;
    std::vector<PieceTable> tables_;
    std::vector<Coverage::Window> windows_;
    std::size_t wanted_ = 0;
    std::size_t nextTable_ = 0;
    std::size_t nextState_ = 0;
    State state_;
    std::vector<std::uint64_t> words_;
    CoverageScratch scratch_;
};

} // namespace lumorph

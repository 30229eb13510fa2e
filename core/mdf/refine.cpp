#include "core/mdf/refine.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/base/error.h"

namespace lumorph {

namespace {

/// What a run of columns holds: covered voxels, and those of them that are wanted.
struct Counts {
    std::size_t covered = 0;
    std::size_t both = 0;
};

} // namespace

class Refiner::Search {
public:
    explicit Search(const Coverage& coverage) : coverage_(coverage) {
        for (std::size_t i = 0; i < coverage.rig().actuatorCount(); ++i)
            windows_.push_back(coverage.window(coverage.columnsMovedBy(i)));
        for (const auto& [i, j] : coverage.coupledPairs()) {
            ColumnRange range = coverage.columnsMovedBy(i);
            range.include(coverage.columnsMovedBy(j));
            pairs_.push_back({i, j, coverage.window(range)});
        }
    }

    void begin(const BitColumns& target, const State& state) {
        check(target, state);
        target_ = target;
        target_ &= coverage_.domain();
        wanted_ = target_.count();
        state_ = state;
        coverage_.covered(state_, current_, scratch_);
        total_ = {current_.count(), current_.countAnd(target_)};
        statesSeen_ = 1;
    }

    void start(Microseconds budget, const Clock& clock) {
        clock_ = &clock;
        hasDeadline_ = budget > Microseconds{0};
        deadline_ = clock.now() + budget;
    }

    /// Moves every actuator by `step` up or down while that helps; true when anything moved.
    bool moveBy(int step) {
        bool moved = false;
        for (std::size_t i = 0; i < windows_.size() && !outOfTime(); ++i)
            while (!outOfTime() && (tryLevel(i, state_[i].index + step) || tryLevel(i, state_[i].index - step)))
                moved = true;
        return moved;
    }

    /// Tries moving coupled actuators together: where one must give way for the other to gain, no
    /// single move helps. True when anything moved.
    bool moveInPairs() {
        constexpr int kSteps[] = {1, -1, 2, -2, 4, -4};
        for (const Pair& pair : pairs_)
            for (const int a : kSteps)
                for (const int b : kSteps) {
                    if (outOfTime()) return false;
                    State next = state_;
                    next[pair.first].index += a;
                    next[pair.second].index += b;
                    if (inRange(next[pair.first]) && inRange(next[pair.second]) && tryState(next, pair.window))
                        return true;
                }
        return false;
    }

    /// Tries every level of every actuator; true when anything moved.
    bool scanAll() {
        bool moved = false;
        for (std::size_t i = 0; i < windows_.size(); ++i)
            for (int level = 0; level < coverage_.levels() && !outOfTime(); ++level) moved |= tryLevel(i, level);
        return moved;
    }

    [[nodiscard]] bool outOfTime() const { return hasDeadline_ && clock_->now() >= deadline_; }
    [[nodiscard]] FitQuality quality() const {
        return {total_.both, wanted_ - total_.both, total_.covered - total_.both};
    }
    [[nodiscard]] const State& state() const { return state_; }
    [[nodiscard]] int statesSeen() const { return statesSeen_; }

private:
    void check(const BitColumns& target, const State& state) const {
        if (target.dimensions() != coverage_.frame().dimensions)
            throw InvalidInput("target", "its voxel grid has another shape than the field's",
                               "voxelise it into the field's own frame");
        if (state.size() != windows_.size())
            throw InvalidInput("state",
                               "it has " + std::to_string(state.size()) + " levels for " +
                                   std::to_string(windows_.size()) + " actuators",
                               "give one level for each actuator");
        for (const Level level : state)
            if (level.index < 0 || level.index >= coverage_.levels())
                throw InvalidInput("level " + std::to_string(level.index),
                                   "levels run from 0 to " + std::to_string(coverage_.levels() - 1),
                                   "give levels in that range");
    }

    /// Calls row(first word in the window, first word in the grid, count).
    template <typename Row> void eachRow(const ColumnRange& range, Row&& row) const {
        const auto words = static_cast<std::size_t>(current_.wordsPerColumn());
        const std::size_t count = static_cast<std::size_t>(std::max(0, range.width())) * words;
        for (int z = range.z0; z <= range.z1; ++z)
            row(static_cast<std::size_t>(z - range.z0) * count, current_.columnIndex(range.x0, z) * words, count);
    }

    [[nodiscard]] bool inRange(Level level) const { return level.index >= 0 && level.index < coverage_.levels(); }

    /// Goes to the level if that raises the IoU.
    bool tryLevel(std::size_t actuator, int level) {
        const Level was = state_[actuator];
        if (!inRange(Level{level}) || level == was.index) return false;
        State next = state_;
        next[actuator] = Level{level};
        return tryState(next, windows_[actuator]);
    }

    /// Goes to a state that differs only within the window, if that raises the IoU.
    bool tryState(const State& state, const Coverage::Window& window) {
        moved_.resize(window.range.size() * static_cast<std::size_t>(current_.wordsPerColumn()));
        coverage_.covered(state, window, moved_, scratch_);
        ++statesSeen_;
        Counts next = total_;
        eachRow(window.range, [&](std::size_t here, std::size_t there, std::size_t count) {
            const std::span<const std::uint64_t> now(&moved_[here], count);
            const std::span<const std::uint64_t> before = std::as_const(current_).words().subspan(there, count);
            const std::span<const std::uint64_t> wanted = std::as_const(target_).words().subspan(there, count);
            next.covered += countBits(now) - countBits(before);
            next.both += countBitsAnd(now, wanted) - countBitsAnd(before, wanted);
        });
        if (!better(next)) return false;
        total_ = next;
        state_ = state;
        eachRow(window.range, [&](std::size_t here, std::size_t there, std::size_t count) {
            std::copy_n(&moved_[here], count, &current_.words()[there]);
        });
        return true;
    }

    /// Compares both / (covered + wanted - both) exactly, in whole numbers.
    [[nodiscard]] bool better(const Counts& next) const {
        const std::size_t eitherNow = total_.covered + wanted_ - total_.both;
        const std::size_t eitherNext = next.covered + wanted_ - next.both;
        return next.both * eitherNow > total_.both * eitherNext;
    }

    struct Pair {
        std::size_t first;
        std::size_t second;
        Coverage::Window window;
    };

    const Coverage& coverage_;
    std::vector<Coverage::Window> windows_;
    std::vector<Pair> pairs_;
    CoverageScratch scratch_;
    BitColumns target_;
    BitColumns current_;
    std::vector<std::uint64_t> moved_;
    std::size_t wanted_ = 0;
    Counts total_;
    State state_;
    int statesSeen_ = 0;
    const Clock* clock_ = nullptr;
    bool hasDeadline_ = false;
    Microseconds deadline_{0};
};

Refiner::Refiner(const Coverage& coverage) : search_(std::make_unique<Search>(coverage)) {}
Refiner::~Refiner() = default;
Refiner::Refiner(Refiner&&) noexcept = default;
Refiner& Refiner::operator=(Refiner&&) noexcept = default;

Refinement Refiner::refine(const BitColumns& target, const State& start, Microseconds budget, const Clock& clock) {
    search_->start(budget, clock);
    search_->begin(target, start);
    Refinement result;
    result.before = search_->quality();
    do {
        for (const int step : {4, 2, 1})
            while (search_->moveBy(step)) {
            }
    } while (!search_->outOfTime() && (search_->scanAll() || search_->moveInPairs()));
    result.state = search_->state();
    result.after = search_->quality();
    result.statesSeen = search_->statesSeen();
    result.converged = !search_->outOfTime();
    return result;
}

FitQuality Refiner::qualityOf(const BitColumns& target, const State& state) {
    search_->begin(target, state);
    return search_->quality();
}

} // namespace lumorph

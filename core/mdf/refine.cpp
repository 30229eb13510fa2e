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
        held_.resize(windows_.size(), false);
        ranges_.assign(windows_.size(), {0, coverage.levels() - 1});
        for (const auto& [i, j] : coverage.coupledPairs()) {
            ColumnRange range = coverage.columnsMovedBy(i);
            range.include(coverage.columnsMovedBy(j));
            pairs_.push_back({i, j, coverage.window(range)});
        }
    }

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

    void begin(const BitColumns& target, const State& state) {
        check(target, state);
        target_ = target;
        target_ &= coverage_.domain();
        wanted_ = target_.count();
        state_ = state;
        coverage_.covered(state_, current_, scratch_);
        total_ = {current_.count(), current_.countAnd(target_)};
        ++statesSeen_;
        phase_ = cursor_ = 0;
        helped_ = false;
    }

    void start(Microseconds budget, const Clock& clock) {
        statesSeen_ = 0;
        clock_ = &clock;
        hasDeadline_ = budget > Microseconds{0};
        deadline_ = clock.now() + budget;
    }

    /// Searches until nothing helps any more or the time is out, from where the last call was stopped.
    Refinement finish() {
        Refinement result;
        result.before = quality();
        while (phase_ < kPhases && finishPhase()) {
            const std::size_t again = phase_ < kScan ? phase_ : 0;
            phase_ = helped_ ? again : phase_ + 1;
            cursor_ = 0;
            helped_ = false;
        }
        result.state = state_;
        result.after = quality();
        result.statesSeen = statesSeen_;
        result.converged = phase_ == kPhases;
        return result;
    }

    void hold(const std::vector<std::size_t>& actuators) {
        std::vector<bool> held(windows_.size(), false);
        for (const std::size_t actuator : actuators) {
            if (actuator >= held.size())
                throw InvalidInput("actuator " + std::to_string(actuator),
                                   "the rig has " + std::to_string(held.size()) + " actuators",
                                   "give indices of actuators that are there");
            held[actuator] = true;
        }
        held_ = std::move(held);
    }

    void keepWithin(const std::vector<LevelRange>& ranges) {
        const LevelRange all{0, coverage_.levels() - 1};
        if (!ranges.empty() && ranges.size() != windows_.size())
            throw InvalidInput("levels that are reached",
                               std::to_string(ranges.size()) + " ranges for " + std::to_string(windows_.size()) +
                                   " actuators",
                               "give one for each actuator");
        for (const LevelRange& range : ranges)
            if (range.low < all.low || range.high > all.high || range.low > range.high)
                throw InvalidInput("levels " + std::to_string(range.low) + " to " + std::to_string(range.high),
                                   "levels run from 0 to " + std::to_string(all.high), "give a range of them");
        ranges_ = ranges.empty() ? std::vector<LevelRange>(windows_.size(), all) : ranges;
    }
    [[nodiscard]] State within(State state) const {
        for (std::size_t i = 0; i < state.size(); ++i)
            state[i].index = std::clamp(state[i].index, ranges_[i].low, ranges_[i].high);
        return state;
    }

    [[nodiscard]] bool outOfTime() const { return hasDeadline_ && clock_->now() >= deadline_; }
    [[nodiscard]] FitQuality quality() const {
        return {total_.both, wanted_ - total_.both, total_.covered - total_.both};
    }

private:
    /// Calls row(first word in the window, first word in the grid, count).
    template <typename Row> void eachRow(const ColumnRange& range, Row&& row) const {
        const auto words = static_cast<std::size_t>(current_.wordsPerColumn());
        const std::size_t count = static_cast<std::size_t>(std::max(0, range.width())) * words;
        for (int z = range.z0; z <= range.z1; ++z)
            row(static_cast<std::size_t>(z - range.z0) * count, current_.columnIndex(range.x0, z) * words, count);
    }

    /// Tries what is left of the current phase; false when the time ran out before its end.
    bool finishPhase() {
        if (phase_ < kScan) return moveBy(kSteps[phase_]);
        return phase_ == kScan ? scanAll() : moveInPairs();
    }

    /// Moves every actuator by `step` up or down while that helps.
    bool moveBy(int step) {
        for (; cursor_ < windows_.size(); ++cursor_) do {
                if (outOfTime()) return false;
            } while (note(tryLevel(cursor_, state_[cursor_].index + step) ||
                          tryLevel(cursor_, state_[cursor_].index - step)));
        return true;
    }

    /// Tries every level of every actuator.
    bool scanAll() {
        const auto levels = static_cast<std::size_t>(coverage_.levels());
        for (; cursor_ < windows_.size() * levels; ++cursor_) {
            if (outOfTime()) return false;
            note(tryLevel(cursor_ / levels, static_cast<int>(cursor_ % levels)));
        }
        return true;
    }

    /// Tries moving coupled actuators together, up to the first move that helps: where one must give way for the
    /// other to gain, no single move does.
    bool moveInPairs() {
        constexpr int kPairSteps[] = {1, -1, 2, -2, 4, -4};
        constexpr std::size_t kCount = std::size(kPairSteps);
        for (; cursor_ < pairs_.size() * kCount * kCount && !helped_; ++cursor_) {
            if (outOfTime()) return false;
            const Pair& pair = pairs_[cursor_ / (kCount * kCount)];
            if (held_[pair.first] || held_[pair.second]) continue;
            State next = state_;
            next[pair.first].index += kPairSteps[cursor_ / kCount % kCount];
            next[pair.second].index += kPairSteps[cursor_ % kCount];
            if (inRange(pair.first, next[pair.first]) && inRange(pair.second, next[pair.second]))
                note(tryState(next, pair.window));
        }
        return true;
    }

    bool note(bool moved) {
        helped_ |= moved;
        return moved;
    }

    [[nodiscard]] bool inRange(std::size_t actuator, Level level) const {
        return level.index >= ranges_[actuator].low && level.index <= ranges_[actuator].high;
    }

    /// Goes to the level if that raises the IoU.
    bool tryLevel(std::size_t actuator, int level) {
        const Level was = state_[actuator];
        if (held_[actuator] || !inRange(actuator, Level{level}) || level == was.index) return false;
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

    // The phases of the search: moves by each step, every level, coupled pairs.
    static constexpr int kSteps[] = {4, 2, 1};
    static constexpr std::size_t kScan = std::size(kSteps);
    static constexpr std::size_t kPhases = kScan + 2;

    const Coverage& coverage_;
    std::vector<Coverage::Window> windows_;
    std::vector<bool> held_;         ///< one an actuator
    std::vector<LevelRange> ranges_; ///< likewise
    std::vector<Pair> pairs_;
    CoverageScratch scratch_;
    BitColumns target_;
    BitColumns current_;
    std::vector<std::uint64_t> moved_;
    std::size_t wanted_ = 0;
    Counts total_;
    State state_;
    int statesSeen_ = 0;
    std::size_t phase_ = kPhases; ///< nothing to resume before the first state
    std::size_t cursor_ = 0;      ///< the next candidate of the phase
    bool helped_ = false;         ///< something moved in this phase
    const Clock* clock_ = nullptr;
    bool hasDeadline_ = false;
    Microseconds deadline_{0};
};

Refiner::Refiner(const Coverage& coverage) : search_(std::make_unique<Search>(coverage)) {}
Refiner::~Refiner() = default;
Refiner::Refiner(Refiner&&) noexcept = default;
Refiner& Refiner::operator=(Refiner&&) noexcept = default;

void Refiner::hold(const std::vector<std::size_t>& actuators) { search_->hold(actuators); }
void Refiner::keepWithin(const std::vector<LevelRange>& ranges) { search_->keepWithin(ranges); }

Refinement Refiner::refine(const BitColumns& target, const State& start, Microseconds budget, const Clock& clock) {
    search_->start(budget, clock);
    search_->check(target, start);
    search_->begin(target, search_->within(start));
    return search_->finish();
}

Refinement Refiner::resume(Microseconds budget, const Clock& clock) {
    search_->start(budget, clock);
    return search_->finish();
}

FitQuality Refiner::qualityOf(const BitColumns& target, const State& state) {
    search_->begin(target, state);
    return search_->quality();
}

double iouBetweenLevels(const Coverage& coverage, const BitColumns& target, const State& state,
                        const std::function<bool()>& isOver) {
    const double level = 1.0 / (coverage.levels() - 1);
    CoverageScratch scratch;
    BitColumns covered;
    std::vector<double> strokes;
    for (const Level of : state) strokes.push_back(of.index * level);
    const auto iouAt = [&](const std::vector<double>& at) {
        coverage.coveredAt(at, covered, scratch);
        return compareVolumes(covered, target).iou();
    };
    double best = iouAt(strokes);
    const auto moveBy = [&](std::size_t actuator, double step) {
        std::vector<double> next = strokes;
        next[actuator] = std::clamp(next[actuator] + step, 0.0, 1.0);
        if (next == strokes || (isOver && isOver())) return false;
        const double iou = iouAt(next);
        if (iou <= best) return false;
        best = iou;
        strokes = std::move(next);
        return true;
    };
    for (const double step : {0.5 * level, 0.25 * level}) {
        bool helped = true;
        while (std::exchange(helped, false))
            for (std::size_t i = 0; i < strokes.size(); ++i) helped |= moveBy(i, step) || moveBy(i, -step);
    }
    return best;
}

} // namespace lumorph

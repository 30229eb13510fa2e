#include "core/mdf/clip_plan.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/motion/motion_plan.h"
#include "core/motion/rig_motion.h"

namespace lumorph {
namespace {

constexpr int kMostRounds = 3;
/// Mean IoU a frame; a round that gains less is the last.
constexpr double kWorthARound = 1e-3;
/// At most so many strokes of an actuator and so many frames a second are looked at; between them gains are
/// interpolated, because a sheet whose levers all move the same columns takes 0.1 ms for each state.
constexpr int kMostStrokes = 17;
constexpr double kLooksASecond = 15.0;

bool sameMotion(const MotionLimits& a, const MotionLimits& b) {
    return a.maxVelocity == b.maxVelocity && a.dampingRatio == b.dampingRatio && a.settleSeconds == b.settleSeconds;
}

} // namespace

class ClipPlanner::Search {
public:
    Search(const Coverage& coverage, double seconds)
        : coverage_(coverage), strokes_(static_cast<std::size_t>(std::min(coverage.levels(), kMostStrokes))),
          every_(static_cast<std::size_t>(std::max(1.0, std::floor(1.0 / (kLooksASecond * seconds) + 1e-6)))) {
        const std::vector<MotionLimits> limits = motionLimits(coverage.rig());
        for (std::size_t i = 0; i < limits.size(); ++i) {
            windows_.push_back(coverage.window(coverage.columnsMovedBy(i)));
            const auto same =
                std::ranges::find_if(limits, [&](const MotionLimits& other) { return sameMotion(other, limits[i]); });
            const auto first = static_cast<std::size_t>(same - limits.begin());
            planners_.push_back(first < i ? planners_[first]
                                          : std::make_shared<const MotionPlanner>(limits[i], seconds));
        }
    }

    void begin(std::span<const MotionState> start, std::span<const BitColumns> targets, std::span<const State> wanted) {
        if (start.size() != windows_.size() || targets.size() != wanted.size())
            throw InvalidInput("clip", "its frames or its actuators are not those of the device",
                               "give one motion an actuator, and one target and state a frame");
        start_ = start;
        targets_ = targets;
        states_.assign(wanted.begin(), wanted.end());
        plans_.assign(windows_.size(), {});
        const std::vector<float> none(targets.size() * strokes_, 0.0F);
        std::vector<double> commands(targets.size());
        for (std::size_t i = 0; i < plans_.size(); ++i) {
            for (std::size_t k = 0; k < commands.size(); ++k) commands[k] = strokeOf(wanted[k][i], coverage_.levels());
            keep(i, planners_[i]->follow(start[i], commands, none, strokes_));
        }
    }

    /// Plans one actuator anew; returns the gain, summed over the frames.
    double improve(std::size_t actuator) {
        gainsOf(actuator);
        const MotionPlanner& planner = *planners_[actuator];
        MotionPlan next = planner.plan(start_[actuator], gains_, strokes_);
        const double gained =
            next.gain - planner.follow(start_[actuator], plans_[actuator].commands, gains_, strokes_).gain;
        if (!(gained > 0.0)) return 0.0;
        keep(actuator, std::move(next));
        return gained;
    }

    [[nodiscard]] FrameCommands commands() const {
        FrameCommands commands(targets_.size(), std::vector<double>(plans_.size()));
        for (std::size_t k = 0; k < commands.size(); ++k)
            for (std::size_t i = 0; i < plans_.size(); ++i) commands[k][i] = plans_[i].commands[k];
        return commands;
    }

private:
    [[nodiscard]] int nearestLevel(double stroke) const {
        return static_cast<int>(std::lround(stroke * (coverage_.levels() - 1)));
    }

    void keep(std::size_t actuator, MotionPlan plan) {
        for (std::size_t k = 0; k < states_.size(); ++k)
            states_[k][actuator].index = nearestLevel(plan.states[k].position);
        plans_[actuator] = std::move(plan);
    }

    /// The IoU of each frame at the strokes of one actuator.
    void gainsOf(std::size_t actuator) {
        gains_.resize(targets_.size() * strokes_);
        const auto row = [this](std::size_t k) { return std::span(gains_).subspan(k * strokes_, strokes_); };
        std::size_t last = targets_.size(); // none
        for (std::size_t k = 0; k < targets_.size(); ++k) {
            if ((k + 1) % every_ != 0 && k + 1 != targets_.size()) continue;
            gainsOf(actuator, targets_[k], states_[k], row(k));
            const std::size_t from = last < k ? last : k;
            for (std::size_t between = last < k ? last + 1 : 0; between < k; ++between) {
                const float share =
                    from == k ? 1.0F : static_cast<float>(between - from) / static_cast<float>(k - from);
                for (std::size_t j = 0; j < strokes_; ++j)
                    row(between)[j] = row(from)[j] + share * (row(k)[j] - row(from)[j]);
            }
            last = k;
        }
    }

    void gainsOf(std::size_t actuator, const BitColumns& target, State state, std::span<float> gains) {
        const Coverage::Window& window = windows_[actuator];
        coverage_.covered(state, whole_, scratch_);
        std::size_t outside = whole_.count(), outsideBoth = whole_.countAnd(target);
        moved_.resize(window.range.size() * static_cast<std::size_t>(target.wordsPerColumn()));
        const auto countMoved = [&](std::size_t& covered, std::size_t& both) {
            coverage_.covered(state, window, moved_, scratch_);
            covered = countBits(moved_);
            both = 0;
            eachRow(window.range, target, [&](std::size_t here, std::size_t there, std::size_t count) {
                both += countBitsAnd(std::span<const std::uint64_t>(moved_).subspan(here, count),
                                     target.words().subspan(there, count));
            });
        };
        std::size_t covered = 0, both = 0;
        countMoved(covered, both);
        outside -= covered;
        outsideBoth -= both;
        const std::size_t wanted = target.count();
        for (std::size_t j = 0; j < gains.size(); ++j) {
            state[actuator].index = nearestLevel(static_cast<double>(j) / static_cast<double>(gains.size() - 1));
            countMoved(covered, both);
            const std::size_t shared = outsideBoth + both;
            const std::size_t either = outside + covered + wanted - shared;
            gains[j] = either == 0 ? 0.0F : static_cast<float>(shared) / static_cast<float>(either);
        }
    }

    /// Calls row(first word in the range, first word in the grid, count).
    template <typename Row> static void eachRow(const ColumnRange& range, const BitColumns& grid, Row&& row) {
        const auto words = static_cast<std::size_t>(grid.wordsPerColumn());
        const std::size_t count = static_cast<std::size_t>(std::max(0, range.width())) * words;
        if (count == 0) return;
        for (int z = range.z0; z <= range.z1; ++z)
            row(static_cast<std::size_t>(z - range.z0) * count, grid.columnIndex(range.x0, z) * words, count);
    }

    const Coverage& coverage_;
    std::size_t strokes_; ///< at which gains are looked at, evenly spaced
    std::size_t every_;   ///< so many frames
    std::vector<Coverage::Window> windows_;
    std::vector<std::shared_ptr<const MotionPlanner>> planners_; ///< one an actuator; those that move alike share one
    std::span<const MotionState> start_;
    std::span<const BitColumns> targets_;
    std::vector<State> states_; ///< one a frame: the levels nearest to the plans
    std::vector<MotionPlan> plans_;
    std::vector<float> gains_;
    BitColumns whole_;
    std::vector<std::uint64_t> moved_;
    CoverageScratch scratch_;
};

ClipPlanner::ClipPlanner(const Coverage& coverage, double seconds)
    : search_(std::make_unique<Search>(coverage, seconds)) {}
ClipPlanner::~ClipPlanner() = default;

FrameCommands ClipPlanner::plan(std::span<const MotionState> start, std::span<const BitColumns> targets,
                                std::span<const State> wanted, const Progress& progress) {
    search_->begin(start, targets, wanted);
    for (int round = 0; round < kMostRounds; ++round) {
        double gained = 0.0;
        for (std::size_t i = 0; i < start.size(); ++i) {
            progress.throwIfCancelled();
            gained += search_->improve(i);
        }
        if (gained < kWorthARound * static_cast<double>(targets.size())) break;
    }
    return search_->commands();
}

} // namespace lumorph

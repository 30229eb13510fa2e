#include "core/mdf/certify.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/mdf/box_bound.h"
#include "core/mdf/piece_tables.h"
#include "core/mdf/refine.h"
#include "core/mdf/volume_bounds.h"

namespace lumorph {
namespace {

constexpr std::size_t kMostPieceStates = 40'000; ///< of a table of actuators that move nothing together
constexpr std::size_t kEvaluated = 8;            ///< a box of so few states is evaluated state by state
constexpr std::size_t kBoxesAtATime = 4;
constexpr std::size_t kMostBoxes = 2'000'000; ///< that are kept
constexpr Microseconds kRefining{20'000};
constexpr int kSlices = 5; ///< of that before boxes are bounded

/// A box of joint states of the actuators that are bounded together.
struct StateBox {
    State low, high;
    double bound = 1.0;   ///< no state in it has a larger IoU
    bool bounded = false; ///< itself, else it has the bound of what it is a half of
    std::size_t axis = 0; ///< to be halved along

    [[nodiscard]] std::size_t states() const noexcept {
        std::size_t count = 1;
        for (std::size_t i = 0; i < low.size() && count <= kEvaluated; ++i)
            count *= static_cast<std::size_t>(high[i].index - low[i].index + 1);
        return count;
    }
    bool operator<(const StateBox& other) const noexcept { return bound < other.bound; }
};

/// What one thread needs to bound boxes.
struct ThreadBuffers {
    VolumeBounds::WorkspacePointer workspace = VolumeBounds::makeWorkspace();
    VolumeEnclosure enclosure;
    BoxBound bound;
    CoverageScratch scratch;
    BitColumns covered;
};

/// Whether one is a better fit than the other, in whole numbers.
bool isBetter(const FitQuality& one, const FitQuality& other) {
    const auto either = [](const FitQuality& of) { return of.both + of.unmatched + of.overfilled; };
    return one.both * either(other) > other.both * either(one);
}

} // namespace

class Certifier::Search {
public:
    Search(const Coverage& coverage, CertifyOptions options)
        : coverage_(coverage), options_(options), refiner_(coverage), joint_(coverage.rig().actuatorCount(), false) {}

    void start(const BitColumns& target, const State& state) {
        const FitQuality quality = refiner_.qualityOf(target, state); // throws where they do not fit
        target_ = target;
        target_ &= coverage_.domain();
        wanted_ = target_.count();
        known_ = {};
        known_.best = state;
        known_.quality = quality;
        tables_.reset();
        boxes_.clear();
        residual_ = 0.0;
        stage_ = Stage::columns;
        if (wanted_ != 0) return;
        known_.upperBound = 0.0;
        known_.exact = true;
        known_.note = "The target has no voxel outside the device's body in the field's frame: no state meets it.";
        stage_ = Stage::done;
    }

    Certificate tighten(Microseconds budget, const Clock& clock, const std::stop_token& stop) {
        clock_ = &clock;
        deadline_ = clock.now() + budget;
        stop_ = stop;
        while (stage_ != Stage::done && !isOver()) advance();
        known_.done = stage_ == Stage::done;
        known_.exact = known_.exact || (stage_ == Stage::done && known_.upperBound <= known_.quality.iou());
        return known_;
    }

private:
    enum class Stage { columns, tables, count, solve, refine, boxes, done };

    [[nodiscard]] bool isOver() const { return stop_.stop_requested() || clock_->now() >= deadline_; }

    void advance() {
        switch (stage_) {
        case Stage::columns:
            if (findColumns()) stage_ = Stage::tables;
            break;
        case Stage::tables:
            makeTables();
            stage_ = Stage::count;
            break;
        case Stage::count:
            if (tables_->count([this] { return isOver(); })) stage_ = Stage::solve;
            break;
        case Stage::solve:
            solveTables();
            break;
        case Stage::refine:
            refineAtFirst();
            break;
        case Stage::boxes:
            halveBoxes();
            break;
        case Stage::done:
            break;
        }
    }

    /// One actuator at a time: the columns that it can change. False while some are left.
    bool findColumns() {
        if (changed_.size() < joint_.size()) changed_.push_back(coverage_.columnsChangedBy(changed_.size()));
        return changed_.size() == joint_.size();
    }

    /// Sorts the columns by the actuators that change them. Where a table would be too large, all of these actuators
    /// are bounded jointly, and with them all that share a column with one of those.
    void makeTables() {
        if (!sorted_) sortColumns();
        std::vector<PieceTable> tables;
        for (const auto& [actuators, columns] : columnsOf_)
            if (!joint_[actuators.front()]) tables.push_back({actuators, columns, {}, {}});
        hasTables_ = !tables.empty();
        tables_.emplace(coverage_, target_, std::move(tables));
    }

    void sortColumns() {
        for (std::size_t column = 0; column < coverage_.domain().columnCount(); ++column) {
            std::vector<std::size_t> by;
            for (std::size_t a = 0; a < changed_.size(); ++a)
                if (changed_[a][column] != 0) by.push_back(a);
            if (!by.empty()) columnsOf_[by].push_back(column);
        }
        std::vector<bool> coupled(joint_.size(), false);
        for (const auto& [i, j] : coverage_.coupledPairs()) coupled[i] = coupled[j] = true;
        const auto isTooLarge = [&](const std::vector<std::size_t>& actuators) {
            const bool together = std::ranges::any_of(actuators, [&](std::size_t a) { return coupled[a]; });
            const std::size_t most = together ? options_.mostTabulated : kMostPieceStates;
            std::size_t states = 1;
            for (std::size_t k = 0; k < actuators.size() && states <= most; ++k)
                states *= static_cast<std::size_t>(coverage_.levels());
            return states > most;
        };
        for (bool more = true; more;) {
            more = false;
            for (const auto& [actuators, columns] : columnsOf_) {
                const bool joint = std::ranges::any_of(actuators, [&](std::size_t a) { return joint_[a]; });
                if (!joint && !isTooLarge(actuators)) continue;
                for (const std::size_t a : actuators) more = more || !joint_[a], joint_[a] = true;
            }
        }
        std::vector<std::uint16_t> axes;
        for (std::size_t a = 0; a < joint_.size(); ++a)
            if (joint_[a]) axes.push_back(static_cast<std::uint16_t>(a));
        std::vector<std::uint8_t> where(coverage_.domain().columnCount(), 0);
        for (const auto& [actuators, columns] : columnsOf_)
            if (joint_[actuators.front()])
                for (const std::size_t column : columns) where[column] = 1;
        jointColumns_ = where;
        jointCount_ = axes.size();
        if (!axes.empty() && axes.size() <= VolumeBounds::kMostAxes)
            volumes_.emplace(coverage_, std::move(axes), std::move(where));
        sorted_ = true;
    }

    /// Without actuators that are bounded jointly the tables solve all: from each lambda to the ratio of the best state
    /// at it, until none is better.
    void solveTables() {
        const double lambda = known_.quality.iou();
        State state = known_.best;
        const PieceTables::Best best = tables_->best(lambda, state);
        if (jointCount_ == 0) {
            if (take(state)) return; // again with its ratio
            known_.upperBound = best.exact ? known_.quality.iou() : boundBeyond(lambda, best.value, 0.0);
            stage_ = Stage::done;
            return;
        }
        take(state);
        if (!volumes_) {
            std::size_t wanted = 0;
            const auto words = static_cast<std::size_t>(target_.wordsPerColumn());
            for (std::size_t column = 0; column < jointColumns_.size(); ++column)
                if (jointColumns_[column] != 0)
                    wanted += countBits(std::as_const(target_).words().subspan(column * words, words));
            known_.upperBound = boundBeyond(lambda, best.value, static_cast<double>(wanted));
            known_.note = std::to_string(jointCount_) +
                          " actuators share voxels, too many to bound jointly: the bound only leaves out what no "
                          "actuator reaches.";
            stage_ = Stage::done;
            return;
        }
        StateBox all;
        for (std::size_t i = 0; i < jointCount_; ++i) {
            all.low.push_back(Level{0});
            all.high.push_back(Level{coverage_.levels() - 1});
        }
        boxes_.assign(1, all);
        slices_ = 0;
        stage_ = Stage::refine;
    }

    /// Where the tables and `more` voxels that count for sure are worth no more than lambda x wanted.
    [[nodiscard]] double boundBeyond(double lambda, double value, double more) {
        State unused = known_.best;
        for (int round = 0; round < 20; ++round) {
            const double excess = value + more - lambda * static_cast<double>(wanted_);
            if (excess <= 0.0) break;
            lambda += excess / static_cast<double>(wanted_);
            if (lambda >= 1.0) return 1.0;
            value = tables_->best(lambda, unused).value;
        }
        return std::max(known_.quality.iou(), lambda + 1e-12);
    }

    /// Evaluates a state, and keeps it where it is better.
    bool take(const State& state) {
        coverage_.covered(state, covered_, scratch_);
        const FitQuality quality = compareVolumes(covered_, target_);
        if (!isBetter(quality, known_.quality)) return false;
        known_.best = state;
        known_.quality = quality;
        return true;
    }

    struct Half {
        StateBox box;
        bool open = true;      ///< a state in it may be better than the best known
        double residual = 0.0; ///< bound of what is closed but not solved
        std::optional<std::pair<State, FitQuality>> seen = {};
    };

    void halveBoxes() {
        std::vector<Half> halves;
        std::vector<StateBox> taken;
        while (!boxes_.empty() && taken.size() < kBoxesAtATime) {
            std::pop_heap(boxes_.begin(), boxes_.end());
            taken.push_back(std::move(boxes_.back()));
            boxes_.pop_back();
        }
        for (const StateBox& box : taken) {
            if (!box.bounded) {
                halves.push_back({box});
                continue;
            }
            const int low = box.low[box.axis].index, high = box.high[box.axis].index;
            Half lower{box}, upper{box};
            lower.box.bounded = upper.box.bounded = false;
            lower.box.high[box.axis] = Level{(low + high) / 2};
            upper.box.low[box.axis] = Level{(low + high) / 2 + 1};
            halves.push_back(std::move(lower));
            halves.push_back(std::move(upper));
        }
        const auto bound = [&](std::size_t k) {
            if (!isOver()) boundHalf(halves[k], buffers_.local());
        };
        if (options_.oneThread)
            for (std::size_t k = 0; k < halves.size(); ++k) bound(k);
        else
            tbb::parallel_for(std::size_t{0}, halves.size(), bound);
        bool improved = false;
        for (Half& half : halves) {
            if (half.seen && isBetter(half.seen->second, known_.quality)) {
                known_.best = half.seen->first;
                known_.quality = half.seen->second;
                improved = true;
            }
            residual_ = std::max(residual_, half.residual);
            if (half.open) {
                boxes_.push_back(std::move(half.box));
                std::push_heap(boxes_.begin(), boxes_.end());
            }
        }
        known_.boxes += halves.size();
        if (improved) refine();
        if (improved) {
            std::erase_if(boxes_, [&](const StateBox& box) { return box.bound <= known_.quality.iou(); });
            std::make_heap(boxes_.begin(), boxes_.end());
        }
        const double left = std::max(residual_, boxes_.empty() ? 0.0 : boxes_.front().bound);
        known_.upperBound = std::max(known_.quality.iou(), std::min(known_.upperBound, left));
        if (boxes_.empty() || boxes_.size() > kMostBoxes) stage_ = Stage::done;
    }

    /// A good state first closes more boxes.
    void refineAtFirst() {
        const Refinement refined = slices_ > 0 ? refiner_.resume(kRefining, *clock_)
                                               : refiner_.refine(target_, known_.best, kRefining, *clock_);
        keep(refined);
        if (refined.converged || ++slices_ == kSlices) stage_ = Stage::boxes;
    }
    void refine() { keep(refiner_.refine(target_, known_.best, kRefining, *clock_)); }
    void keep(const Refinement& refined) {
        if (!isBetter(refined.after, known_.quality)) return;
        known_.best = refined.state;
        known_.quality = refined.after;
    }

    [[nodiscard]] State stateOf(const State& joint) const {
        State state = known_.best;
        for (std::size_t i = 0; i < joint.size(); ++i) state[volumes_->actuators()[i]] = joint[i];
        return state;
    }

    void look(const State& state, Half& half, ThreadBuffers& buffers) const {
        coverage_.covered(state, buffers.covered, buffers.scratch);
        const FitQuality quality = compareVolumes(buffers.covered, target_);
        if (!half.seen || isBetter(quality, half.seen->second)) half.seen.emplace(state, quality);
    }

    /// Bounds a box, or closes it where no state in it can be better than the best known.
    void boundHalf(Half& half, ThreadBuffers& buffers) const {
        StateBox& box = half.box;
        if (box.states() <= kEvaluated) {
            evaluate(half, buffers);
            return;
        }
        State middle;
        for (std::size_t i = 0; i < box.low.size(); ++i)
            middle.push_back(Level{(box.low[i].index + box.high[i].index) / 2});
        State state = stateOf(middle);
        look(state, half, buffers);
        volumes_->over(box.low, box.high, buffers.enclosure, *buffers.workspace);
        buffers.bound.set(buffers.enclosure, target_, coverage_.domain());
        const double wanted = static_cast<double>(wanted_);
        const auto excess = [&](double lambda) {
            const double apart = hasTables_ ? tables_->best(lambda, state).value : 0.0;
            return apart + buffers.bound.at(lambda, lambda * wanted - apart) - lambda * wanted;
        };
        const double reached = known_.quality.iou();
        const double low = excess(reached);
        if (hasTables_) look(state, half, buffers);
        box.bounded = true;
        half.open = low > 0.0;
        if (!half.open) return;
        // The excess is convex in lambda and falls by `wanted` at least.
        const double steepest = wanted + static_cast<double>(half.seen->second.overfilled);
        const double next = std::min(box.bound, reached + low / steepest);
        const double high = excess(next);
        const double root = high <= 0.0 ? reached + (next - reached) * low / (low - high) : next + high / wanted;
        box.bound = std::min(box.bound, root + 1e-12);
        half.open = box.bound > reached;
        box.axis = widestAxis(box, buffers.enclosure.spread);
    }

    /// Looks at every state of a box, each with the best levels of the actuators in tables.
    void evaluate(Half& half, ThreadBuffers& buffers) const {
        State joint = half.box.low;
        while (true) {
            State state = stateOf(joint);
            look(state, half, buffers);
            if (hasTables_) completeWithTables(state, half, buffers);
            std::size_t digit = 0;
            while (digit < joint.size() && joint[digit] == half.box.high[digit])
                joint[digit] = half.box.low[digit], ++digit;
            if (digit == joint.size()) break;
            ++joint[digit].index;
        }
        half.open = false;
    }

    void completeWithTables(State state, Half& half, ThreadBuffers& buffers) const {
        double lambda = std::max(known_.quality.iou(), half.seen->second.iou());
        while (true) {
            const PieceTables::Best best = tables_->best(lambda, state);
            look(state, half, buffers);
            if (half.seen->second.iou() > lambda) {
                lambda = half.seen->second.iou();
                continue;
            }
            if (!best.exact) half.residual = half.box.bound;
            return;
        }
    }

    [[nodiscard]] static std::size_t widestAxis(const StateBox& box, const std::vector<double>& spread) {
        std::size_t axis = 0;
        std::pair<double, int> most{-1.0, -1};
        for (std::size_t i = 0; i < box.low.size(); ++i) {
            const int width = box.high[i].index - box.low[i].index;
            if (width > 0) most = std::max(most, std::pair(spread[i], width));
            if (width > 0 && most == std::pair(spread[i], width)) axis = i;
        }
        return axis;
    }

    const Coverage& coverage_;
    CertifyOptions options_;
    Refiner refiner_;
    // Of the coverage, whatever the target.
    std::vector<std::vector<std::uint8_t>> changed_;
    bool sorted_ = false;
    bool hasTables_ = false;
    std::vector<bool> joint_;
    std::size_t jointCount_ = 0;
    std::map<std::vector<std::size_t>, std::vector<std::size_t>> columnsOf_; ///< by the actuators that change them
    std::vector<std::uint8_t> jointColumns_;
    std::optional<VolumeBounds> volumes_;
    tbb::enumerable_thread_specific<ThreadBuffers> buffers_;
    // Of the target.
    BitColumns target_;
    std::size_t wanted_ = 0;
    Stage stage_ = Stage::done;
    int slices_ = 0; ///< of refining at first
    std::optional<PieceTables> tables_;
    std::vector<StateBox> boxes_; ///< a heap, the largest bound first
    double residual_ = 0.0;       ///< bound of boxes that were closed unsolved
    Certificate known_;
    BitColumns covered_;
    CoverageScratch scratch_;
    // Of the call.
    const Clock* clock_ = nullptr;
    Microseconds deadline_{0};
    std::stop_token stop_;
};

Certifier::Certifier(const Coverage& coverage, CertifyOptions options)
    : search_(std::make_unique<Search>(coverage, options)) {}
Certifier::~Certifier() = default;
Certifier::Certifier(Certifier&&) noexcept = default;
Certifier& Certifier::operator=(Certifier&&) noexcept = default;

void Certifier::start(const BitColumns& target, const State& state) { search_->start(target, state); }
Certificate Certifier::tighten(Microseconds budget, const Clock& clock, const std::stop_token& stop) {
    return search_->tighten(budget, clock, stop);
}

} // namespace lumorph

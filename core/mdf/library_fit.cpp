#include "core/mdf/library_fit.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/mdf/level_gains.h"
#include "core/mdf/refine.h"

namespace lumorph {
namespace {

constexpr Microseconds kCancelPause{20'000}; ///< so long is refined before looking whether the user wants it stopped
constexpr std::size_t kMostSteps = 32;

VoxelFrame frameFor(const Rig& rig, const LibraryFitOptions& options) {
    const Box& box = options.space.empty() ? rig.reach() : options.space;
    for (int resolution = options.resolution; resolution > 1; --resolution) {
        VoxelFrame frame = frameOf(box, resolution);
        if (frame.voxelCount() <= options.voxels) return frame;
    }
    return frameOf(box, 1);
}

} // namespace

class LibraryMatcher::Work {
public:
    Work(const Rig& rig, std::span<const LibraryTarget> library, const LibraryFitOptions& options,
         const Progress& progress)
        : coverage_(rig, frameFor(rig, options), options.levels) {
        if (library.empty()) throw InvalidInput("targets", "there are none", "give at least one");
        const float rest = boundingBox(rig.restMesh().positions).max.y;
        wanted_.resize(library.size());
        fit_.targets.resize(library.size());
        const VoxelFrame& frame = coverage_.frame();
        forEachTarget(progress.part(0.0, 0.5), "placing targets", [&](std::size_t t) {
            TargetFit& fit = fit_.targets[t];
            const LibraryTarget& from = library[t];
            fit.name = from.name;
            fit.placement = placeTarget(frame, rest, coverage_.body(), from, options.placing);
            const Target moved{placed(from.target.mesh, fit.placement), from.target.closed, {}};
            SolidVoxelizer voxelizer;
            voxelizeTarget(frame, moved, voxelizer, wanted_[t], progress.part(0.0, 0.0));
            fit.unreachable = shareBeyondFrame(frame, moved, wanted_[t]);
            wanted_[t] &= coverage_.domain();
        });
        countGains(progress.part(0.5, 1.0));
    }

    const LibraryFit& fit(const Progress& progress) {
        if (fitted_) return fit_;
        fit_.frame = coverage_.frame();
        fit_.levels = coverage_.levels();
        forEachTarget(progress, "matching targets", [&](std::size_t t) {
            Refiner refiner(coverage_);
            const auto wanted = static_cast<int>(wanted_[t].count());
            refineFrom(refiner, t, bestBySums(gains_[t], restBoth_[t], restCovered_, wanted).state, fit_.targets[t],
                       progress);
        });
        sum(fit_);
        fitted_ = true;
        return fit_;
    }

    std::vector<FitWithout> fitByActuators(const Progress& progress) {
        (void)fit(progress.part(0.0, 0.2));
        std::vector<std::size_t> moving(coverage_.rig().actuatorCount());
        std::iota(moving.begin(), moving.end(), std::size_t{0});
        const std::size_t block = (moving.size() + kMostSteps - 1) / kMostSteps;
        std::vector<FitWithout> steps{{moving.size(), fit_.mean, {}}};
        std::vector<std::size_t> held;
        LibraryFit now = fit_;
        while (moving.size() > block) {
            const double done = static_cast<double>(held.size()) / static_cast<double>(held.size() + moving.size());
            const std::vector<std::size_t> left = leastMissed(moving, block, now, progress.part(0.2 + 0.8 * done, 1.0));
            FitWithout step;
            for (const std::size_t a : left) {
                std::erase(moving, a);
                held.push_back(a);
                step.leftOut.push_back(coverage_.rig().actuators()[a].name);
            }
            forEachTarget(Progress(), "", [&](std::size_t t) {
                progress.throwIfCancelled();
                State start = now.targets[t].state;
                for (const std::size_t a : left) start[a] = Level{0};
                Refiner refiner(coverage_);
                refiner.hold(held);
                refineFrom(refiner, t, start, now.targets[t], progress);
            });
            sum(now);
            step.actuators = moving.size();
            step.fit = now.mean;
            steps.push_back(std::move(step));
        }
        return steps;
    }

    [[nodiscard]] const Coverage& coverage() const { return coverage_; }
    [[nodiscard]] const BitColumns& voxelsOf(std::size_t target) const { return wanted_.at(target); }

private:
    template <typename Visit> void forEachTarget(const Progress& progress, const char* stage, Visit&& visit) const {
        std::atomic<std::size_t> done{0};
        tbb::parallel_for(std::size_t{0}, wanted_.size(), [&](std::size_t t) {
            progress.throwIfCancelled();
            visit(t);
            progress.report(static_cast<double>(++done) / static_cast<double>(wanted_.size()), stage);
        });
    }

    /// Every level of every actuator, the others at rest, against all targets.
    void countGains(const Progress& progress) {
        const std::size_t actuators = coverage_.rig().actuatorCount();
        gains_.assign(wanted_.size(), LevelGains(actuators));
        BitColumns rest;
        CoverageScratch scratch;
        coverage_.covered(State(actuators), rest, scratch);
        restCovered_ = static_cast<int>(rest.count());
        for (const BitColumns& wanted : wanted_) restBoth_.push_back(static_cast<int>(rest.countAnd(wanted)));
        std::vector<Reached> reached(actuators);
        tbb::parallel_for(std::size_t{0}, actuators, [&](std::size_t a) {
            progress.throwIfCancelled();
            reached[a] = countGainsOf(a);
        });
        findUnreachable(reached);
    }

    /// Some columns, with what is covered there.
    struct Reached {
        ColumnRange range;
        std::vector<std::uint64_t> words;
    };

    Reached countGainsOf(std::size_t actuator) {
        const ActuatorLevels levels = levelsOf(coverage_, actuator);
        Reached reached{levels.range, {}};
        for (const std::vector<std::uint64_t>& words : levels.words) {
            reached.words.resize(words.size());
            for (std::size_t i = 0; i < words.size(); ++i) reached.words[i] |= words[i];
        }
        for (std::size_t t = 0; t < wanted_.size(); ++t) lumorph::countGains(levels, wanted_[t], gains_[t][actuator]);
        return reached;
    }

    /// What no actuator alone, at any level, covers of each target.
    void findUnreachable(const std::vector<Reached>& parts) {
        BitColumns reached(coverage_.frame().dimensions);
        const auto words = static_cast<std::size_t>(reached.wordsPerColumn());
        for (const Reached& part : parts) {
            const std::size_t count = static_cast<std::size_t>(std::max(0, part.range.width())) * words;
            for (int z = part.range.z0; z <= part.range.z1; ++z)
                for (std::size_t i = 0; i < count; ++i)
                    reached.words()[reached.columnIndex(part.range.x0, z) * words + i] |=
                        part.words[static_cast<std::size_t>(z - part.range.z0) * count + i];
        }
        for (std::size_t t = 0; t < wanted_.size(); ++t) {
            const auto wanted = static_cast<double>(wanted_[t].count());
            const double inside = wanted > 0.0 ? static_cast<double>(wanted_[t].countAnd(reached)) / wanted : 0.0;
            double& share = fit_.targets[t].unreachable;
            share = 1.0 - (1.0 - share) * inside;
        }
    }

    void refineFrom(Refiner& refiner, std::size_t target, const State& start, TargetFit& fit,
                    const Progress& progress) const {
        const SteadyClock clock;
        Refinement refined = refiner.refine(wanted_[target], start, kCancelPause, clock);
        while (!refined.converged) {
            progress.throwIfCancelled();
            refined = refiner.resume(kCancelPause, clock);
        }
        fit.state = refined.state;
        fit.quality = refined.after;
        // A target that does not reach the device's space is not taken at all.
        fit.iou = wanted_[target].count() > 0 ? refined.after.iou() : 0.0;
    }

    static void sum(LibraryFit& fit) {
        fit.mean = 0.0;
        for (std::size_t t = 0; t < fit.targets.size(); ++t) {
            fit.mean += fit.targets[t].iou / static_cast<double>(fit.targets.size());
            if (fit.targets[t].iou > fit.targets[fit.best].iou) fit.best = t;
            if (fit.targets[t].iou < fit.targets[fit.worst].iou) fit.worst = t;
        }
    }

    /// Those whose rest costs the least mean IoU, by how little.
    std::vector<std::size_t> leastMissed(const std::vector<std::size_t>& moving, std::size_t count,
                                         const LibraryFit& now, const Progress& progress) const {
        std::vector<double> left(moving.size(), 0.0);
        std::vector<std::vector<double>> each(wanted_.size(), std::vector<double>(moving.size()));
        forEachTarget(progress, "leaving actuators out", [&](std::size_t t) {
            Refiner refiner(coverage_);
            for (std::size_t k = 0; k < moving.size(); ++k) {
                State state = now.targets[t].state;
                const bool rests = state[moving[k]].index == 0;
                state[moving[k]] = Level{0};
                each[t][k] = rests ? now.targets[t].iou : refiner.qualityOf(wanted_[t], state).iou();
            }
        });
        for (const std::vector<double>& of : each)
            for (std::size_t k = 0; k < moving.size(); ++k) left[k] += of[k];
        std::vector<std::size_t> order(moving.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return left[a] > left[b]; });
        std::vector<std::size_t> chosen;
        for (std::size_t k = 0; k < std::min(count, order.size()); ++k) chosen.push_back(moving[order[k]]);
        return chosen;
    }

    Coverage coverage_;
    std::vector<BitColumns> wanted_;
    std::vector<LevelGains> gains_; ///< one a target
    std::vector<int> restBoth_;
    int restCovered_ = 0;
    LibraryFit fit_;
    bool fitted_ = false;
};

LibraryMatcher::LibraryMatcher(const Rig& rig, std::span<const LibraryTarget> library, const LibraryFitOptions& options,
                               const Progress& progress)
    : work_(std::make_unique<Work>(rig, library, options, progress)) {}
LibraryMatcher::~LibraryMatcher() = default;
LibraryMatcher::LibraryMatcher(LibraryMatcher&&) noexcept = default;
LibraryMatcher& LibraryMatcher::operator=(LibraryMatcher&&) noexcept = default;

const LibraryFit& LibraryMatcher::fit(const Progress& progress) { return work_->fit(progress); }
std::vector<FitWithout> LibraryMatcher::fitByActuators(const Progress& progress) {
    return work_->fitByActuators(progress);
}
const Coverage& LibraryMatcher::coverage() const noexcept { return work_->coverage(); }
const BitColumns& LibraryMatcher::voxelsOf(std::size_t target) const { return work_->voxelsOf(target); }

} // namespace lumorph

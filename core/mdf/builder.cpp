#include "core/mdf/builder.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <string>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/mdf/sampling.h"
#include "core/rig/rig_file.h"

namespace lumorph {

namespace {

/// One part of the work: some rows of the columns that an actuator moves.
struct Slab {
    std::size_t actuator = 0;
    ColumnRange range;
};

/// A part's result: its share of the actuator's field.
struct SlabResult {
    ActuatorField field;
    std::vector<double> errorSums; ///< one a column, so that the sum of all does not depend on the parts
    double errorMax = 0.0;
    std::uint64_t changed = 0;
    std::uint64_t violations = 0;
};

/// In how many samples a voxel was first covered at each level.
class FirstLevels {
public:
    FirstLevels(std::size_t voxels, int levels)
        : levels_(static_cast<std::size_t>(levels)), counts_(voxels * levels_) {}
    void add(std::size_t voxel, int level) noexcept { ++counts_[voxel * levels_ + static_cast<std::size_t>(level)]; }

    /// The share of samples that cover the voxel at each level; false when it is the same at all.
    bool expectation(std::size_t voxel, std::size_t samples, std::vector<double>& out) const {
        const std::uint16_t* count = &counts_[voxel * levels_];
        std::size_t sum = 0;
        out.resize(levels_);
        for (std::size_t j = 0; j < levels_; ++j) {
            sum += count[j];
            out[j] = static_cast<double>(sum) / static_cast<double>(samples);
        }
        return sum > count[0];
    }

private:
    std::size_t levels_;
    std::vector<std::uint16_t> counts_;
};

/// How far the sampling is; one unit is one state of one slab at one level.
class SamplingProgress {
public:
    SamplingProgress(const Progress& progress, std::size_t units) : progress_(progress), units_(units) {
        progress_.report(0.0, kStage);
    }
    void done(std::size_t units) {
        constexpr std::size_t kReports = 1000;
        const std::size_t after = done_ += units;
        if (after * kReports / units_ != (after - units) * kReports / units_)
            progress_.report(static_cast<double>(after) / static_cast<double>(units_), kStage);
    }
    [[nodiscard]] bool cancelled() const noexcept { return progress_.cancelled(); }
    void throwIfCancelled() const { progress_.throwIfCancelled(); }

private:
    static constexpr const char* kStage = "sampling the field";
    const Progress& progress_;
    std::size_t units_;
    std::atomic<std::size_t> done_{0};
};

/// Parts as large as keeps all threads at work, for each deforms what it meets anew, and small enough that the level
/// counts of one take at most this much memory.
constexpr std::size_t kSlabBytes = std::size_t{32} << 20U;
constexpr int kSlabsPerThread = 3;

/// Into how many parts work is best divided.
int partsForAllThreads() {
    return kSlabsPerThread *
           static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}
int divideUp(int count, int by) { return (count + by - 1) / by; }

std::vector<Slab> slabsOf(const Coverage& coverage) {
    std::vector<Slab> slabs;
    int allRows = 0;
    for (std::size_t i = 0; i < coverage.rig().actuatorCount(); ++i) {
        const ColumnRange& range = coverage.columnsMovedBy(i);
        if (!range.empty()) allRows += range.z1 - range.z0 + 1;
    }
    for (std::size_t i = 0; i < coverage.rig().actuatorCount(); ++i) {
        const ColumnRange& all = coverage.columnsMovedBy(i);
        if (all.empty()) continue;
        const std::size_t rowBytes = static_cast<std::size_t>(all.width()) *
                                     static_cast<std::size_t>(coverage.frame().dimensions.y) *
                                     static_cast<std::size_t>(coverage.levels()) * sizeof(std::uint16_t);
        const int most = static_cast<int>(std::clamp<std::size_t>(kSlabBytes / rowBytes, 1, 1U << 20U));
        const int depth = all.z1 - all.z0 + 1;
        const int rows = divideUp(depth, divideUp(depth, std::min(most, divideUp(allRows, partsForAllThreads()))));
        for (int z = all.z0; z <= all.z1; z += rows)
            slabs.push_back({i, {all.x0, all.x1, z, std::min(all.z1, z + rows - 1)}});
    }
    return slabs;
}

/// Runs the actuator of a slab through its levels for every sampled state of the others. Coverage is
/// OR-ed over the levels within each sample, before anything is averaged (R10).
FirstLevels countFirstLevels(const Coverage& coverage, const Slab& slab, const std::vector<State>& states,
                             std::uint64_t& violations, CoverageScratch& scratch, SamplingProgress& progress) {
    const int height = coverage.frame().dimensions.y;
    const auto wordsPerColumn = static_cast<std::size_t>((height + 63) / 64);
    FirstLevels first(slab.range.size() * static_cast<std::size_t>(height), coverage.levels());
    const Coverage::Window window = coverage.window(slab.range);
    std::vector<std::uint64_t> words(slab.range.size() * wordsPerColumn);
    std::vector<std::uint64_t> seen(words.size());
    for (const State& sampled : states) {
        if (progress.cancelled()) return first;
        State state = sampled;
        std::fill(seen.begin(), seen.end(), 0);
        for (int level = 0; level < coverage.levels(); ++level) {
            state[slab.actuator] = Level{level};
            coverage.covered(state, window, words, scratch);
            for (std::size_t w = 0; w < words.size(); ++w) {
                violations += static_cast<std::uint64_t>(std::popcount(seen[w] & ~words[w]));
                std::uint64_t fresh = words[w] & ~seen[w];
                seen[w] |= words[w];
                const std::size_t voxel =
                    (w / wordsPerColumn) * static_cast<std::size_t>(height) + (w % wordsPerColumn) * 64;
                for (; fresh != 0; fresh &= fresh - 1)
                    first.add(voxel + static_cast<std::size_t>(std::countr_zero(fresh)), level);
            }
        }
        progress.done(static_cast<std::size_t>(coverage.levels()));
    }
    return first;
}

/// Column of the frame for a column of the slab.
std::uint32_t frameColumn(const Coverage& coverage, const ColumnRange& range, std::size_t local) {
    const auto width = static_cast<std::size_t>(range.width());
    return static_cast<std::uint32_t>(coverage.body().columnIndex(range.x0 + static_cast<int>(local % width),
                                                                  range.z0 + static_cast<int>(local / width)));
}

void addError(SlabResult& result, const Ramp& ramp, const std::vector<double>& expectation) {
    for (std::size_t j = 0; j < expectation.size(); ++j) {
        const double error = std::abs(expectationAt(ramp, static_cast<int>(j)) - expectation[j]);
        result.errorSums.back() += error;
        result.errorMax = std::max(result.errorMax, error);
    }
    ++result.changed;
}

SlabResult fitSlab(const Coverage& coverage, const Slab& slab, const FirstLevels& first, std::size_t samples) {
    SlabResult result;
    const auto height = static_cast<std::size_t>(coverage.frame().dimensions.y);
    std::vector<double> expectation;
    std::vector<Ramp> column(height);
    for (std::size_t c = 0; c < slab.range.size(); ++c) {
        std::size_t lowest = height;
        std::size_t highest = 0;
        result.errorSums.push_back(0.0);
        for (std::size_t y = 0; y < height; ++y) {
            column[y] = Ramp{};
            if (!first.expectation(c * height + y, samples, expectation)) continue;
            column[y] = fitRamp(expectation);
            if (column[y].v0 == kUnchanged) continue;
            addError(result, column[y], expectation);
            lowest = std::min(lowest, y);
            highest = y;
        }
        if (lowest == height) continue;
        result.field.runs.push_back({frameColumn(coverage, slab.range, c), static_cast<std::uint16_t>(lowest),
                                     static_cast<std::uint16_t>(highest - lowest + 1),
                                     static_cast<std::uint32_t>(result.field.ramps.size())});
        for (std::size_t y = lowest; y <= highest; ++y)
            result.field.ramps.push_back(column[y].v0 == kUnchanged ? Ramp{} : column[y]);
    }
    return result;
}

/// Mean coverage over the sampled states, in 1/255.
std::vector<std::uint8_t> meanCoverage(const Coverage& coverage, const std::vector<State>& states,
                                       SamplingProgress& progress) {
    const glm::ivec3 size = coverage.frame().dimensions;
    const auto height = static_cast<std::size_t>(size.y);
    const auto wordsPerColumn = static_cast<std::size_t>((size.y + 63) / 64);
    std::vector<std::uint8_t> background(coverage.frame().voxelCount());
    tbb::enumerable_thread_specific<CoverageScratch> scratches;
    const int rows = divideUp(size.z, partsForAllThreads());
    tbb::parallel_for(0, divideUp(size.z, rows), [&](int part) {
        const int z0 = part * rows;
        const Coverage::Window window = coverage.window({0, size.x - 1, z0, std::min(z0 + rows, size.z) - 1});
        std::vector<std::uint64_t> words(window.range.size() * wordsPerColumn);
        std::vector<std::uint32_t> counts(window.range.size() * height);
        for (const State& state : states) {
            if (progress.cancelled()) return;
            coverage.covered(state, window, words, scratches.local());
            for (std::size_t w = 0; w < words.size(); ++w)
                for (std::uint64_t bits = words[w]; bits != 0; bits &= bits - 1)
                    ++counts[(w / wordsPerColumn) * height + (w % wordsPerColumn) * 64 +
                             static_cast<std::size_t>(std::countr_zero(bits))];
            progress.done(static_cast<std::size_t>(std::min(rows, size.z - z0)));
        }
        const std::size_t start = coverage.body().columnIndex(0, z0) * height;
        for (std::size_t i = 0; i < counts.size(); ++i)
            background[start + i] = static_cast<std::uint8_t>(
                std::lround(255.0 * static_cast<double>(counts[i]) / static_cast<double>(states.size())));
    });
    return background;
}

/// Calls work(slab index, scratch) for every slab on all cores.
template <typename Work> void forEachSlab(std::size_t count, const SamplingProgress& progress, Work&& work) {
    tbb::enumerable_thread_specific<CoverageScratch> scratches;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t s) {
        if (progress.cancelled()) return;
        work(s, scratches.local());
    });
    progress.throwIfCancelled();
}

void check(const Rig& rig, const BuildOptions& options) {
    if (options.samples < 1 || options.samples > 65535)
        throw InvalidInput(std::to_string(options.samples) + " samples", "a build takes 1 to 65535 samples",
                           "give a number in that range; 64 is usual");
    if (rig.actuatorCount() == 0)
        throw InvalidInput("rig " + rig.name(), "it has no actuators", "give its nodes or morph targets actuators");
}

/// Puts the slabs of each actuator together, in order.
void assemble(Field& field, const Rig& rig, const std::vector<Slab>& slabs, std::vector<SlabResult>& results) {
    for (const Actuator& actuator : rig.actuators()) field.actuators.push_back({actuator.name, {}, {}});
    double errorSum = 0.0;
    for (std::size_t s = 0; s < slabs.size(); ++s) {
        ActuatorField& to = field.actuators[slabs[s].actuator];
        const auto offset = static_cast<std::uint32_t>(to.ramps.size());
        for (ActuatorField::Run run : results[s].field.runs) {
            run.firstRamp += offset;
            to.runs.push_back(run);
        }
        to.ramps.insert(to.ramps.end(), results[s].field.ramps.begin(), results[s].field.ramps.end());
        for (const double sum : results[s].errorSums) errorSum += sum;
        field.report.rampErrorMax = std::max(field.report.rampErrorMax, results[s].errorMax);
        field.report.changedVoxels += results[s].changed;
        field.report.monotonicityViolations += results[s].violations;
        results[s] = {};
    }
    const double terms = static_cast<double>(field.report.changedVoxels) * field.levels;
    field.report.rampErrorMean = terms > 0.0 ? errorSum / terms : 0.0;
}

} // namespace

std::vector<State> sampledStates(const Rig& rig, const BuildOptions& options) {
    const auto samples = static_cast<std::uint64_t>(options.samples);
    if (jointStateCount(rig.actuatorCount(), options.levels, samples + 1) <= samples)
        return allStates(rig.actuatorCount(), options.levels);
    return quasiRandomStates(rig.actuatorCount(), options.levels, samples, options.seed);
}

SampledField sampleField(const Coverage& coverage, const std::vector<State>& states, const Progress& progress) {
    const std::vector<Slab> slabs = slabsOf(coverage);
    SamplingProgress sampling(progress, slabs.size() * states.size() * static_cast<std::size_t>(coverage.levels()));
    std::vector<std::vector<SampledField::Voxel>> parts(slabs.size());
    const auto height = static_cast<std::size_t>(coverage.frame().dimensions.y);
    forEachSlab(slabs.size(), sampling, [&](std::size_t s, CoverageScratch& scratch) {
        std::uint64_t violations = 0;
        const FirstLevels first = countFirstLevels(coverage, slabs[s], states, violations, scratch, sampling);
        std::vector<double> expectation;
        for (std::size_t v = 0; v < slabs[s].range.size() * height; ++v)
            if (first.expectation(v, states.size(), expectation))
                parts[s].push_back(
                    {frameColumn(coverage, slabs[s].range, v / height), static_cast<int>(v % height), expectation});
    });
    SampledField sampled;
    sampled.actuators.resize(coverage.rig().actuatorCount());
    for (std::size_t s = 0; s < slabs.size(); ++s) {
        auto& to = sampled.actuators[slabs[s].actuator];
        to.insert(to.end(), std::make_move_iterator(parts[s].begin()), std::make_move_iterator(parts[s].end()));
    }
    return sampled;
}

Field buildField(const Rig& rig, const BuildOptions& options, const Progress& progress) {
    check(rig, options);
    const std::size_t threads = options.threads > 0
                                    ? static_cast<std::size_t>(options.threads)
                                    : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);

    Field field;
    field.frame = frameOf(rig.reach(), options.resolution);
    field.restSurface = boundingBox(rig.restMesh().positions).max.y;
    field.levels = options.levels;
    field.seed = options.seed;
    field.rigName = rig.name();
    field.rigGlb = writeRigGlb(rig);
    const Coverage coverage(rig, field.frame, options.levels);
    field.body = coverage.body();
    const std::vector<State> states = sampledStates(rig, options);
    field.samples = static_cast<std::uint32_t>(states.size());
    field.exhaustive = jointStateCount(rig.actuatorCount(), options.levels, states.size() + 1) == states.size();

    const std::vector<Slab> slabs = slabsOf(coverage);
    SamplingProgress sampling(progress, states.size() * (slabs.size() * static_cast<std::size_t>(options.levels) +
                                                         static_cast<std::size_t>(field.frame.dimensions.z)));
    std::vector<SlabResult> results(slabs.size());
    forEachSlab(slabs.size(), sampling, [&](std::size_t s, CoverageScratch& scratch) {
        std::uint64_t violations = 0;
        const FirstLevels first = countFirstLevels(coverage, slabs[s], states, violations, scratch, sampling);
        results[s] = fitSlab(coverage, slabs[s], first, states.size());
        results[s].violations = violations;
    });
    field.background = meanCoverage(coverage, states, sampling);
    progress.throwIfCancelled();
    assemble(field, rig, slabs, results);
    return field;
}

} // namespace lumorph

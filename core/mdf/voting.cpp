#include "core/mdf/voting.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "core/base/error.h"

namespace lumorph {

namespace {

/// Equal ramps over equal background are counted together.
struct RampClass {
    Ramp ramp;
    std::uint8_t background = 0;
    bool owned = false; ///< the background of these voxels is summed with this actuator's counts

    [[nodiscard]] std::uint64_t key() const noexcept {
        return (std::uint64_t{ramp.v0} << 40) | (std::uint64_t{ramp.v1} << 32) | (std::uint64_t{ramp.base} << 24) |
               (std::uint64_t{ramp.top} << 16) | (std::uint64_t{background} << 8) | (owned ? 1U : 0U);
    }
};

/// The voxels of one word of one column that an actuator changes.
struct Cell {
    std::uint32_t word = 0;
    std::uint32_t classOffset = 0; ///< the class of bit b is at classOffset + b, modulo 2^32
    std::uint64_t mask = 0;
};

struct CompiledActuator {
    std::vector<Cell> cells;
    std::vector<std::uint32_t> classOf;
    std::vector<RampClass> classes;
    std::vector<double> expectedTotal; ///< sum of V~(i,j) over the domain for each level, in 1/255
};

using Sums = Voting::Workspace::Sums;

void countClasses(const CompiledActuator& actuator, const std::uint64_t* target, std::uint32_t* counts) noexcept {
    const std::uint32_t* classOf = actuator.classOf.data();
    for (const Cell& cell : actuator.cells) {
        std::uint64_t bits = target[cell.word] & cell.mask;
        while (bits != 0) {
            const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
            ++counts[classOf[cell.classOffset + bit]];
            bits &= bits - 1;
        }
    }
}

/// Adds up level by level what the counted ramps hold. A ramp is piecewise linear, so each class adds
/// a start value and two changes of slope, and one running sum gives all levels.
void addUp(const CompiledActuator& actuator, const std::vector<std::uint32_t>& counts, int levels, Sums& sums) {
    sums.values.assign(static_cast<std::size_t>(levels) + 2, 0.0);
    sums.background = sums.ownedBackground = 0.0;
    sums.voxels = 0;
    double start = 0.0;
    for (std::size_t c = 0; c < actuator.classes.size(); ++c) {
        if (counts[c] == 0) continue;
        const RampClass& of = actuator.classes[c];
        const double n = counts[c];
        sums.voxels += counts[c];
        sums.background += n * of.background;
        if (of.owned) sums.ownedBackground += n * of.background;
        if (of.ramp.v0 == kUnchanged) continue;
        start += n * of.ramp.base;
        const double slope = n * (of.ramp.top - of.ramp.base) / (of.ramp.v1 - of.ramp.v0 + 1);
        sums.values[of.ramp.v0] += slope;
        sums.values[of.ramp.v1 + std::size_t{1}] -= slope;
    }
    double slope = 0.0;
    double value = start;
    for (int j = 0; j < levels; ++j) {
        slope += sums.values[static_cast<std::size_t>(j)];
        value += slope;
        sums.values[static_cast<std::size_t>(j)] = value;
    }
    sums.values.resize(static_cast<std::size_t>(levels));
}

/// `sum` - `part`, of which the part is never more. Where both are equal only rounding is left, of either sign: that is
/// zero, so that every level that fits exactly ties with the others.
double difference(double sum, double part) {
    constexpr double kRounding = 1e-12;
    const double left = sum - part;
    return left > kRounding * sum ? left : 0.0;
}

double ratioAt(const ActuatorVote& vote, std::size_t level) { return vote.errors[level] / vote.intersections[level]; }

/// The lowest point of the parabola through the ratios at `best` and its neighbours, in levels.
double betweenLevels(const ActuatorVote& vote, std::size_t best, double least) {
    if (best == 0 || best + 1 == vote.errors.size()) return static_cast<double>(best);
    if (vote.intersections[best - 1] < least || vote.intersections[best + 1] < least) return static_cast<double>(best);
    const double before = ratioAt(vote, best - 1);
    const double here = ratioAt(vote, best);
    const double after = ratioAt(vote, best + 1);
    const double curvature = before - 2.0 * here + after;
    if (!(curvature > 0.0)) return static_cast<double>(best);
    return static_cast<double>(best) + std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

void decide(ActuatorVote& vote, std::uint64_t reachable, const Level* last, double hysteresis) {
    constexpr double kTie = 1e-9;
    vote.level = Level{0};
    vote.reached = false;
    vote.stroke = 0.0;
    if (reachable == 0) return;
    const double least = std::max(1.0, 0.01 * static_cast<double>(reachable));
    double bestRatio = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < vote.errors.size(); ++j)
        if (vote.intersections[j] >= least) bestRatio = std::min(bestRatio, ratioAt(vote, j));
    if (!std::isfinite(bestRatio)) return;
    std::size_t best = 0;
    while (vote.intersections[best] < least || ratioAt(vote, best) > bestRatio * (1.0 + kTie)) ++best;
    if (last != nullptr) {
        const auto kept = static_cast<std::size_t>(last->index);
        if (kept < vote.errors.size() && vote.intersections[kept] >= least &&
            ratioAt(vote, kept) <= bestRatio * (1.0 + hysteresis))
            best = kept;
    }
    vote.level = Level{static_cast<int>(best)};
    vote.reached = true;
    vote.stroke = betweenLevels(vote, best, least) / static_cast<double>(vote.errors.size() - 1);
}

} // namespace

struct Voting::Compiled {
    int levels = 0;
    BitColumns domain;
    std::vector<CompiledActuator> actuators;
    /// Voxels that some states cover but no single actuator changes: background only.
    CompiledActuator shared;

    explicit Compiled(const Field& field);
    void addRun(CompiledActuator& to, std::map<std::uint64_t, std::uint32_t>& known, const Field& field,
                std::size_t column, int firstY, std::span<const Ramp> ramps, std::vector<bool>& owned) const;
    void addShared(const Field& field, const std::vector<bool>& owned);
};

void Voting::Compiled::addRun(CompiledActuator& to, std::map<std::uint64_t, std::uint32_t>& known, const Field& field,
                              std::size_t column, int firstY, std::span<const Ramp> ramps,
                              std::vector<bool>& owned) const {
    const bool backgroundOnly = &to == &shared;
    const std::size_t start = to.classOf.size();
    to.classOf.resize(start + ramps.size());
    for (std::size_t i = 0; i < ramps.size(); ++i) {
        if (!backgroundOnly && ramps[i].v0 == kUnchanged) continue;
        const int y = firstY + static_cast<int>(i);
        const std::size_t voxel =
            column * static_cast<std::size_t>(field.frame.dimensions.y) + static_cast<std::size_t>(y);
        if (backgroundOnly && (owned[voxel] || field.background[voxel] == 0)) continue;
        const RampClass made{ramps[i], field.background[voxel], !owned[voxel]};
        owned[voxel] = true;
        const auto [it, isNew] = known.try_emplace(made.key(), static_cast<std::uint32_t>(to.classes.size()));
        if (isNew) to.classes.push_back(made);
        to.classOf[start + i] = it->second;

        const auto word = static_cast<std::uint32_t>(column * static_cast<std::size_t>(domain.wordsPerColumn()) +
                                                     static_cast<std::size_t>(y >> 6));
        if (to.cells.empty() || to.cells.back().word != word) {
            const auto wordFirstY = static_cast<std::uint32_t>(y & ~63);
            to.cells.push_back(
                {word, static_cast<std::uint32_t>(start) + wordFirstY - static_cast<std::uint32_t>(firstY), 0});
        }
        to.cells.back().mask |= std::uint64_t{1} << (static_cast<unsigned>(y) & 63U);
    }
}

void Voting::Compiled::addShared(const Field& field, const std::vector<bool>& owned) {
    std::map<std::uint64_t, std::uint32_t> known;
    std::vector<bool> taken = owned;
    const std::vector<Ramp> none(static_cast<std::size_t>(field.frame.dimensions.y));
    for (std::size_t column = 0; column < domain.columnCount(); ++column)
        addRun(shared, known, field, column, 0, none, taken);
}

Voting::Compiled::Compiled(const Field& field) : levels(field.levels), domain(field.frame.dimensions) {
    for (int z = 0; z < field.frame.dimensions.z; ++z)
        for (int x = 0; x < field.frame.dimensions.x; ++x)
            for (int y = 0; y < field.frame.dimensions.y; ++y)
                if (!field.body.test(x, y, z)) domain.set(x, y, z);
    std::vector<bool> owned(field.frame.voxelCount());
    for (const ActuatorField& from : field.actuators) {
        CompiledActuator& to = actuators.emplace_back();
        std::map<std::uint64_t, std::uint32_t> known;
        for (const ActuatorField::Run& run : from.runs)
            addRun(to, known, field, run.column, run.firstY, std::span(from.ramps).subspan(run.firstRamp, run.count),
                   owned);
    }
    addShared(field, owned);
    double background = 0.0;
    for (const std::uint8_t value : field.background) background += value;
    std::vector<std::uint32_t> counts;
    Sums sums;
    for (CompiledActuator& to : actuators) {
        counts.assign(to.classes.size(), 0);
        countClasses(to, domain.words().data(), counts.data());
        addUp(to, counts, levels, sums);
        to.expectedTotal = sums.values;
        for (double& value : to.expectedTotal) value += background - sums.background;
    }
}

Voting::Voting(const Field& field) : compiled_(std::make_unique<const Compiled>(field)) {}
Voting::~Voting() = default;
Voting::Voting(Voting&&) noexcept = default;
Voting& Voting::operator=(Voting&&) noexcept = default;

int Voting::levels() const noexcept { return compiled_->levels; }

std::size_t Voting::bytes() const noexcept {
    std::size_t sum = 0;
    for (const CompiledActuator& actuator : compiled_->actuators)
        sum += actuator.cells.size() * sizeof(Cell) + actuator.classOf.size() * sizeof(std::uint32_t) +
               actuator.classes.size() * sizeof(RampClass);
    return sum;
}

void Voting::match(const BitColumns& target, Votes& votes, Workspace& workspace, const State* last,
                   double hysteresis) const {
    const Compiled& c = *compiled_;
    if (target.dimensions() != c.domain.dimensions())
        throw InvalidInput("target", "its voxel grid has another shape than the field's",
                           "voxelise it into the field's own frame");
    const auto levels = static_cast<std::size_t>(c.levels);
    votes.targetVoxels = target.countAnd(c.domain);
    votes.actuators.resize(c.actuators.size());
    const double targetUnits = 255.0 * static_cast<double>(votes.targetVoxels);

    workspace.counts.assign(c.shared.classes.size(), 0);
    countClasses(c.shared, target.words().data(), workspace.counts.data());
    addUp(c.shared, workspace.counts, c.levels, workspace.sums);
    double background = workspace.sums.ownedBackground;

    // First V~.V_T over the voxels each actuator changes; the shared background is complete only after
    // all have been counted, and is added in the second round.
    workspace.reachable.resize(c.actuators.size());
    for (std::size_t i = 0; i < c.actuators.size(); ++i) {
        workspace.counts.assign(c.actuators[i].classes.size(), 0);
        countClasses(c.actuators[i], target.words().data(), workspace.counts.data());
        addUp(c.actuators[i], workspace.counts, c.levels, workspace.sums);
        background += workspace.sums.ownedBackground;
        workspace.reachable[i] = workspace.sums.voxels;
        std::vector<double>& intersections = votes.actuators[i].intersections;
        intersections.resize(levels);
        for (std::size_t j = 0; j < levels; ++j)
            intersections[j] = workspace.sums.values[j] - workspace.sums.background;
    }
    for (std::size_t i = 0; i < c.actuators.size(); ++i) {
        ActuatorVote& vote = votes.actuators[i];
        vote.errors.resize(levels);
        for (std::size_t j = 0; j < levels; ++j) {
            const double intersection = vote.intersections[j] + background;
            vote.errors[j] = difference(c.actuators[i].expectedTotal[j] + targetUnits, 2.0 * intersection) / 255.0;
            vote.intersections[j] = intersection / 255.0;
        }
        decide(vote, workspace.reachable[i], last == nullptr ? nullptr : &(*last)[i], hysteresis);
    }
}

Votes Voting::match(const BitColumns& target) const {
    Votes votes;
    Workspace workspace;
    match(target, votes, workspace);
    return votes;
}

State Votes::state() const {
    State state;
    state.reserve(actuators.size());
    for (const ActuatorVote& vote : actuators) state.push_back(vote.level);
    return state;
}

} // namespace lumorph

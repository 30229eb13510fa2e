#include "core/mdf/voting.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include "core/base/error.h"

namespace lumorph {

namespace {

/// Some of the voxels of one word of the target, as a row of bytes: 255 where the target has the voxel, else 0.
struct Cell {
    std::uint32_t word = 0;
    std::uint8_t low = 0;    ///< the first bit
    std::uint8_t groups = 0; ///< of eight bits, and so of eight bytes
    std::uint64_t mask = 0;
};

/// A byte for each bit, in the order of the bits.
constexpr std::array<std::uint64_t, 256> kSpread = [] {
    std::array<std::uint64_t, 256> spread{};
    for (std::size_t bits = 0; bits < spread.size(); ++bits)
        for (unsigned b = 0; b < 8; ++b)
            if ((bits >> b & 1U) != 0) spread[bits] |= std::uint64_t{255} << (8 * b);
    return spread;
}();
static_assert(std::endian::native == std::endian::little, "bit 0 has to become the first byte");

/// The voxels of one actuator whose expectation rises between the same two levels.
struct RampClass {
    std::uint8_t v0 = 0;
    std::uint8_t v1 = 0;
    std::uint32_t chunks = 0;
    double share = 0.0; ///< of the rise that one level has
};

/// What one voxel adds to its class: how far it rises, what it has at level 0 more than in the background, and one to
/// the count. All three fit one word, which holds the sum of a whole chunk.
constexpr std::size_t kChunk = 16;
constexpr unsigned kCountBits = 5;   // 16
constexpr unsigned kSumBits = 13;    // 16 x 510
constexpr std::uint32_t kBias = 255; // a rise may be a fall

constexpr std::uint32_t packed(int rise, int start) {
    return ((static_cast<std::uint32_t>(rise + 255) << kSumBits | static_cast<std::uint32_t>(start + 255))
            << kCountBits) |
           1U;
}

struct CompiledActuator {
    std::vector<RampClass> classes;
    /// Class by class, whole chunks of them; the last of a class is filled up with voxel 0, which adds nothing.
    std::vector<std::uint32_t> voxels; ///< index into the bytes of all cells
    std::vector<std::uint32_t> values;
    std::vector<double> expectedTotal; ///< sum of V~(i,j) over the domain for each level, in 1/255
};

using Sums = Voting::Workspace::Sums;

struct ClassSums {
    std::int64_t rise = 0;
    std::int64_t start = 0;
    std::uint64_t voxels = 0;
};

/// Without a branch on the target: which bits it has cannot be foreseen, and a wrong guess costs more than ten voxels.
ClassSums sumOf(std::size_t chunks, const std::uint32_t* voxels, const std::uint32_t* values,
                const std::int8_t* bytes) noexcept {
    std::uint64_t rises = 0;
    std::uint64_t starts = 0;
    std::uint64_t count = 0;
    for (std::size_t c = 0; c < chunks; ++c, voxels += kChunk, values += kChunk) {
        std::uint32_t sum = 0;
        for (std::size_t k = 0; k < kChunk; ++k) sum += values[k] & static_cast<std::uint32_t>(bytes[voxels[k]]);
        count += sum & ((1U << kCountBits) - 1U);
        starts += sum >> kCountBits & ((1U << kSumBits) - 1U);
        rises += sum >> (kCountBits + kSumBits);
    }
    const auto bias = static_cast<std::int64_t>(kBias * count);
    return {static_cast<std::int64_t>(rises) - bias, static_cast<std::int64_t>(starts) - bias, count};
}

/// Adds up level by level what the target's voxels hold more than their background. A ramp is piecewise linear, so each
/// class adds a start value and two changes of slope, and one running sum gives all levels.
void addUp(const CompiledActuator& actuator, const std::vector<std::int8_t>& bytes, int levels, Sums& sums) {
    sums.values.assign(static_cast<std::size_t>(levels) + 2, 0.0);
    sums.voxels = 0;
    std::int64_t start = 0;
    std::size_t at = 0;
    for (const RampClass& of : actuator.classes) {
        const ClassSums sum = sumOf(of.chunks, &actuator.voxels[at], &actuator.values[at], bytes.data());
        at += of.chunks * kChunk;
        sums.voxels += sum.voxels;
        start += sum.start;
        const double slope = of.share * static_cast<double>(sum.rise);
        sums.values[of.v0] += slope;
        sums.values[of.v1 + std::size_t{1}] -= slope;
    }
    double slope = 0.0;
    auto value = static_cast<double>(start);
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
    std::vector<Cell> cells;              ///< all voxels that have a background or that an actuator changes
    std::vector<std::uint8_t> background; ///< P of each byte of the cells
    std::vector<CompiledActuator> actuators;

    explicit Compiled(const Field& field);
    void spread(const BitColumns& target, std::vector<std::int8_t>& bytes) const;
    [[nodiscard]] double backgroundOf(const std::vector<std::int8_t>& bytes) const noexcept;

private:
    /// The place of each voxel among the bytes of the cells, by Field::voxelIndex.
    using Places = std::vector<std::uint32_t>;
    static constexpr std::uint32_t kNowhere = ~0U;
    Places addCells(const Field& field);
    [[nodiscard]] CompiledActuator compiled(const Field& field, const ActuatorField& from, const Places& places) const;
};

/// One cell for each word that has such a voxel, from the lowest of them to the highest.
Voting::Compiled::Places Voting::Compiled::addCells(const Field& field) {
    BitColumns some(field.frame.dimensions);
    const auto wordsPerColumn = static_cast<std::size_t>(some.wordsPerColumn());
    const auto height = static_cast<std::size_t>(field.frame.dimensions.y);
    const auto add = [&](std::size_t column, std::size_t y) {
        some.words()[column * wordsPerColumn + y / 64] |= std::uint64_t{1} << (y % 64);
    };
    for (std::size_t column = 0; column < some.columnCount(); ++column)
        for (std::size_t y = 0; y < height; ++y)
            if (field.background[column * height + y] != 0) add(column, y);
    for (const ActuatorField& actuator : field.actuators)
        for (const ActuatorField::Run& run : actuator.runs)
            for (std::size_t i = 0; i < run.count; ++i)
                if (actuator.ramps[run.firstRamp + i].v0 != kUnchanged) add(run.column, run.firstY + i);
    some &= domain;

    Places places(field.frame.voxelCount(), kNowhere);
    for (std::size_t word = 0; word < some.words().size(); ++word) {
        const std::uint64_t mask = some.words()[word];
        if (mask == 0) continue;
        const auto low = static_cast<unsigned>(std::countr_zero(mask));
        const unsigned groups = (static_cast<unsigned>(std::bit_width(mask)) - low + 7) / 8;
        cells.push_back({static_cast<std::uint32_t>(word), static_cast<std::uint8_t>(low),
                         static_cast<std::uint8_t>(groups), mask});
        const std::size_t first = background.size();
        background.resize(first + std::size_t{8} * groups);
        const std::size_t voxel = word / wordsPerColumn * height + word % wordsPerColumn * 64;
        for (std::uint64_t bits = mask; bits != 0; bits &= bits - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(bits));
            places[voxel + bit] = static_cast<std::uint32_t>(first + bit - low);
            background[first + bit - low] = field.background[voxel + bit];
        }
    }
    return places;
}

CompiledActuator Voting::Compiled::compiled(const Field& field, const ActuatorField& from, const Places& places) const {
    std::map<std::pair<std::uint8_t, std::uint8_t>, std::vector<std::pair<std::uint32_t, std::uint32_t>>> byLevels;
    for (const ActuatorField::Run& run : from.runs)
        for (std::size_t i = 0; i < run.count; ++i) {
            const Ramp& ramp = from.ramps[run.firstRamp + i];
            if (ramp.v0 == kUnchanged) continue;
            const std::uint32_t place =
                places[run.column * static_cast<std::size_t>(field.frame.dimensions.y) + run.firstY + i];
            if (place == kNowhere) continue;
            byLevels[{ramp.v0, ramp.v1}].emplace_back(place,
                                                      packed(ramp.top - ramp.base, ramp.base - background[place]));
        }
    CompiledActuator made;
    for (const auto& [ends, voxels] : byLevels) {
        const std::size_t chunks = (voxels.size() + kChunk - 1) / kChunk;
        made.classes.push_back(
            {ends.first, ends.second, static_cast<std::uint32_t>(chunks), 1.0 / (ends.second - ends.first + 1)});
        for (const auto& [voxel, value] : voxels) {
            made.voxels.push_back(voxel);
            made.values.push_back(value);
        }
        made.voxels.resize((made.voxels.size() + kChunk - 1) / kChunk * kChunk);
        made.values.resize(made.voxels.size());
    }
    return made;
}

void Voting::Compiled::spread(const BitColumns& target, std::vector<std::int8_t>& bytes) const {
    bytes.resize(background.size());
    std::int8_t* to = bytes.data();
    const std::uint64_t* words = target.words().data();
    for (const Cell& cell : cells) {
        std::uint64_t bits = (words[cell.word] & cell.mask) >> cell.low;
        for (unsigned g = 0; g < cell.groups; ++g, bits >>= 8, to += 8) std::memcpy(to, &kSpread[bits & 255U], 8);
    }
}

double Voting::Compiled::backgroundOf(const std::vector<std::int8_t>& bytes) const noexcept {
    // Short sums of 16 bits, which a processor adds eight or sixteen at a time.
    constexpr std::size_t kBlock = 256;
    std::uint64_t sum = 0;
    for (std::size_t at = 0; at < bytes.size(); at += kBlock) {
        std::uint16_t block = 0;
        for (std::size_t i = at; i < std::min(at + kBlock, bytes.size()); ++i)
            block = static_cast<std::uint16_t>(block + (background[i] & static_cast<std::uint8_t>(bytes[i])));
        sum += block;
    }
    return static_cast<double>(sum);
}

Voting::Compiled::Compiled(const Field& field) : levels(field.levels), domain(field.frame.dimensions) {
    for (int z = 0; z < field.frame.dimensions.z; ++z)
        for (int x = 0; x < field.frame.dimensions.x; ++x)
            for (int y = 0; y < field.frame.dimensions.y; ++y)
                if (!field.body.test(x, y, z)) domain.set(x, y, z);
    const Places places = addCells(field);
    double total = 0.0;
    for (const std::uint8_t value : field.background) total += value;
    std::vector<std::int8_t> bytes;
    spread(domain, bytes);
    Sums sums;
    for (const ActuatorField& from : field.actuators) {
        CompiledActuator& to = actuators.emplace_back(compiled(field, from, places));
        addUp(to, bytes, levels, sums);
        to.expectedTotal = sums.values;
        for (double& value : to.expectedTotal) value += total;
    }
}

Voting::Voting(const Field& field) : compiled_(std::make_unique<const Compiled>(field)) {}
Voting::~Voting() = default;
Voting::Voting(Voting&&) noexcept = default;
Voting& Voting::operator=(Voting&&) noexcept = default;

int Voting::levels() const noexcept { return compiled_->levels; }

std::size_t Voting::bytes() const noexcept {
    std::size_t sum = compiled_->cells.size() * sizeof(Cell) + compiled_->background.size();
    for (const CompiledActuator& actuator : compiled_->actuators)
        sum += actuator.classes.size() * sizeof(RampClass) + 2 * actuator.voxels.size() * sizeof(std::uint32_t);
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

    c.spread(target, workspace.bytes);
    const double background = c.backgroundOf(workspace.bytes);
    for (std::size_t i = 0; i < c.actuators.size(); ++i) {
        addUp(c.actuators[i], workspace.bytes, c.levels, workspace.sums);
        ActuatorVote& vote = votes.actuators[i];
        vote.errors.resize(levels);
        vote.intersections.resize(levels);
        for (std::size_t j = 0; j < levels; ++j) {
            const double intersection = workspace.sums.values[j] + background;
            vote.errors[j] = difference(c.actuators[i].expectedTotal[j] + targetUnits, 2.0 * intersection) / 255.0;
            vote.intersections[j] = intersection / 255.0;
        }
        decide(vote, workspace.sums.voxels, last == nullptr ? nullptr : &(*last)[i], hysteresis);
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

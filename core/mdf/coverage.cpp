#include "core/mdf/coverage.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>
#include <string>

#include "core/base/error.h"
#include "core/mdf/rig_bodies.h"

namespace lumorph {

namespace {

/// The words of one group or body at each level of its only actuator, filled when first asked for.
struct Kept {
    std::vector<std::vector<std::uint64_t>> words; ///< [level][range.size() x words per column]
    std::unique_ptr<std::once_flag[]> ready;       ///< one a level
};

} // namespace

struct Coverage::Pieces {
    Rig rig;
    VoxelFrame frame;
    int levels;
    GridSnap snap;
    std::size_t wordsPerColumn = 0;
    std::uint64_t lastWordMask = 0;
    std::vector<RigBody> bodies;
    std::vector<std::vector<std::uint64_t>> still;     ///< one a body: parity of the part that stays, over body.range
    mutable std::vector<std::vector<Kept>> keptGroups; ///< [body][group]
    mutable std::vector<Kept> keptSweeps;              ///< [body], where one actuator sweeps it
    std::vector<ColumnRange> movedBy;
    Window everything;
    BitColumns body;
    BitColumns domain;

    Pieces(Rig rigIn, const VoxelFrame& frameIn, int levelsIn)
        : rig(std::move(rigIn)), frame(frameIn), levels(levelsIn), snap(frameIn, reachWithFrame()) {}

    [[nodiscard]] Box reachWithFrame() const {
        Box box = rig.reach();
        box.include(frame.box());
        return box;
    }
    void findMovedColumns();
    void allocateKept();
    void findBody();

    void rasterGroup(const RigGroup& group, std::span<const double> strokes, const ColumnRange& range,
                     std::span<std::uint64_t> out, CoverageScratch& scratch) const;
    std::span<const std::uint64_t> groupAtLevel(std::size_t body, std::size_t group, int level,
                                                CoverageScratch& scratch) const;
    std::span<const std::uint64_t> sweepAtLevel(std::size_t body, int level, CoverageScratch& scratch) const;
    void parityOfBody(const Window::Part& part, std::span<const Level> state, CoverageScratch& scratch) const;
    void parityOfBodyAt(std::size_t body, std::span<const double> strokes, const ColumnRange& range,
                        CoverageScratch& scratch) const;
    void sweepOfBody(std::size_t body, std::span<const double> strokes, const ColumnRange& range,
                     std::span<std::uint64_t> out, CoverageScratch& scratch) const;
    [[nodiscard]] Window windowOver(const ColumnRange& range) const;
    [[nodiscard]] int stepsOfBody(const RigBody& b, std::span<const double> strokes) const noexcept;
    void removeBodyAndTail(const ColumnRange& range, std::span<std::uint64_t> out) const;

    /// Calls row(source words, target words, count) for each row of columns that two ranges share.
    template <typename Row> void eachSharedRow(const ColumnRange& source, const ColumnRange& target, Row&& row) const {
        const ColumnRange shared = source.intersect(target);
        if (shared.empty()) return;
        const std::size_t count = static_cast<std::size_t>(shared.width()) * wordsPerColumn;
        for (int z = shared.z0; z <= shared.z1; ++z)
            row(offsetIn(source, shared.x0, z), offsetIn(target, shared.x0, z), count);
    }
    [[nodiscard]] std::size_t offsetIn(const ColumnRange& range, int x, int z) const noexcept {
        return (static_cast<std::size_t>(z - range.z0) * static_cast<std::size_t>(range.width()) +
                static_cast<std::size_t>(x - range.x0)) *
               wordsPerColumn;
    }
};

void Coverage::Pieces::findMovedColumns() {
    movedBy.resize(rig.actuatorCount());
    for (const RigBody& b : bodies) {
        if (b.sweeps()) {
            // A sweep mixes what all actuators of the body do on the way.
            for (const std::uint16_t actuator : b.actuators) movedBy[actuator].include(b.range);
            continue;
        }
        for (const RigGroup& group : b.groups)
            for (const std::uint16_t actuator : group.actuators) movedBy[actuator].include(group.range);
    }
}

void Coverage::Pieces::allocateKept() {
    const auto make = [&] {
        return Kept{std::vector<std::vector<std::uint64_t>>(static_cast<std::size_t>(levels)),
                    std::make_unique<std::once_flag[]>(static_cast<std::size_t>(levels))};
    };
    CoverageScratch scratch;
    const std::vector<double> rest(rig.actuatorCount(), 0.0);
    keptGroups.resize(bodies.size());
    keptSweeps.resize(bodies.size());
    still.resize(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        still[b].resize(bodies[b].range.size() * wordsPerColumn);
        rasterGroup(bodies[b].groups.front(), rest, bodies[b].range, still[b], scratch);
        keptGroups[b].resize(bodies[b].groups.size());
        if (bodies[b].sweeps()) {
            if (bodies[b].actuators.size() == 1) keptSweeps[b] = make();
            continue;
        }
        for (std::size_t g = 1; g < bodies[b].groups.size(); ++g)
            if (bodies[b].groups[g].actuators.size() == 1) keptGroups[b][g] = make();
    }
}

void Coverage::Pieces::findBody() {
    body = BitColumns(frame.dimensions);
    CoverageScratch scratch;
    const std::vector<double> rest(rig.actuatorCount(), 0.0);
    const ColumnRange all = columnsOf(frame);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        parityOfBodyAt(b, rest, bodies[b].range, scratch);
        eachSharedRow(bodies[b].range, all, [&](std::size_t from, std::size_t to, std::size_t count) {
            for (std::size_t i = 0; i < count; ++i) body.words()[to + i] |= scratch.parity[from + i];
        });
    }
    domain = BitColumns(frame.dimensions);
    for (std::size_t i = 0; i < domain.words().size(); ++i) {
        const bool last = (i + 1) % wordsPerColumn == 0;
        const std::uint64_t valid = last ? lastWordMask : ~std::uint64_t{0};
        body.words()[i] &= valid;
        domain.words()[i] = valid & ~body.words()[i];
    }
}

/// Adds (XOR) the crossings of one group to `out`, laid out over `range`.
void Coverage::Pieces::rasterGroup(const RigGroup& group, std::span<const double> strokes, const ColumnRange& range,
                                   std::span<std::uint64_t> out, CoverageScratch& scratch) const {
    const ColumnRange shared = group.range.intersect(range);
    if (shared.empty()) return;
    const std::size_t count = group.vertices->size();
    scratch.positions.resize(count);
    scratch.vertices.resize(count);
    group.vertices->deform(strokes, scratch.positions);
    for (std::size_t i = 0; i < count; ++i) scratch.vertices[i] = snap(scratch.positions[i]);
    const GridVertex* v = scratch.vertices.data();
    const auto rasterWith = [&](auto&& toggle) {
        for (const glm::uvec3& t : group.triangles)
            rasterizeTriangle(v[t.x], v[t.y], v[t.z], snap.shift(), shared, toggle);
    };
    const int height = frame.dimensions.y;
    const auto width = static_cast<std::size_t>(range.width());
    std::uint64_t* const first = out.data();
    const auto columnAt = [=](int x, int z) noexcept {
        return static_cast<std::size_t>(z - range.z0) * width + static_cast<std::size_t>(x - range.x0);
    };
    if (wordsPerColumn == 1) // the usual height, and this is the inner loop of every evaluation
        rasterWith([=](int x, int z, int level, bool) noexcept {
            if (level < height) first[columnAt(x, z)] ^= ~std::uint64_t{0} << static_cast<unsigned>(std::max(level, 0));
        });
    else
        rasterWith([=, words = wordsPerColumn](int x, int z, int level, bool) noexcept {
            if (level >= height) return;
            const auto bit = static_cast<unsigned>(std::max(level, 0));
            std::uint64_t* const column = first + columnAt(x, z) * words;
            column[bit >> 6U] ^= ~std::uint64_t{0} << (bit & 63U);
            for (std::size_t word = (bit >> 6U) + 1; word < words; ++word) column[word] = ~column[word];
        });
}

std::span<const std::uint64_t> Coverage::Pieces::groupAtLevel(std::size_t b, std::size_t g, int level,
                                                              CoverageScratch& scratch) const {
    const RigGroup& group = bodies[b].groups[g];
    Kept& kept = keptGroups[b][g];
    std::vector<std::uint64_t>& words = kept.words[static_cast<std::size_t>(level)];
    std::call_once(kept.ready[static_cast<std::size_t>(level)], [&] {
        words.resize(group.range.size() * wordsPerColumn);
        scratch.strokes.assign(rig.actuatorCount(), 0.0);
        scratch.strokes[group.actuators.front()] = strokeOf(Level{level}, levels);
        rasterGroup(group, scratch.strokes, group.range, words, scratch);
    });
    return words;
}

/// Everything a body with one actuator passed on its way to `level`.
std::span<const std::uint64_t> Coverage::Pieces::sweepAtLevel(std::size_t b, int level,
                                                              CoverageScratch& scratch) const {
    const RigBody& swept = bodies[b];
    Kept& kept = keptSweeps[b];
    std::vector<std::uint64_t>& words = kept.words[static_cast<std::size_t>(level)];
    std::call_once(kept.ready[static_cast<std::size_t>(level)], [&] {
        words.resize(swept.range.size() * wordsPerColumn);
        if (level == 0) return;
        const std::span<const std::uint64_t> before = sweepAtLevel(b, level - 1, scratch);
        std::copy(before.begin(), before.end(), words.begin());
        std::vector<double> strokes(rig.actuatorCount(), 0.0);
        const int steps = swept.stepsPerLevel(levels);
        for (int step = 1; step <= steps; ++step) {
            strokes[swept.actuators.front()] = (level - 1 + static_cast<double>(step) / steps) / (levels - 1);
            parityOfBodyAt(b, strokes, swept.range, scratch);
            for (std::size_t i = 0; i < words.size(); ++i) words[i] |= scratch.parity[i];
        }
    });
    return words;
}

/// scratch.parity = the body's solid at a joint state over part.range, from kept pieces where there are any.
void Coverage::Pieces::parityOfBody(const Window::Part& part, std::span<const Level> state,
                                    CoverageScratch& scratch) const {
    const RigBody& of = bodies[part.body];
    scratch.parity.resize(part.range.size() * wordsPerColumn);
    eachSharedRow(of.range, part.range, [&](std::size_t from, std::size_t to, std::size_t count) {
        std::copy_n(&still[part.body][from], count, &scratch.parity[to]);
    });
    for (const std::size_t g : part.groups) {
        const RigGroup& group = of.groups[g];
        if (group.actuators.size() == 1) {
            const auto words = groupAtLevel(part.body, g, state[group.actuators.front()].index, scratch);
            eachSharedRow(group.range, part.range, [&](std::size_t from, std::size_t to, std::size_t count) {
                for (std::size_t i = 0; i < count; ++i) scratch.parity[to + i] ^= words[from + i];
            });
            continue;
        }
        scratch.strokes.resize(rig.actuatorCount());
        for (const std::uint16_t a : group.actuators) scratch.strokes[a] = strokeOf(state[a], levels);
        rasterGroup(group, scratch.strokes, part.range, scratch.parity, scratch);
    }
}

/// scratch.parity = the body's solid at any strokes, all of it rasterised.
void Coverage::Pieces::parityOfBodyAt(std::size_t b, std::span<const double> strokes, const ColumnRange& range,
                                      CoverageScratch& scratch) const {
    scratch.parity.assign(range.size() * wordsPerColumn, 0);
    eachSharedRow(bodies[b].range, range, [&](std::size_t from, std::size_t to, std::size_t count) {
        std::copy_n(still[b].begin() + static_cast<std::ptrdiff_t>(from), count,
                    scratch.parity.begin() + static_cast<std::ptrdiff_t>(to));
    });
    for (std::size_t g = 1; g < bodies[b].groups.size(); ++g)
        rasterGroup(bodies[b].groups[g], strokes, range, scratch.parity, scratch);
}

Coverage::Window Coverage::Pieces::windowOver(const ColumnRange& range) const {
    Window made{range.intersect(columnsOf(frame)), {}};
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        Window::Part part{b, bodies[b].range.intersect(made.range), {}};
        if (part.range.empty() || bodies[b].actuators.empty()) continue;
        for (std::size_t g = 1; g < bodies[b].groups.size(); ++g)
            if (!bodies[b].groups[g].range.intersect(part.range).empty()) part.groups.push_back(g);
        made.parts.push_back(std::move(part));
    }
    return made;
}

int Coverage::Pieces::stepsOfBody(const RigBody& b, std::span<const double> strokes) const noexcept {
    // The slack keeps whole levels at whole multiples of the steps between two levels.
    constexpr double kSlack = 1e-6;
    if (!b.sweeps()) return 1;
    if (b.actuators.size() == 1)
        return static_cast<int>(
            std::ceil(b.stepsPerLevel(levels) * strokes[b.actuators.front()] * (levels - 1) - kSlack));
    double steps = 0.0;
    for (std::size_t i = 0; i < b.actuators.size(); ++i) steps += b.fullStrokeSteps[i] * strokes[b.actuators[i]];
    return static_cast<int>(std::ceil(steps - kSlack));
}

void Coverage::Pieces::sweepOfBody(std::size_t b, std::span<const double> strokes, const ColumnRange& range,
                                   std::span<std::uint64_t> out, CoverageScratch& scratch) const {
    const int steps = stepsOfBody(bodies[b], strokes);
    std::vector<double> onTheWay(rig.actuatorCount(), 0.0);
    for (int step = 1; step <= steps; ++step) {
        for (const std::uint16_t a : bodies[b].actuators)
            onTheWay[a] = strokes[a] * (static_cast<double>(step) / steps);
        parityOfBodyAt(b, onTheWay, range, scratch);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] |= scratch.parity[i];
    }
}

void Coverage::Pieces::removeBodyAndTail(const ColumnRange& range, std::span<std::uint64_t> out) const {
    eachSharedRow(columnsOf(frame), range, [&](std::size_t from, std::size_t to, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) out[to + i] &= domain.words()[from + i];
    });
}

Coverage::Coverage(Rig rig, const VoxelFrame& frame, int levels) {
    if (levels < 2 || levels > kMaxLevels)
        throw InvalidInput(std::to_string(levels) + " levels",
                           "an actuator has 2 to " + std::to_string(kMaxLevels) + " levels",
                           "give a number in that range");
    pieces_ = std::make_unique<Pieces>(std::move(rig), frame, levels);
    const int height = frame.dimensions.y;
    pieces_->wordsPerColumn = static_cast<std::size_t>((height + 63) / 64);
    pieces_->lastWordMask = height % 64 == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << (height % 64)) - 1;
    pieces_->bodies = bodiesOf(pieces_->rig, frame);
    pieces_->findMovedColumns();
    pieces_->allocateKept();
    pieces_->findBody();
    pieces_->everything = pieces_->windowOver(columnsOf(frame));
}

Coverage::~Coverage() = default;
Coverage::Coverage(Coverage&&) noexcept = default;
Coverage& Coverage::operator=(Coverage&&) noexcept = default;

const Rig& Coverage::rig() const noexcept { return pieces_->rig; }
const VoxelFrame& Coverage::frame() const noexcept { return pieces_->frame; }
int Coverage::levels() const noexcept { return pieces_->levels; }
const BitColumns& Coverage::body() const noexcept { return pieces_->body; }
const BitColumns& Coverage::domain() const noexcept { return pieces_->domain; }
const ColumnRange& Coverage::columnsMovedBy(std::size_t actuator) const noexcept { return pieces_->movedBy[actuator]; }

void Coverage::covered(std::span<const Level> state, BitColumns& out, CoverageScratch& scratch) const {
    if (out.dimensions() != pieces_->frame.dimensions) out = BitColumns(pieces_->frame.dimensions);
    covered(state, pieces_->everything, out.words(), scratch);
}

Coverage::Window Coverage::window(const ColumnRange& range) const { return pieces_->windowOver(range); }

void Coverage::covered(std::span<const Level> state, const Window& window, std::span<std::uint64_t> out,
                       CoverageScratch& scratch) const {
    std::fill(out.begin(), out.end(), 0);
    const auto unite = [&](const ColumnRange& source, std::span<const std::uint64_t> words) {
        pieces_->eachSharedRow(source, window.range, [&](std::size_t from, std::size_t to, std::size_t count) {
            for (std::size_t i = 0; i < count; ++i) out[to + i] |= words[from + i];
        });
    };
    for (const Window::Part& part : window.parts) {
        const RigBody& of = pieces_->bodies[part.body];
        if (!of.sweeps()) {
            pieces_->parityOfBody(part, state, scratch);
            unite(part.range, scratch.parity);
        } else if (of.actuators.size() == 1) {
            unite(of.range, pieces_->sweepAtLevel(part.body, state[of.actuators.front()].index, scratch));
        } else {
            scratch.swept.assign(part.range.size() * pieces_->wordsPerColumn, 0);
            std::vector<double> strokes(state.size());
            for (std::size_t i = 0; i < state.size(); ++i) strokes[i] = strokeOf(state[i], pieces_->levels);
            pieces_->sweepOfBody(part.body, strokes, part.range, scratch.swept, scratch);
            unite(part.range, scratch.swept);
        }
    }
    pieces_->removeBodyAndTail(window.range, out);
}

void Coverage::coveredAt(std::span<const double> strokes, BitColumns& out, CoverageScratch& scratch) const {
    if (out.dimensions() != pieces_->frame.dimensions) out = BitColumns(pieces_->frame.dimensions);
    out.clear();
    const ColumnRange all = columnsOf(pieces_->frame);
    for (std::size_t b = 0; b < pieces_->bodies.size(); ++b) {
        const RigBody& of = pieces_->bodies[b];
        if (of.actuators.empty()) continue;
        if (of.sweeps()) {
            pieces_->sweepOfBody(b, strokes, all, out.words(), scratch);
            continue;
        }
        pieces_->parityOfBodyAt(b, strokes, all, scratch);
        for (std::size_t i = 0; i < out.words().size(); ++i) out.words()[i] |= scratch.parity[i];
    }
    pieces_->removeBodyAndTail(all, out.words());
}

std::vector<std::uint8_t> Coverage::columnsChangedBy(std::size_t actuator) const {
    std::vector<std::uint8_t> changed(pieces_->domain.columnCount(), 0);
    CoverageScratch scratch;
    const ColumnRange all = columnsOf(pieces_->frame);
    const auto changesAll = [&](const ColumnRange& range) {
        pieces_->eachSharedRow(range, all, [&](std::size_t, std::size_t to, std::size_t count) {
            std::fill_n(changed.begin() + static_cast<std::ptrdiff_t>(to / pieces_->wordsPerColumn),
                        count / pieces_->wordsPerColumn, std::uint8_t{1});
        });
    };
    const auto compare = [&](const ColumnRange& range, auto&& wordsAt) {
        const std::span<const std::uint64_t> rest = wordsAt(0);
        for (int level = 1; level < pieces_->levels; ++level) {
            const std::span<const std::uint64_t> words = wordsAt(level);
            pieces_->eachSharedRow(range, all, [&](std::size_t from, std::size_t to, std::size_t count) {
                for (std::size_t i = 0; i < count; ++i)
                    if (((words[from + i] ^ rest[from + i]) & pieces_->domain.words()[to + i]) != 0)
                        changed[(to + i) / pieces_->wordsPerColumn] = 1;
            });
        }
    };
    for (std::size_t b = 0; b < pieces_->bodies.size(); ++b) {
        const RigBody& of = pieces_->bodies[b];
        if (!std::ranges::binary_search(of.actuators, static_cast<std::uint16_t>(actuator))) continue;
        if (of.sweeps()) {
            if (of.actuators.size() > 1)
                changesAll(of.range);
            else
                compare(of.range, [&](int level) { return pieces_->sweepAtLevel(b, level, scratch); });
            continue;
        }
        for (std::size_t g = 1; g < of.groups.size(); ++g) {
            const RigGroup& group = of.groups[g];
            if (!std::ranges::binary_search(group.actuators, static_cast<std::uint16_t>(actuator))) continue;
            if (group.actuators.size() > 1)
                changesAll(group.range);
            else
                compare(group.range, [&](int level) { return pieces_->groupAtLevel(b, g, level, scratch); });
        }
    }
    return changed;
}

std::vector<std::pair<std::size_t, std::size_t>> Coverage::coupledPairs() const {
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    const auto add = [&](const std::vector<std::uint16_t>& actuators) {
        for (std::size_t i = 0; i < actuators.size(); ++i)
            for (std::size_t j = i + 1; j < actuators.size(); ++j) pairs.emplace(actuators[i], actuators[j]);
    };
    for (const RigBody& body : pieces_->bodies) {
        if (body.sweeps()) add(body.actuators);
        for (const RigGroup& group : body.groups) add(group.actuators);
    }
    return {pairs.begin(), pairs.end()};
}

int Coverage::pathSteps(std::span<const double> strokes) const noexcept {
    int steps = 1;
    for (const RigBody& b : pieces_->bodies) steps = std::max(steps, pieces_->stepsOfBody(b, strokes));
    return steps;
}

std::size_t Coverage::bytes() const noexcept {
    std::size_t words = 0;
    const auto add = [&](const Kept& kept) {
        for (const auto& level : kept.words) words += level.size();
    };
    for (const auto& body : pieces_->still) words += body.size();
    for (const auto& body : pieces_->keptGroups)
        for (const Kept& kept : body) add(kept);
    for (const Kept& kept : pieces_->keptSweeps) add(kept);
    return words * sizeof(std::uint64_t);
}

FitQuality compareVolumes(const BitColumns& covered, const BitColumns& target) noexcept {
    FitQuality quality;
    quality.both = covered.countAnd(target);
    quality.unmatched = target.count() - quality.both;
    quality.overfilled = covered.count() - quality.both;
    return quality;
}

} // namespace lumorph

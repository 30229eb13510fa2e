#include "app/applications/ice/sheet.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>

#include "app/applications/ice/fracture.h"

namespace lumorph::ice {
namespace {

constexpr int kCells = 42;            ///< of a sheet without cracks
constexpr double kSliver = 4e-6;      ///< square metres: no smaller cell is made
constexpr double kLeastBond = 0.0001; ///< metres
constexpr double kLeastEdge = 0.0004; ///< metres: shorter ones of a melting rim become one
constexpr double kOnLine = 2e-6;      ///< metres

Segment edgeOf(const Polygon& outline, std::size_t k) { return {outline[k], outline[(k + 1) % outline.size()]}; }

glm::dvec2 middleOf(const Segment& edge) { return 0.5 * (edge.from + edge.to); }

bool touches(const Polygon& outline, const Polygon& shore) {
    return sharedEdge(outline, {shore.rbegin(), shore.rend()}).has_value();
}

} // namespace

Sheet::Sheet(const Polygon& shore, std::uint64_t seed) : shore_(shore), random_(seed), area_(areaOf(shore)) {
    const std::vector<glm::dvec2> sites = evenSites(shore, kCells, random_);
    for (Polygon& outline : voronoiCells(shore, sites)) {
        const bool ashore = touches(outline, shore);
        cells_.push_back({std::move(outline), 1.0, ashore});
    }
    for (int a = 0; a < std::ssize(cells_); ++a)
        for (int b = 0; b < a; ++b) join(a, b);
}

std::size_t Sheet::alive() const noexcept {
    return static_cast<std::size_t>(
        std::ranges::count_if(cells_, [](const Cell& cell) { return !cell.outline.empty(); }));
}

int Sheet::cellAt(int plate, const glm::dvec2& home) const noexcept {
    for (int k = 0; k < std::ssize(cells_); ++k) {
        const Cell& cell = cells_[static_cast<std::size_t>(k)];
        if (cell.plate == plate && holds(cell.outline, home)) return k;
    }
    return -1;
}

bool Sheet::isInside(int cell, const glm::dvec2& home) const noexcept {
    return std::ranges::any_of(bonds_, [&](const Bond& bond) {
        return (bond.a == cell || bond.b == cell) && distanceTo(bond.edge, home) < kOnLine;
    });
}

bool Sheet::isJoined(int cell, std::size_t edge) const noexcept {
    return isInside(cell, middleOf(edgeOf(cells_[static_cast<std::size_t>(cell)].outline, edge)));
}

/// Cells of an outline around sites; a site whose cell would be a sliver leaves it to the others.
std::vector<Polygon> Sheet::divided(const Polygon& outline, std::span<const glm::dvec2> sites) const {
    std::vector<glm::dvec2> kept(sites.begin(), sites.end());
    for (;;) {
        std::vector<Polygon> parts = voronoiCells(outline, kept);
        const auto count = std::ranges::count_if(parts, [](const Polygon& part) { return !part.empty(); });
        const auto sliver =
            std::ranges::find_if(parts, [](const Polygon& part) { return !part.empty() && areaOf(part) < kSliver; });
        if (sliver == parts.end() || count < 2) {
            std::erase_if(parts, [](const Polygon& part) { return part.empty(); });
            return parts;
        }
        kept.erase(kept.begin() + (sliver - parts.begin()));
    }
}

void Sheet::divide(int plate, const glm::dvec2& home, double reach, std::span<const glm::dvec2> sites) {
    if (alive() + 4 * sites.size() > kMost) return;
    std::vector<int> near, made, around;
    for (int k = 0; k < std::ssize(cells_); ++k) {
        const Cell& cell = cells_[static_cast<std::size_t>(k)];
        if (cell.outline.empty() || cell.plate != plate) continue;
        const bool isNear = holds(cell.outline, home) || glm::distance(nearestOnRim(cell.outline, home), home) < reach;
        (isNear ? near : around).push_back(k);
    }
    for (const int k : near) {
        const Cell parent = std::exchange(cells_[static_cast<std::size_t>(k)], Cell{});
        for (Polygon& outline : divided(parent.outline, sites)) {
            const bool ashore = parent.ashore && touches(outline, shore_);
            made.push_back(static_cast<int>(cells_.size()));
            cells_.push_back({std::move(outline), parent.thickness, ashore, plate});
        }
    }
    std::erase_if(bonds_, [&](const Bond& bond) {
        return std::ranges::find(near, bond.a) != near.end() || std::ranges::find(near, bond.b) != near.end();
    });
    for (auto a = made.begin(); a != made.end(); ++a) {
        for (auto b = made.begin(); b != a; ++b) join(*a, *b);
        for (const int b : around) join(*a, b);
    }
    for (const int b : around) ++cells_[static_cast<std::size_t>(b)].version;
    dirty_ = true;
}

void Sheet::join(int a, int b) {
    const auto edge =
        sharedEdge(cells_[static_cast<std::size_t>(a)].outline, cells_[static_cast<std::size_t>(b)].outline);
    if (edge && lengthOf(*edge) > kLeastBond) bonds_.push_back({a, b, *edge, 0.6 + 0.8 * chance(random_), 0.0});
}

void Sheet::breakBond(std::size_t bond) {
    const Bond broken = bonds_[bond];
    bonds_.erase(bonds_.begin() + static_cast<std::ptrdiff_t>(bond));
    drawBack(broken.a, broken.edge);
    drawBack(broken.b, broken.edge);
    dirty_ = true;
}

/// The whole edge of which this is a part.
void Sheet::drawBack(int cell, const Segment& edge) {
    const Polygon& outline = cells_[static_cast<std::size_t>(cell)].outline;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const Segment own = edgeOf(outline, k);
        if (distanceTo(own, edge.from) > kOnLine || distanceTo(own, edge.to) > kOnLine) continue;
        take(cell, clipped(outline, insideOf(own.from, own.to, kGap)));
        return;
    }
}

void Sheet::breakFromShore(int cell) {
    cells_[static_cast<std::size_t>(cell)].ashore = false;
    for (std::size_t k = 0; k < shore_.size(); ++k) {
        const Segment bank = edgeOf(shore_, k);
        take(cell, clipped(cells_[static_cast<std::size_t>(cell)].outline, insideOf(bank.from, bank.to, kGap)));
    }
    dirty_ = true;
}

void Sheet::cut(int cell, const HalfPlane& half) {
    Polygon outline = clipped(cells_[static_cast<std::size_t>(cell)].outline, half);
    simplify(cell, outline);
    take(cell, std::move(outline));
}

/// Leaves out corners of a rim that melts until none of its edges is short; a smaller polygon comes of it.
void Sheet::simplify(int cell, Polygon& outline) const {
    const auto isFree = [&](std::size_t k) { return !isInside(cell, middleOf(edgeOf(outline, k))); };
    for (std::size_t k = 0; k < outline.size() && outline.size() > 3;) {
        const std::size_t before = (k + outline.size() - 1) % outline.size();
        const bool isShort = lengthOf(edgeOf(outline, k)) < kLeastEdge;
        if (isShort && isFree(k) && isFree(before))
            outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(k));
        else
            ++k;
    }
}

/// A smaller outline for a cell; what it no longer holds has melted.
void Sheet::take(int cell, Polygon outline) {
    Cell& changed = cells_[static_cast<std::size_t>(cell)];
    if (areaOf(outline) < 0.25 * kSliver) outline.clear();
    melted_ += areaOf(changed.outline) - areaOf(outline);
    changed.outline = std::move(outline);
    ++changed.version;
    dropLostBonds(cell);
    if (changed.outline.empty()) dirty_ = true;
}

/// Bonds of a cell that has become smaller: along a shorter edge, or gone.
void Sheet::dropLostBonds(int cell) {
    const auto lost = std::erase_if(bonds_, [&](Bond& bond) {
        if (bond.a != cell && bond.b != cell) return false;
        Cell &a = cells_[static_cast<std::size_t>(bond.a)], &b = cells_[static_cast<std::size_t>(bond.b)];
        const auto edge = sharedEdge(a.outline, b.outline);
        if (edge && lengthOf(*edge) > kLeastBond) {
            bond.edge = *edge;
            return false;
        }
        ++a.version;
        ++b.version;
        return true;
    });
    if (lost > 0) dirty_ = true;
}

void Sheet::thin(int cell, double share) {
    Cell& melting = cells_[static_cast<std::size_t>(cell)];
    melting.thickness = std::max(0.0, melting.thickness - share);
}

void Sheet::remove(int cell) { take(cell, {}); }

std::vector<std::vector<int>> Sheet::gatherPlates() {
    std::vector<int> root(cells_.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int k) {
        while (root[static_cast<std::size_t>(k)] != k) k = root[static_cast<std::size_t>(k)];
        return k;
    };
    for (const Bond& bond : bonds_) {
        const int a = find(bond.a), b = find(bond.b);
        root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
    std::vector<std::vector<int>> plates;
    std::vector<int> numbers(cells_.size(), -1);
    for (int k = 0; k < std::ssize(cells_); ++k) {
        Cell& cell = cells_[static_cast<std::size_t>(k)];
        cell.plate = -1;
        if (cell.outline.empty()) continue;
        int& number = numbers[static_cast<std::size_t>(find(k))];
        if (number < 0) {
            number = static_cast<int>(plates.size());
            plates.emplace_back();
        }
        cell.plate = number;
        plates[static_cast<std::size_t>(number)].push_back(k);
    }
    dirty_ = false;
    return plates;
}

} // namespace lumorph::ice

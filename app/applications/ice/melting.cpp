#include "app/applications/ice/melting.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "app/applications/ice/fracture.h"

namespace lumorph::ice {
namespace {

constexpr double kThinning = 1.0;     ///< of thickness a second
constexpr double kDrawsBack = 0.0055; ///< of a rim in the middle of warmth, metres a second
constexpr double kSmall = 24e-6;      ///< square metres: smaller cells vanish as a whole
constexpr double kReach = 0.008;      ///< metres around a hole that is about to be: its cells are divided
constexpr double kThin = 0.55;        ///< of thickness: what is thinner gets a hole

/// What lies right under it. True when that came to be a hole, or the beginnings of one.
bool meltThrough(Sheet& sheet, int cell, const glm::dvec2& home, double depth, std::mt19937_64& random) {
    sheet.thin(cell, depth);
    const auto under = [&]() -> const Cell& { return sheet.cells()[static_cast<std::size_t>(cell)]; };
    const bool isSmall = areaOf(under().outline) < kSmall;
    if (!isSmall && under().thickness <= kThin) {
        sheet.divide(under().plate, home, kReach, holeSites(home, random));
        if (under().outline.empty()) return true;
    }
    // Where no more cells are to be had, it goes as it is.
    if (under().thickness > 0.0) return false;
    sheet.remove(cell);
    return true;
}

/// A rim beside it.
void meltRim(Sheet& sheet, int cell, const glm::dvec2& home, const glm::dvec2& nearest, double depth) {
    const double distance = glm::distance(home, nearest);
    if (distance < 1e-7 || sheet.isInside(cell, nearest)) return;
    const glm::dvec2 back = (home - nearest) / distance;
    sheet.cut(cell, {back, glm::dot(back, nearest) - depth});
}

} // namespace

bool melt(Sheet& sheet, int plate, const Placement& placement, std::span<const Warmth> warmths, double seconds,
          std::mt19937_64& random) {
    bool gone = false;
    for (const Warmth& warmth : warmths) {
        const glm::dvec2 home = homeOf(placement, warmth.place);
        const auto count = static_cast<int>(sheet.cells().size());
        for (int k = 0; k < count; ++k) {
            const Cell& cell = sheet.cells()[static_cast<std::size_t>(k)];
            if (cell.outline.empty() || cell.plate != plate) continue;
            if (holds(cell.outline, home)) {
                gone = meltThrough(sheet, k, home, kThinning * warmth.power * seconds, random) || gone;
                continue;
            }
            const glm::dvec2 nearest = nearestOnRim(cell.outline, home);
            const double near = 1.0 - glm::distance(nearest, home) / warmth.radius;
            if (near > 0.0) meltRim(sheet, k, home, nearest, kDrawsBack * warmth.power * near * seconds);
        }
    }
    return gone;
}

void thaw(Sheet& sheet, std::span<const int> cells, double depth) {
    for (const int k : cells) {
        const Polygon before = sheet.cells()[static_cast<std::size_t>(k)].outline;
        for (std::size_t edge = 0; edge < before.size(); ++edge) {
            const glm::dvec2 &from = before[edge], &to = before[(edge + 1) % before.size()];
            if (sheet.cells()[static_cast<std::size_t>(k)].outline.empty()) break;
            if (!sheet.isInside(k, 0.5 * (from + to))) sheet.cut(k, insideOf(from, to, depth));
        }
    }
}

} // namespace lumorph::ice

#include "app/applications/ice/cracks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "app/applications/ice/fracture.h"

namespace lumorph::ice {
namespace {

constexpr double kAtTip = 0.0012;       ///< metres: bonds that end nearer can be the next
constexpr double kStraight = 0.15;      ///< cosine of the sharpest bend
constexpr double kFork = 0.12;          ///< chance of a fork at each bond
constexpr double kShoreLoosens = 0.016; ///< metres around the end of a crack at the bank

glm::dvec2 turned(const glm::dvec2& v, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// Where a crack meets the bank the ice comes off it.
void loosen(Sheet& sheet, const Polygon& shore, const glm::dvec2& at) {
    if (glm::distance(nearestOnRim(shore, at), at) > kAtTip) return;
    for (int k = 0; k < std::ssize(sheet.cells()); ++k) {
        const Cell& cell = sheet.cells()[static_cast<std::size_t>(k)];
        if (cell.ashore && !cell.outline.empty() && glm::distance(nearestOnRim(cell.outline, at), at) < kShoreLoosens)
            sheet.breakFromShore(k);
    }
}

} // namespace

void Cracks::start(const glm::dvec2& home, const glm::dvec2& direction, double length) {
    tips_.push_back({home, direction, length, 0.0});
}

bool Cracks::advance(Sheet& sheet, const Polygon& shore, double seconds) {
    bool broke = false;
    std::vector<Tip> forks;
    std::erase_if(tips_, [&](Tip& tip) {
        tip.waits -= seconds;
        while (tip.waits <= 0.0) {
            if (!run(tip, sheet, forks)) {
                loosen(sheet, shore, tip.at);
                return true;
            }
            broke = true;
        }
        return false;
    });
    tips_.insert(tips_.end(), forks.begin(), forks.end());
    return broke;
}

/// Breaks the bond that lies ahead; false where there is none.
bool Cracks::run(Tip& tip, Sheet& sheet, std::vector<Tip>& forks) {
    std::size_t chosen = sheet.bonds().size();
    double best = kStraight;
    glm::dvec2 end(0.0);
    for (std::size_t k = 0; k < sheet.bonds().size(); ++k) {
        const Segment& edge = sheet.bonds()[k].edge;
        for (const auto& [from, to] : {std::pair(edge.from, edge.to), std::pair(edge.to, edge.from)}) {
            if (glm::distance(from, tip.at) > kAtTip) continue;
            const double straight = glm::dot(glm::normalize(to - from), tip.direction) + 0.2 * (chance(random_) - 0.5);
            if (straight <= best) continue;
            best = straight;
            chosen = k;
            end = to;
        }
    }
    if (chosen == sheet.bonds().size() || tip.left <= 0.0) return false;
    const double length = glm::distance(tip.at, end);
    const glm::dvec2 way = length > 0.0 ? (end - tip.at) / length : tip.direction;
    sheet.breakBond(chosen);
    tip.at = end;
    tip.direction = glm::normalize(tip.direction + 0.35 * way);
    tip.left -= length;
    tip.waits += length / kSpeed;
    if (chance(random_) < kFork) {
        const double side = chance(random_) < 0.5 ? -1.0 : 1.0;
        forks.push_back({end, turned(tip.direction, side * 0.3 * std::numbers::pi), 0.6 * tip.left, tip.waits});
        tip.left *= 0.8;
    }
    return true;
}

} // namespace lumorph::ice

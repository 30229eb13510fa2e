#include "app/applications/labyrinth/route.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/labyrinth/game.h"

namespace lumorph::labyrinth {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kLevel = 0.0002;   ///< heights that differ by less are level, metres
constexpr double kMostDrop = 0.012; ///< metres
constexpr double kDropCost = 4.0;
constexpr double kNearHole = 6.0, kAtCorner = 3.0;

int index(int columns, const Spot& spot) { return 2 * (spot.cell.y * columns + spot.cell.x) + (spot.deck ? 1 : 0); }

/// The height at a side of a spot; none where one can neither go in nor out.
std::optional<double> sideOf(const Level& level, const Spot& spot, Way side) {
    if (!spot.deck) return groundAt(level, spot.cell, side);
    if (isAcross(level.at(spot.cell).way) != isAcross(side)) return std::nullopt; // rails
    return deckOf(level, spot.cell);
}

/// What it costs to be near what one can fall into.
double danger(const Level& level, glm::ivec2 cell) {
    double cost = 0.0;
    for (int dz = -1; dz <= 1; ++dz)
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::ivec2 beside = cell + glm::ivec2(dx, dz);
            if (level.holds(beside) && level.at(beside).tile == Tile::hole)
                cost += dx != 0 && dz != 0 ? kAtCorner : kNearHole;
        }
    return cost;
}

/// The cost of a step from one spot over a side into the next; infinite where it cannot be done.
double stepCost(const Level& level, const Spot& from, Way way, const Spot& to) {
    const std::optional<double> out = sideOf(level, from, way);
    const std::optional<double> in = sideOf(level, to, opposite(way));
    if (!out || !in || *in - *out > kLevel || *out - *in > kMostDrop) return kNone;
    const LevelCell& entered = level.at(to.cell);
    const bool fromBelow = !from.deck && level.at(from.cell).tile == Tile::bridge;
    const bool underDeck = !to.deck && entered.tile == Tile::bridge && isAcross(entered.way) == isAcross(way);
    if (underDeck && !fromBelow) return kNone;                                        // its deck is in the way
    if (!to.deck && entered.tile == Tile::stairs && entered.way == way) return kNone; // too steep
    return 1.0 + (*out - *in > kLevel ? kDropCost : 0.0) + danger(level, to.cell);
}

} // namespace

/// Dijkstra's search from the target backwards.
class RouteSearch {
public:
    RouteSearch(const Level& level, Routes& routes) : level_(level), routes_(routes) {}

    void run(const Spot& target) {
        reach(target, 0.0, -1);
        while (!open_.empty()) {
            const auto [cost, at] = open_.top();
            open_.pop();
            const Spot to{{at / 2 % level_.columns, at / 2 / level_.columns}, at % 2 == 1};
            if (cost > routes_.costs_[static_cast<std::size_t>(at)]) continue;
            for (const Way way : kWays) comeFrom(to, way, cost);
        }
    }

private:
    void comeFrom(const Spot& to, Way way, double cost) {
        const glm::ivec2 cell = to.cell - stepOf(way);
        if (!level_.holds(cell) || cell == level_.goal) return;
        for (const bool deck : {false, true}) {
            if (deck && level_.at(cell).tile != Tile::bridge) continue;
            const Spot from{cell, deck};
            const double whole = cost + stepCost(level_, from, way, to);
            if (whole < routes_.cost(from)) reach(from, whole, index(level_.columns, to));
        }
    }
    void reach(const Spot& spot, double cost, int next) {
        const int at = index(level_.columns, spot);
        routes_.costs_[static_cast<std::size_t>(at)] = cost;
        routes_.next_[static_cast<std::size_t>(at)] = next;
        open_.emplace(cost, at);
    }

    const Level& level_;
    Routes& routes_;
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open_;
};

Routes::Routes(const Level& level, glm::ivec2 target)
    : columns_(level.columns), costs_(2 * level.cells.size(), kNone), next_(2 * level.cells.size(), -1) {
    RouteSearch(level, *this).run({target, false});
}

std::optional<Spot> Routes::next(const Spot& from) const {
    const int at = next_[static_cast<std::size_t>(index(columns_, from))];
    if (at < 0) return std::nullopt;
    return Spot{{at / 2 % columns_, at / 2 / columns_}, at % 2 == 1};
}

double Routes::cost(const Spot& from) const { return costs_[static_cast<std::size_t>(index(columns_, from))]; }

std::optional<Spot> spotOf(const Level& level, const glm::dvec3& ball) {
    const glm::ivec2 cell = cellAt(level, {ball.x, ball.z});
    if (!level.holds(cell)) return std::nullopt;
    const Tile tile = level.at(cell).tile;
    if (tile == Tile::wall || tile == Tile::hole) return std::nullopt;
    const std::optional<double> deck = deckOf(level, cell);
    return Spot{cell, deck && ball.y > *deck};
}

namespace {

constexpr double kFast = 0.14, kSlow = 0.07; ///< metres a second
constexpr double kHaste = 9.0;               ///< a second: acceleration by wanted change of speed
constexpr double kInto = 6.0;                ///< a second: speed by distance from the middle line
constexpr double kRolling = 5.0 / 7.0;       ///< of the slide's acceleration is left to a ball that rolls

/// Rise over run that the ball has to climb on its way over a cell.
double slopeAlong(const Level& level, const Spot& spot, Way way) {
    const std::optional<double> in = sideOf(level, spot, opposite(way)), out = sideOf(level, spot, way);
    return in && out ? (*out - *in) / level.cell : 0.0;
}

Way wayOf(const glm::ivec2& step) {
    return step.x > 0 ? Way::right : step.x < 0 ? Way::left : step.y > 0 ? Way::down : Way::up;
}

} // namespace

Pilot::Pilot(const Level& level, bool collect) : level_(level), collect_(collect), goal_(level, level.goal) {
    last_ = {level.start, false};
}

bool Pilot::isStraight(const Routes& routes, const Spot& from, const Spot& to) const {
    const std::optional<Spot> after = routes.next(to);
    return after && after->cell - to.cell == to.cell - from.cell && danger(level_, to.cell) == 0.0;
}

/// To the cheapest pick-up from which the goal is still reached; found anew when one was taken.
const Routes& Pilot::target(const Spot& spot, const std::vector<glm::ivec2>& pickUps) {
    if (!collect_) return goal_;
    if (fetched_ && std::ranges::find(pickUps, *fetched_) != pickUps.end() && toFetched_->cost(spot) < kNone)
        return *toFetched_;
    fetched_.reset();
    double least = kNone;
    for (const glm::ivec2 pickUp : pickUps) {
        if (goal_.cost({pickUp, false}) == kNone) continue;
        Routes routes(level_, pickUp);
        if (routes.cost(spot) >= least) continue;
        least = routes.cost(spot);
        fetched_ = pickUp;
        toFetched_ = std::move(routes);
    }
    return fetched_ ? *toFetched_ : goal_;
}

glm::dvec2 Pilot::lean(const Ball& ball, const std::vector<glm::ivec2>& pickUps) {
    // Over a hole's or wall's edge the ball still belongs to the cell before.
    const Spot spot = spotOf(level_, ball.position).value_or(last_);
    last_ = spot;
    const Routes& routes = target(spot, pickUps);
    const std::optional<Spot> next = routes.next(spot);
    const Spot& to = next ? *next : spot;
    const glm::dvec2 at(ball.position.x, ball.position.z), moves(ball.velocity.x, ball.velocity.z);
    const glm::dvec2 ahead = centreOf(level_, to.cell) - at;
    const glm::ivec2 step = to.cell - spot.cell;
    glm::dvec2 wanted = kInto * ahead;
    double climb = 0.0;
    if (next) {
        const Way way = wayOf(step);
        const glm::dvec2 along(step);
        const double speed = isStraight(routes, spot, to) ? kFast : kSlow;
        // First to the middle line, then along it.
        const glm::dvec2 aside = ahead - glm::dot(ahead, along) * along;
        const double share = glm::clamp(1.0 - glm::length(aside) / (0.35 * level_.cell), 0.0, 1.0);
        wanted = kInto * aside + speed * share * along;
        climb = Game::kGravity * slopeAlong(level_, spot, way);
        const glm::dvec2 pull = kHaste / kRolling * (wanted - moves) + climb * along;
        return glm::atan(pull / Game::kGravity);
    }
    return glm::atan(kHaste / kRolling * (wanted - moves) / Game::kGravity);
}

} // namespace lumorph::labyrinth

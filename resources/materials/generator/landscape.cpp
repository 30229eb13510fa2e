#include "resources/materials/generator/landscape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph {
namespace {

constexpr int kSide = kTextureSide;
constexpr std::array<glm::ivec2, 8> kAround = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

glm::ivec2 wrapped(glm::ivec2 at) { return (at % kSide + kSide) % kSide; }

/// Hills, with ridges where it is high.
Heights ground() {
    Heights heights = drawn([](glm::vec2 at) {
        const glm::vec2 warped = at + 0.05F * glm::vec2(cloudy(at, {4, 4}, 2, 3), cloudy(at, {4, 4}, 2, 4));
        const float land = cloudy(warped, {2, 2}, 6, 12, 0.46F);
        const float ridge = 1.0F - std::abs(cloudy(warped, {5, 5}, 4, 18, 0.45F)) * 2.6F;
        return land + 0.22F * ridge * smooth(-0.05F, 0.35F, land);
    });
    heights = blurred(heights, 3);
    normalize(heights);
    return heights;
}

struct Entry {
    float level;
    glm::ivec2 at;
    bool operator>(const Entry& other) const { return level > other.level; }
};
using Rising = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;

/// Fills hollows from the sea upwards, and remembers for each place where its water runs: every river reaches the sea.
std::vector<glm::ivec2> drains(const Heights& heights, std::vector<std::size_t>& order) {
    std::vector<glm::ivec2> to(heights.values().size(), glm::ivec2(-1));
    std::vector<bool> seen(heights.values().size(), false);
    Rising open;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            if (heights.at(x, y) >= kSeaLevel) continue;
            seen[heights.index(x, y)] = true;
            open.push({heights.at(x, y), {x, y}});
        }
    }
    while (!open.empty()) {
        const Entry low = open.top();
        open.pop();
        order.push_back(heights.index(low.at.x, low.at.y));
        for (const glm::ivec2& step : kAround) {
            const glm::ivec2 next = wrapped(low.at + step);
            const std::size_t index = heights.index(next.x, next.y);
            if (seen[index]) continue;
            seen[index] = true;
            to[index] = low.at;
            open.push({std::max(heights.at(next.x, next.y), low.level + 1e-5F), next});
        }
    }
    return to;
}

Heights rivers(const Heights& heights) {
    std::vector<std::size_t> order;
    const std::vector<glm::ivec2> to = drains(heights, order);
    std::vector<float> water(to.size(), 1.0F);
    for (auto at = order.rbegin(); at != order.rend(); ++at)
        if (to[*at].x >= 0) water[heights.index(to[*at].x, to[*at].y)] += water[*at];
    Heights width(kSide);
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const std::size_t index = heights.index(x, y);
            if (to[index].x < 0 || water[index] < 640.0F) continue;
            width.at(x, y) = std::min(3.2F, 0.75F + 0.022F * std::sqrt(water[index]));
        }
    }
    return width;
}

/// Towns on gentle ground, away from each other.
std::vector<glm::ivec2> townsOf(const Heights& heights) {
    std::vector<glm::ivec2> towns;
    for (std::uint32_t i = 0; i < 4000 && towns.size() < 11; ++i) {
        const glm::ivec2 at(static_cast<int>(hashed(i, 0, 7) * kSide), static_cast<int>(hashed(i, 1, 7) * kSide));
        const float level = heights.at(at.x, at.y);
        const float slope = std::abs(heights.at(at.x + 4, at.y) - level) + std::abs(heights.at(at.x, at.y + 4) - level);
        if (level < kSeaLevel + 0.02F || level > 0.66F || slope > 0.025F) continue;
        const bool alone = std::ranges::all_of(towns, [at](const glm::ivec2& other) {
            glm::ivec2 d = glm::abs(at - other);
            d = glm::min(d, kSide - d);
            return glm::length(glm::vec2(d)) > 85.0F;
        });
        if (alone) towns.push_back(at);
    }
    return towns;
}

/// The way from one town to another that climbs least; nothing where the sea lies between.
void addRoad(const Heights& heights, glm::ivec2 from, glm::ivec2 to, float kind, Heights& roads) {
    std::vector<float> cost(heights.values().size(), std::numeric_limits<float>::max());
    std::vector<glm::ivec2> before(cost.size(), glm::ivec2(-1));
    Rising open;
    open.push({0.0F, from});
    cost[heights.index(from.x, from.y)] = 0.0F;
    while (!open.empty() && open.top().at != to) {
        const Entry here = open.top();
        open.pop();
        if (here.level > cost[heights.index(here.at.x, here.at.y)]) continue;
        for (const glm::ivec2& step : kAround) {
            const glm::ivec2 next = wrapped(here.at + step);
            if (heights.at(next.x, next.y) < kSeaLevel + 0.006F) continue;
            const float length = glm::length(glm::vec2(step));
            const float climb = std::abs(heights.at(next.x, next.y) - heights.at(here.at.x, here.at.y));
            const float reuse = roads.at(next.x, next.y) > 0.0F ? 0.45F : 1.0F;
            const float total = here.level + reuse * length + 900.0F * climb;
            float& known = cost[heights.index(next.x, next.y)];
            if (total >= known) continue;
            known = total;
            before[heights.index(next.x, next.y)] = here.at;
            open.push({total, next});
        }
    }
    for (glm::ivec2 at = to; at.x >= 0 && cost[heights.index(to.x, to.y)] < 1e9F;
         at = before[heights.index(at.x, at.y)])
        roads.at(at.x, at.y) = std::max(roads.at(at.x, at.y), kind);
}

Heights roadsBetween(const Heights& heights, const std::vector<glm::ivec2>& towns) {
    Heights roads(kSide);
    for (std::size_t i = 1; i < towns.size(); ++i) {
        std::vector<std::pair<float, std::size_t>> near;
        for (std::size_t j = 0; j < i; ++j) {
            glm::ivec2 d = glm::abs(towns[i] - towns[j]);
            d = glm::min(d, kSide - d);
            near.emplace_back(glm::length(glm::vec2(d)), j);
        }
        std::ranges::sort(near);
        for (std::size_t k = 0; k < std::min<std::size_t>(2, near.size()); ++k)
            addRoad(heights, towns[i], towns[near[k].second], i < 5 && k == 0 ? 2.0F : 1.0F, roads);
    }
    return roads;
}

} // namespace

Landscape makeLandscape() {
    Landscape land{ground(), Heights(kSide), Heights(kSide), {}};
    land.river = rivers(land.ground);
    land.towns = townsOf(land.ground);
    land.road = roadsBetween(land.ground, land.towns);
    return land;
}

} // namespace lumorph

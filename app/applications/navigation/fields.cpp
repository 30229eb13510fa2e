#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/builder.h"
#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/shapes.h"

namespace lumorph::navigation {
namespace {

constexpr double kBlock = 196.0; ///< metres between the middles of blocks of fields
constexpr glm::vec3 kCrops[] = {{0.74F, 0.67F, 0.43F}, {0.58F, 0.60F, 0.33F}, {0.63F, 0.54F, 0.39F},
                                {0.45F, 0.53F, 0.28F}, {0.79F, 0.73F, 0.51F}, {0.40F, 0.49F, 0.27F},
                                {0.55F, 0.57F, 0.36F}};

bool suits(Builder& builder, const std::vector<glm::dvec2>& strip) {
    const Map& map = builder.map();
    const bool dry = std::ranges::none_of(strip, [&](const glm::dvec2& p) {
        return !std::isnan(map.waterAt(p)) || map.woodsAt(p) > 0.35 || glm::length(map.heights.slopeAt(p, 60.0)) > 0.15;
    });
    return dry && builder.free(strip, 3.0);
}

/// Strips beside each other, as a village divided its land.
void block(Builder& builder, const glm::ivec2& cell, const glm::dvec2& at) {
    const std::uint64_t seed = builder.seed();
    const double turn = 1.4 * noiseAt(at / 1300.0, seed + 43) + (chanceOf(cell, seed + 48) < 0.4 ? 1.5708 : 0.0);
    const glm::dvec2 along(std::cos(turn), std::sin(turn)), across(-along.y, along.x);
    const int strips = 3 + static_cast<int>(4.0 * chanceOf(cell, seed + 44));
    const double length = 150.0 + 34.0 * chanceOf(cell, seed + 45), wide = 176.0 / strips;
    for (int k = 0; k < strips; ++k) {
        const glm::ivec2 own(64 * cell.x + k, cell.y);
        if (chanceOf(own, seed + 46) < 0.12) continue;
        const glm::dvec2 middle = at + (k - 0.5 * (strips - 1)) * wide * across;
        std::vector<glm::dvec2> strip = rectangle(middle, along, length, wide - 1.5);
        if (!suits(builder, strip)) continue;
        const auto crop = static_cast<std::size_t>(7.0 * chanceOf(own, seed + 47));
        const double hedge = chanceOf(own, seed + 49) < 0.45 ? 2.6 : 0.0;
        if (hedge > 0.0)
            for (double passed = 6.0; passed < length; passed += 14.0 + 22.0 * builder.chance())
                builder.tree(strip[0] + passed * along, 3.0 + 5.0 * builder.chance());
        builder.map().parcels.push_back({strip, kCrops[crop], 0.35F, hedge});
        builder.take(std::move(strip));
    }
}

} // namespace

void layFields(Builder& builder) {
    const Map& map = builder.map();
    for (int j = 0; j < static_cast<int>(ValleyPlan::kSide / kBlock); ++j)
        for (int i = 0; i < static_cast<int>(ValleyPlan::kSide / kBlock); ++i) {
            const glm::dvec2 at = kBlock * (glm::dvec2(i, j) + 0.5);
            const double over = builder.ground(at) - ValleyPlan::kLakeLevel;
            if (over > 190.0 || glm::length(map.heights.slopeAt(at, 60.0)) > 0.14 || map.woodsAt(at) > 0.3) continue;
            block(builder, {i, j}, at);
        }
}

} // namespace lumorph::navigation

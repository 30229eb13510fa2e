#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/ice/fracture.h"
#include "app/applications/ice/ice_cover.h"
#include "app/applications/ice/pond_bed.h"
#include "core/base/error.h"

// R40: the ice of the pond. Areas, distances and overlaps are computed here by formulas of their own.

namespace lumorph::ice {
namespace {

using Points = std::vector<glm::dvec2>;

/// Gauss's formula for the area of a polygon.
double gaussArea(const Points& points) {
    double twice = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const glm::dvec2 &a = points[k], &b = points[(k + 1) % points.size()];
        twice += (a.x - b.x) * (a.y + b.y);
    }
    return 0.5 * std::abs(twice);
}

/// How deep two convex polygons overlap: the least of all ways in which the second could be moved clear of the first,
/// along normals of edges; negative where they are apart.
double overlapDepth(const Points& a, const Points& b) {
    double least = std::numeric_limits<double>::max();
    for (const Points* polygon : {&a, &b})
        for (std::size_t k = 0; k < polygon->size(); ++k) {
            const glm::dvec2 edge = (*polygon)[(k + 1) % polygon->size()] - (*polygon)[k];
            if (glm::length(edge) < 1e-9) continue;
            const glm::dvec2 normal = glm::dvec2(edge.y, -edge.x) / glm::length(edge);
            double maxA = -1.0, minA = 1.0, maxB = -1.0, minB = 1.0;
            for (const glm::dvec2& p : a)
                maxA = std::max(maxA, glm::dot(p, normal)), minA = std::min(minA, glm::dot(p, normal));
            for (const glm::dvec2& p : b)
                maxB = std::max(maxB, glm::dot(p, normal)), minB = std::min(minB, glm::dot(p, normal));
            least = std::min(least, std::min(maxA - minB, maxB - minA));
        }
    return least;
}

/// A cell of a floe where it lies now: turned by the matrix of its angle, then shifted.
Points lying(const Floe& floe, const Polygon& outline) {
    const double c = std::cos(floe.motion.placement.turn), s = std::sin(floe.motion.placement.turn);
    Points points;
    for (const glm::dvec2& p : outline)
        points.emplace_back(c * p.x - s * p.y + floe.motion.placement.shift.x,
                            s * p.x + c * p.y + floe.motion.placement.shift.y);
    return points;
}

struct LyingCell {
    int floe = 0;
    Points points;
    glm::dvec2 min{1.0}, max{-1.0};
};

std::vector<LyingCell> lyingCells(const IceCover& ice) {
    std::vector<LyingCell> cells;
    for (const Floe& floe : ice.floes())
        for (const int k : floe.cells) {
            const Polygon outline = ice.grown(k);
            if (outline.empty()) continue;
            LyingCell cell{floe.number, lying(floe, outline)};
            for (const glm::dvec2& p : cell.points) {
                cell.min = glm::min(cell.min, p);
                cell.max = glm::max(cell.max, p);
            }
            cells.push_back(std::move(cell));
        }
    return cells;
}

/// How deep pairs of floes overlap, by their numbers; those that do not are left out.
std::map<std::pair<int, int>, double> overlaps(const std::vector<LyingCell>& cells) {
    std::map<std::pair<int, int>, double> found;
    for (std::size_t a = 0; a < cells.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
            if (cells[a].floe == cells[b].floe) continue;
            if (glm::any(glm::greaterThan(cells[a].min, cells[b].max)) ||
                glm::any(glm::greaterThan(cells[b].min, cells[a].max)))
                continue;
            const double depth = overlapDepth(cells[a].points, cells[b].points);
            if (depth <= 0.0) continue;
            double& deepest = found[std::minmax(cells[a].floe, cells[b].floe)];
            deepest = std::max(deepest, depth);
        }
    return found;
}

/// A visitor: warmth that wanders and rests, strikes, and a device that leans to and fro.
struct Script {
    explicit Script(std::uint64_t seed) : random(seed) {}

    void play(IceCover& ice, double seconds) {
        if (seconds >= next) {
            next = seconds + 1.0 + 2.0 * chance(random);
            const double x = chance(random), z = chance(random);
            place = glm::dvec2(0.18 * (x - 0.5), 0.12 * (z - 0.5));
            if (chance(random) < 0.5) ice.strike(place);
        }
        around.warmths = {{place, 0.018, 1.0}};
        around.presses = {{place, 4e-7}};
        around.lean = 0.25 * glm::dvec2(std::sin(1.3 * seconds), std::cos(0.9 * seconds));
        around.thaw = seconds > 40.0 ? 1e-3 : 0.0;
        ice.advance(1.0 / 60.0, around);
    }

    std::mt19937_64 random;
    Surroundings around;
    glm::dvec2 place{0.0};
    double next = 0.0;
};

TEST(IceFracture, CellsShareThePieceAndHoldWhatIsNearest) {
    const Polygon piece{{-0.03, -0.02}, {0.03, -0.025}, {0.04, 0.01}, {0.0, 0.03}, {-0.035, 0.015}};
    std::mt19937_64 random(5);
    for (const int count : {1, 2, 3, 10, 60}) {
        Points sites;
        for (int k = 0; k < count; ++k) {
            const double x = chance(random), z = chance(random);
            sites.emplace_back(0.07 * (x - 0.5), 0.05 * (z - 0.5));
        }
        const std::vector<Polygon> cells = voronoiCells(piece, sites);
        ASSERT_EQ(cells.size(), sites.size());
        double sum = 0.0;
        for (const Polygon& cell : cells) sum += gaussArea(cell);
        EXPECT_NEAR(sum, gaussArea(piece), 1e-12) << count;
        // Literally: whatever place lies in a cell has no nearer site.
        for (std::size_t k = 0; k < cells.size(); ++k)
            for (const glm::dvec2& corner : cells[k])
                for (const glm::dvec2& site : sites)
                    EXPECT_LE(glm::distance(corner, sites[k]), glm::distance(corner, site) + 1e-9) << count;
    }
}

TEST(IceFracture, SitesOnALineOrAtOnePlaceAreSitesToo) {
    const Polygon square{{0.0, 0.0}, {0.04, 0.0}, {0.04, 0.04}, {0.0, 0.04}};
    const std::array row{glm::dvec2(0.005, 0.02), glm::dvec2(0.015, 0.02), glm::dvec2(0.035, 0.02)};
    const std::vector<Polygon> strips = voronoiCells(square, row);
    EXPECT_NEAR(gaussArea(strips[0]), 0.010 * 0.04, 1e-12);
    EXPECT_NEAR(gaussArea(strips[1]), 0.015 * 0.04, 1e-12);
    EXPECT_NEAR(gaussArea(strips[2]), 0.015 * 0.04, 1e-12);
    const std::array same{glm::dvec2(0.01, 0.02), glm::dvec2(0.01, 0.02), glm::dvec2(0.03, 0.02)};
    const std::vector<Polygon> halves = voronoiCells(square, same);
    EXPECT_NEAR(gaussArea(halves[0]), 0.02 * 0.04, 1e-12);
    EXPECT_TRUE(halves[1].empty());
    EXPECT_NEAR(gaussArea(halves[2]), 0.02 * 0.04, 1e-12);
    const std::array bad{glm::dvec2(NAN, 0.0)};
    EXPECT_THROW((void)voronoiCells(square, bad), InvalidInput);
}

/// Whether a convex polygon holds a place.
bool holdsPlace(const Points& polygon, const glm::dvec2& place) {
    int left = 0, right = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2 &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
        const double side = (to.x - from.x) * (place.y - from.y) - (to.y - from.y) * (place.x - from.x);
        ++(side > 0.0 ? left : right);
    }
    return left == 0 || right == 0;
}

/// Metres of rim in the pond along which no other ice lies, seen from outside: places close beside all edges, in home
/// coordinates. A crack has two such rims, the bank has none where ice is frozen to it.
double openRim(const IceCover& ice) {
    constexpr double kStep = 0.0005, kBeside = 0.00002;
    std::vector<Points> cells;
    for (const Floe& floe : ice.floes())
        for (const int k : floe.cells)
            if (Points outline = ice.grown(k); !outline.empty()) cells.push_back(std::move(outline));
    const Points shore = pondShore();
    double open = 0.0;
    for (const Points& cell : cells)
        for (std::size_t k = 0; k < cell.size(); ++k) {
            const glm::dvec2 along = cell[(k + 1) % cell.size()] - cell[k];
            const double length = glm::length(along);
            if (length < 1e-9) continue;
            const int count = static_cast<int>(std::ceil(length / kStep));
            for (int i = 0; i < count; ++i) {
                const glm::dvec2 at = cell[k] + (i + 0.5) / count * along;
                const glm::dvec2 normal = glm::dvec2(along.y, -along.x) / length;
                const glm::dvec2 beside =
                    holdsPlace(cell, at + kBeside * normal) ? at - kBeside * normal : at + kBeside * normal;
                if (!holdsPlace(shore, beside)) continue; // the bank
                if (std::ranges::none_of(cells, [&](const Points& other) { return holdsPlace(other, beside); }))
                    open += length / count;
            }
        }
    return open;
}

// Without warmth nothing melts: what a crack takes is a hairline, 0.2 mm from either side of it.
TEST(IceCover, BreakingLosesNoMoreThanHairlines) {
    for (const std::uint64_t seed : {11U, 12U, 13U}) {
        IceCover ice(pondShore(), seed);
        std::mt19937_64 random(seed);
        for (int k = 0; k < 60 * 5; ++k) ice.advance(1.0 / 60.0, {});
        const double pond = gaussArea(pondShore());
        for (int blow = 0; blow < 12; ++blow) {
            const double x = chance(random), z = chance(random);
            ice.strike({0.16 * (x - 0.5), 0.10 * (z - 0.5)});
            for (int k = 0; k < 60; ++k) ice.advance(1.0 / 60.0, {});
        }
        double area = 0.0;
        for (const LyingCell& cell : lyingCells(ice)) area += gaussArea(cell.points);
        const double rim = openRim(ice), width = (pond - area) / rim;
        std::printf("seed %d: %.2f %% of the ice lost to %.0f mm of open rim: %.2f mm wide, %zu floes\n",
                    static_cast<int>(seed), 100.0 * (pond - area) / pond, 1e3 * rim, 1e3 * width, ice.floes().size());
        ASSERT_GT(rim, 0.2) << "it breaks";
        EXPECT_LE(width, 0.0003);
        EXPECT_GE(width, 0.0001) << "a crack is seen";
    }
}

TEST(IceCover, CountsWhatItLosesAndFloesKeepClearOfOneAnother) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        IceCover ice(pondShore(), seed);
        Script script(seed);
        const double pond = gaussArea(pondShore());
        std::map<std::pair<int, int>, int> deepSince;
        double deepest = 0.0, worst = 0.0;
        int longest = 0;
        std::size_t most = 0;
        for (int frame = 0; frame < 60 * 60; ++frame) {
            script.play(ice, frame / 60.0);
            if (frame == 60 * 52) ice.freeze();
            double area = 0.0;
            const std::vector<LyingCell> cells = lyingCells(ice);
            for (const LyingCell& cell : cells) area += gaussArea(cell.points);
            worst = std::max(worst, std::abs(area + ice.melted() - pond) / pond);
            most = std::max(most, ice.floes().size());
            std::map<std::pair<int, int>, int> deep;
            for (const auto& [pair, depth] : overlaps(cells)) {
                deepest = std::max(deepest, depth);
                if (depth > 0.001) longest = std::max(longest, deep[pair] = deepSince[pair] + 1);
            }
            deepSince = std::move(deep);
        }
        RecordProperty("deepestOverlapMillimetres", std::to_string(1e3 * deepest));
        std::printf(
            "seed %d: area off by %.1e at most, deepest overlap %.2f mm, longest deep one %d frames, %zu floes\n",
            static_cast<int>(seed), worst, 1e3 * deepest, longest, most);
        EXPECT_LT(worst, 1e-9);
        EXPECT_LE(longest, 12) << "frames of 1/60 s";
        EXPECT_GE(most, 8U) << "it breaks";
    }
}

TEST(IceCover, IsTheSameBitForBitForTheSameSeedAndInputs) {
    IceCover one(pondShore(), 4), other(pondShore(), 4), another(pondShore(), 5);
    Script script(4), same(4), third(4);
    for (int frame = 0; frame < 60 * 25; ++frame) {
        script.play(one, frame / 60.0);
        same.play(other, frame / 60.0);
        if (frame < 60 * 10) third.play(another, frame / 60.0);
        if (frame == 60 * 10 - 1) {
            const std::vector<LyingCell> now = lyingCells(one), others = lyingCells(another);
            EXPECT_FALSE(now.size() == others.size() && now.front().points == others.front().points)
                << "another seed, other ice";
        }
    }
    const std::vector<LyingCell> a = lyingCells(one), b = lyingCells(other);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].points, b[k].points) << k;
}

TEST(IceCover, WarmthMeltsAHoleThatGrowsAboutIt) {
    IceCover ice(pondShore(), 1);
    Surroundings around;
    for (int k = 0; k < 60 * 5; ++k) ice.advance(1.0 / 60.0, around);
    ASSERT_FALSE(ice.freezing());
    EXPECT_NEAR(ice.iceArea(), gaussArea(pondShore()), 1e-9) << "closed";
    const glm::dvec2 warm(0.02, -0.01);
    around.warmths = {{warm, 0.018, 1.0}};
    double before = ice.iceArea();
    for (int second = 0; second < 6; ++second) {
        for (int k = 0; k < 60; ++k) ice.advance(1.0 / 60.0, around);
        if (second >= 1) {
            EXPECT_LT(ice.iceArea(), before - 5e-6) << second;
        }
        before = ice.iceArea();
    }
    // No ice within 5 mm of it, and all of it 25 mm away.
    for (int k = 0; k < 24; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / 24;
        const glm::dvec2 way(std::cos(angle), std::sin(angle));
        const auto covered = [&](const glm::dvec2& at) {
            return std::ranges::any_of(lyingCells(ice), [&](const LyingCell& cell) {
                return overlapDepth(cell.points, {at - 1e-6, at + glm::dvec2(1e-6, -1e-6), at + 1e-6}) > 0.0;
            });
        };
        EXPECT_FALSE(covered(warm + 0.005 * way)) << angle;
        EXPECT_TRUE(covered(warm + 0.025 * way)) << angle;
    }
}

TEST(IceCover, ABlowCracksItAndCracksRunOnUntilFloesComeLoose) {
    IceCover ice(pondShore(), 2);
    for (int k = 0; k < 60 * 5; ++k) ice.advance(1.0 / 60.0, {});
    EXPECT_FALSE(ice.strike({0.2, 0.0})) << "beside the pond";
    EXPECT_FALSE(ice.strike({NAN, 0.0}));
    EXPECT_EQ(ice.floes().size(), 1U);
    ASSERT_TRUE(ice.strike({-0.03, 0.01}));
    for (const glm::dvec2 place : {glm::dvec2(0.03, -0.02), {0.04, 0.03}, {-0.05, -0.03}, {0.0, 0.0}}) {
        for (int k = 0; k < 90; ++k) ice.advance(1.0 / 60.0, {});
        ice.strike(place);
    }
    for (int k = 0; k < 120; ++k) ice.advance(1.0 / 60.0, {});
    EXPECT_GT(ice.floes().size(), 3U);
    EXPECT_TRUE(std::ranges::any_of(ice.floes(), [](const Floe& floe) { return !floe.fixed; }));
}

TEST(IceCover, SurvivesNumbersThatAreNone) {
    IceCover ice(pondShore(), 3);
    Surroundings around;
    for (int k = 0; k < 60 * 6; ++k) {
        around.warmths = {{{NAN, 0.0}, 0.018, 1.0},
                          {{0.0, INFINITY}, 0.018, 1.0},
                          {{0.0, 0.0}, 0.018, NAN},
                          {{0.01, 0.01}, NAN, 1.0},
                          {{5.0, 5.0}, 0.018, 1.0}};
        around.presses = {{{NAN, NAN}, NAN}};
        around.lean = {NAN, INFINITY};
        around.thaw = NAN;
        ice.advance(k % 7 == 0 ? NAN : k % 11 == 0 ? -1.0 : 1.0 / 60.0, around);
    }
    ice.strike({0.0, 0.0});
    for (int k = 0; k < 60 * 3; ++k) ice.advance(1.0 / 60.0, around);
    for (const LyingCell& cell : lyingCells(ice))
        for (const glm::dvec2& p : cell.points) ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y));
    EXPECT_GT(ice.iceArea(), 0.9 * gaussArea(pondShore()));
}

} // namespace
} // namespace lumorph::ice

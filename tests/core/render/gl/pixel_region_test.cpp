#include "core/render/gl/pixel_region.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace lumorph {
namespace {

bool has(const PixelRectangle& r, int x, int y) { return x >= r.low.x && x < r.high.x && y >= r.low.y && y < r.high.y; }

TEST(PixelRectangle, AroundCoversTheRestOnce) {
    const PixelRectangle whole{{10, 5}, {60, 45}};
    for (const PixelRectangle& area : {PixelRectangle{{20, 10}, {40, 30}}, PixelRectangle{{0, 0}, {30, 50}},
                                       PixelRectangle{{55, 40}, {90, 90}}, PixelRectangle{}, whole}) {
        const auto parts = around(area, whole);
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 80; ++x) {
                int covered = has(whole, x, y) && has(area, x, y) ? 1 : 0;
                for (const PixelRectangle& part : parts) covered += has(part, x, y) ? 1 : 0;
                ASSERT_EQ(covered, has(whole, x, y) ? 1 : 0) << x << ", " << y;
            }
    }
}

TEST(PixelRectangle, UnitedHoldsBothAndCommonWhatBothHold) {
    const PixelRectangle a{{0, 0}, {4, 4}}, b{{2, 3}, {9, 6}};
    EXPECT_DOUBLE_EQ(united(a, b).size(), 54.0);
    EXPECT_DOUBLE_EQ(common(a, b).size(), 2.0);
    EXPECT_DOUBLE_EQ(united(a, {}).size(), 16.0);
    EXPECT_TRUE(common(a, {{5, 0}, {6, 4}}).empty());
}

TEST(PixelRegion, HoldsAllThatWasIncludedInFewParts) {
    std::mt19937 random(7);
    const auto below = [&](unsigned most) { return static_cast<int>(random() % most); };
    for (int round = 0; round < 50; ++round) {
        PixelRegion region;
        std::vector<PixelRectangle> included;
        for (int i = 0; i < 20; ++i) {
            const glm::ivec2 low(below(90), below(60));
            included.push_back({low, low + glm::ivec2(below(12), below(12))}); // some of them empty
            region.include(included.back());
        }
        EXPECT_LE(region.parts().size(), 6U);
        for (const PixelRectangle& part : region.parts()) EXPECT_FALSE(part.empty());
        for (int y = 0; y < 75; ++y)
            for (int x = 0; x < 105; ++x) {
                const auto holdsIt = [&](const PixelRectangle& one) { return has(one, x, y); };
                if (!std::ranges::any_of(included, holdsIt)) continue;
                ASSERT_TRUE(std::ranges::any_of(region.parts(), holdsIt)) << x << ", " << y;
                ASSERT_TRUE(has(region.bounds(), x, y));
            }
    }
}

TEST(PixelRegion, KeepsFarPartsApartAndJoinsNearOnes) {
    PixelRegion region({{0, 0}, {10, 10}});
    region.include(PixelRectangle{{90, 90}, {100, 100}});
    EXPECT_EQ(region.parts().size(), 2U);
    region.include(PixelRectangle{{0, 2}, {12, 8}});
    EXPECT_EQ(region.parts().size(), 2U);
    PixelRegion other({{5, 5}, {15, 15}});
    other.include(region);
    EXPECT_TRUE(has(other.bounds(), 99, 99));
    EXPECT_TRUE(PixelRegion().empty());
    EXPECT_TRUE(PixelRegion().bounds().empty());
}

} // namespace
} // namespace lumorph

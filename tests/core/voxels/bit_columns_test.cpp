#include "core/voxels/bit_columns.h"

#include <random>

#include <gtest/gtest.h>

namespace lumorph {
namespace {

BitColumns randomColumns(glm::ivec3 dimensions, unsigned seed, std::vector<bool>& plain) {
    std::mt19937 random(seed);
    BitColumns columns(dimensions);
    plain.clear();
    for (int z = 0; z < dimensions.z; ++z)
        for (int y = 0; y < dimensions.y; ++y)
            for (int x = 0; x < dimensions.x; ++x) {
                plain.push_back(random() & 1U);
                if (plain.back()) columns.set(x, y, z);
            }
    return columns;
}

// A column longer than a word, one exactly a word, and a short one.
class BitColumnsShapes : public testing::TestWithParam<glm::ivec3> {};

TEST_P(BitColumnsShapes, AgreesWithAPlainBitArray) {
    std::vector<bool> plainA;
    std::vector<bool> plainB;
    const BitColumns a = randomColumns(GetParam(), 1, plainA);
    const BitColumns b = randomColumns(GetParam(), 2, plainB);
    std::size_t count = 0;
    std::size_t both = 0;
    std::size_t either = 0;
    for (std::size_t i = 0; i < plainA.size(); ++i) {
        count += plainA[i];
        both += plainA[i] && plainB[i];
        either += plainA[i] || plainB[i];
    }
    EXPECT_EQ(a.count(), count);
    EXPECT_EQ(a.countAnd(b), both);
    EXPECT_EQ((BitColumns(a) |= b).count(), either);
    EXPECT_EQ((BitColumns(a) &= b).count(), both);
    EXPECT_EQ((BitColumns(a) -= b).count(), count - both);
    EXPECT_DOUBLE_EQ(intersectionOverUnion(a, b), static_cast<double>(both) / static_cast<double>(either));
}

INSTANTIATE_TEST_SUITE_P(Shapes, BitColumnsShapes,
                         testing::Values(glm::ivec3(5, 33, 4), glm::ivec3(3, 64, 2), glm::ivec3(2, 130, 7)));

TEST(BitColumns, TwoEmptyGridsAreEqualInEveryRespect) {
    EXPECT_DOUBLE_EQ(intersectionOverUnion(BitColumns({3, 3, 3}), BitColumns({3, 3, 3})), 1.0);
}

} // namespace
} // namespace lumorph

#include "core/base/statistics.h"

#include <chrono>

#include <gtest/gtest.h>

namespace lumorph {
namespace {

TEST(Median, IsTheMiddleOneWhateverTheirOrder) {
    EXPECT_EQ(median(std::vector{7.0}), 7.0);
    EXPECT_EQ(median(std::vector{9.0, 1.0, 5.0}), 5.0);
    EXPECT_EQ(median(std::vector{3, 3, 1, 900, 2}), 3);
}

TEST(Median, OfAnEvenCountIsTheGreaterOfTheMiddleTwo) {
    EXPECT_EQ(median(std::vector{4.0, 1.0}), 4.0);
    EXPECT_EQ(median(std::vector{4.0, 1.0, 3.0, 2.0}), 3.0);
}

TEST(Median, OfNothingIsZero) {
    EXPECT_EQ(median(std::vector<double>{}), 0.0);
    EXPECT_EQ(median(std::vector<std::chrono::microseconds>{}).count(), 0);
}

TEST(Median, LeavesTheCallersValuesAsTheyAre) {
    const std::vector values{3, 1, 2};
    EXPECT_EQ(median(values), 2);
    EXPECT_EQ(values, (std::vector{3, 1, 2}));
}

} // namespace
} // namespace lumorph

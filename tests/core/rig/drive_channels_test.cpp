#include "core/rig/drive_channels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/rig/templates/rig_templates.h"
#include "tests/core/rig/point_rig.h"

namespace lumorph {
namespace {

using testing::ElementsAre;

Rig rigWithChannels(const std::vector<int>& channels) {
    std::vector<Deformer> deformers(channels.size(), Slide{{0, 1, 0}, 0.0, 0.01});
    RigParts parts = test::pointParts({{0.1F, 0, 0}, {0, 0.2F, 0}, {0, 0, 0.3F}}, std::move(deformers));
    for (std::size_t k = 0; k < channels.size(); ++k) parts.actuators[k].drive.channel = channels[k];
    return Rig(std::move(parts));
}

TEST(DriveChannels, CountFromWhereTheBoardBegins) {
    EXPECT_THAT(boardChannels(rigWithChannels({2, 0, 1}), 2), ElementsAre(4, 2, 3));
    EXPECT_THAT(boardChannels(rigWithChannels({2, 0, 1}), 0), ElementsAre(2, 0, 1));
    EXPECT_THAT(boardChannels(rigWithChannels({4, 3, 8}), 2), ElementsAre(4, 3, 8)) << "they are the board's already";
    EXPECT_THAT(boardChannels(rigWithChannels({1, 9}), 2), ElementsAre(2, 10));
    EXPECT_THAT(boardChannels(rigWithChannels({-1, 3, -1}), 2), ElementsAre(2, 3, 4)) << "free ones where none is told";
    EXPECT_THAT(boardChannels(rigWithChannels({-1, 0, -1}), 0), ElementsAre(1, 0, 2));
    EXPECT_TRUE(boardChannels(rigOf(rigTemplate("sheet"), {}), 2).empty());
}

// A sheet's flaps are numbered as its wiring table numbers them.
TEST(DriveChannels, OfSheetsBeginAtZero) {
    for (const char* name : {"tablet", "phone", "flower", "book"}) {
        const Rig rig = rigOf(rigTemplate(name), {});
        for (std::size_t k = 0; k < rig.actuatorCount(); ++k)
            EXPECT_EQ(rig.actuators()[k].drive.channel, static_cast<int>(k)) << name;
    }
}

} // namespace
} // namespace lumorph

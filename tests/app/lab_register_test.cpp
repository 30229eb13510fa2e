#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/process.h"
#include "tests/app/workspace.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

TEST(LabRegister, TellsEachStageBesideTheTruth) {
    const Outcome outcome = lumorph({"lab", "register", cutTabletFile(), "--seed", "3", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json stages = outcome.json()["stages"];
    ASSERT_EQ(stages.size(), 4U);
    const struct {
        const char* name;
        double millimetres, degrees;
    } bars[] = {{"pointer", 1.0, -1.0}, {"tracker", 1.0, 0.2}, {"device", 1.0, 0.2}, {"eye", 5.0, -1.0}};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(stages[i]["stage"], bars[i].name);
        EXPECT_EQ(stages[i]["good"], true);
        EXPECT_GE(stages[i]["fresh"]["points"].size(), 3U);
        EXPECT_LE(double(stages[i]["fromTruth"]["mm"]), bars[i].millimetres) << bars[i].name;
        if (bars[i].degrees > 0.0) {
            EXPECT_LE(double(stages[i]["fromTruth"]["degrees"]), bars[i].degrees) << bars[i].name;
        }
    }
}

TEST(LabRegister, AFaultEndsItByName) {
    const Outcome outcome = lumorph({"lab", "register", cutTabletFile(), "--fault", "left_handed", "--json"});
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_EQ(outcome.json()["refused"]["cause"], "mirrored");
    EXPECT_THAT(outcome.err, HasSubstr("left-handed"));
    const Outcome unknown = lumorph({"lab", "register", cutTabletFile(), "--fault", "tired"});
    EXPECT_NE(unknown.exitCode, 0);
    EXPECT_THAT(unknown.err, HasSubstr("drops_out"));
}

} // namespace
} // namespace lumorph::test

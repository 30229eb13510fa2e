#include <gtest/gtest.h>

#include "core/geometry/mesh_file.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"
#include "tests/support/small_rigs.h"

namespace lumorph::test {
namespace {

class MatchWarnings : public ::testing::Test {
protected:
    nlohmann::json matchBox(const glm::vec3& low, const glm::vec3& high) {
        writeMesh(boxMesh(low, high), w["box.obj"]);
        const Outcome outcome = lumorph({"match", w.field(), w["box.obj"], "--json"});
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return outcome.json();
    }
    static bool warns(const nlohmann::json& result, const std::string& text) {
        for (const std::string warning : result["warnings"])
            if (warning.find(text) != std::string::npos) return true;
        return false;
    }
    TabletWorkspace w;
};

// R42: unreachable size. Half of this box sticks out at the left.
TEST_F(MatchWarnings, TellHowMuchLiesBeyondTheFrame) {
    const nlohmann::json result = matchBox({-0.205F, 0.021F, -0.05F}, {-0.005F, 0.06F, 0.05F});
    ASSERT_TRUE(warns(result, " % of the target lies beyond")) << result["warnings"].dump();
    const std::string first = result["warnings"][0];
    EXPECT_NEAR(std::stoi(first), 50, 3) << first; // within a layer of voxels
}

// R42: unreachable volume. Nothing reaches the middle of the tablet, a box there is all unreachable.
TEST_F(MatchWarnings, TellHowMuchNoActuatorReaches) {
    const nlohmann::json middle = matchBox({-0.02F, 0.03F, -0.001F}, {0.02F, 0.05F, 0.001F});
    EXPECT_TRUE(warns(middle, "where no actuator reaches")) << middle["warnings"].dump();
    const nlohmann::json whole = matchBox({-0.104F, 0.021F, -0.074F}, {0.104F, 0.083F, 0.074F});
    const double unreachable = whole["unreachableVolume"];
    EXPECT_GT(unreachable, 0.0);
    EXPECT_LE(unreachable, whole["unmatchedVolume"].get<double>() + 1e-12);
}

TEST_F(MatchWarnings, AreNoneForATargetInReachOfAll) {
    const Outcome fit = lumorph({"match", w.field(), resource("targets/dunes.glb"), "--fit", "--json"});
    const nlohmann::json result = fit.json();
    for (const std::string warning : result["warnings"])
        EXPECT_EQ(warning.find("beyond"), std::string::npos) << warning;
    for (const nlohmann::json& actuator : result["actuators"]) EXPECT_TRUE(actuator["reached"]);
}

} // namespace
} // namespace lumorph::test

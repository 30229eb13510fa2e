#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/geometry/mesh_file.h"
#include "tests/app/eq1_targets.h"
#include "tests/app/literal_eq1.h"
#include "tests/app/process.h"
#include "tests/support/cgal_oracle.h"

namespace lumorph::test {
namespace {

constexpr std::size_t kActuators = 6;

nlohmann::json jsonOf(const std::vector<std::string>& arguments) {
    const Outcome outcome = lumorph(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return outcome.json();
}

void expectClose(const nlohmann::json& printed, const std::vector<double>& literal, const char* what) {
    ASSERT_EQ(printed.size(), literal.size()) << what;
    for (std::size_t j = 0; j < literal.size(); ++j)
        EXPECT_NEAR(printed[j].get<double>(), literal[j], 1e-6 * std::max(1.0, literal[j]))
            << what << " at level " << j;
}

class TabletMatch : public ::testing::Test {
protected:
    TabletMatch() {
        info = jsonOf({"mdf", "info", w.field(), "--json"});
        const Outcome exported = lumorph({"mdf", "export", w.field(), "-o", w["grids"]});
        EXPECT_EQ(exported.exitCode, 0) << exported.err;
        field = readLiteralField(w["grids"], info["actuators"].size(), info["levels"]);
    }

    [[nodiscard]] nlohmann::json match(const MatchTarget& target) const {
        std::vector<std::string> arguments{"match", w.field(), target.path, "--json"};
        if (target.fit) arguments.emplace_back("--fit");
        return jsonOf(arguments);
    }

    /// The target's voxels: as they are, or as `lumorph voxelize` makes them.
    [[nodiscard]] LiteralGrid voxelsOf(const MatchTarget& target) const {
        if (target.path.ends_with(".nrrd")) return readLiteralGrid(target.path);
        std::vector<std::string> arguments{"voxelize", target.path, "--like", w.field(), "-o", w["target.nrrd"]};
        if (target.fit) arguments.emplace_back("--fit");
        const Outcome outcome = lumorph(arguments);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return readLiteralGrid(w["target.nrrd"]);
    }

    TabletWorkspace w;
    nlohmann::json info;
    LiteralField field;
};

// R7
TEST_F(TabletMatch, TheFrameIsThePapers) {
    EXPECT_EQ(info["dims"], nlohmann::json({83, 33, 59}));
    EXPECT_EQ(info["levels"], 33);
    EXPECT_EQ(info["actuators"].size(), kActuators);
    EXPECT_EQ(field.body.size, (std::array<int, 3>{83, 33, 59}));
}

// R16 R17
TEST_F(TabletMatch, EveryLevelIsWhatEquationOneSays) {
    std::set<int> levels;
    std::map<std::vector<int>, int> states;
    const std::vector<MatchTarget> targets = tabletTargets(w, field.body);
    ASSERT_GE(targets.size(), 17U);
    for (const MatchTarget& target : targets) {
        SCOPED_TRACE(target.name);
        const nlohmann::json printed = match(target);
        const LiteralGrid voxels = voxelsOf(target);
        ASSERT_EQ(voxels.size, field.body.size);
        std::vector<int> state;
        for (std::size_t i = 0; i < kActuators; ++i) {
            const LiteralVote vote = evaluateEq1(field, i, voxels);
            const nlohmann::json& actuator = printed["actuators"][i];
            SCOPED_TRACE(actuator["name"].get<std::string>());
            EXPECT_EQ(printed["state"][i], vote.level);
            EXPECT_EQ(actuator["reached"], vote.reached);
            expectClose(actuator["errors"], vote.errors, "error");
            expectClose(actuator["intersections"], vote.intersections, "intersection");
            state.push_back(vote.level);
        }
        levels.insert(state.begin(), state.end());
        ++states[state];
    }
    // The answers differ enough that no constant, nor any few, would pass.
    EXPECT_GE(levels.size(), 10U) << ::testing::PrintToString(levels);
    EXPECT_GE(states.size(), targets.size() / 2);
    for (const auto& [state, times] : states)
        EXPECT_LE(times, static_cast<int>(targets.size()) / 3) << ::testing::PrintToString(state);
}

// R6: this rig's solid holds its path, so V(s) is the solid at s without the body at rest.
TEST_F(TabletMatch, ThePrintedIouIsThatOfTheDeformedMesh) {
    const std::array<double, 3> origin = info["origin"];
    const double side = info["voxelSize"];
    for (const MatchTarget& target : {tabletTargets(w, field.body).front(), tabletTargets(w, field.body).back()}) {
        SCOPED_TRACE(target.name);
        const nlohmann::json printed = match(target);
        const LiteralGrid voxels = voxelsOf(target);
        std::string state;
        for (const nlohmann::json& level : printed["state"]) state += (state.empty() ? "" : ",") + level.dump();
        const Outcome deformed = lumorph({"rig", "deform", cutTabletFile(), "--state", state, "-o", w["fit.obj"]});
        ASSERT_EQ(deformed.exitCode, 0) << deformed.err;
        const InsideOracle inside(readMesh(w["fit.obj"]));
        std::size_t both = 0;
        std::size_t either = 0;
        for (int z = 0; z < voxels.size[2]; ++z)
            for (int y = 0; y < voxels.size[1]; ++y)
                for (int x = 0; x < voxels.size[0]; ++x) {
                    const std::size_t v = voxels.index(x, y, z);
                    if (field.body.values[v] != 0) continue;
                    const bool wanted = voxels.values[v] != 0;
                    const bool covered = inside(
                        {origin[0] + (x + 0.5) * side, origin[1] + (y + 0.5) * side, origin[2] + (z + 0.5) * side});
                    both += wanted && covered ? 1U : 0U;
                    either += wanted || covered ? 1U : 0U;
                }
        ASSERT_GT(both, 0U);
        EXPECT_NEAR(printed["iou"].get<double>(), static_cast<double>(both) / static_cast<double>(either), 0.005);
    }
}

} // namespace
} // namespace lumorph::test

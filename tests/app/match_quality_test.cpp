#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/app/eq1_targets.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"

namespace lumorph::test {
namespace {

/// Enough for any refinement to end by itself, on a slow machine too.
const std::string kPatience = "60000";

nlohmann::json matchJson(const std::vector<std::string>& arguments) {
    const Outcome outcome = lumorph(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return outcome.json();
}

std::vector<std::vector<std::string>> tableOf(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream cells(line);
        rows.emplace_back();
        for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
}

TEST(MatchQuality, RefinedIsNeverWorseThanVoting) {
    const TabletWorkspace w;
    ASSERT_EQ(lumorph({"mdf", "export", w.field(), "-o", w["grids"]}).exitCode, 0);
    int better = 0;
    for (const MatchTarget& target : tabletTargets(w, readLiteralGrid(w["grids/body.nrrd"]))) {
        SCOPED_TRACE(target.name);
        std::vector<std::string> arguments{"match", w.field(), target.path, "--json"};
        if (target.fit) arguments.emplace_back("--fit");
        const nlohmann::json voting = matchJson(arguments);
        arguments.insert(arguments.end(), {"--method", "refined", "--budget-ms", kPatience});
        const nlohmann::json refined = matchJson(arguments);
        EXPECT_GE(refined["iou"].get<double>(), voting["iou"].get<double>());
        EXPECT_DOUBLE_EQ(refined["iouBefore"].get<double>(), voting["iou"].get<double>());
        EXPECT_TRUE(refined["converged"].get<bool>());
        if (refined["iou"].get<double>() > voting["iou"].get<double>()) ++better;
        // A state that the device can reach is as good as found again.
        EXPECT_GE(refined["iou"].get<double>(), target.name.starts_with("hidden") ? 0.97 : 0.0);
    }
    EXPECT_GT(better, 0);
}

TEST(MatchQuality, AutoPlaceIsAtLeastAsGoodAsFit) {
    const TabletWorkspace w;
    const std::vector<std::string> match{
        "match", w.field(), resource("targets/dunes.glb"), "--json", "--method", "refined", "--budget-ms", kPatience};
    const auto with = [&](const char* option) {
        std::vector<std::string> arguments = match;
        arguments.emplace_back(option);
        return matchJson(arguments);
    };
    const nlohmann::json fit = with("--fit");
    const nlohmann::json placed = with("--auto-place");
    EXPECT_GE(placed["iou"].get<double>(), fit["iou"].get<double>());
    EXPECT_GE(placed["iou"].get<double>(), placed["placement"]["iouAtFit"].get<double>());
    EXPECT_GT(placed["placement"]["placementsSeen"].get<int>(), 12);
}

// R19
TEST(MatchQuality, AnimationKeepsToTheVelocityLimits) {
    constexpr double kFramesPerSecond = 25.0;
    constexpr std::size_t kFirstActuator = 3; // column: after seconds, IoU wanted and reached
    const nlohmann::json rig = matchJson({"rig", "info", resource("models/tablet.glb"), "--states", "1", "--json"});
    const Outcome outcome = lumorph({"match", resource("models/tablet.mdf"), resource("targets/swell.glb"),
                                     "--animation", "first", "--fps", "25", "--csv", "-"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto rows = tableOf(outcome.out);
    ASSERT_EQ(rows.size(), 1U + 101U); // a title and the frames 0 to 100 of four seconds

    bool hurried = false; // somewhere the wanted level jumps further than the limit lets the actuator move
    for (std::size_t i = 0; i < rig["actuators"].size(); ++i) {
        const std::string name = rig["actuators"][i]["name"];
        SCOPED_TRACE(name);
        const double limit = rig["actuators"][i]["maxVelocity"].get<double>() / kFramesPerSecond;
        const std::size_t column = kFirstActuator + 2 * i + 1;
        ASSERT_EQ(rows[0][column], name + " stroke");
        EXPECT_EQ(std::stod(rows[1][column]), 0.0); // starts at rest
        double moved = 0.0;
        for (std::size_t k = 1; k < rows.size(); ++k) {
            EXPECT_NEAR(std::stod(rows[k][0]), static_cast<double>(k - 1) / kFramesPerSecond, 1e-6);
            if (k == 1) continue;
            const double step = std::abs(std::stod(rows[k][column]) - std::stod(rows[k - 1][column]));
            EXPECT_LE(step, limit + 1e-6) << "frame " << k - 1; // the table has six digits
            moved += step;
            const double asked = std::abs(std::stod(rows[k][column - 1]) - std::stod(rows[k - 1][column - 1])) / 32.0;
            hurried = hurried || asked > limit;
        }
        EXPECT_GT(moved, 0.5);
    }
    EXPECT_TRUE(hurried);
}

// R19
TEST(MatchQuality, AnimationIsReachedBetterByLookingAhead) {
    const auto reached = [](const char* animation, const char* seconds) {
        return matchJson({"match", resource("models/tablet.mdf"), resource(animation), "--animation", "first", "--fps",
                          "10", "--json", "--look-ahead", seconds});
    };
    for (const char* animation : {"targets/swell.glb", "targets/bloom.glb"}) {
        const nlohmann::json alone = reached(animation, "0");
        const nlohmann::json ahead = reached(animation, "1");
        EXPECT_EQ(ahead["lookAhead"], 1.0);
        EXPECT_EQ(ahead["iouWanted"], alone["iouWanted"]) << "votes are the same";
        EXPECT_GE(ahead["iouReached"].get<double>(), alone["iouReached"].get<double>() + 0.03) << animation;
    }
}

} // namespace
} // namespace lumorph::test

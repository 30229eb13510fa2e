#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/measured_sigma.h"
#include "core/scene/project.h"
#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

nlohmann::json budgetOfProject(const std::filesystem::path& file, const char* speed = "0.3") {
    const Outcome outcome = lumorph({"calibrate", "budget", file.string(), "--speed", speed, "--json"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return outcome.json();
}

TEST(CalibrateBudget, MeasuringAPartLowersItAndIsTold) {
    const TemporaryFolder folder;
    const auto file = folder / "tablet.lumorph";
    Project project;
    project.rig = writeCutTablet(folder.path()).filename().string();
    writeProject(project, file);
    const nlohmann::json before = budgetOfProject(file);
    ASSERT_EQ(before["parts"].size(), 8U);
    double squares = 0.0, shares = 0.0;
    for (const auto& part : before["parts"]) {
        squares += std::pow(part["millimetres"].get<double>(), 2);
        shares += part["share"].get<double>();
    }
    EXPECT_NEAR(before["totalMm"].get<double>(), std::sqrt(squares), 1e-6);
    EXPECT_NEAR(shares, 1.0, 1e-6);
    EXPECT_EQ(before["trackerPlaced"], false);
    EXPECT_EQ(before["advice"][0]["part"], "tracker") << "before all else";
    EXPECT_EQ(before["parts"][2]["source"], "assumed");

    const auto measured = [](const MeasuredSigma& sigma) {
        return Origin{Origin::Way::measured, withSigma("in a test", sigma), "2026-11-26T10:00:00Z"};
    };
    project.installation.origins.deviceBody = measured({0.0005, 0.002, 0.0});
    project.installation.origins.tracker = measured({0.0008, 0.001, 0.0});
    writeProject(project, file);
    const nlohmann::json after = budgetOfProject(file);
    EXPECT_EQ(after["parts"][2]["source"], "measured");
    EXPECT_EQ(after["trackerPlaced"], true);
    EXPECT_LT(after["parts"][2]["millimetres"].get<double>(), 0.1 * before["parts"][2]["millimetres"].get<double>());
    EXPECT_EQ(after["parts"][3]["millimetres"], before["parts"][3]["millimetres"]) << "the eye was not touched";
    EXPECT_LT(after["totalMm"].get<double>(), before["totalMm"].get<double>());
    ASSERT_FALSE(after["advice"].empty());
    for (const auto& advice : after["advice"]) EXPECT_LT(advice["afterMm"], advice["beforeMm"]);

    const nlohmann::json resting = budgetOfProject(file, "0");
    EXPECT_EQ(resting["parts"][5]["millimetres"], 0.0) << "a delay harms only what moves";
    EXPECT_LT(resting["parts"][6]["millimetres"].get<double>(), 0.5) << "what rests is still";
}

TEST(CalibrateBudget, IsReadAloudAndRefusesWrongNumbers) {
    const Outcome words = lumorph({"calibrate", "budget", "resource:projects/techniques.lumorph"});
    ASSERT_EQ(words.exitCode, 0) << words.err;
    EXPECT_THAT(words.out, HasSubstr("all together"));
    EXPECT_THAT(words.out, HasSubstr("not measured, usual size"));
    EXPECT_EQ(lumorph({"calibrate", "budget", "resource:projects/techniques.lumorph", "--speed", "-1"}).exitCode, 2);
    EXPECT_EQ(lumorph({"calibrate", "budget", "resource:projects/nowhere.lumorph"}).exitCode, 1);
}

} // namespace
} // namespace lumorph::test

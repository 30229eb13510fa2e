#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/project.h"
#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"

// What the virtual lab made is simulated wherever it is printed, and joins nothing real unless that is said.

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::filesystem::path tabletRoom(const TemporaryFolder& folder, void (*edit)(Installation&) = nullptr) {
    const auto file = folder / "tablet.lumorph";
    Project project;
    project.rig = writeCutTablet(folder.path()).filename().string();
    if (edit) edit(project.installation);
    writeProject(project, file);
    return file;
}

TEST(SimulatedRoom, LightAndDelaysOfTheLabShowNowhereAsMeasured) {
    const TemporaryFolder folder;
    const auto file = tabletRoom(folder);
    for (const char* stage : {"light", "delays"}) {
        const Outcome outcome = lumorph({"calibrate", stage, file.string(), "--seed", "4", "--apply", "--json"});
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(outcome.json()["way"], "simulated");
        EXPECT_EQ(outcome.json()["applied"], true);
    }
    const std::string text = projectText(readProject(file));
    EXPECT_THAT(text, HasSubstr("\"way\": \"simulated\""));
    EXPECT_THAT(text, Not(HasSubstr("\"way\": \"measured\"")));
    const nlohmann::json budget = lumorph({"calibrate", "budget", file.string(), "--json"}).json();
    EXPECT_EQ(budget["simulated"], true);
    EXPECT_EQ(budget["parts"][5]["part"], "delay");
    EXPECT_EQ(budget["parts"][5]["source"], "simulated");
    for (const auto& part : budget["parts"]) EXPECT_NE(part["source"], "measured") << part["part"];
    for (const auto& advice : budget["advice"]) EXPECT_EQ(advice["measuredBefore"], false) << advice["part"];
    const Outcome words = lumorph({"calibrate", "budget", file.string()});
    EXPECT_THAT(words.out, HasSubstr("simulated in the virtual lab"));
    EXPECT_THAT(words.out, HasSubstr("says nothing of this room"));
    EXPECT_THAT(words.out, Not(HasSubstr("%  measured")));
}

TEST(SimulatedRoom, AMeasuredOrEnteredRoomTakesNothingFromTheLabUnlessThatIsSaid) {
    constexpr auto kMeasured = [](Installation& room) {
        room.projectors.front().lens = {Origin::Way::measured, "structured light, 6 boards", "2026-11-20T10:00:00Z"};
    };
    constexpr auto kEntered = [](Installation& room) { room.origins.table.way = Origin::Way::entered; };
    for (void (*edit)(Installation&) : {+kMeasured, +kEntered}) {
        const TemporaryFolder folder;
        const auto file = tabletRoom(folder, edit);
        const Installation before = readProject(file).installation;
        for (const char* stage : {"light", "delays", "servos", "verify"}) {
            const Outcome refused = lumorph({"calibrate", stage, file.string(), "--apply"});
            EXPECT_EQ(refused.exitCode, 2) << stage;
            EXPECT_THAT(refused.err, HasSubstr("measured or entered (")) << stage;
            EXPECT_THAT(refused.err, HasSubstr("add --simulated")) << stage;
            EXPECT_EQ(readProject(file).installation, before) << stage;
        }
    }
    const TemporaryFolder folder;
    const auto file = tabletRoom(folder, kMeasured);
    const Outcome applied = lumorph({"calibrate", "delays", file.string(), "--apply", "--simulated", "--json"});
    ASSERT_EQ(applied.exitCode, 0) << applied.err;
    const Installation after = readProject(file).installation;
    EXPECT_EQ(after.origins.delays.way, Origin::Way::simulated);
    EXPECT_EQ(after.projectors.front().lens.way, Origin::Way::measured) << "what is real stays so";
}

} // namespace
} // namespace lumorph::test

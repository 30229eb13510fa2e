#include <chrono>
#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/process.h"
#include "tests/app/workspace.h"

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

TEST(CommandLineInterrupt, ABuildStopsSoonAndLeavesNothing) {
    const TemporaryFolder folder;
    const std::string output = (folder / "long.mdf").string();
    Process build(lumorphProgram(),
                  {"mdf", "build", resource("models/tablet.glb"), "-o", output, "--resolution", "65", "--levels", "100",
                   "--samples", "60000"},
                  {}, Process::ErrorStream::terminal);
    ASSERT_TRUE(build.waitForError("%", 60s)) << "no progress bar";
    const auto start = std::chrono::steady_clock::now();
    build.send(SIGINT);
    const Outcome outcome = build.wait(20s);
    EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.err, HasSubstr("lumorph: stopped: it was asked to; nothing was written"));
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(filesIn(folder.path()).empty()) << ::testing::PrintToString(filesIn(folder.path()));
}

TEST(CommandLineInterrupt, NoProgressBarIsDrawnWhereNobodyLooks) {
    const SmallWorkspace w;
    const Outcome outcome = lumorph({"mdf", "build", w["rig.glb"], "-o", w["x.mdf"], "--resolution", "9"});
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_EQ(outcome.err, "");
}

} // namespace
} // namespace lumorph::test

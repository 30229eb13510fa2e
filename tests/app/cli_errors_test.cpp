#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/process.h"
#include "tests/app/workspace.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;

struct Mistake {
    int exitCode;
    std::vector<std::string> arguments; ///< {NAME} is a file of the workspace
    std::string says;                   ///< part of the message
};

std::string truncated(const std::string& text) { return text.substr(0, text.size() / 2); }

std::string flipped(std::string text) {
    for (std::size_t at = text.size() / 2; at < text.size() / 2 + 4; ++at) text[at] = static_cast<char>(~text[at]);
    return text;
}

class CommandLineErrors : public ::testing::Test {
protected:
    CommandLineErrors() {
        const std::string field = textOfFile(w["field.mdf"]);
        writeFile(w["truncated.mdf"], truncated(field));
        writeFile(w["flipped.mdf"], flipped(field));
        writeFile(w["empty.mdf"], std::string());
        writeFile(w["truncated.glb"], truncated(textOfFile(w["rig.glb"])));
        writeFile(w["truncated.obj"], "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
        writeFile(w["mesh.xyz"], "0 0 0\n");
        const Outcome grid = lumorph({"voxelize", w["target.obj"], "--like", w["field.mdf"], "-o", w["good.nrrd"]});
        EXPECT_EQ(grid.exitCode, 0) << grid.err;
        writeFile(w["other.nrrd"], "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n\n\x01\x01");
        writeFile(w["short.nrrd"], truncated(textOfFile(w["good.nrrd"])));
    }

    std::vector<std::string> filled(std::vector<std::string> arguments) const {
        for (std::string& argument : arguments)
            if (argument.front() == '{') argument = w[argument.substr(1, argument.size() - 2)];
        return arguments;
    }

    /// Each fails with its exit code, one line of the agreed form, nothing on stdout, and no new file.
    void expectRefused(const std::vector<Mistake>& mistakes) const {
        const std::vector<std::string> before = filesIn(w.folder());
        for (const Mistake& mistake : mistakes) {
            SCOPED_TRACE(::testing::PrintToString(mistake.arguments));
            const Outcome outcome = lumorph(filled(mistake.arguments));
            EXPECT_EQ(outcome.exitCode, mistake.exitCode);
            EXPECT_EQ(outcome.out, "");
            EXPECT_THAT(outcome.err, ::testing::MatchesRegex("lumorph: [^\n]+: [^\n]+; [^\n]+\n"));
            EXPECT_THAT(outcome.err, HasSubstr(mistake.says));
            EXPECT_EQ(filesIn(w.folder()), before);
        }
    }

    SmallWorkspace w;
};

TEST_F(CommandLineErrors, WrongUsageExitsWithTwo) {
    expectRefused({
        {2, {}, "subcommand"},
        {2, {"mdf"}, "subcommand"},
        {2, {"shake"}, "'shake' is no command"},
        {2, {"mdf", "shake"}, "'shake' is no command"},
        {2, {"mdf", "info", "{field.mdf}", "--colour"}, "see 'lumorph mdf info --help'"},
        {2, {"rig", "info"}, "rig is required"},
        {2, {"rig", "info", "{rig.glb}", "--states", "-3"}, "--states"},
        {2, {"rig", "deform", "{rig.glb}", "--state", "1,2,3"}, "--output"},
        {2, {"rig", "deform", "{rig.glb}", "--state", "1,2", "-o", "{x.obj}"}, "3"},
        {2, {"rig", "deform", "{rig.glb}", "--state", "0,33,0", "-o", "{x.obj}"}, "33"},
        {2, {"rig", "deform", "{rig.glb}", "--state", "0,-1,0", "-o", "{x.obj}"}, "-1"},
        {2, {"rig", "deform", "{rig.glb}", "--state", "0,x,0", "-o", "{x.obj}"}, "'x' is not a whole number"},
        {2, {"rig", "deform", "{rig.glb}", "--state", "0,0,0,", "-o", "{x.obj}"}, "'' is not a whole number"},
        {2, {"rig", "deform", "{rig.glb}", "--state", "0,0,0", "-o", "{x.step}"}, ".obj, .stl or .glb"},
        {2, {"mdf", "build", "{rig.glb}"}, "--output"},
        {2, {"mdf", "build", "{rig.glb}", "-o", "{x.mdf}", "--levels", "1"}, "--levels"},
        {2, {"mdf", "build", "{rig.glb}", "-o", "{x.mdf}", "--levels", "201"}, "--levels"},
        {2, {"mdf", "build", "{rig.glb}", "-o", "{x.mdf}", "--resolution", "0"}, "--resolution"},
        {2, {"mdf", "build", "{rig.glb}", "-o", "{x.mdf}", "--resolution", "4000"}, "resolution"},
        {2, {"mdf", "build", "{rig.glb}", "-o", "{x.mdf}", "--samples", "many"}, "--samples"},
        {2, {"mdf", "build", "{rig.glb}", "-o", "{x.mdf}", "--seed", "-1"}, "--seed"},
        {2, {"mdf", "build", "{rig.glb}", "-o", "-", "--json"}, "--json"},
        {2, {"mdf", "reach", "{field.mdf}", "-o", "-", "--json"}, "--json"},
        {2, {"mdf", "build", "{rig.glb}", "-o", "{rig.glb}"}, "replace"},
        {2, {"voxelize", "{target.obj}", "-o", "{x.nrrd}"}, "--like"},
        {2, {"voxelize", "{good.nrrd}", "--like", "{field.mdf}", "--fit", "-o", "{x.nrrd}"}, "--fit"},
        {2, {"voxelize", "{good.nrrd}", "--like", "{field.mdf}", "--surface", "-o", "{x.nrrd}"}, "--surface"},
        {2, {"match", "{field.mdf}"}, "target is required"},
        {2, {"match", "{field.mdf}", "{target.obj}", "--method", "guessing"}, "guessing"},
        {2, {"match", "{field.mdf}", "{good.nrrd}", "--fit"}, "--fit"},
        {2, {"match", "{field.mdf}", "{target.obj}", "--fit", "--auto-place"}, "--fit"},
        {2, {"match", "{field.mdf}", "{target.obj}", "--budget-ms", "nan"}, "--budget-ms"},
        {2, {"match", "{field.mdf}", "{target.obj}", "--budget-ms", "0"}, "--budget-ms"},
        {2, {"match", "{field.mdf}", "{target.obj}", "--certify", "nan"}, "--certify"},
        {2, {"match", "{field.mdf}", "{target.obj}", "--certify", "0"}, "--certify"},
        {2, {"match", "{field.mdf}", "{target.obj}", "--repeat", "0"}, "--repeat"},
        {2, {"match", "{field.mdf}", "{target.obj}", "--csv", "{x.csv}"}, "--animation"},
        {2, {"match", "{field.mdf}", "{target.obj}", "--picture", "-"}, "--picture"},
    });
}

TEST_F(CommandLineErrors, FilesThatAreNotWhatTheyShouldBeExitWithOne) {
    expectRefused({
        {1, {"rig", "info", "{missing.glb}"}, "missing.glb"},
        {1, {"rig", "info", "{truncated.glb}"}, "truncated.glb"},
        {1, {"rig", "info", "{field.mdf}"}, "field.mdf"},
        {1, {"mdf", "build", "{mesh.xyz}", "-o", "{x.mdf}"}, "mesh.xyz"},
        {1, {"mdf", "build", "{truncated.glb}", "-o", "{x.mdf}"}, "truncated.glb"},
        {1, {"mdf", "info", "{missing.mdf}"}, "missing.mdf"},
        {1, {"mdf", "info", "{truncated.mdf}", "--json"}, "truncated.mdf"},
        {1, {"mdf", "info", "{flipped.mdf}", "--json"}, "flipped.mdf"},
        {1, {"mdf", "info", "{empty.mdf}"}, "empty.mdf"},
        {1, {"mdf", "info", "{rig.glb}"}, "rig.glb"},
        {1, {"mdf", "info", "-"}, "standard input"},
        {1, {"mdf", "export", "{flipped.mdf}", "-o", "{grids}"}, "flipped.mdf"},
        {1, {"voxelize", "{missing.obj}", "--like", "{field.mdf}", "-o", "{x.nrrd}"}, "missing.obj"},
        {1, {"voxelize", "{truncated.obj}", "--like", "{field.mdf}", "-o", "{x.nrrd}"}, "line 4"},
        {1, {"voxelize", "-", "--like", "{field.mdf}", "-o", "{x.nrrd}"}, "standard input"},
        {1, {"match", "{truncated.mdf}", "{target.obj}"}, "truncated.mdf"},
        {1, {"match", "{field.mdf}", "{missing.obj}", "--json"}, "missing.obj"},
        {1, {"match", "{field.mdf}", "{mesh.xyz}", "--json"}, "mesh.xyz"},
        {1, {"match", "{field.mdf}", "{other.nrrd}", "--json"}, "other.nrrd"},
        {1, {"match", "{field.mdf}", "{short.nrrd}", "--json"}, "short.nrrd"},
        {1, {"match", "{field.mdf}", "{target.obj}", "--animation", "first"}, "target.obj"},
        {1, {"match", "{field.mdf}", "{rig.glb}", "--animation", "first"}, "animation"},
    });
}

TEST_F(CommandLineErrors, AnOutputThatCannotBeIsRefusedBeforeTheWork) {
    const std::string nowhere = w["nowhere/x.out"];
    expectRefused({
        {1, {"mdf", "build", "{rig.glb}", "-o", nowhere}, "nowhere"},
        {1, {"mdf", "build", "{rig.glb}", "-o", w.folder().string()}, "folder"},
        {1, {"rig", "deform", "{rig.glb}", "--state", "0,0,0", "-o", nowhere}, "nowhere"},
        {1, {"voxelize", "{target.obj}", "--like", "{field.mdf}", "-o", nowhere}, "nowhere"},
        {1, {"match", "{field.mdf}", "{target.obj}", "--picture", nowhere}, "nowhere"},
    });
}

TEST_F(CommandLineErrors, AFailedCommandLeavesTheOldFile) {
    const std::string before = textOfFile(w["good.nrrd"]);
    const Outcome outcome = lumorph({"voxelize", w["truncated.obj"], "--like", w["field.mdf"], "-o", w["good.nrrd"]});
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_EQ(textOfFile(w["good.nrrd"]), before);
}

} // namespace
} // namespace lumorph::test

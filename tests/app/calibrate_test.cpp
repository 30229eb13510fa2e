#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/process.h"
#include "tests/app/workspace.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/procam_capture.h"

namespace lumorph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

std::string readText(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

/// A simulated capture of four poses by phase shift, and one picture under white light of each.
class Calibrate : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        const ProcamSetup setup = ProcamSetup::usual();
        std::vector<std::vector<Image>> poses;
        std::filesystem::create_directories(*folder_ / "pictures");
        for (const std::size_t pose : {0U, 1U, 3U, 5U}) {
            poses.push_back(photographAll(setup, setup.cameraFromBoard[pose], phaseLights(setup.projector.size, 16),
                                          static_cast<std::uint32_t>(pose) + 1));
            const auto white = [](int, int) { return 1.0; };
            writePng(photograph(setup, seenSamples(setup, setup.cameraFromBoard[pose]), white, 7),
                     *folder_ / "pictures" / imageName(pose));
        }
        writeCapture(*folder_ / "capture", poses);
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static Outcome procam(const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"calibrate", "procam",       (*folder_ / "capture").string(),
                                           "--board",   "chess:9x7:30", "--projector",
                                           "256x192"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lumorph(arguments);
    }

    static std::unique_ptr<TemporaryFolder> folder_;
};

std::unique_ptr<TemporaryFolder> Calibrate::folder_;

TEST_F(Calibrate, ProcamPrintsTheTrueProjectorAsJson) {
    const Outcome outcome = procam({"--pattern", "phase:16x3+1x3", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json result = outcome.json();
    for (const char* key : {"camera", "projector", "R", "T", "rms", "views", "worstView", "halvesDiffer",
                            "halvesAllowed", "model", "warnings", "degenerate"})
        EXPECT_TRUE(result.contains(key)) << key;
    for (const char* device : {"camera", "projector"})
        for (const char* key : {"K", "distortion", "size", "rms", "sigma"})
            EXPECT_TRUE(result[device].contains(key)) << key;
    const double sigma = result["projector"]["sigma"]["fx"];
    EXPECT_NEAR(result["projector"]["K"][0][0], 470.0, 4.0 * sigma);
    EXPECT_LT(sigma, 2.5);
    EXPECT_NEAR(result["projector"]["K"][1][2], 213.0, 4.0 * double(result["projector"]["sigma"]["cy"]));
    EXPECT_NEAR(result["T"][1], -255.0, 4.0 * double(result["sigma"]["T"][1]));
    EXPECT_LT(result["rms"], 0.2);
    ASSERT_EQ(result["views"].size(), 4U);
    EXPECT_LT(result["views"][0]["heldOutTransfer"], 0.4);
    EXPECT_EQ(result["degenerate"], false);
}

TEST_F(Calibrate, AnOrderFileSaysTheSameAsItsPattern) {
    std::string lines;
    for (const char* axis : {"column", "row"})
        for (const char* periods : {"16", "1"})
            for (const char* step : {"0", "1", "2"})
                lines += std::string(axis) + " phase " + periods + " step " + step + " of 3\n";
    writeFile(*folder_ / "order.txt", lines);
    const Outcome outcome = procam({"--order", (*folder_ / "order.txt").string(), "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    // Beside what is printed, the same goes into files.
    const auto exported = *folder_ / "procam.json";
    const auto report = *folder_ / "report.html";
    const nlohmann::json printed =
        procam({"--pattern", "phase:16x3+1x3", "--json", "--export", exported.string(), "--report", report.string()})
            .json();
    EXPECT_EQ(outcome.json(), printed);
    const nlohmann::json kept = nlohmann::json::parse(readText(exported));
    EXPECT_EQ(kept["lumorph"], "calibration");
    EXPECT_EQ(kept["board"], "chess:9x7:30");
    for (const char* key : {"K", "distortion", "size", "rms", "sigma"}) {
        EXPECT_EQ(kept["projector"][key], printed["projector"][key]) << key;
        EXPECT_EQ(kept["camera"][key], printed["camera"][key]) << key;
    }
    for (const char* key : {"R", "T", "sigma", "rms", "worstView", "halvesDiffer", "degenerate"})
        EXPECT_EQ(kept[key], printed[key]) << key;
    const std::string page = readText(report);
    EXPECT_THAT(page, HasSubstr("chess:9x7:30"));
    for (const auto& view : printed["views"]) EXPECT_THAT(page, HasSubstr(std::string(view["name"])));
    EXPECT_THAT(page, HasSubstr("What the camera saw"));
}

TEST_F(Calibrate, ARefusalIsReportedToo) {
    const auto report = *folder_ / "refused.html";
    EXPECT_EQ(procam({"--pattern", "graycode", "--report", report.string()}).exitCode, 1);
    EXPECT_THAT(readText(report), HasSubstr("projector_size"));
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--report", "x.pdf"}, std::vector<std::string>{"--report", "x.txt"},
          std::vector<std::string>{"--export", "x.xml"}}) {
        const Outcome outcome = procam(more);
        EXPECT_EQ(outcome.exitCode, 2) << more[1];
        EXPECT_THAT(outcome.err, MatchesRegex("lumorph: [^\n]+: [^\n]+; [^\n]+\n"));
    }
}

TEST_F(Calibrate, ARefusalHasItsCauseOnBothStreams) {
    const Outcome outcome = procam({"--pattern", "graycode", "--json"});
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_THAT(outcome.err, MatchesRegex("lumorph: [^\n]+: [^\n]+; [^\n]+\n"));
    const nlohmann::json refused = outcome.json()["refused"];
    EXPECT_EQ(refused["cause"], "projector_size");
    EXPECT_TRUE(refused["view"].is_null());
    EXPECT_TRUE(refused["file"].is_null());
    EXPECT_THAT(outcome.err, HasSubstr(std::string(refused["sentence"])));
}

TEST_F(Calibrate, WrongArgumentsAreUsage) {
    for (const auto& [board, projector, pattern] : {std::tuple("chess:9x7", "256x192", "graycode"),
                                                    {"chess:9x7:30", "256", "graycode"},
                                                    {"chess:9x7:30", "256x192", "grey"}}) {
        const Outcome outcome = lumorph({"calibrate", "procam", (*folder_ / "capture").string(), "--board", board,
                                         "--projector", projector, "--pattern", pattern});
        EXPECT_EQ(outcome.exitCode, 2) << outcome.err;
        EXPECT_THAT(outcome.err, MatchesRegex("lumorph: [^\n]+: [^\n]+; [^\n]+\n"));
    }
}

TEST_F(Calibrate, IntrinsicsPrintsTheTrueCameraAsJson) {
    const Outcome outcome =
        lumorph({"calibrate", "intrinsics", (*folder_ / "pictures").string(), "--board", "chess:9x7:30", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json result = outcome.json();
    EXPECT_NEAR(result["camera"]["K"][0][0], 960.0, 4.0 * double(result["camera"]["sigma"]["fx"]));
    EXPECT_LT(result["camera"]["sigma"]["fx"], 5.0);
    EXPECT_EQ(result["camera"]["size"], nlohmann::json({480, 360}));
    ASSERT_EQ(result["views"].size(), 4U);
    EXPECT_LT(result["views"][0]["rms"], 0.2);
    EXPECT_TRUE(result["worstView"].is_string());
}

TEST_F(Calibrate, IntrinsicsRefusesTheWrongBoard) {
    const Outcome outcome =
        lumorph({"calibrate", "intrinsics", (*folder_ / "pictures").string(), "--board", "chess:8x7:30", "--json"});
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_EQ(outcome.json()["refused"]["cause"], "board_not_found");
}

} // namespace
} // namespace lumorph::test

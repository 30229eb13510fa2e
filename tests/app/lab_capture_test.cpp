#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/process.h"
#include "tests/core/temporary_folder.h"

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

nlohmann::json truthIn(const fs::path& folder) {
    std::ifstream file(folder / "truth.json");
    return nlohmann::json::parse(file);
}

std::vector<std::string> captureArguments(const fs::path& folder, const std::vector<std::string>& more = {}) {
    std::vector<std::string> all{"lab", "capture", "--board", "chess:9x7:25", "--size", "320x256", "--poses", "2"};
    all.insert(all.end(), more.begin(), more.end());
    all.insert(all.end(), {"-o", folder.string()});
    return all;
}

TEST(LabCapture, WritesAFolderAPoseAndItsTruth) {
    const TemporaryFolder folder;
    const Outcome outcome = lumorph(captureArguments(folder / "sound", {"--json"}));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("no camera"));
    EXPECT_EQ(outcome.json()["projector"], nlohmann::json({1920, 1080}));
    for (const char* pose : {"pose_00", "pose_01"}) {
        EXPECT_EQ(std::distance(fs::directory_iterator(folder / "sound" / pose), {}), 46) << pose; // 2 x (11 + 11) + 2
        EXPECT_TRUE(fs::exists(folder / "sound" / pose / "image_45.png"));
    }
    const nlohmann::json truth = truthIn(folder / "sound");
    EXPECT_EQ(truth["camera"]["size"], nlohmann::json({320, 256}));
    EXPECT_EQ(truth["projector"]["K"][0][0], 6080.0);
    EXPECT_EQ(truth["poses"].size(), 2U);
    EXPECT_EQ(truth["board"]["points"].size(), 63U);
    EXPECT_TRUE(truth["faults"].empty());
    // The first board lies flat on the table: its normal is the world's y.
    EXPECT_NEAR(std::abs(double(truth["poses"][0]["worldFromBoard"][1][2])), 1.0, 1e-12);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << "something was left beside";
}

/// What a shell makes of the line that a capture printed last.
Outcome pasted(const Outcome& capture) {
    const std::size_t end = capture.out.find_last_not_of('\n') + 1;
    const std::size_t begin = capture.out.rfind('\n', end - 1) + 1;
    const std::string folder = fs::path(lumorphProgram()).parent_path().string();
    return Process("/bin/sh",
                   {"-c", "PATH='" + folder + "':$PATH\n" + capture.out.substr(begin, end - begin) + " --json"})
        .wait();
}

TEST(LabCapture, WhatItPrintsCanBePastedIntoAShell) {
    const TemporaryFolder folder;
    const fs::path place = folder / "it's (1) $HOME `id` \"x\" & M\u00F6bel";
    // A board larger than what the projector lights is printed smaller; the words say how large it is.
    const Outcome capture = lumorph({"lab", "capture", "--board", "chess:9x7:75", "--size", "640x512", "--poses", "4",
                                     "--seed", "3", "-o", place.string()});
    ASSERT_EQ(capture.exitCode, 0) << capture.err;
    EXPECT_THAT(capture.err, HasSubstr("taken as printed smaller: chess:9x7:26.363."));
    EXPECT_THAT(capture.out, HasSubstr(" --board chess:9x7:26.363 --projector 1920x1080 --pattern graycode\n"));
    const Outcome result = pasted(capture);
    ASSERT_EQ(result.exitCode, 0) << result.err << result.out << capture.out;
    // Lengths are right where the board's are: the projector stands as far from the camera as it does.
    const nlohmann::json truth = truthIn(place), found = result.json();
    const auto distance = [](const nlohmann::json& device) {
        const auto t = device["T"].get<std::vector<double>>();
        return std::hypot(t.at(0), t.at(1), t.at(2));
    };
    EXPECT_EQ(truth["board"]["name"], "chess:9x7:26.363");
    EXPECT_NEAR(distance(found), distance(truth), 0.03 * distance(truth));
}

TEST(LabCapture, TheSameSeedGivesTheSameBytesAndAFaultIsTold) {
    const TemporaryFolder folder;
    for (const char* name : {"one", "other"})
        ASSERT_EQ(lumorph(captureArguments(folder / name, {"--seed", "5", "--fault", "missing_image"})).exitCode, 0);
    const nlohmann::json truth = truthIn(folder / "one");
    ASSERT_EQ(truth["faults"].size(), 1U);
    EXPECT_EQ(truth["faults"][0]["key"], "missing_image");
    const std::string view = truth["faults"][0]["view"];
    const std::string file = truth["faults"][0]["file"];
    EXPECT_FALSE(fs::exists(folder / "one" / view / file));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "one" / view), {}), 45);
    const auto bytes = [](const fs::path& path) {
        std::ifstream in(path, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    EXPECT_EQ(bytes(folder / "one/pose_01/image_30.png"), bytes(folder / "other/pose_01/image_30.png"));
    EXPECT_EQ(truth, truthIn(folder / "other"));
}

TEST(LabCapture, WrongArgumentsAreRefusedAndNothingIsWritten) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "full");
    std::ofstream(folder / "full/something") << "x";
    const std::pair<std::vector<std::string>, const char*> wrong[] = {
        {captureArguments(folder / "full"), "not an empty folder"},
        {captureArguments(folder / "new", {"--fault", "sabotage"}), "there is no such fault"},
        {captureArguments(folder / "new", {"--fault", "undetermined"}), "cannot make it"},
        {captureArguments(folder / "new", {"--fault", "projector_gamma"}), "phase pattern"},
        {captureArguments(folder / "new", {"--pattern", "stripes"}), "no such pattern"},
        {captureArguments(folder / "new", {"--poses", "0"}), "poses"},
    };
    for (const auto& [arguments, why] : wrong) {
        const Outcome outcome = lumorph(arguments);
        EXPECT_EQ(outcome.exitCode, 2) << why;
        EXPECT_THAT(outcome.err, HasSubstr(why));
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "full"), {}), 1);
}

} // namespace
} // namespace lumorph::test

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "core/base/image.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"

// `lumorph demo` as a script uses it: played without a window, by the studio's own loop.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

TEST(Demo, IsPlayedWithoutAWindowIntoAVideo) {
    const TemporaryFolder folder;
    const std::string video = (folder / "water.mp4").string();
    const Outcome outcome = lumorph({"demo", "water", "--seconds", "0.5", "--record", video, "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto told = outcome.json();
    EXPECT_EQ(told["demo"], "water");
    EXPECT_EQ(told["frames"], 15);
    EXPECT_EQ(told["record"], video);
    EXPECT_GT(told["framesPerSecond"], 0.0);
    EXPECT_GT(told["ms"]["passes"], told["ms"]["loop"]);
    EXPECT_TRUE(told["warnings"].empty()) << told["warnings"];

    cv::VideoCapture shown(video, cv::CAP_FFMPEG);
    cv::Mat first, last;
    ASSERT_TRUE(shown.read(first));
    int frames = 1;
    for (cv::Mat frame; shown.read(frame); ++frames) last = frame.clone();
    EXPECT_EQ(frames, 15);
    EXPECT_GT(cv::norm(first, last, cv::NORM_L1) / static_cast<double>(first.total()), 1.0) << "the sea moves";
    const cv::Scalar color = cv::mean(last(cv::Rect(last.cols / 2 - 20, last.rows / 2 - 20, 40, 40))); // BGR
    EXPECT_GT(color[0], color[2]) << "and is blue";
}

TEST(Demo, FilmHasTheSoundOfItsApplication) {
    const TemporaryFolder folder;
    const auto tracks = [&](const std::string& demo) {
        const std::string video = (folder / (demo + ".mp4")).string();
        EXPECT_EQ(lumorph({"demo", demo, "--seconds", "0.3", "--record", video}).exitCode, 0);
        std::ifstream file(video, std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        return std::pair(bytes.find("vide") != std::string::npos, bytes.find("mp4a") != std::string::npos);
    };
    EXPECT_EQ(tracks("ambient"), std::pair(true, true)) << "wind and waves";
    EXPECT_EQ(tracks("techniques"), std::pair(true, false)) << "which says nothing";
}

TEST(Demo, EndsAtTheFirstSignalAndLeavesNoFilm) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const TemporaryFolder folder;
        Process demo(lumorphProgram(), {"demo", "water", "--seconds", "600", "--record", folder / "x.mp4"}, {},
                     Process::ErrorStream::terminal);
        ASSERT_TRUE(demo.waitForError("drawing", 60s));
        demo.send(signal);
        const Outcome outcome = demo.wait(60s);
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_THAT(outcome.err, HasSubstr("stopped: it was asked to; nothing was written"));
        EXPECT_EQ(outcome.out, "");
        EXPECT_TRUE(filesIn(folder.path()).empty()) << ::testing::PrintToString(filesIn(folder.path()));
    }
}

TEST(Demo, LeavesNoFilmWhereItIsKilled) {
    const TemporaryFolder folder;
    const int unnamed = ::open(folder.path().c_str(), O_TMPFILE | O_RDWR, 0600);
    if (unnamed < 0) GTEST_SKIP() << "this file system has no files without a name";
    ::close(unnamed);
    Process demo(lumorphProgram(), {"demo", "water", "--seconds", "600", "--record", folder / "x.mp4"}, {},
                 Process::ErrorStream::terminal);
    ASSERT_TRUE(demo.waitForError("drawing", 60s));
    // The first picture is in the film when the bar goes on.
    ASSERT_TRUE(demo.waitForError(" 28 %", 120s));
    demo.send(SIGKILL);
    EXPECT_EQ(demo.wait(60s).exitCode, 128 + SIGKILL);
    EXPECT_TRUE(filesIn(folder.path()).empty()) << ::testing::PrintToString(filesIn(folder.path()));
}

TEST(Demo, OfAMatchedTargetPlaysWithoutAWindowToo) {
    const Outcome outcome = lumorph({"demo", "field", "--seconds", "0.1", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto told = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(told["demo"], "field");
    EXPECT_EQ(told["frames"], 3);
    EXPECT_TRUE(told["warnings"].empty()) << told["warnings"];
}

TEST(Demo, WhatWasReadOfAMapIsOneValueForPrograms) {
    const TemporaryFolder folder;
    std::ofstream(folder / "town.osm") << R"(<?xml version="1.0"?><osm version="0.6">
 <node id="1" lat="0.0" lon="9.0"/><node id="2" lat="0.0" lon="9.0002"/><node id="3" lat="0.0002" lon="9.0002"/>
 <way id="10"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="1"/><tag k="building" v="yes"/><tag k="height" v="72 ft"/></way></osm>)";
    std::ofstream(folder / "view.jpg") << "a photo";
    const Outcome outcome =
        lumorph({"demo", "navigation", "--map", folder.path().string(), "--seconds", "0.1", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto told = outcome.json()["map"];
    EXPECT_EQ(told["buildings"], 1);
    EXPECT_NEAR(told["tallest"].get<double>(), 21.9456, 1e-9);
    EXPECT_EQ(told["lowest"], 0.0);
    EXPECT_EQ(told["highest"], 0.0);
    EXPECT_EQ(told["passedOver"], nlohmann::json({"view.jpg"}));
    EXPECT_FALSE(outcome.json()["warnings"].empty()) << "the photo, and the level ground";
}

/// How far apart two pictures are, a pixel.
double picturesDiffer(const Image& one, const Image& other) {
    EXPECT_EQ(one.size(), other.size());
    double sum = 0.0;
    for (int y = 0; y < one.size().y; ++y)
        for (int x = 0; x < one.size().x; ++x)
            for (std::size_t c = 0; c < 3; ++c) sum += std::abs(int(one.at(x, y)[c]) - int(other.at(x, y)[c]));
    return sum / (static_cast<double>(one.size().x) * one.size().y);
}

// The same seed and inputs are the same show.
TEST(Demo, AnApplicationAnswersRecordedInputs) {
    const TemporaryFolder folder;
    const std::string inputs = (folder / "inputs.json").string();
    writeFile(inputs, std::string(R"({"inputs": [{"seconds": 0.0, "name": "key.next", "value": 1},
                                                {"seconds": 0.02, "name": "key.next", "value": 1}]})"));
    const auto play = [&](const std::string& name, const std::vector<std::string>& more) {
        // The last frame itself: what an encoder makes of a film is not the same twice where threads are late.
        const std::string picture = (folder / (name + ".png")).string();
        std::vector<std::string> all{
            "demo",      "labyrinth", "--seconds", "0.1", "--json", "--record", (folder / (name + ".mp4")).string(),
            "--picture", picture};
        all.insert(all.end(), more.begin(), more.end());
        const Outcome outcome = lumorph(all);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_TRUE(outcome.json()["warnings"].empty()) << outcome.json()["warnings"];
        return readPng(picture);
    };
    const Image itself = play("itself", {"--seed", "7"});
    EXPECT_EQ(picturesDiffer(itself, play("again", {"--seed", "7"})), 0.0);
    EXPECT_GT(picturesDiffer(itself, play("next", {"--seed", "7", "--input", inputs})), 3.0) << "another level";
}

/// The last picture of the map after half a second.
Image mapPicture(const TemporaryFolder& folder, const std::vector<std::string>& more) {
    const std::string file = (folder / "map.png").string();
    std::vector<std::string> all{"demo", "navigation", "--seconds", "0.5", "--seed", "2", "--picture", file};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = lumorph(all);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return readPng(file);
}

bool differ(const Image::Pixel& one, const Image::Pixel& other) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(int(one[c]) - int(other[c])));
    return most > 40;
}

// Both halves are seen by one eye: near it all is the same, and what differs is the far edge, which comes up.
TEST(Demo, BendsTheFarEdgeInTheRightHalfOfAComparisonAlone) {
    const TemporaryFolder folder;
    const Image both = mapPicture(folder, {"--bend", "beside"});
    const int half = both.size().x / 2, middle = both.size().y / 2, captions = both.size().y * 7 / 8;
    std::size_t far = 0, near = 0, black[2] = {};
    for (int y = 0; y < captions; ++y)
        for (int x = 4; x < half - 4; ++x) { // beside the line between them
            (y < middle ? far : near) += differ(both.at(x, y), both.at(half + x, y)) ? 1U : 0U;
            for (const int side : {0, 1})
                if (y < middle && differ(both.at(side * half + x, y), {0, 0, 0, 255})) ++black[side];
        }
    const double part = half * middle;
    EXPECT_GT(static_cast<double>(far) / part, 0.02);
    EXPECT_LT(static_cast<double>(near), 0.2 * static_cast<double>(far));
    EXPECT_GT(black[1], black[0]) << "the right one reaches over the table's end";
}

/// Whether one of the bright plates that names stand on is near.
bool isNearPlate(const Image& image, int x, int y) {
    constexpr int kNear = 10;
    for (int v = std::max(0, y - kNear); v <= std::min(y + kNear, image.size().y - 1); ++v)
        for (int u = std::max(0, x - kNear); u <= std::min(x + kNear, image.size().x - 1); ++u) {
            const auto [least, most] = std::minmax({image.at(u, v)[0], image.at(u, v)[1], image.at(u, v)[2]});
            if (least > 190 && most - least < 25) return true;
        }
    return false;
}

TEST(Demo, InGermanDiffersWhereNamesAreReadAlone) {
    const TemporaryFolder folder;
    const Image english = mapPicture(folder, {"--language", "en"}), german = mapPicture(folder, {"--language", "de"});
    std::size_t different = 0, elsewhere = 0;
    for (int y = 0; y < english.size().y; ++y)
        for (int x = 0; x < english.size().x; ++x) {
            if (!differ(english.at(x, y), german.at(x, y))) continue;
            ++different;
            if (!isNearPlate(english, x, y) && !isNearPlate(german, x, y)) ++elsewhere;
        }
    EXPECT_GT(different, 500U) << "pixels";
    EXPECT_LT(different, english.pixels().size() / 50);
    EXPECT_EQ(elsewhere, 0U);
}

TEST(Demo, WrongUseIsNamed) {
    const TemporaryFolder folder;
    const auto refused = [&](const std::vector<std::string>& arguments, int code, const std::string& says) {
        std::vector<std::string> all{"demo"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const Outcome outcome = lumorph(all);
        EXPECT_EQ(outcome.exitCode, code) << says;
        EXPECT_THAT(outcome.err, HasSubstr(says));
        EXPECT_EQ(outcome.out, "") << says;
    };
    refused({"volcano", "--json"}, 2, "there is no demo 'volcano'; there are: water, techniques");
    refused({"water", "--seconds", "0"}, 2, "--seconds");
    refused({"water", "--seconds", "0.5", "--record", (folder / "none/w.mp4").string()}, 1, "its folder is not there");
    refused({"water", "--seconds", "0.5", "--record", (folder / "w.txt").string()}, 2, "ends in .mp4");
    EXPECT_TRUE(filesIn(folder.path()).empty());
    const std::string inputs = (folder / "inputs.json").string();
    writeFile(inputs, std::string(R"({"inputs": [{"seconds": -1, "name": "key.left", "value": 1}]})"));
    refused({"labyrinth", "--json", "--input", inputs}, 1, "inputs[0].seconds");
    refused({"labyrinth", "--json", "--input", (folder / "none.json").string()}, 1, "none.json");
    refused({"field", "--json", "--input", inputs}, 2, "goes by time alone");
    refused({"navigation", "--json", "--bend", "sideways"}, 2,
            "bend 'sideways': it is no way to bend; say off, on or beside");
    refused({"water", "--json", "--bend", "on"}, 2, "--bend: the demo 'water' has no such option; leave it out");
    refused({"navigation", "--json", "--language", "fr"}, 2, "--language: fr not in {en,de}");
}

/// What `demo new` changes of a source tree.
std::vector<std::filesystem::path> filesOfATree() {
    return {"app/applications/CMakeLists.txt", "app/applications/registry/demos.cpp", "packaging/folder_order.txt"};
}

class OwnDemo : public ::testing::Test {
protected:
    OwnDemo() {
        for (const auto& file : filesOfATree()) {
            std::filesystem::create_directories((tree() / file).parent_path());
            std::filesystem::copy_file(std::filesystem::path(LUMORPH_SOURCE_DIR) / file, tree() / file);
        }
    }
    [[nodiscard]] std::filesystem::path tree() const { return folder_ / "tree"; }
    [[nodiscard]] std::string text(const std::filesystem::path& file) const {
        std::ifstream in(tree() / file);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    [[nodiscard]] Outcome make(const std::string& name) const {
        return lumorph({"demo", "new", name, "--tree", tree().string()});
    }
    void expectUntouched() const {
        for (const auto& file : filesOfATree()) {
            std::ifstream in(std::filesystem::path(LUMORPH_SOURCE_DIR) / file);
            EXPECT_EQ(text(file), std::string(std::istreambuf_iterator<char>(in), {})) << file;
        }
    }

private:
    TemporaryFolder folder_;
};

TEST_F(OwnDemo, IsWrittenAndNamedWhereItHasToBe) {
    const Outcome outcome = make("ripple_ring");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("app/applications/ripple_ring/ripple_ring.cpp\n"));
    const std::string source = text("app/applications/ripple_ring/ripple_ring.cpp");
    EXPECT_THAT(source, HasSubstr("RippleRingProgram::frame"));
    EXPECT_THAT(source, HasSubstr("Demo rippleRingDemo() {"));
    EXPECT_THAT(source, HasSubstr("\"Ripple ring\""));
    EXPECT_EQ(source.find("xample"), std::string::npos);
    EXPECT_THAT(text("app/applications/CMakeLists.txt"), HasSubstr("    ripple_ring/ripple_ring.cpp\n"));
    EXPECT_THAT(text("app/applications/registry/demos.cpp"), HasSubstr("ripple_ring::rippleRingDemo()"));
    EXPECT_THAT(text("packaging/folder_order.txt"),
                HasSubstr("\napp/applications/ripple_ring\napp/applications/registry\n"));
    EXPECT_THAT(text("app/applications/ripple_ring/README.md"), HasSubstr("Ripple ring"));
    EXPECT_TRUE(std::filesystem::exists(tree() / "resources/thumbnails/ripple_ring.png"));
    const Outcome again = make("ripple_ring");
    EXPECT_EQ(again.exitCode, 2);
    EXPECT_THAT(again.err, HasSubstr("there is one already"));
    EXPECT_EQ(make("second").exitCode, 0);
    EXPECT_THAT(text("app/applications/registry/demos.cpp"), HasSubstr("second::secondDemo()"));
}

TEST_F(OwnDemo, IsRefusedWithAWrongNameAndNothingIsWritten) {
    for (const char* name : {"Ripple", "../out", "a__b", "class"}) {
        const Outcome outcome = make(name);
        EXPECT_EQ(outcome.exitCode, 2) << name;
        EXPECT_FALSE(outcome.err.empty());
    }
    expectUntouched();
}

TEST_F(OwnDemo, IsRefusedWhereNoPlaceIsFoundForIt) {
    std::ofstream(tree() / "packaging/folder_order.txt") << "# Another tree\n";
    const Outcome outcome = make("ripple");
    EXPECT_NE(outcome.exitCode, 0);
    EXPECT_THAT(outcome.err, HasSubstr("packaging/folder_order.txt"));
    EXPECT_THAT(outcome.err, HasSubstr("by hand"));
    EXPECT_FALSE(std::filesystem::exists(tree() / "app/applications/ripple"));
    std::filesystem::remove(tree() / "app/applications/registry/demos.cpp");
    EXPECT_THAT(make("ripple").err, HasSubstr("--tree"));
}

TEST(Demo, SaysWhatThereIsWhenNoneIsNamed) {
    const Outcome outcome = lumorph({"demo"});
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_THAT(outcome.err, HasSubstr("labyrinth"));
}

} // namespace
} // namespace lumorph::test

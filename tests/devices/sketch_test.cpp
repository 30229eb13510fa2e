#include "devices/firmware/sketch.h"

#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "devices/firmware/pin_header.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

DeviceProfile twoServos() {
    DeviceProfile profile;
    profile.name = "Two";
    profile.servos.resize(2);
    profile.servos[0].channel = 9;
    profile.servos[1].channel = 10;
    profile.servos[1].pulseMax = 1800.0;
    return profile;
}

using Texts = std::map<std::string, std::string>;

Texts textsIn(const fs::path& folder) {
    Texts texts;
    for (const auto& entry : fs::directory_iterator(folder)) {
        std::ifstream file(entry.path(), std::ios::binary);
        texts[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
    }
    return texts;
}

TEST(Sketch, IsWrittenWholeWithTheChannelsOfTheProfile) {
    const TemporaryFolder folder;
    const fs::path written = writeSketch(twoServos(), folder.path());
    EXPECT_EQ(written, folder / "tablet");
    Texts expected = textsIn(LUMORPH_SOURCE_DIR "/devices/firmware/tablet");
    expected.erase("README.md"); // is about the source tree
    ASSERT_GT(expected.count("tablet.ino"), 0u);
    ASSERT_GT(expected.count("channels.h"), 0u);
    EXPECT_NE(expected["channels.h"], channelsHeader(twoServos()));
    expected["channels.h"] = channelsHeader(twoServos());
    EXPECT_EQ(textsIn(written), expected);
}

TEST(Sketch, ReplacesNothingAndIsStillOneThatArduinoOpens) {
    const TemporaryFolder folder;
    const fs::path first = writeSketch(twoServos(), folder.path());
    std::ofstream(first / "channels.h") << "// with the voltmeter's value";
    const fs::path second = writeSketch(twoServos(), folder.path());
    EXPECT_EQ(second, folder / "tablet-2");
    EXPECT_EQ(textsIn(first)["channels.h"], "// with the voltmeter's value");
    const Texts texts = textsIn(second);
    EXPECT_GT(texts.count("tablet-2.ino"), 0u) << "the main file is called as its folder";
    EXPECT_EQ(texts.count("tablet.ino"), 0u);
    EXPECT_EQ(texts.size(), textsIn(first).size());
}

TEST(Sketch, OfAProfileThatNoBoardCanHaveLeavesNothing) {
    const TemporaryFolder folder;
    DeviceProfile profile = twoServos();
    profile.servos[1].channel = 9;
    EXPECT_THROW((void)writeSketch(profile, folder.path()), InvalidInput);
    EXPECT_TRUE(fs::is_empty(folder.path()));
    EXPECT_THROW((void)writeSketch(twoServos(), folder / "absent"), DeviceError);
}

TEST(Sketch, IsFoundBesideTheProgramAndInTheSourceTree) {
    const TemporaryFolder folder;
    const fs::path installed = folder / "usr/share/lumorph/firmware/tablet";
    const fs::path source = folder / "source/devices/firmware/tablet";
    for (const fs::path& place : {installed, source}) {
        fs::create_directories(place);
        std::ofstream(place / "tablet.ino") << "void setup() {}";
    }
    EXPECT_EQ(sketchFolder(folder / "usr/share/lumorph"), installed);
    EXPECT_EQ(sketchFolder(folder / "source/resources"), source);
    EXPECT_THROW((void)sketchFolder(folder / "elsewhere"), DataError);
}

} // namespace
} // namespace lumorph

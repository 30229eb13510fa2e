#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/installation_store.h"
#include "tests/core/scene/scenes.h"
#include "tests/core/temporary_folder.h"

// Versions of an installation: what measurements made of it.

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

InstallationVersion measuredVersion(double rms, const std::string& date = "2026-11-24T10:00:00Z") {
    InstallationVersion version;
    version.date = date;
    version.title = "Projector and camera \"by\" structured light";
    version.figures = {{"camera RMS", rms, "px"}, {"poses", 6.0, ""}};
    version.inputs = {"/home/me/capture", "chess:9x7:25"};
    version.result = R"({"lumorph": "calibration"})";
    version.installation = test::fullInstallation();
    return version;
}

TEST(InstallationVersion, ComesBackAsItWasKeptNewestFirst) {
    const TemporaryFolder folder;
    InstallationStore store(folder.path());
    std::vector<InstallationVersion> kept;
    for (int i = 0; i < 12; ++i) { // more than ten of one second must sort as they came
        kept.push_back(measuredVersion(0.1 * i));
        store.keepVersion(kept.back());
    }
    kept.push_back(measuredVersion(9.0, "2026-11-25T10:00:00Z"));
    store.keepVersion(kept.back());
    const std::vector<KeptVersion> versions = store.versions();
    ASSERT_THAT(versions, SizeIs(kept.size()));
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(versions[i].version, kept[kept.size() - 1 - i]) << i;
    EXPECT_FALSE(store.load()) << "the room itself is left alone";
}

TEST(InstallationVersion, OldestGoAndOneCanBeRemoved) {
    const TemporaryFolder folder;
    InstallationStore store(folder.path());
    for (std::size_t i = 0; i < InstallationStore::kKeptVersions + 3; ++i)
        store.keepVersion(measuredVersion(static_cast<double>(i)));
    const std::vector<KeptVersion> versions = store.versions();
    ASSERT_THAT(versions, SizeIs(InstallationStore::kKeptVersions));
    EXPECT_EQ(versions.back().version.figures.front().value, 3.0);
    InstallationStore::removeVersion(versions.front().file);
    InstallationStore::removeVersion(versions.front().file);
    EXPECT_EQ(store.versions().front().file, versions[1].file);
}

TEST(InstallationVersion, BrokenOnesAreNamedAndTheOthersRead) {
    const TemporaryFolder folder;
    InstallationStore store(folder.path());
    store.keepVersion(measuredVersion(0.1));
    const fs::path versions = folder / "versions";
    const auto write = [&](const char* name, const std::string& text) { std::ofstream(versions / name) << text; };
    write("version-a.json", "{");
    write("version-b.json", R"({"lumorph": "installation version", "schemaVersion": 99})");
    write("version-c.json", R"({"lumorph": "installation version", "schemaVersion": 1})");
    write("version-d.json", R"({"lumorph": "installation version", "schemaVersion": 1, "installation": {},
                                "figures": [{"name": "a", "value": "b"}]})");
    write("version-e.json", R"({"lumorph": "installation version", "schemaVersion": 1, "installation": {},
                                "inputs": [1]})");
    write("version-f.json", std::string(100, '[') + std::string(100, ']'));
    std::vector<std::string> broken;
    EXPECT_THAT(store.versions(&broken), SizeIs(1));
    EXPECT_THAT(broken,
                ElementsAre(HasSubstr("version-f"), HasSubstr("inputs"), HasSubstr("figures[0].value"),
                            HasSubstr("installation: is missing"), HasSubstr("newer Lumorph"), HasSubstr("version-a")));
}

TEST(InstallationVersion, IsWholeOrNotThere) {
    const TemporaryFolder folder;
    InstallationStore store(folder.path());
    InstallationVersion unsound = measuredVersion(0.1);
    unsound.installation.projectors[0].camera.focal.x = -1.0;
    EXPECT_THROW(store.keepVersion(unsound), InvalidInput);
    for (const char* date : {"", "../../x", "2026/11"})
        EXPECT_THROW(store.keepVersion(measuredVersion(1, date)), InvalidInput);
    EXPECT_FALSE(fs::exists(folder / "versions"));
    std::ofstream(folder / "versions") << "a file where the folder should be";
    EXPECT_THROW(store.keepVersion(measuredVersion(0.1)), DeviceError);
    EXPECT_THAT(store.versions(), SizeIs(0));
}

TEST(InstallationVersion, FiguresOfTwoAreCompared) {
    const InstallationVersion before = measuredVersion(0.2);
    InstallationVersion after = measuredVersion(0.1);
    after.figures[1] = {"held out", 0.5, "px"};
    const auto changes = compareFigures(before, after);
    ASSERT_THAT(changes, SizeIs(3));
    EXPECT_EQ(changes[0].name, "camera RMS");
    EXPECT_EQ(changes[0].before, 0.2);
    EXPECT_EQ(changes[0].after, 0.1);
    EXPECT_EQ(changes[1].before, std::nullopt);
    EXPECT_EQ(changes[1].after, 0.5);
    EXPECT_EQ(changes[2].name, "poses");
    EXPECT_EQ(changes[2].after, std::nullopt);
}

TEST(InstallationVersion, DevicesThatMovedAreMeasured) {
    const Installation before = test::fullInstallation();
    Installation after = before;
    CalibratedCamera& camera = after.projectors[0].camera;
    const glm::dvec3 place = positionOf(camera) + glm::dvec3(0.03, 0.0, 0.04);
    const double angle = 0.02;
    const glm::dmat3 turn(std::cos(angle), std::sin(angle), 0.0, -std::sin(angle), std::cos(angle), 0.0, 0.0, 0.0, 1.0);
    const glm::dmat3 rotation = turn * glm::dmat3(camera.cameraFromWorld);
    camera.cameraFromWorld = glm::dmat4(rotation);
    camera.cameraFromWorld[3] = glm::dvec4(-(rotation * place), 1.0);
    camera.focal *= 1.01;
    camera.principal += glm::dvec2(3.0, -4.0);
    after.cameras.clear();
    const auto changes = compareDevices(before, after);
    ASSERT_THAT(changes, SizeIs(before.projectors.size()));
    EXPECT_EQ(changes[0].name, before.projectors[0].name);
    EXPECT_NEAR(changes[0].moved, 0.05, 1e-9);
    EXPECT_NEAR(changes[0].turned, angle, 1e-9);
    EXPECT_NEAR(changes[0].focal, 0.01, 1e-9);
    EXPECT_NEAR(changes[0].principal, 5.0, 1e-9);
    EXPECT_NEAR(changes[1].moved + changes[1].turned, 0.0, 1e-9);
}

} // namespace
} // namespace lumorph

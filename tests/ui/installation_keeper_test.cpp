#include <condition_variable>
#include <fstream>
#include <mutex>

#include <QElapsedTimer>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/applications/registry/demos.h"
#include "app/studio/document/installation_keeper.h"
#include "app/studio/document/scene_edit.h"
#include "core/base/resources.h"
#include "core/scene/project.h"
#include "tests/ui/project_world.h"

// What stands in the room: kept by the machine, and left alone by whatever is opened in it.

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;
using test::eventually;

/// A studio without a window in a room whose installation somebody has measured.
struct InstallationKeeperTest : test::ProjectServiceFixture {
    Settings settings;
    const fs::path folder = settings.folder() / "installation";
    InstallationStore store{folder};
    std::unique_ptr<InstallationKeeper> keeper;

    InstallationKeeperTest() {
        fs::remove_all(folder);
        settings.setValue("installation/answered", {});
        store.keep(measuredRoom());
        start();
    }
    ~InstallationKeeperTest() override {
        keeper.reset();
        fs::remove_all(folder);
    }

    static Installation measuredRoom() {
        Installation room = defaultInstallation();
        room.projectors.front().peak = 1.75;
        room.projectors.front().pose = {Origin::Way::measured, "structured light", "2026-11-20T10:00:00Z"};
        room.worldFromDevice[3] = glm::vec4(0.04F, 0.01F, -0.02F, 1.0F);
        room.tableColor = {0.7F, 0.6F, 0.5F};
        return room;
    }
    /// As a start of the program does.
    void start() {
        keeper = std::make_unique<InstallationKeeper>(settings, world.document, world.service, world.notices);
    }
    [[nodiscard]] const Installation& room() const { return *world.state().installation; }
    [[nodiscard]] bool open(const fs::path& file) {
        world.service.open(file);
        return eventually([&] { return world.jobs.running().empty() && world.document.file() == file; });
    }
    /// A project that was saved in another room.
    [[nodiscard]] fs::path projectFromElsewhere() const {
        Project project;
        project.rig = "resource:models/tablet.glb";
        project.installation.projectors.front().peak = 9.5;
        project.installation.tableSize = {2.0F, 1.5F};
        const fs::path file = files / "elsewhere.lumorph";
        writeProject(project, file);
        return file;
    }
    [[nodiscard]] QString asked() const {
        for (const Notice& notice : world.notices.at("scene"))
            if (notice.subject == "Installation") return notice.why;
        return {};
    }
};

TEST_F(InstallationKeeperTest, StartsWithWhatWasKept) { EXPECT_EQ(room(), measuredRoom()); }

TEST_F(InstallationKeeperTest, EveryDemoLeavesTheRoomAsItIs) {
    for (const Demo& demo : demos()) {
        world.service.openDemo(demo.name);
        ASSERT_TRUE(eventually([&] { return world.jobs.running().empty() && world.state().field.field; })) << demo.name;
        EXPECT_EQ(room(), measuredRoom()) << demo.name;
        EXPECT_EQ(asked(), QString()) << demo.name;
        EXPECT_TRUE(fs::exists(resourceFile(demo.thumbnail))) << demo.thumbnail;
        for (const DemoStep& step : demo.steps()) {
            editScene(world.document, "Step", [&](Scene& scene) { scene = step.scene; });
            EXPECT_EQ(room(), measuredRoom()) << demo.name << ' ' << step.key;
        }
    }
}

TEST_F(InstallationKeeperTest, EveryOldProjectLeavesTheRoomAsItIs) {
    int opened = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(LUMORPH_SOURCE_DIR) / "tests/data/projects")) {
        const fs::path file = files / entry.path().filename().string();
        fs::copy_file(entry.path(), file);
        fs::create_directories(files / "targets");
        files.writeMesh(test::boxMesh({-0.02F, 0.0F, -0.01F}, {0.02F, 0.03F, 0.01F}),
                        "targets/cow.obj"); // what one names
        ASSERT_TRUE(open(file)) << file;
        EXPECT_EQ(room(), measuredRoom()) << file;
        ++opened;
    }
    EXPECT_GE(opened, 2);
}

TEST_F(InstallationKeeperTest, AsksOnceWhichInstallationToUse) {
    const fs::path file = projectFromElsewhere();
    ASSERT_TRUE(open(file));
    EXPECT_EQ(room(), measuredRoom());
    EXPECT_THAT(asked().toStdString(), testing::HasSubstr("elsewhere.lumorph"));
    ASSERT_TRUE(world.press("scene", "Keep"));
    EXPECT_EQ(room(), measuredRoom());
    world.service.newProject();
    ASSERT_TRUE(world.rest());
    ASSERT_TRUE(open(file));
    EXPECT_EQ(asked(), QString()) << "it was answered";
    // In another room it is another question, even if one has only looked around since.
    editInstallation(world.document, "Table", [](Installation& edited) { edited.tableSize.x += 0.1F; });
    ASSERT_TRUE(open(projectFromElsewhere()) && eventually([&] { return !asked().isEmpty(); }));
}

TEST_F(InstallationKeeperTest, TheProjectsIsTakenByAStepOfUndo) {
    const fs::path file = projectFromElsewhere();
    ASSERT_TRUE(open(file));
    ASSERT_TRUE(world.press("scene", "Use its"));
    EXPECT_EQ(room().tableSize, glm::vec2(2.0F, 1.5F));
    EXPECT_EQ(room().projectors.front().peak, 9.5);
    EXPECT_EQ(room().origins.table.way, Origin::Way::entered);
    EXPECT_EQ(room().origins.table.method, "project elsewhere.lumorph");
    world.document.undoStack().undo();
    EXPECT_EQ(room(), measuredRoom());
}

TEST_F(InstallationKeeperTest, MeasurementIsAVersionThatIsTakenBackAtOnce) {
    InstallationVersion version;
    version.title = "Structured light";
    version.figures = {{"RMS", 0.12, "px"}};
    version.installation = measuredRoom();
    version.installation.projectors.front().camera.focal *= 1.1;
    version.installation.projectors.front().lens = {Origin::Way::measured, "structured light, 6 boards",
                                                    "2026-11-25T10:00:00Z"};
    ASSERT_TRUE(keeper->takeVersion(version));
    EXPECT_EQ(room(), version.installation) << "with the origins that it brought";
    auto versions = keeper->versions();
    ASSERT_EQ(versions.size(), 2U) << "the room as it stood before is one too";
    EXPECT_EQ(versions[0].version.title, version.title);
    EXPECT_FALSE(versions[0].version.date.empty());
    EXPECT_TRUE(keeper->isCurrent(versions[0].version));
    EXPECT_EQ(versions[1].version.installation, measuredRoom());
    keeper->bringBackVersion(versions[1].file);
    EXPECT_TRUE(isSameRoom(room(), measuredRoom()));
    EXPECT_TRUE(keeper->isCurrent(versions[1].version));
    world.document.undoStack().undo();
    EXPECT_EQ(room(), version.installation);
    // A second measurement: the state before it is a version already.
    version.installation.projectors.front().camera.focal *= 1.1;
    ASSERT_TRUE(keeper->takeVersion(version));
    EXPECT_EQ(keeper->versions().size(), 3U);
    keeper->removeVersion(versions[1].file);
    EXPECT_EQ(keeper->versions().size(), 2U);
    keeper->bringBackVersion(versions[1].file);
    EXPECT_FALSE(world.notices.at("project").empty()) << "it is gone";
}

TEST_F(InstallationKeeperTest, MeasurementThatCannotBeKeptChangesNothing) {
    InstallationVersion version;
    version.installation = measuredRoom();
    version.installation.projectors.front().camera.focal.x = -1.0;
    EXPECT_FALSE(keeper->takeVersion(version));
    EXPECT_EQ(room(), measuredRoom());
    EXPECT_TRUE(keeper->versions().empty());
    EXPECT_FALSE(world.notices.at("project").empty());
}

TEST_F(InstallationKeeperTest, KeepsAnEditForTheNextStartAndTheOneBefore) {
    editInstallation(world.document, "Table", [](Installation& edited) { edited.tableSize = {1.5F, 1.0F}; });
    const Installation edited = room();
    EXPECT_EQ(edited.origins.table.way, Origin::Way::entered);
    EXPECT_EQ(edited.projectors.front().pose, measuredRoom().projectors.front().pose) << "it is still as measured";
    keeper.reset(); // the end of the program
    world.document.setInstallation(std::make_shared<const Installation>(defaultInstallation()));
    start();
    EXPECT_EQ(room(), edited);
    ASSERT_EQ(keeper->earlier().size(), 1U);
    keeper->bringBack(keeper->earlier().front());
    EXPECT_EQ(room().tableSize, measuredRoom().tableSize);
}

TEST_F(InstallationKeeperTest, AnEditIsWrittenWhileTheWindowGoesOn) {
    editInstallation(world.document, "Table", [](Installation& edited) { edited.tableSize = {1.5F, 1.0F}; });
    editInstallation(world.document, "Table", [](Installation& edited) { edited.tableSize = {1.6F, 1.1F}; });
    ASSERT_TRUE(eventually([&] { return *store.load() == room(); }));
    EXPECT_EQ(store.earlier().size(), 1U) << "the newest alone";
}

TEST_F(InstallationKeeperTest, WhatTheDiskRefusesIsToldAndTriedAgain) {
    fs::remove_all(folder);
    std::ofstream(folder) << "no folder";
    editInstallation(world.document, "Table", [](Installation& edited) { edited.tableSize = {1.5F, 1.0F}; });
    ASSERT_TRUE(eventually([&] { return !world.notices.at("project").empty(); }));
    EXPECT_THAT(world.notice("project").why.toStdString(), testing::HasSubstr("could not be kept for the next start"));
    fs::remove(folder);
    ASSERT_TRUE(world.press("project", "Try again"));
    ASSERT_TRUE(eventually([&] { return fs::exists(store.file()) && *store.load() == room(); }));
    fs::remove_all(folder);
    std::ofstream(folder) << "no folder";
    editInstallation(world.document, "Table", [](Installation& edited) { edited.tableSize = {1.7F, 1.0F}; });
    world.notices.dismissAll();
    keeper.reset(); // the end of the program
    EXPECT_FALSE(world.notices.at("project").empty());
    fs::remove(folder);
}

TEST_F(InstallationKeeperTest, AnEditBeforeADragIsKeptThoughTheProgramEndsInTheDrag) {
    editInstallation(world.document, "Table", [](Installation& edited) { edited.tableSize = {1.5F, 1.0F}; });
    const Installation before = room();
    world.document.preview([](StudioState& state) {
        Installation dragged = *state.installation;
        dragged.tableSize.x = 1.9F;
        state.installation = std::make_shared<const Installation>(dragged);
    });
    ASSERT_TRUE(world.document.previewing());
    keeper.reset();
    EXPECT_EQ(*store.load(), before);
}

TEST(InstallationWriter, TheNewestIsWrittenHoweverSlowTheDisk) {
    std::mutex mutex;
    std::condition_variable changed;
    bool isDiskReady = false;
    std::vector<float> written;
    const auto write = [&](const Installation& installation) {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return isDiskReady; });
        written.push_back(installation.tableSize.x);
    };
    const auto tableOf = [](float size) {
        auto installation = std::make_shared<Installation>(defaultInstallation());
        installation->tableSize.x = size;
        return installation;
    };
    std::vector<float> done;
    {
        InstallationWriter writer(write, [&](const std::shared_ptr<const Installation>& one, std::exception_ptr) {
            done.push_back(one->tableSize.x); // one thread at a time, and read after its end
        });
        QElapsedTimer since;
        since.start();
        for (int i = 1; i <= 100; ++i) writer.offer(tableOf(static_cast<float>(i)));
        EXPECT_LT(since.elapsed(), 1000) << "nobody waits for the disk";
        const std::scoped_lock lock(mutex);
        EXPECT_TRUE(written.empty());
        isDiskReady = true;
        changed.notify_all();
    }
    EXPECT_LE(written.size(), 2U) << "what waited behind the first is passed over";
    ASSERT_FALSE(written.empty());
    EXPECT_EQ(written.back(), 100.0F) << "the end of the program waits for it";
    EXPECT_EQ(done, written);
}

TEST_F(InstallationKeeperTest, WhileAnotherStudioHasTheRoomNothingIsWritten) {
    settings.setReadOnly(true);
    editInstallation(world.document, "Table", [](Installation& edited) { edited.tableSize = {1.5F, 1.0F}; });
    const Installation mine = room();
    keeper.reset(); // the end of the program
    EXPECT_EQ(*store.load(), measuredRoom());
    EXPECT_TRUE(world.notice("home").why.contains("in this window alone"));
    start();
    world.document.setInstallation(std::make_shared<const Installation>(mine));
    Installation others = measuredRoom(); // the other studio measures the room meanwhile
    others.tableSize = {1.25F, 1.0F};
    store.keep(others);
    settings.setReadOnly(false);
    EXPECT_EQ(room(), others);
    EXPECT_TRUE(world.press("home", "Use this window's"));
    EXPECT_EQ(room().tableSize, mine.tableSize);
    keeper.reset();
    EXPECT_EQ(store.load()->tableSize, mine.tableSize);
}

TEST_F(InstallationKeeperTest, KeepsTenEarlierOnesWhateverOneLooksAt) {
    for (int i = 0; i < 14; ++i) {
        Installation next = measuredRoom();
        next.tableSize.x = 1.0F + 0.1F * static_cast<float>(i);
        store.keep(next);
        next.eye.x += 0.5F; // walking around is no other room
        store.keep(next);
    }
    const auto earlier = store.earlier();
    ASSERT_EQ(earlier.size(), InstallationStore::kKept);
    for (std::size_t i = 0; i < earlier.size(); ++i)
        EXPECT_FLOAT_EQ(InstallationStore::read(earlier[i]).tableSize.x, 1.0F + 0.1F * static_cast<float>(12 - i)) << i;
}

TEST_F(InstallationKeeperTest, AFileThatCannotBeReadIsToldAndLeftAlone) {
    keeper.reset();
    Installation later = measuredRoom();
    later.tableSize.y = 2.0F;
    store.keep(later); // the measured one becomes an earlier one
    const std::string broken = "{\"lumorph\": \"installation\", \"schemaVersion\": 1, \"installation\": {\"eye\": 3}}";
    std::ofstream(store.file(), std::ios::binary) << broken;
    world.document.setInstallation(std::make_shared<const Installation>(defaultInstallation()));
    start();
    const Notice notice = world.notice("project");
    EXPECT_THAT(notice.why.toStdString(), testing::HasSubstr("installation.eye"));
    EXPECT_EQ(room(), defaultInstallation());
    std::ifstream in(store.file(), std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), broken);
    ASSERT_TRUE(world.press("project", "Bring back the last one"));
    EXPECT_TRUE(isSameRoom(room(), measuredRoom()));
}

} // namespace
} // namespace lumorph::studio

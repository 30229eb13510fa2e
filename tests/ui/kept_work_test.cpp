#include <algorithm>
#include <csignal>
#include <cstdio>
#include <set>

#include <QLabel>
#include <QProcess>
#include <QPushButton>

#include "app/studio/document/kept_work.h"
#include "tests/ui/project_world.h"
#include "tests/ui/studio_window.h"

// Edited work that something else replaces: kept on disk until it is brought back or thrown away.

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using studio::KeptWork;
using studio::ProjectService;
using studio::StudioState;

/// Opens another project, which needs little time.
void openSmall(ProjectWorld& world, const fs::path& file) {
    world.service.openProject(file);
    EXPECT_TRUE(eventually(
        [&] { return world.jobs.running().empty() && world.document.file() == file && !world.document.modified(); }));
}

void saveSmall(const SessionFiles& files) {
    ProjectWorld world;
    world.openRig(files / "lifter.glb");
    world.service.saveAs(files / "small.lumorph");
}

void setSpin(ProjectWorld& world, double spin) {
    world.document.change("Spin the target", [&](StudioState& state) { state.playback.spin = spin; });
}

struct KeptWorkTest : testing::Test {
    SessionFiles files;

    KeptWorkTest() {
        saveSmall(files);
        fs::remove_all(ProjectService::sessionFolder());
    }
    [[nodiscard]] fs::path small() const { return files / "small.lumorph"; }
    [[nodiscard]] static bool keeps(ProjectWorld& world, std::size_t count) {
        return eventually([&] { return world.service.keptWork().size() == count; });
    }
};

TEST_F(KeptWorkTest, EveryOpeningKeepsWhatItReplacesAlsoAfterARestart) {
    StudioState first;
    {
        ProjectWorld world;
        world.openRig(files / "cushion.glb");
        world.openTarget(files / "block.obj");
        setSpin(world, 0.125);
        first = world.state();
        openSmall(world, small());
        setSpin(world, 0.25);
        openSmall(world, small());
        openSmall(world, small()); // nothing was edited
        EXPECT_TRUE(keeps(world, 2));
    }
    ProjectWorld world;
    ASSERT_TRUE(keeps(world, 2));
    const std::vector<KeptWork> kept = world.service.keptWork();
    EXPECT_EQ(kept[0].name, "small.lumorph");
    EXPECT_EQ(kept[0].edits, 1);
    EXPECT_EQ(kept[0].lastEdit, "Spin the target");
    EXPECT_EQ(kept[1].name, "cushion.glb");
    EXPECT_GE(kept[0].when, kept[1].when);
    EXPECT_LT(std::abs(kept[1].when.secsTo(QDateTime::currentDateTime())), 600);
    for (const char* name : {"cushion.glb", "block.obj"}) fs::remove(files / name);
    world.service.bringBack(kept[1].id);
    ASSERT_TRUE(eventually([&] { return world.state().rig.path == first.rig.path && world.jobs.running().empty(); }));
    EXPECT_EQ(world.state().playback.spin, 0.125);
    EXPECT_EQ(writeRigGlb(*world.state().rig.rig), writeRigGlb(*first.rig.rig));
    ASSERT_TRUE(world.state().target.target);
    EXPECT_EQ(world.state().target.target->solid.mesh.positions, first.target.target->solid.mesh.positions);
    EXPECT_TRUE(world.document.modified()) << "it is still to be saved";
    EXPECT_TRUE(keeps(world, 1)) << "it is open now";
    EXPECT_EQ(world.service.keptWork().front().id, kept[0].id);
    // What is open and edited is kept in turn.
    world.service.bringBack(kept[0].id);
    ASSERT_TRUE(eventually([&] { return world.document.file() == small() && world.jobs.running().empty(); }));
    EXPECT_TRUE(eventually([&] {
        const auto now = world.service.keptWork();
        return now.size() == 1 && now.front().name == "cushion.glb";
    }));
}

TEST_F(KeptWorkTest, ManyOpeningsOfWhatNobodyEditedLeaveNothing) {
    ProjectWorld world;
    world.openRig(files / "cushion.glb");
    world.service.saveAs(files / "saved.lumorph");
    for (int visit = 0; visit < 5; ++visit) {
        openSmall(world, small());
        openSmall(world, files / "saved.lumorph");
    }
    for (const char* demo : {"water", "labyrinth", "field", "water"}) {
        world.service.openDemo(demo, studio::Audience::visitors);
        ASSERT_TRUE(eventually([&] {
            return world.jobs.running().empty() && world.service.demo() && world.service.demo()->name == demo;
        }));
    }
    world.service.keepSession();
    EXPECT_TRUE(world.service.keptWork().empty());
    EXPECT_FALSE(fs::exists(ProjectService::sessionFolder() / "replaced"));
}

TEST_F(KeptWorkTest, ThrowingAwayCanBeUndoneForADay) {
    const fs::path folder = ProjectService::sessionFolder() / "replaced";
    std::string id;
    {
        ProjectWorld world;
        world.openRig(files / "cushion.glb");
        openSmall(world, small());
        ASSERT_TRUE(keeps(world, 1));
        id = world.service.keptWork().front().id;
        world.service.setThrown(id, true);
        EXPECT_TRUE(world.service.keptWork().front().thrown);
        world.service.setThrown(id, false);
        EXPECT_FALSE(world.service.keptWork().front().thrown);
        world.service.setThrown(id, true);
    }
    {
        ProjectWorld world;
        ASSERT_TRUE(keeps(world, 1)) << "also after a restart";
        EXPECT_TRUE(world.service.keptWork().front().thrown);
    }
    fs::last_write_time(folder / (id + ".thrown"), fs::file_time_type::clock::now() - std::chrono::hours(25));
    ProjectWorld world;
    EXPECT_TRUE(eventually([&] { return fs::is_empty(folder); }));
}

TEST_F(KeptWorkTest, ASessionThatAStartLeavesOutIsKept) {
    {
        ProjectWorld world;
        world.openRig(files / "cushion.glb");
        world.service.keepSession();
    }
    ProjectWorld world; // started with a project's name
    openSmall(world, small());
    EXPECT_TRUE(eventually([&] {
        const auto kept = world.service.keptWork();
        return kept.size() == 1 && kept.front().name == "cushion.glb";
    }));
}

TEST_F(KeptWorkTest, ADiskThatRefusesLosesNothing) {
    ProjectWorld world;
    world.openRig(files / "cushion.glb");
    setSpin(world, 0.5);
    world.service.keepSession();
    const fs::path folder = ProjectService::sessionFolder();
    std::ofstream(folder / "replaced") << "a file where a folder should be";
    openSmall(world, small());
    EXPECT_TRUE(eventually([&] { return world.notice("project").subject == "Session"; }));
    fs::remove(folder / "replaced");
    world.service.keepSession();
    EXPECT_TRUE(keeps(world, 1));
}

/// Edits and opens something else in turn, until it is killed. Run by the test below.
TEST(ReplacingChild, DISABLED_ReplacesForEver) {
    const fs::path folder = qgetenv("LUMORPH_TEST_FILES").toStdString();
    needApplication();
    ProjectWorld world;
    for (int k = 1; k < 1000; ++k) {
        openSmall(world, folder / "small.lumorph");
        setSpin(world, k / 1000.0);
        world.service.keepSession();
        std::printf("kept %d\n", k);
        std::fflush(stdout);
    }
}

TEST_F(KeptWorkTest, AKillWhileSomethingIsOpenedLosesNoWork) {
    auto environment = QProcessEnvironment::systemEnvironment();
    environment.insert("LUMORPH_TEST_FILES", QString::fromStdString((files / ".").string()));
    for (int kill = 0; kill < 3; ++kill) {
        fs::remove_all(ProjectService::sessionFolder());
        QProcess child;
        child.setProcessEnvironment(environment);
        child.start(QCoreApplication::applicationFilePath(),
                    {"--gtest_also_run_disabled_tests", "--gtest_filter=ReplacingChild.*"});
        QByteArray output;
        const auto last = [&] {
            output += child.readAllStandardOutput();
            const qsizetype at = output.lastIndexOf("kept ");
            return at < 0 ? 0 : output.mid(at + 5).split('\n').front().toInt();
        };
        ASSERT_TRUE(eventually([&] { return last() >= 3; }));
        pass(std::chrono::milliseconds(11 * kill));
        child.kill();
        ASSERT_TRUE(child.waitForFinished());
        const int kept = last();
        ProjectWorld world;
        bool ready = false;
        world.service.restoreSession([&] { ready = true; });
        ASSERT_TRUE(eventually([&] { return ready; }));
        world.service.keepSession();
        ASSERT_TRUE(eventually([&] { return world.service.keptWork().size() + 2 > static_cast<std::size_t>(kept); }));
        std::set<int> found{static_cast<int>(std::lround(1000.0 * world.state().playback.spin))};
        for (const KeptWork& one : world.service.keptWork()) {
            const fs::path place = studio::placeOfKeptWork(ProjectService::sessionFolder(), one.id);
            found.insert(static_cast<int>(std::lround(1000.0 * readProject(place / "session.lumorph").playback.spin)));
        }
        for (int k = 1; k <= kept; ++k) EXPECT_TRUE(found.contains(k)) << k << " of " << kept << " is lost";
    }
}

// As a maker finds it: two cards, one after the other, and his work back by one click on the cards' page.
TEST(KeptWorkWindow, WorkComesBackAfterTwoCards) {
    const TemporaryFolder folder;
    StudioWindow window{folder / "session", "scene"};
    ProjectService& project = window.studio().project;
    QAction* command = window.studio().commands.find("file.bringBack");
    ASSERT_NE(command, nullptr);
    EXPECT_FALSE(command->isEnabled());
    window.studio().document.change("Spin the target", [](StudioState& state) { state.playback.spin = 0.375; });
    const auto open = [&](const char* card) {
        window.window().showApplications();
        window.click(QString("applications.") + card);
        EXPECT_TRUE(eventually(
            [&] { return window.studio().jobs.running().empty() && project.demo() && project.demo()->name == card; }));
    };
    open("water");
    open("labyrinth");
    ASSERT_TRUE(eventually([&] { return project.keptWork().size() == 1; }));
    window.window().showApplications();
    EXPECT_TRUE(window.text("applications.kept.name").startsWith("Your work from "))
        << window.text("applications.kept.name").toStdString();
    window.screenshot("kept-cards");
    window.click("applications.kept.bringBack");
    EXPECT_TRUE(eventually([&] { return window.state().playback.spin == 0.375; }));
    EXPECT_TRUE(window.studio().document.modified());
    EXPECT_TRUE(eventually([&] { return project.keptWork().empty() && !command->isEnabled(); }));
    // By File it is thrown away, which the same list undoes.
    project.openDemo("water");
    ASSERT_TRUE(eventually([&] { return project.keptWork().size() == 1 && command->isEnabled(); }));
    command->trigger();
    window.screenshot("kept-list");
    window.click("keptWork.throw");
    window.click("keptWork.undo");
    window.click("keptWork.bringBack");
    EXPECT_TRUE(eventually([&] { return window.state().playback.spin == 0.375; }));
}

} // namespace
} // namespace lumorph::test

#include <csignal>
#include <cstdio>
#include <fstream>

#include <QProcess>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/studio/document/state_rules.h"
#include "core/scene/project.h"
#include "tests/ui/project_world.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;
using test::eventually;
using test::ProjectWorld;
using test::SessionFiles;

struct SessionTest : testing::Test {
    SessionFiles files;

    void restore(ProjectWorld& world) const {
        bool ready = false;
        world.service.restoreSession([&] { ready = true; });
        EXPECT_TRUE(eventually([&] { return ready; }));
    }
};

/// Equal for a user: same paths, numbers and contents; the objects are others.
void expectEqual(const StudioState& is, const StudioState& was) {
    EXPECT_EQ(is.rig.path, was.rig.path);
    EXPECT_EQ(is.field.path, was.field.path);
    EXPECT_EQ(is.target.path, was.target.path);
    ASSERT_TRUE(is.rig.rig && is.field.field && is.target.target);
    EXPECT_EQ(writeRigGlb(*is.rig.rig), writeRigGlb(*was.rig.rig));
    EXPECT_EQ(is.field.field->field, was.field.field->field);
    EXPECT_EQ(is.target.target->solid.mesh.positions, was.target.target->solid.mesh.positions);
    StudioState sameObjects = is;
    sameObjects.rig = was.rig;
    sameObjects.field = was.field;
    sameObjects.target = was.target;
    EXPECT_FALSE(differenceOf(sameObjects, was));
}

StudioState edited(ProjectWorld& world, const SessionFiles& files) {
    world.openRig(files / "cushion.glb");
    world.openTarget(files / "block.obj");
    world.document.change("Edit", [](StudioState& s) {
        s.strokes = {0.1, 0.2, 1.0 / 3.0};
        s.matching = {Driver::hand, MatchMethod::voting, Microseconds(5250)};
        s.playback = {false, 0.3};
        s.placement = {0.7, Angle::radians(1.1), {0.01F, 0.02F, 0.03F}};
    });
    return world.state();
}

TEST_F(SessionTest, TheDemoOpensWhereThereWasNoSession) {
    ProjectWorld world;
    restore(world);
    EXPECT_EQ(world.state().rig.path.filename(), "tablet.glb");
    EXPECT_NE(drivingItem(*world.state().scene), nullptr) << "the sea moves the tablet";
    EXPECT_TRUE(world.document.file().empty()) << "the demo is nobody's file";
    EXPECT_FALSE(world.document.modified());
    EXPECT_TRUE(world.notices.at().empty());
}

TEST_F(SessionTest, GoesOnWhereItEnded) {
    StudioState was;
    {
        ProjectWorld world;
        was = edited(world, files);
        world.service.saveAs(files / "garden.lumorph");
        world.document.change("Turn", [](StudioState& s) { s.placement.yaw = Angle::radians(0.25); });
        was = world.state();
        world.service.keepSession();
    }
    const fs::path project = files / "garden.lumorph";
    const auto saved = fs::last_write_time(project);
    {
        ProjectWorld world;
        restore(world);
        expectEqual(world.state(), was);
        EXPECT_EQ(world.document.file(), project);
        EXPECT_TRUE(world.document.modified());
        EXPECT_EQ(fs::last_write_time(project), saved) << "the project's own file is the user's to save";
        EXPECT_EQ(readProject(project).placement.yaw.inRadians(), 1.1);
        EXPECT_TRUE(world.service.save());
        EXPECT_EQ(readProject(project).placement.yaw.inRadians(), 0.25);
        world.service.keepSession();
    }
    ProjectWorld world;
    restore(world);
    EXPECT_FALSE(world.document.modified());
    test::pass(std::chrono::milliseconds(1500));
    EXPECT_TRUE(world.notices.at().empty()) << "nothing has changed on disk";
}

TEST_F(SessionTest, IsKeptSomeSecondsAfterAChange) {
    StudioState was;
    ProjectWorld world;
    was = edited(world, files);
    const auto kept = [&] {
        for (const auto& entry : fs::directory_iterator(ProjectService::sessionFolder()))
            if (fs::exists(entry.path() / "session.lumorph") &&
                readProject(entry.path() / "session.lumorph").playback.spin == 0.3)
                return true;
        return false;
    };
    EXPECT_TRUE(eventually(kept, std::chrono::seconds(30)));
}

TEST_F(SessionTest, HoldsWhatVanishedSince) {
    StudioState was;
    {
        ProjectWorld world;
        was = edited(world, files);
        world.service.keepSession();
    }
    fs::remove(files / "block.obj");
    fs::remove(files / "cushion.glb");
    ProjectWorld world;
    restore(world);
    expectEqual(world.state(), was);
    EXPECT_TRUE(eventually([&] { return !world.notices.at("target").empty() && !world.notices.at("rig").empty(); }));
}

TEST_F(SessionTest, ABrokenOneIsMovedAsideAndTheDemoOpens) {
    {
        ProjectWorld world;
        edited(world, files);
        world.service.keepSession();
    }
    fs::path session;
    for (const auto& entry : fs::directory_iterator(ProjectService::sessionFolder()))
        if (fs::exists(entry.path() / "session.lumorph")) session = entry.path();
    std::ofstream(session / "session.lumorph") << "{ torn";
    ProjectWorld world;
    restore(world);
    EXPECT_EQ(world.state().rig.path.filename(), "tablet.glb");
    const Notice notice = world.notice("project");
    EXPECT_TRUE(notice.why.contains("last session"));
    EXPECT_TRUE(notice.remedy.contains("broken-1"));
    EXPECT_TRUE(fs::exists(ProjectService::sessionFolder() / "broken-1" / "session.lumorph"));
}

TEST_F(SessionTest, ASecondStudioLeavesTheSessionOfTheFirstAlone) {
    ProjectWorld first;
    const StudioState was = edited(first, files);
    first.service.keepSession();
    {
        ProjectWorld second;
        second.openRig(files / "lifter.glb");
        second.service.keepSession();
        second.service.openRig(files / "lifter.glb");
    }
    ProjectWorld third;
    restore(third);
    EXPECT_EQ(third.state().rig.path, was.rig.path);
}

/// Keeps sessions in which every part tells the same number, until it is killed. Run by the test below.
TEST(SessionChild, DISABLED_KeepsForEver) {
    const fs::path folder = qgetenv("LUMORPH_TEST_FILES").toStdString();
    test::needApplication();
    ProjectWorld world;
    world.openTarget(folder / "block.obj");
    const auto even = world.state().target;
    world.openTarget(folder / "other.obj");
    const auto odd = world.state().target;
    world.openRig(folder / "cushion.glb");
    for (int k = 1; k < 1000; ++k) {
        world.document.change("Count", [&](StudioState& s) {
            s.target = k % 2 == 0 ? even : odd;
            s.strokes = {k / 1000.0, 1.0 - k / 1000.0, 0.5};
            s.playback.spin = k / 1000.0;
        });
        world.service.keepSession();
        std::printf("kept %d\n", k);
        std::fflush(stdout);
    }
}

int lastKept(const QByteArray& output) {
    const auto lines = output.split('\n');
    for (auto line = lines.rbegin(); line != lines.rend(); ++line)
        if (line->startsWith("kept ")) return line->mid(5).toInt();
    return 0;
}

TEST_F(SessionTest, KilledAtAnyTimeItLeavesAWholeSession) {
    files.writeMesh(test::boxMesh({0, 0, 0}, {0.01F, 0.05F, 0.01F}, 3), "other.obj");
    auto environment = QProcessEnvironment::systemEnvironment();
    environment.insert("LUMORPH_TEST_FILES", QString::fromStdString((files / ".").string()));
    for (int kill = 0; kill < 6; ++kill) {
        QProcess child;
        child.setProcessEnvironment(environment);
        child.start(QCoreApplication::applicationFilePath(),
                    {"--gtest_also_run_disabled_tests", "--gtest_filter=SessionChild.*"});
        QByteArray output;
        ASSERT_TRUE(eventually([&] {
            output += child.readAllStandardOutput();
            return lastKept(output) >= 2;
        }));
        test::pass(std::chrono::milliseconds(7 * kill + 3));
        child.kill();
        ASSERT_TRUE(child.waitForFinished());
        ASSERT_EQ(child.exitStatus(), QProcess::CrashExit);
        output += child.readAllStandardOutput();
        const int kept = lastKept(output);

        ProjectWorld world;
        restore(world);
        ASSERT_EQ(world.state().rig.path.filename(), "cushion.glb");
        const int number = static_cast<int>(std::lround(1000.0 * world.state().playback.spin));
        EXPECT_GE(number, kept);
        EXPECT_LE(number, kept + 1);
        EXPECT_EQ(world.state().strokes, (std::vector<double>{number / 1000.0, 1.0 - number / 1000.0, 0.5}));
        EXPECT_EQ(world.state().target.path.filename(), number % 2 == 0 ? "block.obj" : "other.obj");
        ASSERT_TRUE(world.state().field.field);
    }
}

} // namespace
} // namespace lumorph::studio

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include "app/studio/document/state_rules.h"
#include "core/scene/project.h"
#include "tests/ui/project_world.h"

// Projects and demos, and files that change or vanish under them.

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;
using test::eventually;
using test::ProjectWorld;
using testing::HasSubstr;

std::string textOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

using ProjectServiceFiles = test::ProjectServiceFixture;

TEST_F(ProjectServiceFiles, TheDemoPlaysAndLeavesNothingToSave) {
    world.service.openDemo("field");
    ASSERT_TRUE(eventually([&] { return world.jobs.running().empty() && world.state().field.field; }));
    EXPECT_GT(world.state().target.target->duration, 0.0);
    EXPECT_TRUE(world.state().playback.playing);
    EXPECT_EQ(world.state().matching.driver, Driver::target);
    EXPECT_EQ(world.state().matching.method, MatchMethod::refined);
    EXPECT_FALSE(world.document.modified()) << "the field that was built for it is no change of the user's";
    EXPECT_EQ(world.document.undoStack().count(), 0);
}

TEST_F(ProjectServiceFiles, ChangesThatAnotherProjectReplacesCanBeBroughtBack) {
    world.openRig(files / "cushion.glb");
    const StudioState before = world.state();
    world.service.newProject();
    ASSERT_TRUE(eventually([&] { return world.jobs.running().empty() && world.state().field.field; }));
    EXPECT_NE(world.state().rig.path, before.rig.path);
    EXPECT_TRUE(world.press("project", "Bring it back"));
    EXPECT_FALSE(differenceOf(before, world.state()));
    EXPECT_TRUE(world.document.modified());
}

TEST_F(ProjectServiceFiles, AProjectHoldsCopiesSoThatItOpensElsewhere) {
    world.openRig(files / "cushion.glb");
    world.openTarget(files / "block.obj");
    world.document.change("Hold", [](StudioState& s) {
        s.strokes = {0.1, 0.2, 1.0 / 3.0};
        s.matching = {Driver::hand, MatchMethod::voting, Microseconds(5250)};
        s.playback = {false, 0.3};
        s.placement = {0.7, Angle::radians(1.1), {0.01F, 0.02F, 0.03F}};
    });
    fs::create_directories(files / "here");
    EXPECT_FALSE(world.service.save()) << "it has no file yet";
    world.service.saveAs(files / "here/garden.lumorph");
    EXPECT_FALSE(world.document.modified());
    fs::rename(files / "here", files / "there");
    for (const char* name : {"cushion.glb", "block.obj"}) fs::remove(files / name);

    ProjectWorld other;
    other.service.openProject(files / "there/garden.lumorph");
    ASSERT_TRUE(other.rest());
    const StudioState& was = world.state();
    const StudioState& is = other.state();
    EXPECT_EQ(is.strokes, was.strokes);
    EXPECT_EQ(is.matching, was.matching);
    EXPECT_EQ(is.playback, was.playback);
    EXPECT_EQ(is.placement.deviceFromTarget(), was.placement.deviceFromTarget());
    EXPECT_EQ(is.field.field->field, was.field.field->field);
    EXPECT_EQ(is.target.target->solid.mesh.positions, was.target.target->solid.mesh.positions);
    EXPECT_EQ(writeRigGlb(*is.rig.rig), writeRigGlb(*was.rig.rig));
}

TEST_F(ProjectServiceFiles, WhatVanishedIsSavedFromMemory) {
    world.openRig(files / "cushion.glb");
    world.openTarget(files / "block.obj");
    const TriangleMesh open = world.state().target.target->solid.mesh;
    fs::remove(files / "block.obj");
    ASSERT_TRUE(eventually([&] { return world.notice("target").subject == "block.obj"; }));
    EXPECT_THAT(world.notice("target").why.toStdString(), HasSubstr("no longer"));
    bool asked = false;
    QObject::connect(&world.service, &ProjectService::saveElsewhere, [&] { asked = true; });
    EXPECT_TRUE(world.press("target", "Save a copy..."));
    EXPECT_TRUE(asked);
    ASSERT_TRUE(world.state().target.target);
    world.service.saveAs(files / "garden.lumorph");
    EXPECT_FALSE(world.document.modified());
    ProjectWorld other;
    other.service.openProject(files / "garden.lumorph");
    ASSERT_TRUE(other.rest());
    ASSERT_TRUE(other.state().target.target);
    EXPECT_EQ(other.state().target.target->solid.mesh.triangles.size(), open.triangles.size());
    EXPECT_EQ(boundingBox(other.state().target.target->solid.mesh.positions).max, boundingBox(open.positions).max);
}

TEST_F(ProjectServiceFiles, AChangedTargetIsToldOfAndReadAgainOnRequest) {
    world.openRig(files / "cushion.glb");
    world.openTarget(files / "block.obj");
    world.document.change("Turn", [](StudioState& s) { s.placement.yaw = Angle::radians(0.5); });
    const StudioState before = world.state();
    files.writeMesh(test::boxMesh({0, 0, 0}, {0.01F, 0.05F, 0.01F}, 3), "block.obj");
    ASSERT_TRUE(eventually([&] { return world.notice("target").subject == "block.obj"; }));
    EXPECT_THAT(world.notice("target").why.toStdString(), HasSubstr("changed on disk"));
    EXPECT_FALSE(differenceOf(before, world.state()));
    EXPECT_TRUE(world.press("target", "Read again"));
    ASSERT_TRUE(world.rest());
    EXPECT_FLOAT_EQ(world.state().target.target->box.max.y, 0.05F);
    EXPECT_EQ(world.state().placement.yaw.inRadians(), 0.5) << "it stays where it is";
    EXPECT_EQ(world.document.undoStack().undoText(), "Read block again");

    // What is kept although the file has changed is saved as it is open, not as it is on disk.
    const fs::path next = files / "next.obj";
    files.writeMesh(test::boxMesh({0, 0, 0}, {0.09F, 0.09F, 0.09F}), "next.obj");
    fs::rename(next, files / "block.obj");
    ASSERT_TRUE(eventually([&] { return world.notice("target").subject == "block.obj"; }));
    EXPECT_TRUE(world.press("target", "Keep"));
    world.service.saveAs(files / "garden.lumorph");
    ProjectWorld other;
    other.service.openProject(files / "garden.lumorph");
    ASSERT_TRUE(other.rest());
    EXPECT_FLOAT_EQ(other.state().target.target->box.max.y, 0.05F);
}

/// A file system of some kilobytes.
class SmallDisk {
public:
    explicit SmallDisk(const fs::path& place) : place_(place) {
        fs::create_directories(place_);
        mounted_ = ::mount("tmpfs", place_.c_str(), "tmpfs", 0, "size=16k") == 0;
    }
    ~SmallDisk() {
        if (mounted_) ::umount2(place_.c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    [[nodiscard]] bool mounted() const { return mounted_; }

private:
    fs::path place_;
    bool mounted_ = false;
};

TEST_F(ProjectServiceFiles, AFullDiskOnSaveIsToldWithRemediesAndNothingIsLost) {
    const SmallDisk disk(files / "disk");
    if (!disk.mounted()) GTEST_SKIP() << "needs the right to mount a file system";
    world.openRig(files / "cushion.glb");
    std::ofstream(files / "disk/garden.lumorph") << "the old project";
    world.service.saveAs(files / "disk/garden.lumorph");
    EXPECT_TRUE(world.document.modified());
    EXPECT_TRUE(world.document.file().empty());
    EXPECT_EQ(textOf(files / "disk/garden.lumorph"), "the old project");
    EXPECT_THAT(world.notice("project").why.toStdString(), HasSubstr("No space left"));
    bool asked = false;
    QObject::connect(&world.service, &ProjectService::saveElsewhere, [&] { asked = true; });
    EXPECT_TRUE(world.press("project", "Save somewhere else..."));
    EXPECT_TRUE(asked);
    world.service.saveAs(files / "garden.lumorph");
    EXPECT_FALSE(world.document.modified());
    EXPECT_TRUE(world.notices.at("project").empty());
}

TEST_F(ProjectServiceFiles, AFolderThatIsAFileRefusesToBeSavedIn) {
    world.openRig(files / "cushion.glb");
    world.service.saveAs(files / "block.obj/garden.lumorph");
    EXPECT_TRUE(world.document.modified());
    EXPECT_EQ(world.notice("project").actions.size(), 2U);
    EXPECT_FALSE(world.notice("project").why.isEmpty());
}

} // namespace
} // namespace lumorph::studio

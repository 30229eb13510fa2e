#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/studio/document/state_rules.h"
#include "core/mdf/builder.h"
#include "core/mdf/field_file.h"
#include "core/scene/project.h"
#include "tests/ui/project_world.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;
using test::eventually;
using test::ProjectWorld;

Field smallField(const Rig& rig) {
    BuildOptions options;
    options.resolution = 8;
    options.levels = 5;
    options.samples = 4;
    return buildField(rig, options);
}

struct ProjectServiceTest : test::ProjectServiceFixture {
    /// Nothing happened but that `place` says something about `subject`.
    void expectRefused(const StudioState& before, int steps, const QString& place, const QString& subject) {
        ASSERT_TRUE(world.rest());
        EXPECT_FALSE(differenceOf(before, world.state()));
        EXPECT_EQ(world.document.undoStack().count(), steps);
        const Notice notice = world.notice(place);
        EXPECT_THAT(notice.subject.toStdString(), testing::StartsWith(subject.toStdString()));
        EXPECT_FALSE(notice.why.isEmpty());
        EXPECT_FALSE(notice.remedy.isEmpty());
    }
};

TEST_F(ProjectServiceTest, OpensEachFileByWhatItIs) {
    world.service.open(files / "cushion.glb");
    ASSERT_TRUE(eventually([&] { return world.jobs.running().empty() && world.state().field.field; }));
    EXPECT_EQ(world.state().rig.path, files / "cushion.glb");
    EXPECT_EQ(world.state().field.field->field.frame.dimensions.y, 33) << "built with the usual options";

    world.service.open(files / "block.obj");
    ASSERT_TRUE(world.rest());
    ASSERT_TRUE(world.state().target.target);
    EXPECT_EQ(world.document.undoStack().undoText(), "Open block");
    world.service.open(fs::path(LUMORPH_SOURCE_DIR) / "resources/targets/dunes.glb");
    ASSERT_TRUE(world.rest());
    EXPECT_EQ(world.state().target.path.filename(), "dunes.glb") << "a glTF without actuators is a target";
    EXPECT_EQ(world.state().rig.path, files / "cushion.glb");

    world.service.saveAs(files / "garden");
    const StudioState saved = world.state();
    world.service.newProject();
    ASSERT_TRUE(eventually([&] { return world.state().rig.path.filename() == "tablet.glb"; }));
    EXPECT_EQ(world.state().target.target, nullptr);
    world.service.open(files / "garden.lumorph");
    ASSERT_TRUE(eventually([&] { return world.document.name() == "garden"; }));
    EXPECT_EQ(world.state().placement.scale, saved.placement.scale);
    EXPECT_EQ(world.state().field.field->field, saved.field.field->field);
    EXPECT_FALSE(world.document.modified());
}

TEST_F(ProjectServiceTest, ATargetIsAsLargeAsFitsAndStandsOnTheDevice) {
    world.openRig(files / "cushion.glb");
    world.openTarget(files / "block.obj");
    const Field& field = world.state().field.field->field;
    // 4 x 3 x 2 cm, turned by nothing: each side against the room of the frame above the rest surface.
    const Box frame = field.frame.box();
    const double scale = std::min({(frame.max.x - frame.min.x) / 0.04F, (frame.max.y - field.restSurface) / 0.03F,
                                   (frame.max.z - frame.min.z) / 0.02F});
    EXPECT_NEAR(world.state().placement.scale, scale, 1e-5 * scale);
    EXPECT_FLOAT_EQ(world.state().placement.translation.y, field.restSurface);
    world.document.change("Elsewhere", [](StudioState& s) { s.placement = {0.1, {}, {1, 1, 1}}; });
    world.service.fit();
    EXPECT_NEAR(world.state().placement.scale, scale, 1e-5 * scale);
    EXPECT_EQ(world.document.undoStack().undoText(), "Fit target");
}

TEST_F(ProjectServiceTest, WrongFilesAreRefusedWhereTheyBelongAndNothingChanges) {
    world.openRig(files / "cushion.glb");
    world.openTarget(files / "block.obj");
    files.writeText("broken.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
    files.writeText("empty.stl", "");
    files.writeText("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    files.writeText("huge.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
                                "property float y\nproperty float z\nend_header\n");
    files.writeText("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    files.writeText("broken.mdf", "LUMORPH");
    files.writeText("broken.lumorph", "{\"rig\":");
    files.writeText("broken.glb", "glTF nonsense");
    files.writeText("grid.nrrd", "NRRD0004\n");
    files.writeText("song.mp3", "la");
    struct Wrong {
        const char* file;
        const char* place;
    };
    for (const Wrong& wrong :
         {Wrong{"broken.obj", "target"}, Wrong{"empty.stl", "target"}, Wrong{"flat.obj", "target"},
          Wrong{"huge.ply", "target"}, Wrong{"nan.obj", "target"}, Wrong{"gone.obj", "target"},
          Wrong{"broken.mdf", "field"}, Wrong{"broken.lumorph", "project"}, Wrong{"broken.glb", "viewport"},
          Wrong{"grid.nrrd", "target"}, Wrong{"song.mp3", "viewport"}}) {
        SCOPED_TRACE(wrong.file);
        const StudioState before = world.state();
        const int steps = world.document.undoStack().count();
        world.service.open(files / wrong.file);
        expectRefused(before, steps, wrong.place, wrong.file);
        QString asked;
        const auto connection =
            QObject::connect(&world.service, &ProjectService::chooseFile, [&](const QString& p) { asked = p; });
        EXPECT_TRUE(world.press(wrong.place, "Choose another file..."));
        EXPECT_EQ(asked, wrong.place);
        QObject::disconnect(connection);
    }
}

TEST_F(ProjectServiceTest, AnOpenMeshIsTakenAndTheUserTold) {
    world.openRig(files / "cushion.glb");
    TriangleMesh open = test::boxMesh({0, 0, 0}, {0.02F, 0.02F, 0.02F}, 40);
    open.triangles.resize(open.triangles.size() / 2); // far more than a hole to be filled
    files.writeMesh(open, "open.obj");
    world.openTarget(files / "open.obj");
    ASSERT_TRUE(world.state().target.target);
    EXPECT_FALSE(world.state().target.target->solid.closed);
    EXPECT_EQ(world.notice("target").subject, "open.obj");
    EXPECT_EQ(world.notice("target").level, Notice::Level::warning);
}

TEST_F(ProjectServiceTest, AFieldBesideTheRigIsUsedWhenItIsTheRigs) {
    writeFileAtomically(files / "cushion.mdf", writeField(smallField(test::cushionRig())));
    world.service.openRig(files / "cushion.glb");
    ASSERT_TRUE(world.rest());
    EXPECT_EQ(world.state().field.path, files / "cushion.mdf");
    EXPECT_EQ(world.state().field.field->field.levels, 5);
    EXPECT_EQ(world.document.undoStack().count(), 1);

    writeFileAtomically(files / "lifter.mdf", writeField(smallField(test::cushionRig())));
    world.openRig(files / "lifter.glb");
    EXPECT_TRUE(world.state().field.path.empty());
    EXPECT_EQ(world.state().field.field->field.levels, 33) << "another rig's field is no use: it was built";
}

TEST_F(ProjectServiceTest, AFieldThatWasBuiltOnceNeedNotBeBuiltAgain) {
    world.openRig(files / "cushion.glb");
    const auto first = world.state().field.field;
    ProjectWorld later;
    later.service.openRig(files / "cushion.glb");
    ASSERT_TRUE(later.rest());
    ASSERT_TRUE(later.state().field.field);
    EXPECT_EQ(later.state().field.field->field, first->field);
    EXPECT_EQ(later.document.undoStack().count(), 1) << "it came with the rig";
}

TEST_F(ProjectServiceTest, CancellingABuildLeavesEverythingAsItWas) {
    world.openRig(files / "cushion.glb");
    const StudioState before = world.state();
    const int steps = world.document.undoStack().count();
    BuildOptions fine;
    fine.resolution = 120;
    fine.samples = 4096;
    fine.levels = 100;
    world.service.buildField(fine);
    ASSERT_EQ(world.jobs.running().size(), 1U);
    const Jobs::Id id = world.jobs.running().front().id;
    ASSERT_TRUE(eventually([&] { return world.jobs.running().front().fraction > 0.0; }));
    world.jobs.cancel(id);
    test::pass(std::chrono::milliseconds(300));
    EXPECT_EQ(world.state().field.field, before.field.field);
    EXPECT_FALSE(differenceOf(before, world.state()));
    EXPECT_EQ(world.document.undoStack().count(), steps);
    EXPECT_TRUE(world.notices.at().empty());
}

TEST_F(ProjectServiceTest, ABuildIsOneStepOfUndo) {
    world.openRig(files / "cushion.glb");
    const auto before = world.state().field.field;
    BuildOptions options;
    options.resolution = 10;
    options.levels = 7;
    world.service.buildField(options);
    ASSERT_TRUE(world.rest());
    EXPECT_EQ(world.state().field.field->field, buildField(test::cushionRig(), options));
    world.document.undoStack().undo();
    EXPECT_EQ(world.state().field.field, before);
    world.document.undoStack().redo();
    EXPECT_EQ(world.state().field.field->field.levels, 7);
}

TEST_F(ProjectServiceTest, OptionsOutOfRangeAreRefusedWithARemedy) {
    world.openRig(files / "cushion.glb");
    struct Wrong {
        int resolution, levels, samples;
    };
    for (const Wrong& wrong :
         {Wrong{0, 33, 64}, Wrong{5000, 33, 64}, Wrong{33, 1, 64}, Wrong{33, 500, 64}, Wrong{33, 33, 0}}) {
        const StudioState before = world.state();
        const int steps = world.document.undoStack().count();
        BuildOptions options;
        options.resolution = wrong.resolution;
        options.levels = wrong.levels;
        options.samples = wrong.samples;
        world.notices.dismissAll("field");
        world.service.buildField(options);
        ASSERT_TRUE(world.rest());
        expectRefused(before, steps, "field", world.notice("field").subject);
    }
    EXPECT_TRUE(world.press("field", "Build with the usual settings"));
    ASSERT_TRUE(world.rest());
    EXPECT_TRUE(world.notices.at("field").empty());
}

TEST_F(ProjectServiceTest, AFieldOfAnotherRigIsRefusedAndItsRigOffered) {
    world.openRig(files / "cushion.glb");
    const Field other = smallField(test::lifterRig());
    writeFileAtomically(files / "other.mdf", writeField(other));
    const StudioState before = world.state();
    world.service.open(files / "other.mdf");
    expectRefused(before, world.document.undoStack().count(), "field", "other.mdf");
    EXPECT_TRUE(world.press("field", "Keep mine"));
    EXPECT_FALSE(differenceOf(before, world.state()));
    EXPECT_TRUE(world.notices.at("field").empty());

    world.service.openField(files / "other.mdf");
    ASSERT_TRUE(world.rest());
    EXPECT_TRUE(world.press("field", "Open its rig"));
    EXPECT_EQ(world.state().field.field->field, other);
    EXPECT_EQ(writeRigGlb(*world.state().rig.rig), other.rigGlb);
    world.document.undoStack().undo();
    EXPECT_FALSE(differenceOf(before, world.state()));
}

TEST_F(ProjectServiceTest, AutoPlaceIsOneStepAndNeverWorseThanFitting) {
    world.openRig(files / "cushion.glb");
    world.openTarget(files / "block.obj");
    const int steps = world.document.undoStack().count();
    world.service.autoPlace();
    ASSERT_TRUE(world.rest());
    ASSERT_TRUE(world.notices.at("target").empty()) << world.notice("target").why.toStdString();
    EXPECT_EQ(world.document.undoStack().count(), steps + 1);
    EXPECT_EQ(world.document.undoStack().undoText(), "Auto-place target");
}

} // namespace
} // namespace lumorph::studio

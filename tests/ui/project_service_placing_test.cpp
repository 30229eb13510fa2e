#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/mdf/frame_matcher.h"
#include "tests/ui/project_world.h"

// Where a new target goes by itself.

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;
using test::eventually;

/// A service that places new targets, with the cushion open and a thin wall to be placed on it.
class ProjectServicePlacing : public test::ProjectServiceFixture {
protected:
    void SetUp() override {
        files.writeMesh(test::boxMesh({-0.004F, 0.0F, -0.03F}, {0.004F, 0.02F, 0.03F}), "wall.obj");
        world.openRig(files / "cushion.glb");
        world.service.setPlacesNewTargets(true);
        before = world.document.undoStack().count();
    }
    /// Opens it and returns as soon as it is there, with the search for its place under way.
    void open(const std::string& name) {
        world.service.openTarget(files / name);
        ASSERT_TRUE(eventually([&] { return world.document.undoStack().count() == before + 1; }));
        fitted = world.state().placement;
    }
    double iou(const Placement& placement) {
        const MatchField& field = *world.state().field.field;
        SolidVoxelizer voxelizer;
        BitColumns bits;
        voxelizeTarget(field.field.frame, {placed(world.state().target.target->solid.mesh, placement), true, {}},
                       voxelizer, bits);
        Votes votes;
        FrameMatcher matcher(field.coverage, field.voting);
        matcher.vote(bits, votes);
        matcher.refine(bits, Microseconds(0), SteadyClock());
        return matcher.found().quality.iou();
    }

    int before = 0;
    Placement fitted;
};

TEST_F(ProjectServicePlacing, ANewTargetShowsWhereItFitsAndThenMovesWhereItMatchesBest) {
    open("wall.obj");
    EXPECT_EQ(world.document.undoStack().undoText(), "Open wall");
    ASSERT_TRUE(eventually([&] { return world.document.undoStack().count() == before + 2; }));
    EXPECT_EQ(world.document.undoStack().undoText(), "Auto-place wall");
    EXPECT_GT(iou(world.state().placement), iou(fitted));
    world.document.undoStack().undo();
    EXPECT_TRUE(world.state().placement == fitted);
    EXPECT_TRUE(world.state().target.target) << "only its place was taken back";
}

TEST_F(ProjectServicePlacing, OtherPlacesThatWereFoundCanBeChosen) {
    open("wall.obj");
    ASSERT_TRUE(eventually([&] { return world.document.undoStack().count() == before + 2; }));
    const auto places = world.service.places();
    ASSERT_GE(places.size(), 2U);
    EXPECT_TRUE(world.state().placement == places[0].placement);
    EXPECT_GE(places[0].iou, places[1].iou);
    world.service.choosePlace(1);
    EXPECT_TRUE(world.state().placement == places[1].placement);
    EXPECT_EQ(world.document.undoStack().undoText(), "Choose another place");
    world.service.choosePlace(7);
    EXPECT_EQ(world.document.undoStack().count(), before + 3);
    world.document.undoStack().undo();
    EXPECT_TRUE(world.state().placement == places[0].placement);
    world.service.removeTarget();
    EXPECT_TRUE(world.service.places().empty()) << "they were of another target";
}

TEST_F(ProjectServicePlacing, AReliefIsShownAndTakenBack) {
    open("wall.obj");
    ASSERT_TRUE(eventually([&] { return world.document.undoStack().count() == before + 2; }));
    world.service.setRelief(true);
    ASSERT_TRUE(eventually([&] { return world.state().placement.relief; }));
    world.service.setRelief(false);
    ASSERT_TRUE(eventually([&] { return !world.state().placement.relief; }));
}

TEST_F(ProjectServicePlacing, WhoMovesItMeanwhileWins) {
    open("wall.obj");
    world.document.change("Move", [](StudioState& s) { s.placement.translation.x += 0.003F; });
    const Placement moved = world.state().placement;
    ASSERT_TRUE(world.rest());
    test::pass(std::chrono::milliseconds(100));
    EXPECT_TRUE(world.state().placement == moved);
    EXPECT_EQ(world.document.undoStack().undoText(), "Move");
}

TEST_F(ProjectServicePlacing, WhoMovesItWhileItGlidesWins) {
    open("wall.obj");
    ASSERT_TRUE(eventually([&] { return world.state().placement != fitted; }));
    ASSERT_EQ(world.document.undoStack().count(), before + 1) << "it is on its way";
    world.document.preview([](StudioState& s) { s.placement.translation = {0.001F, 0.002F, 0.003F}; });
    test::pass(std::chrono::milliseconds(100));
    world.document.commitPreview("Move");
    test::pass(std::chrono::milliseconds(900));
    EXPECT_EQ(world.state().placement.translation, glm::vec3(0.001F, 0.002F, 0.003F));
    EXPECT_EQ(world.document.undoStack().undoText(), "Move");
}

TEST_F(ProjectServicePlacing, WhoTakesTheTargetBackIsNotInterferedWith) {
    open("wall.obj");
    world.document.undoStack().undo();
    ASSERT_TRUE(world.rest());
    test::pass(std::chrono::milliseconds(100));
    EXPECT_FALSE(world.state().target.target);
    EXPECT_TRUE(world.document.undoStack().canRedo());
}

TEST_F(ProjectServicePlacing, ATargetThatMovesStaysWhereItFits) {
    world.openTarget(fs::path(LUMORPH_SOURCE_DIR) / "resources/targets/swell.glb");
    test::pass(std::chrono::milliseconds(100));
    EXPECT_TRUE(world.jobs.running().empty());
    EXPECT_EQ(world.document.undoStack().count(), before + 1);
}

} // namespace
} // namespace lumorph::studio

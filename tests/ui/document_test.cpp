#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "app/studio/document/state_rules.h"
#include "app/studio/document/studio_document.h"
#include "core/mdf/builder.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/event_loop.h"

namespace lumorph::studio {
namespace {

using test::cushionRig;
using test::lifterRig;

std::shared_ptr<const MatchField> sharedField(const Rig& rig) {
    BuildOptions options;
    options.resolution = 8;
    options.levels = 5;
    options.samples = 4;
    return std::make_shared<const MatchField>(buildField(rig, options));
}

std::shared_ptr<const MatchTarget> blockTarget() {
    auto target = std::make_shared<MatchTarget>();
    target->name = "block";
    target->solid = makeTarget(test::boxMesh({0, 0, 0}, {0.01F, 0.01F, 0.01F}));
    return target;
}

struct DocumentTest : testing::Test {
    DocumentTest() {
        test::needApplication();
        QObject::connect(&document, &StudioDocument::changed, [this](StateParts parts) { told.push_back(parts); });
        StudioState state;
        state.rig = {"cushion.glb", std::make_shared<const Rig>(cushionRig())};
        document.reset(state, {});
        told.clear();
    }
    StudioDocument document;
    std::vector<StateParts> told;
    const double nan = std::numeric_limits<double>::quiet_NaN();
};

using Edit = std::function<void(StudioState&)>;

TEST_F(DocumentTest, EachPartIsToldAloneAndComesBackExactlyByUndoAndRedo) {
    const auto target = blockTarget();
    const auto field = sharedField(*document.state().rig.rig);
    const std::vector<std::pair<StatePart, Edit>> edits = {
        {StatePart::rig, [](StudioState& s) { s.rig.path = "elsewhere.glb"; }},
        {StatePart::field,
         [&](StudioState& s) {
             s.field = {"cushion.mdf", field};
         }},
        {StatePart::target,
         [&](StudioState& s) {
             s.target = {"block.obj", target};
         }},
        {StatePart::placement,
         [](StudioState& s) {
             s.placement = {2.5, Angle::radians(0.1), {1, 2, 3}};
         }},
        {StatePart::strokes,
         [](StudioState& s) {
             s.strokes = {0.25, 0.5, 1.0};
         }},
        {StatePart::matching,
         [](StudioState& s) {
             s.matching = {Driver::hand, MatchMethod::voting, Microseconds(5000)};
         }},
        {StatePart::poses,
         [](StudioState& s) {
             PoseBook poses = *s.poses;
             keepPose(poses, "open", std::vector<std::string>{"left", "right"}, std::vector{1.0, 0.5});
             s.poses = std::make_shared<const PoseBook>(poses);
         }},
        {StatePart::scene,
         [](StudioState& s) {
             Scene scene = *s.scene;
             scene.exposure += 0.1;
             s.scene = std::make_shared<const Scene>(scene);
         }},
        {StatePart::installation,
         [](StudioState& s) {
             Installation installation = *s.installation;
             installation.tableSize.x += 0.1F;
             s.installation = std::make_shared<const Installation>(installation);
         }},
        {StatePart::playback,
         [](StudioState& s) {
             s.playback = {false, 0.7};
         }},
    };
    std::vector<StudioState> states = {document.state()};
    for (const auto& [part, edit] : edits) {
        document.change("Edit", edit);
        ASSERT_EQ(told.size(), 1U);
        EXPECT_EQ(told.front(), StateParts(part));
        told.clear();
        states.push_back(document.state());
    }
    for (std::size_t i = edits.size(); i-- > 0;) {
        document.undoStack().undo();
        EXPECT_FALSE(differenceOf(document.state(), states[i]));
        EXPECT_EQ(told, std::vector{StateParts(edits[i].first)});
        told.clear();
    }
    EXPECT_FALSE(document.modified());
    for (std::size_t i = 1; i <= edits.size(); ++i) {
        document.undoStack().redo();
        EXPECT_FALSE(differenceOf(document.state(), states[i]));
    }
    EXPECT_EQ(document.state().placement.translation, glm::vec3(1, 2, 3));
    EXPECT_EQ(document.state().target.target, target);
}

TEST_F(DocumentTest, AnEditThatChangesNothingIsNoStep) {
    document.change("Nothing", [](StudioState& s) { s.placement.scale *= 1.0; });
    EXPECT_EQ(document.undoStack().count(), 0);
    EXPECT_TRUE(told.empty());
    EXPECT_FALSE(document.modified());
}

TEST_F(DocumentTest, ADragIsOneStep) {
    for (int i = 1; i <= 20; ++i)
        document.preview([&](StudioState& s) { s.placement.translation.x = 0.01F * static_cast<float>(i); });
    EXPECT_EQ(told.size(), 20U);
    EXPECT_EQ(document.undoStack().count(), 0);
    document.commitPreview("Move target");
    EXPECT_EQ(told.size(), 20U) << "committing shows nothing new";
    ASSERT_EQ(document.undoStack().count(), 1);
    EXPECT_EQ(document.undoStack().undoText(), "Move target");
    document.undoStack().undo();
    EXPECT_EQ(document.state().placement.translation.x, 0.0F);
    document.undoStack().redo();
    EXPECT_FLOAT_EQ(document.state().placement.translation.x, 0.2F);
}

TEST_F(DocumentTest, EscDuringADragRevertsItWithoutAStep) {
    document.preview([](StudioState& s) { s.strokes = {1, 1, 1}; });
    document.cancelPreview();
    EXPECT_EQ(document.state().strokes, std::vector<double>(3, 0.0));
    EXPECT_EQ(document.undoStack().count(), 0);
    EXPECT_FALSE(document.modified());
    document.commitPreview("Nothing is left to commit");
    EXPECT_EQ(document.undoStack().count(), 0);
}

TEST_F(DocumentTest, AResultThatArrivesDuringADragIsAStepOfItsOwnBelowIt) {
    document.preview([](StudioState& s) { s.placement.scale = 2.0; });
    const auto target = blockTarget();
    document.change("Open block", [&](StudioState& s) { s.target = {"block.obj", target}; });
    EXPECT_EQ(document.state().placement.scale, 2.0) << "the drag goes on";
    document.preview([](StudioState& s) { s.placement.scale = 3.0; });
    document.commitPreview("Scale target");
    ASSERT_EQ(document.undoStack().count(), 2);
    document.undoStack().undo();
    EXPECT_EQ(document.state().placement.scale, 1.0);
    EXPECT_EQ(document.state().target.target, target);
    document.undoStack().undo();
    EXPECT_EQ(document.state().target.target, nullptr);
}

TEST_F(DocumentTest, UndoDuringADragTakesTheDragBackToo) {
    document.change("Turn", [](StudioState& s) { s.placement.yaw = Angle::radians(1.0); });
    document.preview([](StudioState& s) { s.placement.scale = 2.0; });
    document.undoStack().undo();
    EXPECT_EQ(document.state().placement.scale, 1.0);
    EXPECT_EQ(document.state().placement.yaw.inRadians(), 0.0);
    EXPECT_FALSE(document.previewing());
}

TEST_F(DocumentTest, AFieldOfAnotherRigIsDropped) {
    const auto field = sharedField(*document.state().rig.rig);
    document.change("Build", [&](StudioState& s) { s.field.field = field; });
    EXPECT_EQ(document.state().field.field, field);
    document.change("Open rig", [](StudioState& s) { s.rig.rig = std::make_shared<const Rig>(lifterRig()); });
    EXPECT_EQ(document.state().field.field, nullptr);
    document.change("Wrong field", [&](StudioState& s) { s.field.field = field; });
    EXPECT_EQ(document.state().field.field, nullptr);
    EXPECT_EQ(document.undoStack().count(), 2);
    document.undoStack().undo();
    EXPECT_EQ(document.state().field.field, field) << "rig and field come back together";
    document.change("Same rig read again",
                    [](StudioState& s) { s.rig.rig = std::make_shared<const Rig>(cushionRig()); });
    EXPECT_EQ(document.state().field.field, field) << "an equal rig keeps the field";
}

TEST_F(DocumentTest, ThereIsOneStrokeAnActuatorWithinItsRange) {
    EXPECT_EQ(document.state().strokes, std::vector<double>(3, 0.0));
    document.change("Too many", [](StudioState& s) { s.strokes = {-1.0, 2.0, 0.5, 0.25, 0.1}; });
    EXPECT_EQ(document.state().strokes, (std::vector<double>{0.0, 1.0, 0.5}));
    document.change("Too few", [](StudioState& s) { s.strokes = {0.75}; });
    EXPECT_EQ(document.state().strokes, (std::vector<double>{0.75, 0.0, 0.0}));
}

TEST_F(DocumentTest, PosesThatAreNotSoundAreRefusedAndFollowActuatorsThatAreRenamed) {
    std::vector<std::string> names;
    for (const Actuator& actuator : document.state().rig.parts->actuators) names.push_back(actuator.name);
    PoseBook poses;
    keepPose(poses, "open", names, std::vector<double>(names.size(), 0.5));
    document.change("Keep", [&](StudioState& s) { s.poses = std::make_shared<const PoseBook>(poses); });
    PoseBook wrong = poses;
    wrong.sequence.poses[0].strokes[0] = nan;
    document.change("Spoil", [&](StudioState& s) { s.poses = std::make_shared<const PoseBook>(wrong); });
    EXPECT_EQ(*document.state().poses, poses);
    EXPECT_EQ(document.undoStack().count(), 1);
    document.change("Rename", [](StudioState& s) {
        RigParts parts = *s.rig.parts;
        parts.actuators[1].name = "heart";
        s.rig.parts = std::make_shared<const RigParts>(parts);
    });
    EXPECT_EQ(document.state().poses->actuators[1], "heart");
    document.change("Fewer", [](StudioState& s) {
        RigParts parts = *s.rig.parts;
        parts.actuators.pop_back();
        s.rig.parts = std::make_shared<const RigParts>(parts);
    });
    EXPECT_EQ(document.state().poses->actuators.size(), names.size()) << "nothing is lost";
    document.undoStack().undo();
    document.undoStack().undo();
    EXPECT_EQ(*document.state().poses, poses);
}

TEST_F(DocumentTest, ANumberThatIsNoneIsRefused) {
    document.change("Place", [](StudioState& s) { s.placement = {2.0, Angle::radians(1.0), {1, 2, 3}}; });
    document.change("Hold", [](StudioState& s) { s.strokes = {0.5, 0.5, 0.5}; });
    const StudioState before = document.state();
    const std::vector<Edit> edits = {
        [this](StudioState& s) { s.placement.scale = nan; },
        [this](StudioState& s) { s.placement.yaw = Angle::radians(nan); },
        [](StudioState& s) { s.placement.translation.y = std::numeric_limits<float>::infinity(); },
        [this](StudioState& s) { s.strokes[1] = nan; },
        [this](StudioState& s) { s.playback.spin = nan; },
    };
    for (const Edit& edit : edits) {
        document.change("Not a number", edit);
        document.preview(edit);
        document.commitPreview("Not a number");
    }
    EXPECT_FALSE(differenceOf(before, document.state()));
    EXPECT_EQ(document.undoStack().count(), 2);
}

TEST_F(DocumentTest, ModifiedMeansOtherThanWhatWasSaved) {
    int titles = 0;
    QObject::connect(&document, &StudioDocument::titleChanged, [&] { ++titles; });
    EXPECT_EQ(document.name(), "Untitled");
    document.change("Spin", [](StudioState& s) { s.playback.spin = 1.0; });
    EXPECT_TRUE(document.modified());
    document.setSaved("/somewhere/garden.lumorph");
    EXPECT_EQ(document.name(), "garden");
    EXPECT_FALSE(document.modified());
    document.undoStack().undo();
    EXPECT_TRUE(document.modified());
    document.undoStack().redo();
    EXPECT_FALSE(document.modified());
    EXPECT_GE(titles, 4);
    document.reset(document.state(), {});
    EXPECT_FALSE(document.undoStack().canUndo());
    EXPECT_EQ(document.name(), "Untitled");
}

} // namespace
} // namespace lumorph::studio

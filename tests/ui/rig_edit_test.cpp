#include <gtest/gtest.h>

#include "app/studio/document/match_wish.h"
#include "app/studio/document/rig_edit.h"
#include "app/studio/document/state_rules.h"
#include "app/workspaces/rig/rig_facts.h"
#include "core/rig/rig_file.h"
#include "tests/ui/project_world.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;
using test::eventually;
using test::ProjectWorld;

double maxOf(const RigParts& parts, std::size_t actuator) {
    return std::get<Slide>(parts.actuators.at(actuator).deformer).max;
}

RigEdit lift(std::size_t actuator, double max) {
    return [=](RigParts& parts) { std::get<Slide>(parts.actuators.at(actuator).deformer).max = max; };
}

RigEdit rename(std::size_t actuator, const std::string& name) {
    return [=](RigParts& parts) { parts.actuators.at(actuator).name = name; };
}

const RigEdit kEmptyRange = [](RigParts& parts) {
    auto& slide = std::get<Slide>(parts.actuators[0].deformer);
    slide.max = slide.min;
};

/// The lifter with its field, and a block to match.
struct RigEditTest : test::ProjectServiceFixture {
    RigEditTest() {
        world.openRig(files / "lifter.glb");
        world.openTarget(files / "block.obj");
        QObject::connect(&world.document, &StudioDocument::changed, [this](StateParts parts) { told |= parts; });
    }
    [[nodiscard]] bool compiles() {
        return eventually([&] { return world.state().rig.compiled; });
    }
    [[nodiscard]] Notice stale() const {
        for (const Notice& notice : world.notices.at("field"))
            if (notice.why.contains("before your edit")) return notice;
        return {};
    }
    [[nodiscard]] bool isSaidToBeStale() const { return !stale().why.isEmpty(); }
    StateParts told;
};

TEST_F(RigEditTest, AnEditIsToldAsOneAndCompiledBesideTheWindow) {
    const StudioState before = world.state();
    const int steps = world.document.undoStack().count();
    editRig(world.document, "Lift", lift(0, 0.05));
    EXPECT_EQ(maxOf(*world.state().rig.parts, 0), 0.05);
    EXPECT_FALSE(world.state().rig.compiled);
    EXPECT_EQ(world.state().rig.rig, before.rig.rig) << "the last rig is shown meanwhile";
    ASSERT_TRUE(compiles());
    EXPECT_EQ(world.state().rig.rig->parts(), *world.state().rig.parts);
    EXPECT_EQ(world.state().rig.origin, before.rig.origin);
    EXPECT_EQ(world.state().rig.path, before.rig.path);
    EXPECT_FALSE(told & StatePart::rig) << "it is the same rig, edited";
    EXPECT_TRUE(told & StatePart::rigEdited);
    EXPECT_EQ(world.document.undoStack().count(), steps + 1) << "compiling is no step of its own";
    EXPECT_EQ(world.state().strokes, before.strokes);
    EXPECT_EQ(world.state().placement, before.placement);

    told = {};
    world.openRig(files / "cushion.glb");
    EXPECT_TRUE(told & StatePart::rig);
    EXPECT_NE(world.state().rig.origin, before.rig.origin);
}

TEST(RigFacts, AnotherRangeHasOtherPulsesForTheSameTurnOfTheServo) {
    Bend bend;
    bend.max = Angle::degrees(90.0);
    Actuator flap;
    flap.deformer = bend;
    flap.maxVelocity = 2.0;
    flap.drive.pulseMin = 2000.0;
    flap.drive.pulseMax = 1000.0;
    flap.drive.curve = {0.0, 0.6, 0.9, 1.0};
    const auto pulseAt = [](const Actuator& a, double degrees) {
        const double stroke = degrees / Angle::radians(rangeOf(a).max).inDegrees();
        return std::lerp(a.drive.pulseMin, a.drive.pulseMax, turnedAt(a.drive.curve, stroke));
    };
    Actuator shorter = flap;
    setRange(shorter, 0.0, Angle::degrees(60.0).inRadians());
    for (const double degrees : {0.0, 20.0, 40.0, 60.0})
        EXPECT_NEAR(pulseAt(shorter, degrees), pulseAt(flap, degrees), 1e-9);
    EXPECT_NEAR(shorter.maxVelocity, 3.0, 1e-12);
    Actuator longer = flap;
    setRange(longer, 0.0, Angle::degrees(120.0).inRadians());
    EXPECT_NEAR(longer.drive.pulseMax, 900.0, 1e-9) << "straight on from where it ended";
    Actuator tooLong = flap;
    tooLong.drive.pulseMax = 600.0;
    const ActuatorDrive before = tooLong.drive;
    setRange(tooLong, 0.0, Angle::degrees(270.0).inRadians());
    EXPECT_EQ(tooLong.drive, before) << "no servo can be told that";
}

TEST_F(RigEditTest, AnEditThatChangesNothingIsNoStep) {
    const int steps = world.document.undoStack().count();
    const auto parts = world.state().rig.parts;
    editRig(world.document, "Lift", lift(0, maxOf(*parts, 0)));
    EXPECT_EQ(world.document.undoStack().count(), steps);
    EXPECT_EQ(world.state().rig.parts, parts);
}

TEST_F(RigEditTest, TheFieldStaysShownAndMatchedIsSaidToBeStaleAndIsNewAfterBuilding) {
    const auto field = world.state().field.field;
    editRig(world.document, "Lift", lift(0, 0.05));
    EXPECT_EQ(world.state().field.field, field);
    EXPECT_TRUE(world.state().field.stale);
    EXPECT_TRUE(isSaidToBeStale());
    ASSERT_TRUE(compiles());
    EXPECT_EQ(wishOf(world.state()).field, field) << "it is still matched";

    ASSERT_TRUE(world.press("field", "Build the field"));
    ASSERT_TRUE(eventually([&] { return world.state().field.field != field; }));
    EXPECT_FALSE(world.state().field.stale);
    EXPECT_FALSE(isSaidToBeStale());
    EXPECT_EQ(world.state().field.field->field.rigGlb, writeRigGlb(*world.state().rig.rig));
    EXPECT_EQ(world.state().field.field->field.levels, field->field.levels);
    EXPECT_EQ(world.state().field.field->field.frame.dimensions.y, field->field.frame.dimensions.y);

    world.document.undoStack().undo();
    EXPECT_EQ(world.state().field.field, field);
    EXPECT_TRUE(world.state().field.stale);
    world.document.undoStack().undo();
    EXPECT_FALSE(world.state().field.stale) << "undone to what it was built for";
    EXPECT_FALSE(isSaidToBeStale());
}

TEST_F(RigEditTest, UndoAndRedoBringPartsAndRigBackAtOnce) {
    const StudioState::RigAsset original = world.state().rig;
    editRig(world.document, "Lift", lift(0, 0.05));
    ASSERT_TRUE(compiles());
    const StudioState::RigAsset once = world.state().rig;
    editRig(world.document, "Lift more", lift(0, 0.06));
    ASSERT_TRUE(compiles());
    world.document.undoStack().undo();
    EXPECT_EQ(world.state().rig, once);
    world.document.undoStack().undo();
    EXPECT_EQ(world.state().rig, original);
    world.document.undoStack().redo();
    EXPECT_EQ(world.state().rig, once);
}

TEST_F(RigEditTest, NamesAndVelocitiesLeaveTheFieldAsItIs) {
    const auto field = world.state().field.field;
    editRig(world.document, "Rename", rename(0, "left"));
    editRig(world.document, "Slow down", [](RigParts& parts) { parts.actuators[0].maxVelocity = 0.25; });
    ASSERT_TRUE(compiles());
    EXPECT_EQ(world.state().field.field, field);
    EXPECT_FALSE(world.state().field.stale);
    EXPECT_FALSE(isSaidToBeStale());
    EXPECT_EQ(wishOf(world.state()).field, field);
}

TEST_F(RigEditTest, AFieldOfOtherActuatorsIsShownButNotMatched) {
    const auto field = world.state().field.field;
    editRig(world.document, "Remove", [](RigParts& parts) { parts.actuators.pop_back(); });
    ASSERT_TRUE(compiles());
    EXPECT_EQ(world.state().field.field, field);
    EXPECT_TRUE(world.state().field.stale);
    const MatchWish wish = wishOf(world.state());
    EXPECT_EQ(wish.field, nullptr);
    EXPECT_EQ(wish.strokes.size(), wish.rig->actuatorCount());

    editRig(world.document, "Exchange", [](RigParts& parts) { std::swap(parts.actuators[0], parts.actuators[1]); });
    ASSERT_TRUE(compiles());
    EXPECT_EQ(wishOf(world.state()).field, nullptr);
    world.document.undoStack().undo();
    world.document.undoStack().undo();
    EXPECT_EQ(wishOf(world.state()).field, field);

    editRig(world.document, "Exchange", [](RigParts& parts) { std::swap(parts.actuators[0], parts.actuators[1]); });
    ASSERT_TRUE(compiles());
    EXPECT_FALSE(fieldFits(world.state())) << "as many, but its levels are not theirs";
}

TEST_F(RigEditTest, PartsThatDoNotCompileLeaveTheLastRigAndSayWhy) {
    editRig(world.document, "Lift", lift(1, 0.05));
    ASSERT_TRUE(compiles());
    const StudioState good = world.state();
    editRig(world.document, "Close", kEmptyRange);
    ASSERT_TRUE(eventually([&] { return !world.notices.at("rig").empty(); }));
    EXPECT_EQ(world.state().rig.rig, good.rig.rig);
    EXPECT_EQ(world.state().field.field, good.field.field);
    EXPECT_EQ(wishOf(world.state()).field, good.field.field);
    const Notice notice = world.notice("rig");
    EXPECT_TRUE(notice.subject.contains(QString::fromStdString(good.rig.parts->actuators[0].name)))
        << notice.subject.toStdString();
    EXPECT_FALSE(notice.why.isEmpty());
    EXPECT_FALSE(notice.remedy.isEmpty());
    // It is kept as it was last sound.
    world.service.saveAs(files / "broken");
    EXPECT_EQ(world.notice("project").why, QString());

    editRig(world.document, "Open", lift(0, 0.04));
    ASSERT_TRUE(compiles());
    EXPECT_TRUE(world.notices.at("rig").empty()) << "it goes when they fit again";
    world.document.undoStack().undo();
    ASSERT_TRUE(eventually([&] { return !world.notices.at("rig").empty(); }));
    world.document.undoStack().undo();
    EXPECT_TRUE(world.notices.at("rig").empty());
    EXPECT_EQ(world.state().rig, good.rig);
}

TEST_F(RigEditTest, ADragIsOneStepAndEscTakesItBack) {
    const StudioState::RigAsset original = world.state().rig;
    const int steps = world.document.undoStack().count();
    for (int i = 1; i <= 30; ++i) {
        previewRig(world.document, lift(0, 0.03 + 0.001 * i));
        test::pass(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(world.document.undoStack().count(), steps);
    world.document.cancelPreview();
    EXPECT_EQ(world.state().rig, original);
    EXPECT_FALSE(world.state().field.stale);
    test::pass(std::chrono::milliseconds(100));
    EXPECT_EQ(world.state().rig, original) << "what comes late from the compiler is no longer wanted";

    for (int i = 1; i <= 30; ++i) previewRig(world.document, lift(0, 0.03 + 0.001 * i));
    world.document.commitPreview("Lift");
    EXPECT_EQ(world.document.undoStack().count(), steps + 1);
    ASSERT_TRUE(compiles());
    EXPECT_EQ(maxOf(world.state().rig.rig->parts(), 0), 0.03 + 0.001 * 30) << "the newest wins";
    world.document.undoStack().undo();
    EXPECT_EQ(world.state().rig, original);
}

TEST_F(RigEditTest, AnEditWhileTheFieldIsBuiltMakesItStale) {
    const auto field = world.state().field.field;
    editRig(world.document, "Lift", lift(0, 0.05));
    world.service.buildField({});
    editRig(world.document, "Lift more", lift(0, 0.06));
    ASSERT_TRUE(eventually([&] { return world.state().field.field != field && world.state().rig.compiled; }));
    EXPECT_TRUE(world.state().field.stale);
    EXPECT_EQ(*world.state().field.builtFor == *world.state().rig.parts, false);
}

void expectKept(const StudioState& was, const StudioState& is) {
    EXPECT_EQ(*is.rig.parts, *was.rig.parts);
    EXPECT_EQ(is.rig.parts->restMesh.positions, was.rig.parts->restMesh.positions);
    ASSERT_TRUE(is.field.field);
    EXPECT_EQ(is.field.field->field, was.field.field->field);
    EXPECT_EQ(is.field.stale, was.field.stale);
    EXPECT_EQ(is.strokes, was.strokes);
}

TEST_F(RigEditTest, SavedAndReopenedItIsTheEditedRig) {
    for (const double max : {0.05, 0.06}) {
        editRig(world.document, "Lift", lift(0, max));
        editRig(world.document, "Rename", rename(1, "middle"));
        world.service.saveAs(files / "edited"); // not compiled yet
        const StudioState was = world.state();
        ProjectWorld other;
        other.service.openProject(files / "edited.lumorph");
        ASSERT_TRUE(eventually([&] { return other.document.name() == "edited" && other.jobs.running().empty(); }));
        expectKept(was, other.state());
        EXPECT_TRUE(other.state().field.stale);
        EXPECT_FALSE(other.document.modified());
        bool said = false;
        for (const Notice& notice : other.notices.at("field")) said = said || notice.why.contains("before your edit");
        EXPECT_TRUE(said);
    }
    int rigs = 0;
    for (const auto& file : fs::directory_iterator(files / "edited files")) rigs += file.path().extension() == ".glb";
    EXPECT_LE(rigs, 2) << "rigs of earlier savings are left behind"; // and the target
    EXPECT_EQ(readRig(files / "lifter.glb").parts(), world.state().rig.origin->parts())
        << "the opened file is as it was";
}

TEST_F(RigEditTest, AFieldOfTheSameShapesIsItsFieldAfterReopening) {
    editRig(world.document, "Rename", rename(0, "left"));
    world.service.saveAs(files / "named");
    const StudioState was = world.state();
    ProjectWorld other;
    other.service.openProject(files / "named.lumorph");
    ASSERT_TRUE(eventually([&] { return other.document.name() == "named" && other.jobs.running().empty(); }));
    expectKept(was, other.state());
    EXPECT_FALSE(other.state().field.stale);
    EXPECT_TRUE(other.notices.at("field").empty());
}

TEST_F(RigEditTest, TheKeptSessionHoldsTheEditedRig) {
    editRig(world.document, "Lift", lift(0, 0.05));
    ASSERT_TRUE(compiles());
    const StudioState was = world.state();
    for (int start = 0; start < 2; ++start) { // and what goes on from there
        if (start == 0) world.service.keepSession();
        ProjectWorld later;
        bool ready = false;
        later.service.restoreSession([&] { ready = true; });
        ASSERT_TRUE(eventually([&] { return ready && later.jobs.running().empty(); }));
        expectKept(was, later.state());
        EXPECT_EQ(later.state().rig.path, was.rig.path);
        test::pass(std::chrono::milliseconds(300));
        EXPECT_TRUE(later.notices.at("rig").empty()) << later.notice("rig").why.toStdString();
        later.service.keepSession();
    }
}

} // namespace
} // namespace lumorph::studio

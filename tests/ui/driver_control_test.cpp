#include <gtest/gtest.h>

#include "app/studio/document/scene_edit.h"
#include "app/studio/shell/studio.h"
#include "core/mdf/builder.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/event_loop.h"

// Who moves the servos, as the top bar says and sets it.

namespace lumorph::studio {
namespace {

std::shared_ptr<const MatchTarget> namedTarget(const std::string& name) {
    auto target = std::make_shared<MatchTarget>();
    target->name = name;
    target->solid = makeTarget(test::boxMesh({-0.02F, 0.0F, -0.02F}, {0.02F, 0.03F, 0.02F}, 4));
    target->box = boundingBox(target->solid.mesh.positions);
    return target;
}

SceneItem sea() {
    SceneItem item;
    item.id = 7;
    item.name = "Sea";
    item.role = ItemRole::physical;
    item.kind = HeightItem{};
    return item;
}

class StillProgram final : public ShowProgram {
public:
    ShowContent frame(const ShowMoment& /*moment*/) override { return {}; }
};

class DriverControlTest : public testing::Test {
protected:
    void SetUp() override {
        BuildOptions options;
        options.resolution = 12;
        options.levels = 9;
        options.samples = 8;
        StudioState state;
        state.field.field = std::make_shared<const MatchField>(buildField(test::lifterRig(), options));
        state.rig.rig = std::make_shared<const Rig>(test::lifterRig());
        Scene scene = defaultScene();
        scene.items = {sea()};
        state.scene = std::make_shared<const Scene>(scene);
        state.matching.driver = Driver::sceneItem;
        studio_.document.reset(std::move(state), {});
        ASSERT_TRUE(test::eventually([&] { return studio_.loop.frame() != nullptr; }));
        QObject::connect(&control(), &DriverControl::tookOver, [this] { ++takeovers_; });
    }
    [[nodiscard]] DriverControl& control() { return studio_.driver; }
    [[nodiscard]] Driver driver() { return control().driver(); }
    void openTarget(const std::string& name) {
        studio_.document.change("Open " + QString::fromStdString(name),
                                [&](StudioState& state) { state.target.target = namedTarget(name); });
    }
    void edit(const std::function<void(SceneItem&)>& change) {
        editScene(studio_.document, "Edit", [&](Scene& scene) { change(scene.items.front()); });
    }
    [[nodiscard]] bool frameBy(Driver driver) {
        return test::eventually([&] { return studio_.loop.frame()->driver == driver; });
    }

    struct Application {
        Application() { test::needApplication(); }
    } application_;
    Studio studio_;
    int takeovers_ = 0;
};

TEST_F(DriverControlTest, ATargetThatIsOpenedTakesOverAndOneCallGivesBack) {
    ASSERT_EQ(driver(), Driver::sceneItem);
    EXPECT_EQ(control().nameOf(driver()), "Sea");
    EXPECT_FALSE(control().before()) << "what was opened with the project took nothing from anybody";
    openTarget("cow");
    EXPECT_EQ(driver(), Driver::target);
    EXPECT_EQ(control().nameOf(driver()), "cow");
    EXPECT_EQ(takeovers_, 1);
    EXPECT_EQ(studio_.document.undoStack().count(), 1) << "the takeover is part of the same step";
    ASSERT_TRUE(frameBy(Driver::target));
    EXPECT_TRUE(test::eventually([&] { return studio_.loop.frame()->matched; }));
    ASSERT_EQ(control().before(), Driver::sceneItem);
    control().back();
    EXPECT_EQ(driver(), Driver::sceneItem);
    ASSERT_TRUE(frameBy(Driver::sceneItem));
    EXPECT_FALSE(studio_.loop.frame()->matched);
    studio_.document.undoStack().undo();
    EXPECT_EQ(driver(), Driver::target);
    studio_.document.undoStack().undo();
    EXPECT_EQ(driver(), Driver::sceneItem);
    EXPECT_FALSE(studio_.document.state().target.target);
}

TEST_F(DriverControlTest, AnItemMadePhysicalOrShownTakesOverAndOneThatGoesLeavesTheTarget) {
    openTarget("cow");
    edit([](SceneItem& item) { item.position.y += 0.01F; });
    EXPECT_EQ(driver(), Driver::target) << "an edit of the item is not meant for the servos";
    edit([](SceneItem& item) { item.role = ItemRole::virtualOnly; });
    edit([](SceneItem& item) { item.role = ItemRole::split; });
    EXPECT_EQ(driver(), Driver::sceneItem);
    edit([](SceneItem& item) { item.visible = false; });
    EXPECT_EQ(driver(), Driver::target);
    edit([](SceneItem& item) { item.visible = true; });
    EXPECT_EQ(driver(), Driver::sceneItem);
}

TEST_F(DriverControlTest, SaysWhyNobodyMoves) {
    EXPECT_TRUE(control().whyStill().isEmpty());
    EXPECT_FALSE(control().whyNot(Driver::target).isEmpty());
    EXPECT_FALSE(control().whyNot(Driver::recording).isEmpty());
    EXPECT_FALSE(control().whyNot(Driver::program).isEmpty());
    edit([](SceneItem& item) { item.visible = false; });
    EXPECT_TRUE(control().whyStill().contains("'Sea' is hidden")) << control().whyStill().toStdString();
    control().choose(Driver::target);
    EXPECT_EQ(driver(), Driver::sceneItem) << "there is none to follow";
    edit([](SceneItem& item) { item.visible = true; });
    studio_.loop.stop();
    EXPECT_TRUE(control().whyStill().contains("STOP"));
    studio_.loop.resume();
    editScene(studio_.document, "Light alone", [](Scene& scene) { scene.showing = Showing::virtualOnly; });
    EXPECT_TRUE(control().whyStill().contains("light alone"));
}

TEST_F(DriverControlTest, TheHandTakesOverWhereTheServosStand) {
    openTarget("cow");
    ASSERT_TRUE(test::eventually(
        [&] { return studio_.loop.frame()->matched && studio_.loop.frame()->wantedStrokes.front() > 0.0; }));
    const std::vector<double> wanted = studio_.loop.frame()->wantedStrokes;
    control().choose(Driver::hand);
    EXPECT_EQ(studio_.document.state().strokes, wanted);
    HandControl hand(studio_.document, studio_.loop);
    hand.commit(0, 0.125);
    EXPECT_EQ(driver(), Driver::hand);
    control().back();
    EXPECT_EQ(driver(), Driver::target);
    control().back();
    EXPECT_EQ(driver(), Driver::hand);
    EXPECT_EQ(studio_.document.state().strokes.front(), 0.125) << "as it was left";
}

TEST_F(DriverControlTest, DanceAndProgramLetGoWhenSomebodyTakesTheServos) {
    studio_.loop.setProgram(std::make_shared<StillProgram>());
    EXPECT_EQ(driver(), Driver::program);
    control().choose(Driver::dance);
    EXPECT_EQ(driver(), Driver::dance);
    control().back();
    EXPECT_EQ(driver(), Driver::program);
    EXPECT_FALSE(studio_.loop.dancing());
    openTarget("cow");
    EXPECT_EQ(driver(), Driver::target);
    EXPECT_TRUE(studio_.loop.program()) << "its light goes on";
    control().back();
    EXPECT_EQ(driver(), Driver::program);
    studio_.document.change("Faster", [](StudioState& state) { state.matching.budget = Microseconds{2000}; });
    EXPECT_EQ(driver(), Driver::program) << "how a target would be matched takes nothing";
    studio_.loop.setProgram(nullptr);
    EXPECT_EQ(driver(), Driver::target);
}

TEST_F(DriverControlTest, AFieldThatComesLaterTakesNothing) {
    studio_.loop.setProgram(std::make_shared<StillProgram>());
    int takeovers = 0;
    QObject::connect(&studio_.loop, &StudioLoop::taken, [&] { ++takeovers; });
    const std::shared_ptr<const MatchField> field = studio_.document.state().field.field;
    studio_.document.complete([](StudioState& state) { state.field.field.reset(); });
    studio_.document.complete([&](StudioState& state) { state.field.field = field; });
    EXPECT_EQ(studio_.document.state().field.field, field);
    EXPECT_EQ(driver(), Driver::program);
    EXPECT_EQ(takeovers, 0);
    EXPECT_FALSE(studio_.document.modified());
    EXPECT_EQ(studio_.document.undoStack().count(), 0);
}

} // namespace
} // namespace lumorph::studio

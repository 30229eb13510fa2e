#include "app/workspaces/scene/item_handles.h"

#include <cmath>

#include <QTreeView>

#include "app/workspaces/scene/item_pick.h"
#include "app/workspaces/scene/outliner_item.h"
#include "app/workspaces/scene/outliner_model.h"
#include "app/workspaces/scene/view_pane.h"
#include "tests/support/show_frames.h"
#include "tests/ui/view_pictures.h"

// Things of a scene in the hand: which one a click takes, and where a dragged one goes.

namespace lumorph::test {
namespace {

using studio::OutlinerModel;
using studio::SceneChoice;
using studio::ViewPane;

SceneItem boxAt(int id, const glm::vec3& position, const glm::vec3& size) {
    SceneItem box;
    box.id = id;
    box.name = "Box " + std::to_string(id);
    box.anchor = Anchor::world;
    box.position = position;
    box.kind = ShapeItem{ShapeItem::Form::box, size};
    return box;
}

class ItemPick : public testing::Test {
protected:
    /// At the place of the picture where a point of the world is seen.
    [[nodiscard]] int at(const glm::dvec3& place) const {
        ShowFrame frame = frameOf(scene, std::vector<double>(6, 0.0));
        PoseInput input;
        input.worldFromDevice = scene.worldFromDevice;
        frame.posed = ScenePoser().pose(scene, *frame.assets, input);
        const CalibratedCamera camera = deviceView(frame, scene.eye, {900, 600});
        // Pixel centres are at whole numbers for cameras, at halves for windows.
        return studio::pickItem(frame, studio::rayThrough(camera, glm::vec2(pixelOf(camera, place).value() + 0.5)));
    }
    SceneInRoom scene = [] {
        SceneInRoom one = defaultSceneInRoom();
        one.items.clear();
        one.device.show = DeviceSkin::Show::material;
        one.eye = {0.0F, 0.5F, 0.5F};
        return one;
    }();
};

TEST_F(ItemPick, TakesWhatIsSeen) {
    scene.items = {boxAt(1, {0.0F, 0.04F, 0.0F}, glm::vec3(0.03F)),
                   boxAt(2, {0.0F, 0.1F, 0.06F}, glm::vec3(0.03F)),  // before the first, seen from the eye
                   boxAt(3, {0.07F, 0.0F, 0.0F}, glm::vec3(0.01F))}; // within the device
    EXPECT_EQ(at({0.0, 0.1, 0.06}), 2);
    EXPECT_EQ(at({0.0, 0.04, -0.014}), 2) << "the far rim of the first is behind the second";
    EXPECT_EQ(at({0.0, 0.026, 0.015}), 1);
    EXPECT_EQ(at({-0.08, 0.02, 0.05}), 0) << "the bare device";
    EXPECT_EQ(at({0.3, 0.0, 0.0}), 0) << "the table";
    EXPECT_EQ(at({0.07, 0.0, 0.0}), 0) << "the device is before it";
    scene.device.show = DeviceSkin::Show::content;
    EXPECT_EQ(at({0.07, 0.0, 0.0}), 3) << "a mere screen hides nothing";
}

TEST_F(ItemPick, KnowsTurnedAndStretchedThingsWithinGroups) {
    SceneItem group;
    group.id = 7;
    group.name = "Group";
    group.anchor = Anchor::world;
    group.position = {-0.05F, 0.05F, 0.0F};
    group.rotation = glm::angleAxis(0.5F * glm::pi<float>(), glm::vec3(0.0F, 1.0F, 0.0F)); // x becomes -z
    group.kind = GroupItem{};
    SceneItem rod = boxAt(8, {0.02F, 0.0F, 0.0F}, glm::vec3(0.01F));
    rod.parent = 7;
    rod.scale = {8.0F, 1.0F, 1.0F};
    scene.items = {group, rod};
    const glm::dvec3 middle(-0.05, 0.05, -0.02);
    for (const double along : {-0.039, 0.0, 0.039}) EXPECT_EQ(at(middle + glm::dvec3(0.0, 0.0, along)), 8) << along;
    EXPECT_EQ(at(middle + glm::dvec3(0.015, 0.0, 0.0)), 0);
    EXPECT_EQ(at(middle + glm::dvec3(0.0, 0.0, 0.055)), 0);
}

class SceneHandles : public testing::Test {
protected:
    SceneHandles() : window(folder.path(), "scene") {
        window.studio().loop.setScenePlaying(false);
        window.studio().loop.seekScene(1.5); // no wave hides the box then
        window.studio().document.change("Pause", [](studio::StudioState& state) { state.playback.playing = false; });
        window.command("add a box");
        pane = window.find<ViewPane>("scene.eye");
        EXPECT_TRUE(eventually([&] {
            const auto& newest = window.studio().show.newest();
            return newest.frame && newest.still && newest.frame->scene == window.state().scene;
        }));
    }

    [[nodiscard]] const Scene& scene() { return *window.state().scene; }
    [[nodiscard]] const Installation& room() { return *window.state().installation; }
    [[nodiscard]] const SceneItem& box() { return scene().items.back(); }
    [[nodiscard]] int steps() { return window.studio().document.undoStack().index(); }
    [[nodiscard]] glm::vec3 worldOf(const SceneItem& item) {
        return glm::vec3(studio::worldFromParent(scene(), item, 0.0, room().worldFromDevice) *
                         glm::vec4(item.position, 1.0F));
    }
    /// Where the eye's picture shows a point, in the pane.
    [[nodiscard]] QPointF seen(const glm::vec3& place) {
        const CalibratedCamera camera =
            deviceView(*window.studio().show.newest().frame, room().eye, {pane->width(), pane->height()});
        const glm::dvec2 pixel = pixelOf(camera, place).value() + 0.5;
        return {pixel.x, pixel.y};
    }
    /// A place on the arrow along a world axis, 45 of its 90 pixels out.
    [[nodiscard]] QPointF onArrow(const glm::vec3& axis) {
        const QLineF way(seen(worldOf(box())), seen(worldOf(box()) + 0.02F * axis));
        return way.pointAt(45.0 / way.length());
    }

    TemporaryFolder folder;
    StudioWindow window;
    ViewPane* pane = nullptr;
};

TEST_F(SceneHandles, AnArrowCarriesTheThingAndIsOneStepOfUndo) {
    for (const glm::vec3& axis : {glm::vec3(1.0F, 0.0F, 0.0F), glm::vec3(0.0F, 1.0F, 0.0F)}) {
        const glm::vec3 before = worldOf(box());
        const glm::vec3 eye = room().eye;
        const SceneItem whole = box();
        const int step = steps();
        dragMouse(pane, onArrow(axis), seen(before + 0.02F * axis) - seen(before));
        EXPECT_LT(glm::distance(worldOf(box()), before + 0.02F * axis), 0.001F) << axis.x;
        EXPECT_LT(glm::length(glm::cross(worldOf(box()) - before, axis)), 1e-5F) << "along the arrow alone";
        EXPECT_EQ(room().eye, eye) << "the hand is on the thing";
        EXPECT_EQ(steps(), step + 1);
        window.screenshot("scene-handles");
        window.studio().document.undoStack().undo();
        EXPECT_EQ(box(), whole);
        ASSERT_TRUE(eventually([&] { return window.studio().show.newest().frame->scene == window.state().scene; }));
    }
}

TEST_F(SceneHandles, EscapeTakesADragBack) {
    const SceneItem before = box();
    const int step = steps();
    dragMouse(pane, onArrow({1.0F, 0.0F, 0.0F}), {40.0, 5.0}, {}, false);
    EXPECT_NE(box(), before);
    QTest::keyClick(pane, Qt::Key_Escape);
    EXPECT_EQ(box(), before);
    QTest::mouseRelease(pane, Qt::LeftButton);
    EXPECT_EQ(box(), before);
    EXPECT_EQ(steps(), step);
}

TEST_F(SceneHandles, AClickChoosesTheThingUnderIt) {
    auto* tree = window.find<QTreeView>("scene.outliner");
    auto* model = qobject_cast<OutlinerModel*>(tree->model());
    const auto chosen = [&](const SceneChoice& choice) { return tree->currentIndex() == model->indexOf(choice); };
    const SceneChoice itself{SceneChoice::Kind::item, box().id};
    ASSERT_TRUE(chosen(itself)) << "what was added is chosen";
    const QPointF corner(12.0, pane->height() - 12.0); // far from the handles: table
    QTest::mouseClick(pane, Qt::LeftButton, {}, corner.toPoint());
    EXPECT_FALSE(chosen(itself));
    QTest::mouseClick(pane, Qt::LeftButton, {}, seen(worldOf(box())).toPoint());
    EXPECT_TRUE(chosen(itself));
}

} // namespace
} // namespace lumorph::test

#include <cmath>

#include "app/applications/labyrinth/board.h"
#include "app/studio/shell/program_inputs.h"
#include "app/workspaces/scene/view_pane.h"
#include "tests/ui/studio_window.h"

// The labyrinth in the real window: opened by its command, it plays by itself until a mouse or a key leans it.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using studio::ViewPane;

class LabyrinthWindow : public ::testing::Test {
protected:
    void SetUp() override {
        pane = window.find<ViewPane>("scene.eye");
        window.command("Demonstration labyrinth");
        ASSERT_TRUE(eventually([&] { return ball() != nullptr; }, 30s)) << "its scene shows";
        ASSERT_EQ(window.studio().loop.driver(), Driver::program) << "and is felt";
    }
    /// As it is shown now; null where no labyrinth shows.
    [[nodiscard]] const SceneItem* ball() {
        const auto& frame = window.studio().loop.frame();
        if (!frame || !frame->program || !frame->scene) return nullptr;
        const SceneItem* item = findItem(*frame->scene, labyrinth::kBallItem);
        return item && item->name == "Ball" ? item : nullptr;
    }
    [[nodiscard]] glm::vec3 place() { return ball()->position; }

    TemporaryFolder folder;
    StudioWindow window{folder.path(), "scene"};
    ViewPane* pane = nullptr;
};

TEST_F(LabyrinthWindow, PlaysByItselfAndAnswersTheMouse) {
    const glm::vec3 first = place();
    EXPECT_TRUE(eventually([&] { return glm::distance(place(), first) > 0.02F; })) << "by itself";
    // Over the right edge of the view: one move, and the ball rolls from the start to the right, and stays there.
    const QPoint right(pane->width() - 4, pane->height() / 2);
    QTest::mouseMove(pane, QPoint(pane->width() / 2, pane->height() / 2));
    QTest::mouseMove(pane, right);
    EXPECT_TRUE(eventually([&] {
        const glm::vec3 at = place();
        return at.x > 0.015F && std::abs(at.z - -0.06F) < 0.006F;
    })) << place().x
        << " " << place().z;
    EXPECT_TRUE(eventually([&] { return !pane->picture().isNull(); }, 60s));
    window.screenshot("labyrinth");
}

TEST_F(LabyrinthWindow, KeysLeanItAndDoNotTurnTheEye) {
    const glm::vec3 eye = window.state().installation->eye;
    pane->setFocus();
    QTest::keyPress(pane, Qt::Key_Down);
    EXPECT_TRUE(eventually([&] { return place().z > -0.04F && place().x < -0.08F; }, 10s)) << "down the left side";
    QTest::keyRelease(pane, Qt::Key_Down);
    EXPECT_EQ(window.state().installation->eye, eye);
    QTest::keyClick(pane, Qt::Key_N);
    EXPECT_TRUE(eventually(
        [&] { return findItem(*window.studio().loop.frame()->scene, labyrinth::kMaze)->name == "Mind the holes"; }));
}

TEST_F(LabyrinthWindow, EndsWhenSomethingElseIsOpened) {
    window.studio().project.openDemo("water");
    EXPECT_TRUE(eventually([&] { return window.studio().loop.program() == nullptr && ball() == nullptr; }, 30s));
    QTest::mouseMove(pane, QPoint(10, 10));
    QTest::keyClick(pane, Qt::Key_N);
    EXPECT_NE(window.studio().loop.driver(), Driver::program);
}

} // namespace
} // namespace lumorph::test

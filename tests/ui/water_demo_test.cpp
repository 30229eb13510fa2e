#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/applications/techniques/techniques.h"
#include "app/workspaces/scene/eye_orbit.h"
#include "app/workspaces/scene/view_pane.h"
#include "core/base/resources.h"
#include "tests/ui/stall_watch.h"
#include "tests/ui/view_pictures.h"

// What a visitor sees first, in the real window: water on the tablet, with shadows that go with the sun.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using studio::ViewPane;

/// The program as it starts for the first time.
struct FirstStart {
    FirstStart() {
        EXPECT_TRUE(eventually([&] {
            const SceneItem* sea = drivingItem(*window.state().scene);
            return sea != nullptr && sea->name == "Sea" && window.studio().jobs.running().empty();
        })) << "it shows the sea by itself";
    }

    TemporaryFolder folder;
    StudioWindow window{folder.path(), "scene"};
};

class WaterDemo : public ::testing::Test {
protected:
    WaterDemo() { pane = window.find<ViewPane>("scene.eye"); }
    [[nodiscard]] bool plays() { return window.studio().loop.scenePlaying(); }
    [[nodiscard]] const studio::DrawnShow& newest() { return window.studio().show.newest(); }
    /// By the key that the button names.
    void playOrPause(bool play) {
        QTest::keyClick(&window.window(), Qt::Key_P, Qt::AltModifier);
        ASSERT_TRUE(eventually([&] { return plays() == play; }));
        if (!play) {
            ASSERT_TRUE(stageSettles(window));
        }
    }
    [[nodiscard]] studio::EyePlace eyePlace() {
        const Installation& room = *window.state().installation;
        const glm::vec4 middle(window.state().rig.rig->reach().centre(), 1.0F);
        return studio::placeOf(room.eye, glm::vec3(room.worldFromDevice * middle));
    }
    [[nodiscard]] QImage picture() { return pane->picture().copy(); }
    /// The picture's colour at a point of the world, as the eye sees it; none outside the picture.
    [[nodiscard]] std::optional<QColor> seen(const QImage& in, const glm::dvec3& place) {
        const glm::ivec2 size(in.width(), in.height());
        const auto pixel = pixelOf(deviceView(*newest().frame, newest().frame->eye.value(), size), place);
        if (!pixel) return std::nullopt;
        const QPoint at(static_cast<int>(std::lround(pixel->x)), static_cast<int>(std::lround(pixel->y)));
        return in.rect().contains(at) ? std::optional(in.pixelColor(at)) : std::nullopt;
    }

    FirstStart program;
    StudioWindow& window = program.window;
    ViewPane* pane = nullptr;
};

TEST_F(WaterDemo, IsWaterThatMovesUntilItIsPaused) {
    ASSERT_TRUE(plays()) << "a visitor presses nothing";
    ASSERT_TRUE(eventually([&] { return !pane->picture().isNull(); }));
    const QImage first = picture();
    EXPECT_TRUE(eventually([&] { return differingShare(picture(), first) > 0.05; }));
    playOrPause(false);
    const QImage paused = picture();
    int blue = 0;
    int all = 0;
    for (double x = -0.09; x <= 0.0901; x += 0.02)
        for (double z = -0.06; z <= 0.0601; z += 0.02) {
            const auto color = seen(paused, {x, 0.038, z});
            ASSERT_TRUE(color);
            ++all;
            blue += color->blue() > color->red() + 20 ? 1 : 0;
        }
    EXPECT_GT(blue, all * 7 / 10) << "but buoy and crate, and glints";
    const QColor wood = paused.pixelColor(8, paused.height() - 8);
    EXPECT_GT(wood.red(), wood.blue() + 20);
    pass(700ms);
    EXPECT_EQ(picture(), paused);
    window.screenshot("water-demo");
    playOrPause(true);
    EXPECT_TRUE(eventually([&] { return differingShare(picture(), paused) > 0.05; }));
}

TEST_F(WaterDemo, PhysicalShowsTheBareDeviceLifting) {
    ASSERT_TRUE(eventually([&] { return !pane->picture().isNull(); }));
    window.click("scene.showing.physical.button");
    ASSERT_TRUE(eventually([&] { return newest().match && newest().match->scene->showing == Showing::physical; }));
    std::vector<QImage> pictures;
    std::vector<std::vector<double>> strokes;
    for (int moment = 0; moment < 2; ++moment) {
        if (moment > 0) playOrPause(true);
        const double from = window.studio().loop.frame()->sceneSeconds;
        ASSERT_TRUE(eventually([&] { return window.studio().loop.frame()->sceneSeconds > from + 1.5; }));
        playOrPause(false);
        pictures.push_back(picture());
        strokes.push_back(newest().match->estimatedStrokes);
        int grey = 0;
        int all = 0;
        for (double x = -0.08; x <= 0.0801; x += 0.02)
            for (double z = -0.05; z <= 0.0501; z += 0.02) {
                const auto color = seen(pictures.back(), {x, 0.03, z});
                ASSERT_TRUE(color);
                ++all;
                grey += std::abs(color->red() - color->blue()) < 40 ? 1 : 0;
            }
        EXPECT_GT(grey, all * 9 / 10) << "paper, and not the table's wood, which is what one saw through the device";
        window.screenshot(QString("water-physical-%1").arg(moment));
    }
    double moved = 0.0;
    for (std::size_t a = 0; a < strokes[0].size(); ++a)
        moved = std::max(moved, std::abs(strokes[1][a] - strokes[0][a]));
    EXPECT_GT(moved, 0.02) << "the servos go on";
    EXPECT_GT(differingShare(pictures[0], pictures[1]), 0.01) << "and it is seen";
}

TEST_F(WaterDemo, ShadowsOnTheTableGoWithTheSun) {
    playOrPause(false);
    std::vector<QImage> pictures;
    for (const double moment : {2.0, 12.0}) { // a quarter of the sun's way round
        window.studio().loop.seekScene(moment);
        ASSERT_TRUE(eventually([&] { return std::abs(window.studio().loop.frame()->sceneSeconds - moment) < 1e-6; }));
        ASSERT_TRUE(stageSettles(window));
        pictures.push_back(picture());
        EXPECT_NEAR(newest().match->sceneSeconds, moment, 1e-6);
    }
    int changed = 0;
    int shown = 0;
    for (double along = -1.0; along <= 1.0; along += 0.1)
        for (const glm::dvec3& place : {glm::dvec3(-0.125, 0.0, 0.08 * along), glm::dvec3(0.125, 0.0, 0.08 * along),
                                        glm::dvec3(0.1 * along, 0.0, 0.095)}) { // just beside the device
            const auto before = seen(pictures[0], place), after = seen(pictures[1], place);
            if (!before || !after) continue;
            ++shown;
            const double low = std::min(before->lightness(), after->lightness());
            const double high = std::max(before->lightness(), after->lightness());
            changed += low < 0.75 * high ? 1 : 0;
        }
    EXPECT_GT(shown, 20);
    EXPECT_GT(changed, 3);
}

// In the first hour a target was opened, the device went on following the sea, and the numbers were of the sea's pose.
TEST_F(WaterDemo, GivesTheServosToATargetThatIsOpenedAndTakesThemBackByOneClick) {
    const auto frame = [&] { return window.studio().loop.frame(); };
    ASSERT_TRUE(eventually([&] { return window.text("bar.driver") == "Servos: Sea"; }));
    ASSERT_TRUE(eventually([&] { return window.state().field.field != nullptr; }, 60s));
    ASSERT_TRUE(eventually([&] { return frame()->itemFit.has_value(); }));
    window.window().showWorkspace("field");
    EXPECT_EQ(window.findNow<QWidget>("match.driver"), nullptr);
    window.studio().project.openTarget(resourceFile("targets/bloom.glb"));
    ASSERT_TRUE(eventually([&] { return window.text("bar.driver") == "Servos: bloom"; }, 30s));
    ASSERT_TRUE(eventually([&] { return frame()->matched && frame()->driver == Driver::target; }));
    EXPECT_GE(frame()->iouWanted, frame()->iouVoting - 1e-9);
    window.screenshot("driver-target");
    EXPECT_EQ(window.text("bar.driver.back"), "Back to Sea");
    window.click("bar.driver.back");
    ASSERT_TRUE(eventually([&] { return frame()->driver == Driver::sceneItem; }));
    EXPECT_EQ(window.text("bar.driver"), "Servos: Sea");
    EXPECT_TRUE(eventually([&] { return window.text("match.driver.text").startsWith("'Sea' of the scene moves"); }));
    EXPECT_TRUE(eventually([&] { return window.text("match.iou") == QString(QChar(0x2013)); }));
    EXPECT_FALSE(window.find<QWidget>("match.iou")->isEnabled());
    window.screenshot("driver-sea");
    window.click("match.driver.remedy");
    EXPECT_EQ(window.text("bar.driver"), "Servos: bloom");
}

TEST_F(WaterDemo, ADragLeadsTheEyeAroundTheWaterAndUndoLeadsItBack) {
    ASSERT_TRUE(eventually([&] { return !pane->picture().isNull(); }));
    playOrPause(false); // what changes then is the eye's doing
    const glm::vec3 eye = window.state().installation->eye;
    const studio::EyePlace from = eyePlace();
    const QImage before = picture();
    const QPoint by(-pane->height() / 4, -pane->height() / 18);
    dragMouse(pane, pane->rect().center(), by);
    const double degrees = 180.0 / pane->height(); // a pixel
    EXPECT_NEAR(eyePlace().azimuth.inDegrees() - from.azimuth.inDegrees(), -degrees * by.x(), 0.1);
    EXPECT_NEAR(eyePlace().elevation.inDegrees() - from.elevation.inDegrees(), degrees * by.y(), 0.1);
    EXPECT_NEAR(eyePlace().distance, from.distance, 1e-4);
    EXPECT_TRUE(eventually([&] { return differingShare(picture(), before) > 0.2; }, 20s));
    ASSERT_TRUE(stageSettles(window));
    int blue = 0;
    for (const double x : {-0.008, 0.0, 0.008})
        for (const double z : {-0.008, 0.0, 0.008}) {
            const auto color = seen(picture(), {x, 0.038, z});
            blue += color && color->blue() > color->red() + 20 ? 1 : 0;
        }
    EXPECT_GT(blue, 4) << "the water stays on the device, glints aside";
    QTest::keyClick(&window.window(), Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(window.state().installation->eye, eye);
    EXPECT_TRUE(eventually([&] { return differingShare(picture(), before) < 0.02; }, 20s));
}

double longestStallOfDemos() {
    FirstStart program; // its caches are empty each time
    StudioWindow& window = program.window;
    StallWatch watch;
    window.studio().project.openDemo("water");
    pass(1s);
    window.studio().project.openDemo("techniques");
    EXPECT_TRUE(eventually([&] { return window.findNow<QWidget>("technique.3.button") != nullptr; }));
    for (const int key : {1, 4, 6}) {
        QTest::keyClick(&window.window(), static_cast<Qt::Key>(Qt::Key_0 + key));
        EXPECT_TRUE(window.state().scene->items == techniqueScene(key).items) << key;
        pass(500ms);
    }
    window.drop(resourceFile("targets/dunes.glb"), window.find<QWidget>("scene.outliner"));
    const auto& show = window.studio().show;
    EXPECT_TRUE(eventually([&] {
        const auto& assets = window.state().assets;
        return !assets->models.empty() && show.newest().match->assets == assets;
    })) << "read, and drawn";
    pass(500ms);
    return watch.takeLongest();
}

// Other programs on the machine only add to a stall, so the best of three counts.
TEST(WaterDemoStalls, DemosAndDroppedModelsNeverStallTheWindow) {
    double best = 1e9;
    for (int attempt = 0; attempt < 3 && best > 100.0; ++attempt) best = std::min(best, longestStallOfDemos());
    RecordProperty("longest_stall_ms", std::to_string(best));
    std::printf("longest stall of the window: %.0f ms\n", best);
    EXPECT_LE(best, 100.0);
}

} // namespace
} // namespace lumorph::test

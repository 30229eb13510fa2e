#include <gtest/gtest.h>

#include <QComboBox>
#include <QDockWidget>
#include <QPushButton>

#include "app/workspaces/rig/light_map_view.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using test::eventually;

QColor colorAt(LightMapView& map, const QPointF& point) {
    const QPixmap picture = map.grab();
    const QPointF pixel = point * picture.devicePixelRatio();
    return picture.toImage().pixelColor(pixel.toPoint());
}

TEST(LightDock, MapFollowsTheRoomAndTheBestPlaceIsHungByOneStep) {
    TemporaryFolder folder;
    test::StudioWindow window(folder / "session", "rig");
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig != nullptr; }));
    window.window().findChild<QDockWidget*>("dock.rig.light")->raise();
    auto* map = window.find<LightMapView>("rig.light.map");
    ASSERT_TRUE(map);
    const QPointF middle(0.5 * map->width(), 0.4 * map->height());
    ASSERT_TRUE(eventually([&] { return map->at(middle) != nullptr; }, std::chrono::seconds(30)));
    EXPECT_TRUE(window.text("rig.light.text").startsWith("Over all its states "))
        << window.text("rig.light.text").toStdString();
    const double often = map->at(middle)->lit;
    EXPECT_GT(often, 0.5) << "the middle of the tablet, under a projector above it";
    EXPECT_GT(colorAt(*map, middle).green(), colorAt(*map, middle).red());
    EXPECT_FALSE(window.findNow<QPushButton>("rig.light.hang"));

    // A projector that is off lights nothing, and the map says so.
    auto dark = std::make_shared<Installation>(*window.state().installation);
    for (InstalledProjector& projector : dark->projectors) projector.enabled = false;
    const auto before = window.state().installation;
    window.studio().document.setInstallation(dark);
    ASSERT_TRUE(eventually([&] { return window.text("rig.light.text") == "No light reaches the device."; },
                           std::chrono::seconds(30)));
    EXPECT_LT(colorAt(*map, middle).green(), colorAt(*map, middle).red());
    window.studio().document.setInstallation(before);
    ASSERT_TRUE(eventually([&] { return map->at(middle) && map->at(middle)->lit == often; }, std::chrono::seconds(30)));

    window.enter("rig.light.throwLeast", "1.3");
    window.enter("rig.light.throwMost", "2.1");
    window.enter("rig.light.shift", "0");
    window.enter("rig.light.low.y", "100cm");
    window.enter("rig.light.high.y", "150cm");
    window.click("rig.light.search");
    ASSERT_TRUE(
        eventually([&] { return window.findNow<QPushButton>("rig.light.hang") != nullptr; }, std::chrono::seconds(60)));
    EXPECT_TRUE(window.text("rig.light.best").startsWith("Best place: "))
        << window.text("rig.light.best").toStdString();
    window.screenshot("light_dock");
    const int steps = window.studio().document.undoStack().index();
    window.click("rig.light.hang");
    ASSERT_EQ(window.studio().document.undoStack().index(), steps + 1);
    const InstalledProjector& hung = window.state().installation->projectors.front();
    EXPECT_GE(positionOf(hung.camera).y, 1.0 - 1e-6);
    EXPECT_LE(positionOf(hung.camera).y, 1.5 + 1e-6);
    EXPECT_GE(hung.camera.focal.x / hung.camera.size.x, 1.3 - 1e-6);
    EXPECT_LE(hung.camera.focal.x / hung.camera.size.x, 2.1 + 1e-6);
    EXPECT_EQ(hung.pose.way, Origin::Way::entered);
    window.studio().document.undoStack().undo();
    EXPECT_TRUE(isSameRoom(*window.state().installation, *before));

    // What was measured is not overwritten by a plan.
    auto measured = std::make_shared<Installation>(*before);
    measured->projectors.front().pose = {Origin::Way::measured, "structured light", "2026-11-24T17:05:00Z"};
    measured->projectors.front().camera.focal *= 1.001;
    window.studio().document.setInstallation(measured);
    ASSERT_TRUE(eventually(
        [&] { return !window.find<QPushButton>("rig.light.hang")->isEnabled() && map->at(middle) != nullptr; },
        std::chrono::seconds(30)));
}

} // namespace
} // namespace lumorph::studio

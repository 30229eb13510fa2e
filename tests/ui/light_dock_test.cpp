#include <cmath>

#include <gtest/gtest.h>

#include <QComboBox>
#include <QDockWidget>
#include <QPushButton>

#include "app/studio/viewport/viewport_widget.h"
#include "app/studio/widgets/value_field.h"
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
    // The map gets another size whenever the text above has more lines.
    const auto middle = [map] { return QPointF(0.5 * map->width(), 0.4 * map->height()); };
    ASSERT_TRUE(eventually([&] { return map->at(middle()) != nullptr; }, std::chrono::seconds(30)));
    EXPECT_TRUE(window.text("rig.light.text").startsWith("Over all its states "))
        << window.text("rig.light.text").toStdString();
    const LightAt first = *map->at(middle());
    const double often = first.lit;
    const auto isAsBefore = [&] {
        for (int y = 0; y < map->height(); y += 4)
            for (int x = 0; x < map->width(); x += 4)
                if (const LightAt* at = map->at(QPointF(x, y)); at != nullptr && at->place == first.place)
                    return at->lit == often;
        return false;
    };
    EXPECT_GT(often, 0.5) << "the middle of the tablet, under a projector above it";
    EXPECT_GT(colorAt(*map, middle()).green(), colorAt(*map, middle()).red());
    EXPECT_FALSE(window.findNow<QPushButton>("rig.light.hang"));

    // The device in the view takes the same colours: hardly any grey is left on its upper side.
    auto* view = window.find<ViewportWidget>("rig.viewport");
    ASSERT_TRUE(view);
    const auto greenShare = [&] {
        const QImage picture = view->grab().toImage();
        int green = 0;
        for (int y = 0; y < picture.height(); ++y)
            for (int x = 0; x < picture.width(); ++x) {
                const QColor pixel = picture.pixelColor(x, y);
                green += pixel.green() > pixel.red() + 40 && pixel.green() > pixel.blue() + 40 ? 1 : 0;
            }
        return static_cast<double>(green) / (picture.width() * picture.height());
    };
    EXPECT_LT(greenShare(), 0.01);
    window.click("rig.light.onDevice");
    EXPECT_TRUE(eventually([&] { return greenShare() > 0.03; }, std::chrono::seconds(30)));
    window.screenshot("light_on_device");
    window.click("rig.light.onDevice");
    EXPECT_TRUE(eventually([&] { return greenShare() < 0.01; }, std::chrono::seconds(30)));

    // A projector that is off lights nothing, and the map says so.
    auto dark = std::make_shared<Installation>(*window.state().installation);
    for (InstalledProjector& projector : dark->projectors) projector.enabled = false;
    const auto before = window.state().installation;
    window.studio().document.setInstallation(dark);
    ASSERT_TRUE(eventually([&] { return window.text("rig.light.text") == "No light reaches the device."; },
                           std::chrono::seconds(30)));
    EXPECT_LT(colorAt(*map, middle()).green(), colorAt(*map, middle()).red());
    window.studio().document.setInstallation(before);
    ASSERT_TRUE(eventually(isAsBefore, std::chrono::seconds(30)));

    // How sharp light is follows from the aperture or from measured blur alone. A focus is one step of undo.
    auto* shown = window.find<QComboBox>("rig.light.shown");
    shown->setCurrentIndex(3);
    EXPECT_TRUE(window.text("rig.light.focus.note").startsWith("For all states alike it is best focused at "))
        << window.text("rig.light.focus.note").toStdString();
    window.enter("rig.light.blur", "1: 2, 2: 2");
    EXPECT_EQ(window.state().installation, before) << "too little to tell a lens";
    window.enter("rig.light.blur", "1: 2, 1.5: 1, 3: 2");
    const LensFocus& lens = window.state().installation->projectors.front().focus;
    EXPECT_NEAR(lens.aperture, 0.004, 1e-9);
    EXPECT_NEAR(lens.focusDistance, 2.0, 1e-9);
    ASSERT_TRUE(eventually([&] { return window.text("rig.light.focus.note").contains("no wider than "); },
                           std::chrono::seconds(30)));
    const QString blurred = window.text("rig.light.focus.note");
    window.screenshot("light_blur");
    window.click("rig.light.focus.best");
    ASSERT_TRUE(eventually(
        [&] {
            const QString text = window.text("rig.light.focus.note");
            return text != blurred && text.contains("no wider than ") &&
                   !window.findNow<QPushButton>("rig.light.focus.best");
        },
        std::chrono::seconds(30)));
    shown->setCurrentIndex(0);
    window.studio().document.setInstallation(before);
    ASSERT_TRUE(eventually(isAsBefore, std::chrono::seconds(30)));

    // What a camera sees is shown beside.
    auto* whose = window.find<QComboBox>("rig.light.whose");
    ASSERT_TRUE(whose);
    ASSERT_EQ(whose->count(), 1);
    auto watched = std::make_shared<Installation>(*before);
    watched->cameras.push_back({});
    watched->cameras.back().name = "Ceiling";
    watched->cameras.back().camera = cameraLookingAt({0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}, {1280, 960}, 2560.0);
    window.studio().document.setInstallation(watched);
    ASSERT_TRUE(eventually([&] { return whose->count() == 2; }, std::chrono::seconds(30)));
    whose->setCurrentIndex(1);
    EXPECT_TRUE(window.text("rig.light.text").startsWith("Ceiling sees "));
    EXPECT_NEAR(map->at(middle())->pixelsPerMillimetre,
                2560.0 / 1000.0 * std::cos(map->at(middle())->incidence.inRadians()), 0.13)
        << "focal length over distance, and shortened by the slant of the worst state";
    window.studio().document.setInstallation(before);
    ASSERT_TRUE(eventually([&] { return whose->count() == 1; }, std::chrono::seconds(30)));
    EXPECT_TRUE(eventually(isAsBefore));

    // A known projector brings its numbers; its shift goes as far as its lens allows.
    auto* model = window.find<QComboBox>("rig.light.model");
    const auto choose = [&](const char* name) {
        model->setCurrentIndex(model->findText(name));
        emit model->activated(model->currentIndex());
    };
    ASSERT_GE(model->findText("Optoma GT1080HDR"), 1);
    choose("Optoma GT1080HDR");
    EXPECT_DOUBLE_EQ(window.find<ValueField>("rig.light.throwMost")->value(), 0.496);
    EXPECT_DOUBLE_EQ(window.find<ValueField>("rig.light.shift")->value(), 0.66);
    choose("Epson EH-TW7100");
    EXPECT_DOUBLE_EQ(window.find<ValueField>("rig.light.shift")->value(), 0.6);
    EXPECT_TRUE(window.text("rig.light.model.note").contains("-60"));
    window.enter("rig.light.throwLeast", "1.3");
    EXPECT_EQ(model->currentIndex(), 0) << "other numbers are of another projector";
    window.enter("rig.light.throwMost", "2.1");
    window.enter("rig.light.shift", "0");
    window.enter("rig.light.low.y", "100cm");
    window.enter("rig.light.high.y", "150cm");
    window.click("rig.light.search");
    ASSERT_TRUE(eventually([&] { return window.findNow<QPushButton>("rig.light.hang") != nullptr; },
                           std::chrono::seconds(150)));
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
        [&] { return !window.find<QPushButton>("rig.light.hang")->isEnabled() && map->at(middle()) != nullptr; },
        std::chrono::seconds(30)));
}

} // namespace
} // namespace lumorph::studio

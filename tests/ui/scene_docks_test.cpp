#include <cstdio>

#include <QAbstractButton>
#include <QApplication>
#include <QColorDialog>
#include <QDockWidget>
#include <QFileDialog>
#include <QListWidget>
#include <QMimeData>
#include <QPushButton>
#include <QScrollArea>
#include <QSlider>
#include <QTreeView>

#include "app/applications/techniques/techniques.h"
#include "app/studio/document/scene_edit.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/scene/direction_dial.h"
#include "app/workspaces/scene/material_picture.h"
#include "app/workspaces/scene/outliner_item.h"
#include "app/workspaces/scene/outliner_model.h"
#include "app/workspaces/scene/scene_words.h"
#include "core/base/resources.h"
#include "tests/ui/stall_watch.h"
#include "tests/ui/studio_window.h"

// The Scene workspace as its user has it: the real window, driven by mouse and keys.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using studio::OutlinerModel;
using studio::SceneChoice;

class SceneDocks : public ::testing::Test {
protected:
    SceneDocks() : window(folder_ / "session", "scene") {
        tree = window.find<QTreeView>("scene.outliner");
        model = qobject_cast<OutlinerModel*>(tree->model());
    }

    [[nodiscard]] const Scene& scene() { return *window.state().scene; }
    [[nodiscard]] const Installation& room() { return *window.state().installation; }
    [[nodiscard]] int steps() { return window.studio().document.undoStack().index(); }
    [[nodiscard]] const SceneItem* item(const std::string& name) {
        for (const SceneItem& one : scene().items)
            if (one.name == name) return &one;
        return nullptr;
    }
    [[nodiscard]] QRect rowOf(const SceneChoice& choice) {
        const QModelIndex index = model->indexOf(choice);
        tree->scrollTo(index);
        return tree->visualRect(index);
    }
    [[nodiscard]] QRect rowOf(const std::string& name) {
        const SceneItem* found = item(name);
        EXPECT_NE(found, nullptr) << name;
        return found ? rowOf({SceneChoice::Kind::item, found->id}) : QRect();
    }
    void click(const QRect& row) { QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, row.center()); }
    void choose(SceneChoice::Kind kind) { click(rowOf({kind, 0})); }
    void addBox() {
        window.command("add a box");
        ASSERT_NE(item("Box"), nullptr);
    }
    void undo() { QTest::keyClick(&window.window(), Qt::Key_Z, Qt::ControlModifier); }

    TemporaryFolder folder_;
    StudioWindow window;
    QTreeView* tree = nullptr;
    OutlinerModel* model = nullptr;
};

TEST_F(SceneDocks, ABoxIsAddedMovedByTypingAndTakenBack) {
    const Scene before = scene();
    addBox();
    EXPECT_EQ(steps(), 1);
    EXPECT_EQ(window.find<QLineEdit>("inspector.name")->text(), "Box");
    window.enter("item.position.x", "2 cm");
    EXPECT_NEAR(item("Box")->position.x, 0.02F, 1e-6F);
    window.enter("item.position.z", "-15 mm");
    EXPECT_NEAR(item("Box")->position.z, -0.015F, 1e-6F);
    window.enter("item.rotation.heading", "30");
    EXPECT_NEAR(glm::angle(item("Box")->rotation), 0.5236F, 1e-3F);
    window.enter("item.size.x", "5");
    EXPECT_NEAR(std::get<ShapeItem>(item("Box")->kind).size.x, 0.05F, 1e-6F);
    EXPECT_EQ(steps(), 5);
    window.screenshot("scene-box");
    window.enter("item.position.y", "nowhere");
    EXPECT_EQ(steps(), 5) << "what is no number changes nothing";
    for (int i = 0; i < 5; ++i) undo();
    EXPECT_TRUE(scene() == before);
    EXPECT_EQ(window.findNow<QLineEdit>("item.position.x"), nullptr) << "the inspector lets go of what is gone";
}

TEST_F(SceneDocks, TheEyeHidesAndDeleteRemoves) {
    addBox();
    const QRect row = rowOf("Box");
    QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, studio::OutlinerItem::eyeBox(row).center());
    EXPECT_FALSE(item("Box")->visible);
    auto* visible = window.find<QAbstractButton>("item.visible");
    EXPECT_FALSE(visible->isChecked());
    QTest::mouseClick(visible, Qt::LeftButton, {}, QPoint(8, visible->height() / 2));
    EXPECT_TRUE(item("Box")->visible);
    tree->setFocus();
    QTest::keyClick(tree, Qt::Key_Delete);
    EXPECT_EQ(item("Box"), nullptr);
    undo();
    EXPECT_NE(item("Box"), nullptr);
}

TEST_F(SceneDocks, ItIsRenamedInPlaceAndGrouped) {
    addBox();
    tree->setFocus();
    QTest::keyClick(tree, Qt::Key_F2);
    auto* editor = tree->viewport()->findChild<QLineEdit*>();
    ASSERT_NE(editor, nullptr);
    QTest::keyClicks(editor, "Ice");
    QTest::keyClick(editor, Qt::Key_Return);
    ASSERT_TRUE(eventually([&] { return item("Ice") != nullptr; }));
    QTest::mouseClick(tree->viewport(), Qt::LeftButton, {}, rowOf({SceneChoice::Kind::device, 0}).center());
    window.command("add a group");
    ASSERT_NE(item("Group"), nullptr);
    const QModelIndex group = model->indexOf({SceneChoice::Kind::item, item("Group")->id});
    const std::unique_ptr<QMimeData> ice(model->mimeData({model->indexOf({SceneChoice::Kind::item, item("Ice")->id})}));
    model->dropMimeData(ice.get(), Qt::MoveAction, -1, 0, group);
    EXPECT_EQ(item("Ice")->parent, item("Group")->id);
    EXPECT_TRUE(rowOf("Ice").isValid()) << "groups are unfolded";
    window.screenshot("scene-group");
    undo();
    EXPECT_EQ(item("Ice")->parent, 0);
}

TEST_F(SceneDocks, TheServosTakeItsShapeOnRequest) {
    addBox();
    window.click("item.role.physical");
    ASSERT_NE(drivingItem(scene()), nullptr);
    EXPECT_EQ(drivingItem(scene())->name, "Box");
    EXPECT_EQ(window.text("item.role.sentence"), studio::roleSentence(ItemRole::physical));
    EXPECT_EQ(model->indexOf({SceneChoice::Kind::item, item("Box")->id}).data(OutlinerModel::badgeRole).toString(),
              "Physical");
    window.click("item.role.split");
    EXPECT_EQ(drivingItem(scene())->role, ItemRole::split);
    undo();
    undo();
    EXPECT_EQ(drivingItem(scene()), nullptr);
}

TEST_F(SceneDocks, TheSwitchSaysWhichLayerWorks) {
    window.click("scene.showing.light.button");
    EXPECT_EQ(scene().showing, Showing::virtualOnly);
    window.click("scene.showing.physical.button");
    EXPECT_EQ(scene().showing, Showing::physical);
    EXPECT_TRUE(window.find<QAbstractButton>("scene.showing.physical.button")->isChecked());
    undo();
    EXPECT_EQ(scene().showing, Showing::virtualOnly);
    EXPECT_TRUE(window.find<QAbstractButton>("scene.showing.light.button")->isChecked());
    window.click("scene.showing.both.button");
    EXPECT_EQ(scene().showing, Showing::both);
}

TEST_F(SceneDocks, AColourIsSeenWhileItIsChosenAndOneStep) {
    choose(SceneChoice::Kind::device);
    const glm::vec3 before = scene().device.material.color;
    const auto open = [&] {
        window.click("device.material.color");
        return window.find<QColorDialog>("dialog.color");
    };
    QColorDialog* dialog = open();
    dialog->setCurrentColor(QColor(255, 0, 0));
    EXPECT_EQ(scene().device.material.color, glm::vec3(1.0F, 0.0F, 0.0F)) << "at once";
    EXPECT_EQ(steps(), 0);
    dialog->reject();
    EXPECT_EQ(scene().device.material.color, before);
    EXPECT_EQ(steps(), 0);
    dialog = open();
    dialog->setCurrentColor(QColor(0, 255, 0));
    dialog->setCurrentColor(QColor(0, 0, 255));
    window.screenshot("scene-colour");
    dialog->accept();
    EXPECT_EQ(scene().device.material.color, glm::vec3(0.0F, 0.0F, 1.0F));
    EXPECT_EQ(steps(), 1);
}

TEST_F(SceneDocks, AMaterialOfTheLibraryIsOneClick) {
    addBox();
    window.window().findChild<QDockWidget*>("dock.scene.library")->raise();
    auto* shelf = window.find<QListWidget>("library.shelf");
    ASSERT_GT(shelf->count(), 2);
    EXPECT_TRUE(eventually([&] { return !shelf->item(shelf->count() - 1)->icon().isNull(); }));
    window.screenshot("scene-library");
    const auto press = [&](int row) {
        QTest::mouseClick(shelf->viewport(), Qt::LeftButton, {}, shelf->visualItemRect(shelf->item(row)).center());
    };
    press(1);
    EXPECT_EQ(item("Box")->material.name, shelf->item(1)->text().toStdString());
    undo();
    EXPECT_NE(item("Box")->material.name, shelf->item(1)->text().toStdString());
    window.window().findChild<QDockWidget*>("dock.scene.outliner")->raise();
    pass(50ms);
    QMimeData dragged;
    dragged.setData(studio::kMaterialMime, "1");
    model->dropMimeData(&dragged, Qt::CopyAction, -1, 0, model->indexOf({SceneChoice::Kind::table, 0}));
    EXPECT_EQ(scene().table.material.name, shelf->item(1)->text().toStdString());
}

TEST_F(SceneDocks, TheLightIsMovedByDialAndHour) {
    window.command("add a sun");
    auto* dial = window.find<studio::DirectionDial>("item.light.dial");
    const int before = steps();
    const QPoint start = dial->handle().toPoint();
    QTest::mousePress(dial, Qt::LeftButton, {}, start);
    QTest::mouseMove(dial, dial->rect().center() + QPoint(0, 20));
    EXPECT_EQ(steps(), before);
    const float distance = glm::length(scene().items.back().position);
    QTest::mouseRelease(dial, Qt::LeftButton, {}, dial->rect().center() + QPoint(0, 20));
    EXPECT_EQ(steps(), before + 1);
    const glm::vec3 sun = scene().items.back().position;
    EXPECT_NEAR(glm::length(sun), distance, 1e-3F);
    EXPECT_GT(sun.z, 0.1F) << "the front is below";
    EXPECT_GT(sun.y, 0.3F);
    auto* hour = window.find<QSlider>("item.light.hour");
    hour->setFocus();
    QTest::keyClick(hour, Qt::Key_Home);
    EXPECT_GT(scene().items.back().position.x, 0.8F * distance) << "in the morning it stands on the right";
    EXPECT_TRUE(window.text("item.light.time").startsWith("6:"));
    window.screenshot("scene-light");
    undo();
    EXPECT_NEAR(glm::length(scene().items.back().position - sun), 0.0F, 1e-4F);
}

TEST_F(SceneDocks, WavesAndHolesAreAddedAndRemoved) {
    window.command("add water");
    const auto waves = [&] { return std::get<HeightItem>(item("Water")->kind).waves.size(); };
    const std::size_t before = waves();
    window.click("item.wave.add");
    ASSERT_EQ(waves(), before + 1);
    window.enter(QString("item.wave.%1.amplitude").arg(before), "7 mm");
    EXPECT_NEAR(std::get<HeightItem>(item("Water")->kind).waves.back().amplitude, 0.007, 1e-9);
    window.screenshot("scene-water");
    window.click("item.wave.0.remove");
    EXPECT_EQ(waves(), before);
    EXPECT_NEAR(std::get<HeightItem>(item("Water")->kind).waves.back().amplitude, 0.007, 1e-9);
}

TEST_F(SceneDocks, WhatIsDroppedIsLightOnTheDeviceUntilItIsMadeTheTarget) {
    window.drop(resourceFile("targets/dunes.glb"), tree);
    ASSERT_NE(item("dunes"), nullptr);
    EXPECT_EQ(item("dunes")->role, ItemRole::virtualOnly);
    EXPECT_EQ(item("dunes")->anchor, Anchor::device);
    EXPECT_TRUE(eventually([&] {
        const auto& assets = window.state().assets;
        return assets && assets->models.contains(std::get<MeshItem>(item("dunes")->kind).model);
    }));
    window.screenshot("scene-dropped");
    window.click("notice.action.0");
    EXPECT_EQ(item("dunes")->role, ItemRole::physical);

    Image picture({16, 16}, {10, 200, 30, 255});
    writePng(picture, folder_ / "picture.png");
    window.drop(folder_ / "picture.png", tree);
    EXPECT_EQ(scene().device.material.colorTexture.image, (folder_ / "picture.png").string());
    EXPECT_TRUE(eventually([&] {
        const auto& assets = window.state().assets;
        return assets && assets->images.contains((folder_ / "picture.png").string());
    }));
    window.screenshot("scene-picture");
}

TEST_F(SceneDocks, EverythingAlwaysThereHasItsPage) {
    using Kind = SceneChoice::Kind;
    struct Page {
        Kind kind;
        const char* field;
        const char* picture;
        bool ofTheRoom; ///< of the installation, not of the scene
    };
    for (const Page& page : {Page{Kind::device, "device.material.roughness", "scene-device", false},
                             Page{Kind::table, "table.size.x", "scene-table", true},
                             Page{Kind::projector, "projector.position.y", "scene-projector", true},
                             Page{Kind::viewer, "viewer.eye.z", "scene-viewer", true},
                             Page{Kind::room, "room.exposure", "scene-room", false}}) {
        choose(page.kind);
        const int before = steps();
        const Scene was = scene();
        const Installation wasThere = room();
        auto* field = window.find<QLineEdit>(page.field);
        ASSERT_NE(field, nullptr);
        field->setFocus();
        QTest::keyClick(field, Qt::Key_Up);
        EXPECT_EQ(steps(), before + 1) << page.field;
        EXPECT_EQ(scene() == was, page.ofTheRoom) << page.field;
        EXPECT_EQ(room() == wasThere, !page.ofTheRoom) << page.field;
        window.screenshot(page.picture);
    }
}

TEST_F(SceneDocks, TheNumberKeysShowTheTechniquesOfTheirDemoAlone) {
    const Scene before = scene();
    QTest::keyClick(&window.window(), Qt::Key_3);
    EXPECT_TRUE(scene() == before) << "elsewhere a number changes nothing";
    EXPECT_EQ(window.findNow<QWidget>("technique.3.button"), nullptr);
    window.studio().project.openDemo("techniques");
    ASSERT_NE(window.find<QAbstractButton>("technique.3.button"), nullptr);
    ASSERT_TRUE(eventually([&] { return window.studio().jobs.running().empty(); }));
    const glm::vec3 grey(0.7F);
    studio::editInstallation(window.studio().document, "Measured", [&](Installation& measured) {
        measured.deviceColor = grey;
        measured.tableColor = grey;
        measured.tableSize = {1.0F, 0.8F};
        measured.eye = {0.1F, 0.5F, 0.4F};
        measured.projectors.front().peak = 2.0;
        measured.predictionSeconds = 0.05;
    });
    const Installation measured = room();
    ASSERT_EQ(measured.deviceColor, grey);
    for (const Technique& technique : techniques()) {
        QTest::keyClick(&window.window(), static_cast<Qt::Key>(Qt::Key_0 + technique.key));
        EXPECT_TRUE(scene().items == techniqueScene(technique.key).items) << technique.name.english;
        EXPECT_TRUE(room() == measured) << "the same device on the same table, in the same light";
        EXPECT_TRUE(window.find<QAbstractButton>(QString("technique.%1.button").arg(technique.key))->isChecked());
        EXPECT_TRUE(window.text("technique.sentence").contains(QString::fromStdString(technique.name.english)));
        QTest::keyClick(&window.window(), Qt::Key_O);
        EXPECT_TRUE(scene().items == techniqueScene(technique.key, false).items) << technique.name.english;
        EXPECT_TRUE(scene().device == techniqueScene(technique.key, false).device) << technique.name.english;
        EXPECT_EQ(window.find<QAbstractButton>("technique.off.button")->isChecked(), technique.key != 0);
        window.click("technique.off.button");
        EXPECT_TRUE(scene().items == techniqueScene(technique.key).items) << technique.name.english;
        window.screenshot(QString("technique-%1").arg(technique.key), 1s);
    }
    for (int k = 0; k < 3; ++k) undo(); // with, without, the number
    EXPECT_TRUE(scene().items == techniqueScene(5).items);
}

TEST_F(SceneDocks, TheWaterDemoIsWhatAVisitorSeesFirst) {
    window.studio().project.openDemo();
    ASSERT_TRUE(eventually([&] { return drivingItem(scene()) != nullptr && window.studio().jobs.running().empty(); }));
    EXPECT_TRUE(window.studio().notices.at("scene").empty());
    EXPECT_TRUE(window.state().assets->problems.empty());
    EXPECT_FALSE(window.studio().document.modified());
    window.screenshot("scene-water-demo", 3s);
    const auto strokes = window.studio().loop.frame()->wantedStrokes;
    EXPECT_TRUE(eventually([&] { return window.studio().loop.frame()->wantedStrokes != strokes; }))
        << "its long waves move the servos";
}

TEST_F(SceneDocks, WarnsWhereAProjectorHasTooLittleLight) {
    choose(SceneChoice::Kind::projector);
    ASSERT_NE(window.find<QWidget>("projector.section.light"), nullptr);
    auto* warning = window.window().findChild<QLabel*>("projector.warning"); // hidden while there is none
    ASSERT_NE(warning, nullptr);
    pass(700ms); // the rig stands as it is looked at
    EXPECT_FALSE(warning->text().contains("cannot become white")) << warning->text().toStdString();
    window.click("projector.section.light");
    window.enter("projector.peak", "0.2");
    EXPECT_TRUE(eventually([&] { return warning->isVisible() && warning->text().contains("cannot become white"); }));
    window.screenshot("scene-dim-projector");
    undo();
    EXPECT_TRUE(eventually([&] { return !warning->text().contains("cannot become white"); }));
    studio::editInstallation(window.studio().document, "Measure", [](Installation& installation) {
        installation.deviceColor = glm::vec3(0.5F); // a fifth of the light
    });
    EXPECT_TRUE(eventually([&] { return warning->text().contains("cannot become white"); }));
}

/// Visible texts that do not fit their widgets.
QStringList cutTexts(QWidget& window) {
    QStringList cut;
    for (auto* field : window.findChildren<studio::ValueField*>())
        if (field->isVisible() && field->fontMetrics().horizontalAdvance(field->text()) > field->width() - 14)
            cut << field->objectName() + ": " + field->text();
    for (auto* button : window.findChildren<QPushButton*>())
        if (button->isVisible() && button->icon().isNull() && !button->text().isEmpty() &&
            button->fontMetrics().horizontalAdvance(button->text()) > button->width() - 4)
            cut << button->objectName() + ": " + button->text();
    for (auto* label : window.findChildren<QLabel*>())
        if (label->isVisible() && !label->wordWrap() && label->text().size() < 40 &&
            label->sizePolicy().horizontalPolicy() != QSizePolicy::Ignored &&
            label->fontMetrics().horizontalAdvance(label->text()) > label->width() + 1)
            cut << label->objectName() + ": " + label->text();
    return cut;
}

TEST_F(SceneDocks, FitsASmallWindowInBothThemes) {
    using Kind = SceneChoice::Kind;
    window.window().resize(1280, 800);
    pass(200ms);
    EXPECT_GE(window.find<QWidget>("scene.stage")->width(), 600);
    int docks = 0;
    for (auto* dock : window.window().findChildren<QDockWidget*>()) docks += dock->isVisible();
    EXPECT_LE(docks, 3) << "a new user meets few docks";
    for (const Theme theme : {Theme::light, Theme::dark}) {
        window.studio().settings.setTheme(theme);
        const QString name = theme == Theme::light ? "light" : "dark";
        for (const char* command : {"add water", "add a sun", "add fog", "add a box"}) {
            window.command(command);
            pass(100ms);
            window.screenshot("scene-" + name + "-" + QString(command).section(' ', -1));
            EXPECT_EQ(cutTexts(window.window()).join(", ").toStdString(), "") << command;
        }
        for (const Kind kind : {Kind::device, Kind::table, Kind::projector, Kind::viewer, Kind::room}) {
            choose(kind);
            for (auto* section : window.window().findChildren<QAbstractButton*>())
                if (section->objectName().contains(".section.") && section->isVisible() && !section->isChecked())
                    section->click();
            pass(100ms);
            window.screenshot(QString("scene-%1-page-%2").arg(name).arg(static_cast<int>(kind)));
            EXPECT_EQ(cutTexts(window.window()).join(", ").toStdString(), "") << static_cast<int>(kind);
        }
    }
}

TEST_F(SceneDocks, InspectorIsNeverNarrowerThanItsRows) {
    using Kind = SceneChoice::Kind;
    window.command("add water");
    QDockWidget* inspector = nullptr;
    for (QWidget* above = window.find<QWidget>("inspector.name"); above != nullptr && inspector == nullptr;
         above = above->parentWidget())
        inspector = qobject_cast<QDockWidget*>(above);
    ASSERT_TRUE(inspector);
    const auto check = [&](const std::string& page) {
        for (const int width : {100, 400, 100}) {
            window.window().resizeDocks({inspector}, {width}, Qt::Horizontal);
            pass(100ms);
            int shown = 0;
            for (auto* area : inspector->findChildren<QScrollArea*>()) {
                if (!area->isVisible() || area->widget() == nullptr) continue;
                ++shown;
                EXPECT_LE(area->widget()->width(), area->viewport()->width()) << page << " at " << width;
            }
            EXPECT_EQ(shown, 1) << page;
        }
    };
    check("water");
    for (const Kind kind : {Kind::device, Kind::table, Kind::projector, Kind::viewer, Kind::room}) {
        choose(kind);
        check(std::to_string(static_cast<int>(kind)));
    }
    window.screenshot("scene-narrow-inspector");
}

double longestStallOfEditing(StudioWindow& window) {
    StallWatch watch;
    const auto scrub = [&window](const QString& name) {
        auto* field = window.find<QLineEdit>(name);
        window.window().setFocus();
        const QPoint middle = field->rect().center();
        QTest::mousePress(field, Qt::LeftButton, {}, middle);
        for (int i = 1; i <= 40; ++i) {
            QTest::mouseMove(field, middle + QPoint(i, 0));
            pass(8ms);
        }
        QTest::mouseRelease(field, Qt::LeftButton, {}, middle + QPoint(40, 0));
    };
    scrub("item.position.x");
    scrub("item.size.y");
    scrub("item.opacity");
    for (const char* command : {"add water", "add fog", "add a lamp", "add a box"}) {
        window.command(command);
        pass(100ms);
    }
    scrub("item.position.y");
    return watch.takeLongest();
}

// Other programs on the machine only add to a stall, so the best of three counts.
TEST_F(SceneDocks, EditingNeverFreezesTheWindow) {
    setPlaying(window.studio(), true);
    addBox();
    pass(2s); // the first pictures compile shaders
    double best = 1e9;
    for (int attempt = 0; attempt < 3 && best > 100.0; ++attempt) best = std::min(best, longestStallOfEditing(window));
    RecordProperty("longestStallMilliseconds", std::to_string(best));
    std::printf("longest stall of the window: %.0f ms\n", best);
    EXPECT_LE(best, 100.0);
}

TEST(MaterialPicture, ShowsColourPictureAndHoles) {
    Material red;
    red.color = {1.0F, 0.1F, 0.1F};
    const QImage ball = studio::paintMaterial(red, nullptr, 64);
    EXPECT_EQ(qAlpha(ball.pixel(0, 0)), 0) << "a ball has no corners";
    const QColor middle = ball.pixelColor(30, 24);
    EXPECT_EQ(middle.alpha(), 255);
    EXPECT_GT(middle.red(), 2 * middle.green());
    const QColor below = ball.pixelColor(44, 56);
    EXPECT_GT(middle.lightness(), below.lightness() + 30) << "light comes from above";

    SceneAssets assets;
    auto halves = std::make_shared<Image>(glm::ivec2(2, 1), Image::Pixel{0, 0, 255, 255});
    halves->at(1, 0) = {0, 0, 0, 0};
    assets.images["halves"] = halves;
    Material cut;
    cut.color = glm::vec3(1.0F);
    cut.colorTexture.image = "halves";
    cut.colorTexture.tile = glm::vec2(1.0F);
    cut.holes.image = "halves";
    cut.holes.tile = glm::vec2(1.0F);
    const QImage half = studio::paintMaterial(cut, &assets, 64);
    EXPECT_EQ(qAlpha(half.pixel(16, 32)), 0) << "the transparent half lies at coordinates below zero";
    EXPECT_EQ(qAlpha(half.pixel(44, 32)), 255);
    EXPECT_GT(qBlue(half.pixel(44, 32)), qRed(half.pixel(44, 32)) + 60) << "the other shows its picture";
}

} // namespace
} // namespace lumorph::test

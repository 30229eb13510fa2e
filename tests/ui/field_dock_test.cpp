#include <algorithm>
#include <cstdlib>

#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QMainWindow>
#include <QPushButton>
#include <QStackedWidget>
#include <QtTest/QTest>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/studio/look/palette.h"
#include "app/studio/shell/studio.h"
#include "app/studio/widgets/plot.h"
#include "app/studio/widgets/range_slider.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/field_summary.h"
#include "app/workspaces/field/field_dock.h"
#include "core/mdf/builder.h"
#include "core/mdf/field_view.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/event_loop.h"

namespace lumorph::studio {
namespace {

constexpr BuildOptions kSmall{.resolution = 14, .levels = 6, .samples = 8, .seed = 3, .threads = 1};

std::shared_ptr<const MatchField> cushionField() {
    static const auto field = std::make_shared<const MatchField>(buildField(test::cushionRig(), kSmall));
    return field;
}

/// Widgets need an application with a screen; the first to ask makes one where the program has none.
void needWindows() {
    if (QCoreApplication::instance()) return;
    if (qEnvironmentVariableIsEmpty("DISPLAY")) qputenv("QT_QPA_PLATFORM", "offscreen");
    static int count = 1;
    static char name[] = "test";
    static char* arguments[] = {name, nullptr};
    static QApplication application(count, arguments);
    applyTheme(application, Theme::dark);
}

/// The dock in a window of its own, with a studio that has a rig and, where asked, its field.
class FieldDockTest : public testing::Test {
protected:
    FieldDockTest() {
        needWindows();
        ::setenv("LUMORPH_SESSION", (folder_ / "session").c_str(), 1);
        studio_ = std::make_unique<Studio>();
    }
    ~FieldDockTest() override {
        window_.reset();
        studio_.reset();
        ::unsetenv("LUMORPH_SESSION");
    }

    void open(bool withField) {
        StudioState state;
        state.rig.rig = std::make_shared<const Rig>(test::cushionRig());
        if (withField) {
            state.field.field = cushionField();
            state.rig.rig = std::make_shared<const Rig>(cushionField()->rig);
        }
        state.strokes.assign(state.rig.rig->actuatorCount(), 0.0);
        studio_->document.reset(std::move(state), {});
        window_ = std::make_unique<QMainWindow>();
        window_->setCentralWidget(makeFieldDock(*studio_, display_));
        window_->resize(340, 900);
        window_->show();
        ASSERT_TRUE(QTest::qWaitForWindowExposed(window_.get()));
        ASSERT_TRUE(test::eventually([&] { return studio_->jobs.running().empty(); })); // a look at the rig
    }

    template <class Widget> Widget* find(const char* name) {
        auto* found = window_->findChild<Widget*>(name);
        EXPECT_NE(found, nullptr) << name;
        return found;
    }
    void click(const char* name) { QTest::mouseClick(find<QWidget>(name), Qt::LeftButton); }
    /// Types into a field as a person does: click, replace, Enter.
    void type(const char* name, const QString& text, bool enter = true) {
        auto* field = find<ValueField>(name);
        field->setFocus();
        field->selectAll();
        QTest::keyClicks(field, text);
        if (enter) QTest::keyClick(field, Qt::Key_Return);
    }

    TemporaryFolder folder_;
    FieldDisplayModel display_;
    std::unique_ptr<Studio> studio_;
    std::unique_ptr<QMainWindow> window_;
};

TEST_F(FieldDockTest, WithoutAFieldItOffersToBuildOne) {
    open(false);
    EXPECT_EQ(find<QStackedWidget>("field.pages")->currentIndex(), 0);
    ASSERT_NE(studio_->commands.find("field.build"), nullptr);
    EXPECT_TRUE(studio_->commands.find("field.build")->isEnabled());
}

TEST_F(FieldDockTest, SaysWhatTheFieldIs) {
    open(true);
    const Field& field = cushionField()->field;
    const glm::ivec3& d = field.frame.dimensions;
    const QString space = find<QLabel>("field.fact.space")->text();
    EXPECT_THAT(space.toStdString(),
                testing::HasSubstr(QString("%1 × %2 × %3").arg(d.x).arg(d.y).arg(d.z).toStdString()));
    EXPECT_EQ(find<QLabel>("field.fact.voxel")->text(),
              QString::number(1000.0 * field.frame.voxelSize, 'f', 2) + " mm");
    EXPECT_THAT(find<QLabel>("field.fact.levels")->text().toStdString(), testing::HasSubstr("6 for each of 3"));
}

TEST_F(FieldDockTest, ButtonsChooseWhatIsShownAndOnlyThatIsAskedAbout) {
    open(true);
    click("field.show.voxels");
    EXPECT_EQ(display_.value().show, FieldDisplay::Show::voxels);
    EXPECT_TRUE(find<QWidget>("field.slice.x.from")->isVisible());
    EXPECT_FALSE(find<QWidget>("field.surface.slider")->isVisible());
    click("field.show.surface");
    EXPECT_EQ(display_.value().show, FieldDisplay::Show::surface);
    EXPECT_FALSE(find<QWidget>("field.slice.x.from")->isVisible());
    type("field.surface.level", "4");
    EXPECT_EQ(display_.value().surfaceLevel, 4);
    click("field.show.nothing");
    EXPECT_EQ(display_.value().show, FieldDisplay::Show::nothing);
    EXPECT_FALSE(find<QWidget>("field.actuator")->isVisible());
}

TEST_F(FieldDockTest, TheActuatorIsChosenByItsName) {
    open(true);
    click("field.show.voxels");
    auto* actuator = find<QComboBox>("field.actuator");
    ASSERT_EQ(actuator->count(), 4);
    EXPECT_EQ(actuator->itemText(2).toStdString(), cushionField()->field.actuators[1].name);
    actuator->setFocus();
    QTest::keyClick(actuator, Qt::Key_Down);
    QTest::keyClick(actuator, Qt::Key_Down);
    EXPECT_EQ(display_.value().actuator, 1);
    QTest::keyClick(actuator, Qt::Key_Home);
    EXPECT_EQ(display_.value().actuator, std::nullopt);
}

TEST_F(FieldDockTest, SlicesFollowTypingAndDragging) {
    open(true);
    click("field.show.voxels");
    const int last = cushionField()->field.frame.dimensions.x - 1;
    type("field.slice.x.from", "3");
    EXPECT_EQ(display_.value().sliceFrom, glm::ivec3(3, 0, 0));
    auto* slider = find<RangeSlider>("field.slice.x.slider");
    EXPECT_EQ(slider->from(), 3);
    EXPECT_EQ(slider->to(), last);
    QTest::mousePress(slider, Qt::LeftButton, {}, slider->handleAt(last));
    QTest::mouseMove(slider, slider->handleAt(6));
    QTest::mouseRelease(slider, Qt::LeftButton, {}, slider->handleAt(6));
    EXPECT_EQ(display_.value().sliceTo.x, 6);
    EXPECT_EQ(find<ValueField>("field.slice.x.to")->value(), 6.0);
    // Between the handles both move, and neither leaves the limits.
    QTest::mousePress(slider, Qt::LeftButton, {}, (slider->handleAt(3) + slider->handleAt(6)) / 2);
    QTest::mouseMove(slider, slider->handleAt(0) - QPoint(400, 0));
    QTest::mouseRelease(slider, Qt::LeftButton);
    EXPECT_EQ(display_.value().sliceFrom.x, 0);
    EXPECT_EQ(display_.value().sliceTo.x, 3);
    // By keyboard the handle used last moves.
    slider->setFocus();
    QTest::keyClick(slider, Qt::Key_End);
    EXPECT_EQ(display_.value().sliceTo.x, last);
    // A lower end beyond the upper one takes it along.
    type("field.slice.x.to", "2");
    type("field.slice.x.from", "5");
    EXPECT_EQ(display_.value().sliceFrom.x, 5);
    EXPECT_EQ(display_.value().sliceTo.x, 5);
}

TEST_F(FieldDockTest, LevelsOfTheVoxelsAreARange) {
    open(true);
    click("field.show.voxels");
    type("field.levels.from", "2");
    type("field.levels.to", "4");
    EXPECT_EQ(display_.value().lowestLevel, 2);
    EXPECT_EQ(display_.value().highestLevel, 4);
    type("field.levels.to", "99");
    EXPECT_EQ(display_.value().highestLevel, 5) << "there are six levels";
}

TEST_F(FieldDockTest, AClickedVoxelShowsTheRampsOfTheActuatorsThatChangeIt) {
    open(true);
    click("field.show.voxels");
    const Field& field = cushionField()->field;
    const glm::ivec3& d = field.frame.dimensions;
    glm::ivec3 chosen(-1);
    for (int x = 0; x < d.x && chosen.x < 0; ++x)
        for (int y = d.y - 1; y >= 0 && chosen.x < 0; --y)
            if (denseRamps(field, 0)[field.voxelIndex(x, y, d.z / 2)].v0 != kUnchanged) chosen = {x, y, d.z / 2};
    ASSERT_GE(chosen.x, 0);
    FieldDisplay value = display_.value();
    value.voxel = chosen;
    display_.set(value);
    const auto expected = rampsAt(field, chosen);
    const auto& curves = find<Plot>("field.ramps")->curves();
    ASSERT_FALSE(curves.empty());
    for (const Plot::Curve& curve : curves) {
        const auto actuator =
            std::find_if(field.actuators.begin(), field.actuators.end(),
                         [&](const ActuatorField& one) { return one.name == curve.name.toStdString(); });
        ASSERT_NE(actuator, field.actuators.end());
        EXPECT_EQ(curve.values, expected[static_cast<std::size_t>(actuator - field.actuators.begin())]);
    }
    value.voxel.reset();
    display_.set(value);
    EXPECT_TRUE(find<Plot>("field.ramps")->curves().empty());
}

TEST_F(FieldDockTest, TheBuildDialogRefusesNonsenseWhereItIsTyped) {
    open(true);
    click("field.finer");
    auto* build = find<QPushButton>("field.build.accept");
    auto* wrong = find<QLabel>("field.build.levels.wrong");
    EXPECT_TRUE(build->isEnabled());
    for (const char* text : {"1", "201", "12.5", "many", "-3"}) {
        SCOPED_TRACE(text);
        type("field.build.levels", text);
        EXPECT_FALSE(build->isEnabled());
        EXPECT_TRUE(wrong->isVisible());
        EXPECT_FALSE(wrong->text().isEmpty());
        EXPECT_TRUE(studio_->jobs.running().empty());
    }
    type("field.build.levels", "8", false);
    EXPECT_FALSE(wrong->isVisible());
    EXPECT_TRUE(build->isEnabled());
    // A resolution whose voxels would fill the memory.
    type("field.build.resolution", "4000", false);
    EXPECT_FALSE(build->isEnabled());
    EXPECT_TRUE(find<QLabel>("field.build.resolution.wrong")->isVisible());
}

TEST_F(FieldDockTest, BuildingAFinerFieldIsOneStepOfUndo) {
    open(true);
    click("field.finer");
    type("field.build.resolution", "18", false);
    type("field.build.levels", "7", false);
    const VoxelFrame expected = frameOf(studio_->document.state().rig.rig->reach(), 18);
    EXPECT_THAT(find<QLabel>("field.build.estimate")->text().toStdString(),
                testing::HasSubstr(countText(expected.voxelCount()).toStdString()));
    click("field.build.accept");
    ASSERT_TRUE(test::eventually([&] { return studio_->document.state().field.field != cushionField(); }));
    EXPECT_EQ(studio_->document.state().field.field->field.frame, expected);
    EXPECT_EQ(studio_->document.state().field.field->field.levels, 7);
    EXPECT_THAT(find<QLabel>("field.fact.levels")->text().toStdString(), testing::HasSubstr("7 for each"));
    studio_->document.undoStack().undo();
    EXPECT_EQ(studio_->document.state().field.field, cushionField());
    EXPECT_THAT(find<QLabel>("field.fact.levels")->text().toStdString(), testing::HasSubstr("6 for each"));
}

TEST_F(FieldDockTest, ACancelledBuildChangesNothing) {
    open(true);
    click("field.finer");
    type("field.build.resolution", "120", false);
    type("field.build.samples", "4000", false);
    click("field.build.accept");
    ASSERT_FALSE(studio_->jobs.running().empty());
    studio_->jobs.cancel(studio_->jobs.running().front().id);
    ASSERT_TRUE(test::eventually([&] { return studio_->jobs.running().empty(); }));
    test::pass(std::chrono::milliseconds(200));
    EXPECT_EQ(studio_->document.state().field.field, cushionField());
    EXPECT_EQ(studio_->document.undoStack().count(), 0);
}

} // namespace
} // namespace lumorph::studio

#include <cstdlib>
#include <memory>
#include <optional>

#include <QApplication>
#include <QLabel>
#include <QPushButton>
#include <QTest>
#include <QTreeView>
#include <gtest/gtest.h>

#include "app/workspaces/field/actuator_dock.h"
#include "app/workspaces/field/actuator_grid.h"
#include "app/workspaces/field/actuator_scale.h"
#include "app/workspaces/field/error_curves.h"
#include "app/workspaces/field/field_commands.h"
#include "app/workspaces/field/level_slider.h"
#include "app/workspaces/field/match_dock.h"
#include "app/workspaces/field/target_dock.h"
#include "core/mdf/builder.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/event_loop.h"

namespace lumorph::studio {
namespace {

/// Settings and sessions of the test are its own.
struct OwnFolders {
    OwnFolders() {
        ::setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
        ::setenv("LUMORPH_SESSION", folder.path().c_str(), 1);
        if (qEnvironmentVariableIsEmpty("DISPLAY")) ::setenv("QT_QPA_PLATFORM", "offscreen", 1);
        if (!QCoreApplication::instance()) {
            static int count = 1;
            static char name[] = "test";
            static char* arguments[] = {name, nullptr};
            static const QApplication application(count, arguments);
        }
    }
    TemporaryFolder folder;
};

Rig manyPins(int count) {
    RigParts parts;
    parts.name = "pins";
    parts.restMesh = test::boxMesh({-0.05F, 0.0F, -0.05F}, {0.05F, 0.02F, 0.05F}, 10);
    for (int i = 0; i < count; ++i) {
        Actuator pin;
        pin.name = "pin " + std::to_string(i);
        pin.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.03};
        pin.influences = {{static_cast<std::uint32_t>(i), 1.0F}};
        parts.actuators.push_back(pin);
    }
    return Rig(parts);
}

/// The docks of the Field workspace on a small rig with a field and a box to match.
class FieldDocks : public testing::Test {
protected:
    FieldDocks() {
        addFieldCommands(studio_, [] { return nullptr; });
    }

    void useTarget() {
        BuildOptions options;
        options.resolution = 12;
        options.levels = 9;
        options.samples = 8;
        StudioState state;
        state.field.field = std::make_shared<const MatchField>(buildField(test::lifterRig(), options));
        state.rig.rig = std::make_shared<const Rig>(test::lifterRig());
        auto target = std::make_shared<MatchTarget>();
        target->name = "box";
        target->solid = makeTarget(test::boxMesh({-0.02F, 0.0F, -0.02F}, {0.02F, 0.03F, 0.02F}, 4));
        target->box = boundingBox(target->solid.mesh.positions);
        state.target.target = target;
        state.placement = fitPlacement(state.field.field->field, target->box);
        studio_.document.reset(state, {});
    }

    template <class Widget> Widget* find(QWidget& dock, const QString& name) {
        auto* found = dock.findChild<Widget*>(name);
        EXPECT_TRUE(found) << name.toStdString();
        return found;
    }
    [[nodiscard]] bool matched() {
        return test::eventually([&] { return studio_.loop.frame() && studio_.loop.frame()->matched; });
    }

    OwnFolders folders_;
    Studio studio_;
    Throttle numbers_{20};
    FitCertificate certificate_{studio_.loop};
};

TEST_F(FieldDocks, DraggingASliderMovesOneActuatorAndStopsMatchingInOneStep) {
    useTarget();
    std::unique_ptr<QWidget> dock(makeActuatorDock(studio_));
    dock->resize(300, 600);
    dock->show();
    ASSERT_TRUE(matched());
    auto* slider = find<LevelSlider>(*dock, "actuators.slider.1");
    auto* hint = find<QWidget>(*dock, "actuators.hint");
    EXPECT_FALSE(hint->isVisible());

    const QPoint middle(0, slider->height() / 2);
    QTest::mousePress(slider, Qt::LeftButton, {}, middle + QPoint(static_cast<int>(slider->xOf(0.2)), 0));
    QTest::mouseMove(slider, middle + QPoint(static_cast<int>(slider->xOf(0.5)), 0));
    EXPECT_EQ(studio_.document.undoStack().count(), 0) << "not yet a step";
    QTest::mouseMove(slider, middle + QPoint(static_cast<int>(slider->xOf(0.75)), 0));
    QTest::mouseRelease(slider, Qt::LeftButton, {}, middle + QPoint(static_cast<int>(slider->xOf(0.75)), 0));
    EXPECT_EQ(studio_.document.undoStack().count(), 1);
    EXPECT_EQ(studio_.document.state().matching.driver, Driver::hand);
    EXPECT_DOUBLE_EQ(studio_.document.state().strokes[1], 0.75);
    EXPECT_EQ(find<QLabel>(*dock, "actuators.level.1")->text(), "level 6");
    EXPECT_TRUE(hint->isVisible());

    QTest::mouseClick(find<QPushButton>(*dock, "actuators.hint.remedy"), Qt::LeftButton);
    EXPECT_EQ(studio_.document.state().matching.driver, Driver::target);
    EXPECT_FALSE(hint->isVisible());
}

TEST_F(FieldDocks, ArrowKeysStepALevelAndRestBringsAllBack) {
    useTarget();
    std::unique_ptr<QWidget> dock(makeActuatorDock(studio_));
    dock->show();
    auto* slider = find<LevelSlider>(*dock, "actuators.slider.0");
    QTest::keyClick(slider, Qt::Key_End);
    EXPECT_DOUBLE_EQ(studio_.document.state().strokes[0], 1.0);
    QTest::keyClick(slider, Qt::Key_Left);
    EXPECT_DOUBLE_EQ(studio_.document.state().strokes[0], 7.0 / 8.0);
    QTest::mouseClick(find<QPushButton>(*dock, "actuators.rest"), Qt::LeftButton);
    EXPECT_EQ(studio_.document.state().strokes, std::vector<double>(3, 0.0));
    studio_.document.undoStack().undo();
    EXPECT_DOUBLE_EQ(studio_.document.state().strokes[0], 7.0 / 8.0);
}

TEST_F(FieldDocks, ManyActuatorsShareOneEditor) {
    StudioState state;
    state.rig.rig = std::make_shared<const Rig>(manyPins(100));
    studio_.document.reset(state, {});
    std::unique_ptr<QWidget> dock(makeActuatorDock(studio_));
    dock->resize(300, 600);
    dock->show();
    EXPECT_EQ(dock->findChildren<LevelSlider*>().size(), 1);
    auto* grid = find<ActuatorGrid>(*dock, "actuators.grid");
    QTest::mouseClick(grid, Qt::LeftButton, {}, grid->cellOf(37).center());
    QTest::keyClick(grid, Qt::Key_Right);
    EXPECT_EQ(grid->current(), 38);
    QTest::keyClick(find<LevelSlider>(*dock, "actuators.slider.current"), Qt::Key_End);
    EXPECT_DOUBLE_EQ(studio_.document.state().strokes[38], 1.0);
    EXPECT_DOUBLE_EQ(studio_.document.state().strokes[37], 0.0);
}

TEST_F(FieldDocks, MatchShowsTheNumbersOfTheFrameAndSwitchesTheMethod) {
    useTarget();
    std::unique_ptr<QWidget> dock(makeMatchDock(studio_, numbers_, certificate_));
    dock->show();
    ASSERT_TRUE(matched());
    numbers_.request();
    auto* iou = find<QLabel>(*dock, "match.iou");
    ASSERT_TRUE(
        test::eventually([&] { return iou->text() == QString::number(studio_.loop.frame()->iouWanted, 'f', 2); }));
    const MatchFrame& frame = *studio_.loop.frame();
    EXPECT_GT(frame.iouWanted, 0.1);
    EXPECT_EQ(find<QLabel>(*dock, "match.iou.voting")->text(), QString::number(frame.iouVoting, 'f', 2));
    auto* table = find<QTreeView>(*dock, "match.actuators");
    ASSERT_EQ(table->model()->rowCount(), 3);
    EXPECT_TRUE(table->model()->index(0, 1).data().toString().endsWith(QString::number(frame.wanted[0].index)) ||
                table->model()->index(0, 1).data().toString() == "out of reach");

    auto* voting = find<QPushButton>(*dock, "match.method.voting");
    auto* refined = find<QPushButton>(*dock, "match.method.refined");
    EXPECT_TRUE(refined->isChecked());
    QTest::mouseClick(voting, Qt::LeftButton);
    EXPECT_EQ(studio_.document.state().matching.method, MatchMethod::voting);
    EXPECT_TRUE(voting->isChecked());
    EXPECT_FALSE(refined->isChecked());
    QTest::mouseClick(voting, Qt::LeftButton);
    EXPECT_TRUE(voting->isChecked()) << "a second click changes nothing";
    EXPECT_EQ(studio_.document.undoStack().count(), 1);
}

/// The best IoU of all joint states.
double bestOfAll(const Coverage& coverage, const BitColumns& target) {
    CoverageScratch scratch;
    BitColumns covered;
    double best = 0.0;
    State state(3);
    for (state[0].index = 0; state[0].index < coverage.levels(); ++state[0].index)
        for (state[1].index = 0; state[1].index < coverage.levels(); ++state[1].index)
            for (state[2].index = 0; state[2].index < coverage.levels(); ++state[2].index) {
                coverage.covered(state, covered, scratch);
                best = std::max(best, compareVolumes(covered, target).iou());
            }
    return best;
}

TEST_F(FieldDocks, MatchSaysHowFarItIsFromTheBestPossibleWhileNothingMoves) {
    useTarget();
    std::unique_ptr<QWidget> dock(makeMatchDock(studio_, numbers_, certificate_));
    dock->show();
    auto* bound = find<QLabel>(*dock, "match.bound");
    ASSERT_TRUE(matched());
    test::pass(std::chrono::milliseconds(600));
    EXPECT_FALSE(certificate_.known()) << "nobody looks";
    certificate_.setActive(true);
    for (const float x : {0.0F, 0.013F}) {
        studio_.document.change("Move", [&](StudioState& state) { state.placement.translation.x += x; });
        if (x != 0.0F) {
            ASSERT_TRUE(test::eventually([&] { return !certificate_.known(); })) << "it was of another place";
        }
        ASSERT_TRUE(test::eventually([&] { return certificate_.known() && certificate_.known()->betweenLevels; })) << x;
        const StudioState& state = studio_.document.state();
        const Coverage& coverage = state.field.field->coverage;
        SolidVoxelizer voxelizer;
        BitColumns target;
        voxelizeTarget(state.field.field->field.frame,
                       {placed(state.target.target->solid.mesh, state.placement), true, {}}, voxelizer, target);
        target &= coverage.domain();
        const double best = bestOfAll(coverage, target);
        EXPECT_NEAR(certificate_.known()->certificate.upperBound, best, 1e-9) << "a rig so small is solved";
        EXPECT_GE(*certificate_.known()->betweenLevels, certificate_.known()->certificate.quality.iou());
        const double gap = best - studio_.loop.frame()->iouWanted;
        EXPECT_TRUE(test::eventually([&] {
            return bound->text().startsWith(gap > 1e-9 ? "At most 0." : "No state of this device fits better.");
        })) << bound->text().toStdString();
    }
}

TEST(CertificateText, IsRoundedSoThatItHolds) {
    const auto said = [](double bound, double iou, bool done, std::optional<double> between) {
        FitCertificate::Known known;
        known.certificate.upperBound = bound;
        known.certificate.done = done;
        known.certificate.quality = {40, 60, 0}; // 0.4
        known.betweenLevels = between;
        return certificateText(known, iou).toStdString();
    };
    EXPECT_EQ(certificateText(std::nullopt, 0.4).toStdString(), "");
    EXPECT_EQ(said(1.0, 0.4, false, std::nullopt), "Looking for how much better it could be...");
    EXPECT_EQ(said(0.431, 0.4, false, std::nullopt),
              "At most 0.04 from the best possible: no state of this device reaches more than 0.44.");
    EXPECT_EQ(said(0.4, 0.4, true, 0.42),
              "No state of this device fits better. 0.02 are lost to the steps between levels.");
    EXPECT_EQ(said(0.4, 0.4, true, 0.401), "No state of this device fits better.");
}

TEST_F(FieldDocks, TheFirstActuatorWithACurveIsChosenUntilTheUserDoes) {
    useTarget();
    // Only the last of three lifters is near the target, so that the first ones have no curve.
    StudioState state = studio_.document.state();
    const auto& field = *state.field.field;
    std::optional<std::size_t> first;
    for (float x = 0.02F; x < 0.3F && !(first && *first > 0); x += 0.005F) {
        state.placement.translation.x = x;
        const Target target{placed(state.target.target->solid.mesh, state.placement), true, {}};
        SolidVoxelizer voxelizer;
        BitColumns goal;
        voxelizeTarget(field.field.frame, target, voxelizer, goal);
        const Votes votes = field.voting.match(goal);
        first.reset();
        for (std::size_t i = votes.actuators.size(); i-- > 0;)
            if (votes.actuators[i].reached) first = i;
    }
    ASSERT_TRUE(first && *first > 0) << "no place of the target leaves the first actuator out";
    studio_.document.reset(state, {});
    std::unique_ptr<QWidget> dock(makeMatchDock(studio_, numbers_, certificate_));
    dock->show();
    auto* table = find<QTreeView>(*dock, "match.actuators");
    EXPECT_TRUE(test::eventually([&] {
        numbers_.request();
        return table->currentIndex().row() == static_cast<int>(*first);
    })) << table->currentIndex().row();
    table->setCurrentIndex(table->model()->index(0, 0)); // the user may look at it all the same
    test::pass(std::chrono::milliseconds(200));
    EXPECT_EQ(table->currentIndex().row(), 0);
}

TEST_F(FieldDocks, DraggingInAnErrorCurveTriesALevelAndLetsGo) {
    useTarget();
    std::unique_ptr<QWidget> dock(makeMatchDock(studio_, numbers_, certificate_));
    dock->resize(320, 900);
    dock->show();
    ASSERT_TRUE(matched());
    auto* curves = find<ErrorCurves>(*dock, "match.curves");
    std::size_t reached = 0;
    for (const auto& votes = studio_.loop.frame()->votes->actuators; !votes[reached].reached;) ++reached;
    const int at = static_cast<int>(reached);
    ASSERT_TRUE(test::eventually([&] {
        numbers_.request();
        return curves->isVisible() && curves->current() == at;
    }));
    const StudioState before = studio_.document.state();
    const auto pixel = [&](int level) { return QPoint(curves->xOf(at, level), curves->cellOf(at).center().y()); };
    QTest::mousePress(curves, Qt::LeftButton, {}, pixel(2));
    EXPECT_EQ(studio_.document.state().matching.driver, Driver::target) << "a click moves nothing";
    for (const int level : {3, 4, 6}) QTest::mouseMove(curves, pixel(level));
    EXPECT_TRUE(curves->trying());
    EXPECT_EQ(studio_.document.state().matching.driver, Driver::hand);
    EXPECT_DOUBLE_EQ(studio_.document.state().strokes[reached], 6.0 / 8.0); // of 9 levels
    QTest::mouseRelease(curves, Qt::LeftButton, {}, pixel(6));
    EXPECT_EQ(studio_.document.state().matching.driver, Driver::target) << "the match goes on";
    EXPECT_EQ(studio_.document.state().strokes, before.strokes);
    EXPECT_EQ(studio_.document.undoStack().count(), 0);

    QTest::mouseDClick(curves, Qt::LeftButton, {}, pixel(4));
    EXPECT_DOUBLE_EQ(studio_.document.state().strokes[reached], 4.0 / 8.0);
    EXPECT_EQ(studio_.document.undoStack().count(), 1);
}

TEST_F(FieldDocks, PlacementIsTypedInUnits) {
    useTarget();
    std::unique_ptr<QWidget> dock(makeTargetDock(studio_));
    dock->show();
    auto* x = find<ValueField>(*dock, "target.x");
    x->setFocus();
    x->selectAll();
    QTest::keyClicks(x, "12 mm");
    QTest::keyClick(x, Qt::Key_Return);
    EXPECT_NEAR(studio_.document.state().placement.translation.x, 0.012F, 1e-6F);
    EXPECT_EQ(studio_.document.undoStack().count(), 1);
    EXPECT_EQ(find<QLabel>(*dock, "target.name")->text(), "box");
    EXPECT_TRUE(find<QLabel>(*dock, "target.about")->text().contains("closed"));
}

} // namespace
} // namespace lumorph::studio

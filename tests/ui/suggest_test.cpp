#include <cmath>

#include <gtest/gtest.h>

#include <QDockWidget>
#include <QElapsedTimer>
#include <QListWidget>
#include <QPushButton>

#include "app/workspaces/rig/front_plot.h"
#include "app/workspaces/rig/sheet_picture.h"
#include "core/geometry/triangle_mesh.h"
#include "core/mdf/placement.h"
#include "core/rig/rig_file.h"
#include "tests/support/cgal_oracle.h"
#include "tests/ui/stall_watch.h"
#include "tests/ui/studio_window.h"

namespace lumorph::studio {
namespace {

using test::eventually;

struct Suggest : testing::Test {
    void SetUp() override {
        ASSERT_TRUE(eventually([&] { return window.state().rig.rig != nullptr; }));
        window.window().findChild<QDockWidget*>("dock.rig.suggest")->raise();
        button = window.find<QPushButton>("rig.suggest.search");
        plot = window.find<FrontPlot>("rig.suggest.plot");
        ASSERT_TRUE(button && plot);
    }
    void tickOnly(const QStringList& names) {
        window.click("rig.suggest.none");
        EXPECT_TRUE(eventually([&] { return !button->isEnabled(); })) << "nothing is ticked";
        auto* list = window.find<QListWidget>("rig.suggest.targets");
        for (const QString& name : names)
            for (QListWidgetItem* item : list->findItems(name, Qt::MatchExactly)) item->setCheckState(Qt::Checked);
        ASSERT_TRUE(eventually([&] { return button->isEnabled(); }));
    }
    [[nodiscard]] QString status() { return window.text("rig.suggest.status"); }
    [[nodiscard]] int generation() { return status().section(' ', 1, 1).remove(',').toInt(); }
    [[nodiscard]] bool searchesTo(int wanted) {
        return eventually([&] { return status().startsWith("Generation") && generation() >= wanted; },
                          std::chrono::seconds(60));
    }
    [[nodiscard]] bool stopsWithinASecond() {
        QElapsedTimer since;
        since.start();
        window.click("rig.suggest.search");
        return eventually([&] { return button->text() == "Go on searching"; }) && since.elapsed() < 1000;
    }

    TemporaryFolder folder;
    test::StudioWindow window{folder / "session", "rig"};
    QPushButton* button = nullptr;
    FrontPlot* plot = nullptr;
};

void expectSound(const Rig& rig) {
    for (const double stroke : {0.0, 0.5, 1.0}) {
        const TriangleMesh mesh = deformed(rig, std::vector<double>(rig.actuatorCount(), stroke));
        EXPECT_TRUE(isClosedSolid(mesh)) << stroke;
        EXPECT_FALSE(test::crossesItself(mesh)) << stroke;
    }
}

TEST_F(Suggest, FrontGrowsUntilStoppedAndADotBecomesTheRigByOneStep) {
    test::setPlaying(window.studio(), true);
    const std::vector<std::byte> before = writeRigGlb(*window.state().rig.rig);
    tickOnly({"Bowl", "Ridge"});
    window.enter("rig.suggest.most", "4");
    test::StallWatch stalls;
    (void)stalls.takeLongest();
    window.click("rig.suggest.search");
    EXPECT_TRUE(eventually([&] { return button->text() == "Stop searching"; }));
    ASSERT_TRUE(searchesTo(2));
    EXPECT_LT(stalls.takeLongest(), 100.0);
    window.screenshot("suggest_running");
    ASSERT_TRUE(stopsWithinASecond());
    const QString stopped = status();
    test::pass(std::chrono::milliseconds(500));
    EXPECT_EQ(status(), stopped) << "nothing comes late";

    const int generations = generation();
    window.click("rig.suggest.search");
    ASSERT_TRUE(searchesTo(generations + 1));
    ASSERT_TRUE(stopsWithinASecond());
    const std::vector<FrontPlot::Dot> dots = plot->dots();
    ASSERT_GE(dots.size(), 2U);
    EXPECT_LE(dots.back().cost, 4.0);
    for (std::size_t k = 1; k < dots.size(); ++k) {
        EXPECT_GT(dots[k].cost, dots[k - 1].cost);
        EXPECT_GT(dots[k].fit, dots[k - 1].fit);
    }
    EXPECT_FALSE(plot->openDevice()) << "the tablet has one sheet: no design is like it";

    // What is pointed at is shown; what is clicked is used.
    const auto wanted = static_cast<std::size_t>(std::lround(dots[1].cost));
    QTest::mouseMove(plot, plot->placeOf(dots[1]).toPoint());
    ASSERT_TRUE(eventually([&] { return window.findNow<SheetPicture>("rig.suggest.picture") != nullptr; }));
    EXPECT_EQ(window.find<SheetPicture>("rig.suggest.picture")->flaps().size(), wanted);
    EXPECT_FALSE(window.find<QPushButton>("rig.suggest.use")->isEnabled()) << "pointed at, not chosen";
    QTest::mouseClick(plot, Qt::LeftButton, {}, plot->placeOf(dots[1]).toPoint());
    const int steps = window.studio().document.undoStack().index();
    window.click("rig.suggest.use");
    ASSERT_TRUE(eventually([&] { return window.studio().document.undoStack().index() > steps; }));
    const std::shared_ptr<const Rig> made = window.state().rig.rig;
    EXPECT_EQ(made->actuatorCount(), wanted);
    expectSound(*made);
    ASSERT_TRUE(eventually([&] { return plot->openDevice() == dots[1]; })) << "the cross is the device that is open";
    EXPECT_EQ(plot->dots(), dots) << "another dot can be tried";
    window.screenshot("suggest_applied");
    while (window.studio().document.undoStack().index() > steps) window.studio().document.undoStack().undo();
    EXPECT_EQ(writeRigGlb(*window.state().rig.rig), before);
}

TEST_F(Suggest, AnotherRigEndsTheSearchAndOneThatIsNoSheetIsToldSo) {
    tickOnly({"Bowl"});
    window.click("rig.suggest.search");
    window.studio().project.openRig(std::filesystem::path(LUMORPH_SOURCE_DIR) / "resources/models/pin_display.glb");
    ASSERT_TRUE(eventually([&] { return window.findNow<QWidget>("rig.suggest.noSheet") != nullptr; }));
    for (const Jobs::Status& job : window.studio().jobs.running()) EXPECT_NE(job.place, "rig.suggest");
    EXPECT_NE(window.find<QPushButton>("empty.rig.new"), nullptr) << "what to do instead";
    window.screenshot("suggest_no_sheet");
}

} // namespace
} // namespace lumorph::studio

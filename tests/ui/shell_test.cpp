#include <algorithm>
#include <map>

#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QPushButton>
#include <QToolButton>

#include "app/studio/look/palette.h"
#include "app/workspaces/rig/rig_facts.h"
#include "tests/support/cut_tablet.h"
#include "tests/ui/studio_window.h"

// The frame around the workspaces: its bar, its menus, and the tour.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

const QStringList kWorkspaces{"rig", "field", "scene", "calibrate", "devices"};

class Shell : public ::testing::Test {
protected:
    /// The window comes back as the test before left it.
    Shell() { window.window().resize(1440, 900); }
    [[nodiscard]] std::vector<QMenu*> menusInSight() {
        std::vector<QMenu*> menus;
        auto* bar = window.window().findChild<QMenuBar*>();
        for (const QAction* action : bar->actions())
            if (action->isVisible()) menus.push_back(action->menu());
        return menus;
    }
    [[nodiscard]] QStringList entriesInSight(const QMenu& menu) {
        QStringList entries;
        for (const QAction* action : menu.actions())
            if (action->isVisible() && !action->isSeparator()) entries << action->text().remove('&');
        return entries;
    }
    [[nodiscard]] QRect inWindow(const QWidget& widget) {
        return {widget.mapTo(&window.window(), QPoint()), widget.size()};
    }

    TemporaryFolder folder;
    StudioWindow window{folder / "session", "scene"};
};

TEST_F(Shell, TabsAndMenusAreInOnePlaceAndHaveWordsOfTheirOwn) {
    std::map<QString, QRect> places;
    QStringList fileOrder;
    for (const int width : {1600, 1024, 760})
        for (const QString& workspace : kWorkspaces) {
            SCOPED_TRACE(workspace.toStdString() + " " + std::to_string(width));
            window.window().resize(width, 700);
            window.window().showWorkspace(workspace);
            pass(50ms);
            QStringList tabs;
            for (const QString& id : kWorkspaces) {
                auto* tab = window.find<QToolButton>("tab." + id);
                const QRect at = inWindow(*tab);
                if (!places.contains(id)) places[id] = at;
                EXPECT_EQ(at, places[id]) << id.toStdString();
                tabs << tab->text().toLower();
            }
            EXPECT_LE(inWindow(*window.find<QWidget>("stop")).right(), window.window().width());
            for (const QMenu* menu : menusInSight()) {
                const QString word = menu->title().remove('&').toLower();
                for (const QString& tab : tabs)
                    EXPECT_FALSE(tab.startsWith(word) || word.startsWith(tab)) << word.toStdString();
            }
            const QStringList file = entriesInSight(*window.window().findChild<QMenu*>("menu.File"));
            EXPECT_EQ(file.last(), "Quit");
            EXPECT_EQ(file.mid(0, 6),
                      (QStringList{"New project", "Open...", "Open rig...", "Open recent", "Save", "Save as..."}));
            for (const QString& entry : file) // those of all workspaces, merged: each keeps its place
                if (!fileOrder.contains(entry)) {
                    const qsizetype before = file.indexOf(entry);
                    fileOrder.insert(before == 0 ? 0 : fileOrder.indexOf(file[before - 1]) + 1, entry);
                }
            QStringList expected;
            for (const QString& entry : fileOrder)
                if (file.contains(entry)) expected << entry;
            EXPECT_EQ(file, expected);
        }
}

TEST_F(Shell, TourPointsAtWhatItMeansAndIsNeverClipped) {
    for (const QSize& size : {QSize(1600, 1000), QSize(1024, 700), QSize(760, 400)}) {
        window.window().resize(size);
        pass(100ms);
        window.studio().commands.find("help.tour")->trigger();
        auto* tour = window.find<QWidget>("tour");
        auto* card = window.find<QWidget>("tour.card");
        for (int step = 0; step < 5; ++step) {
            SCOPED_TRACE(std::to_string(size.width()) + " step " + std::to_string(step));
            pass(250ms); // a dock may have been raised
            window.screenshot(QString("tour-%1-%2").arg(size.width()).arg(step));
            const QRect box = inWindow(*card);
            EXPECT_TRUE(window.window().rect().adjusted(8, 40, -8, -28).contains(box))
                << "clear of bar and status line";
            for (const QLabel* label : card->findChildren<QLabel*>()) {
                EXPECT_GE(label->width(), label->sizeHint().width() * (label->wordWrap() ? 0 : 1));
                if (label->wordWrap()) {
                    EXPECT_GE(label->height(), label->heightForWidth(label->width()));
                }
                EXPECT_TRUE(card->rect().contains(QRect(label->mapTo(card, QPoint()), label->size())));
            }
            for (const QPushButton* button : card->findChildren<QPushButton*>())
                if (button->isVisible()) {
                    EXPECT_GE(button->width(), button->sizeHint().width()) << button->text().toStdString();
                    EXPECT_TRUE(card->rect().contains(QRect(button->mapTo(card, QPoint()), button->size())));
                }
            // The edge is in the accent's colour, whatever the picture behind it, and an arrow sticks out of it.
            const QImage picture = window.window().grab().toImage();
            const double scale = picture.devicePixelRatio();
            const auto at = [&](int x, int y) {
                return picture.pixelColor(std::clamp(static_cast<int>(x * scale), 0, picture.width() - 1),
                                          std::clamp(static_cast<int>(y * scale), 0, picture.height() - 1));
            };
            const auto near = [](const QColor& a, const QColor& b) {
                return std::abs(a.red() - b.red()) + std::abs(a.green() - b.green()) + std::abs(a.blue() - b.blue()) <
                       30;
            };
            int edge = 0;
            for (int x = box.left() + 20; x < box.right() - 20; ++x)
                for (int y = -1; y <= 3; ++y)
                    if (near(at(x, box.bottom() - y), studio::currentPalette().accent)) {
                        ++edge;
                        break;
                    }
            EXPECT_GT(edge, (box.width() - 40) * 8 / 10);
            int arrow = 0;
            const QRect around = box.adjusted(-5, -5, 5, 5);
            for (int x = around.left(); x <= around.right(); ++x)
                for (int y = around.top(); y <= around.bottom(); ++y)
                    if (!box.adjusted(-3, -3, 3, 3).contains(x, y) && near(at(x, y), studio::currentPalette().raised))
                        ++arrow;
            EXPECT_GT(arrow, 12);
            QTest::keyClick(tour, Qt::Key_Right);
        }
        EXPECT_TRUE(eventually([&] { return window.findNow<QWidget>("tour") == nullptr; }));
    }
}

TEST_F(Shell, TourShowsWhatItsButtonsDo) {
    window.studio().commands.find("view.resetLayout")->trigger(); // of a window that was small before
    window.studio().commands.find("help.tour")->trigger();
    auto* tour = window.find<QWidget>("tour");
    QTest::keyClick(tour, Qt::Key_Right); // servos, light, or both
    pass(250ms);
    const auto* button = window.find<QWidget>("scene.showing.physical.button");
    ASSERT_NE(button, nullptr);
    EXPECT_FALSE(tour->mask().contains(inWindow(*button).center()));
    const auto* lab = window.find<QWidget>("scene.lab");
    EXPECT_FALSE(tour->mask().contains(inWindow(*lab).center())) << "the picture is neither darkened nor shut";
}

// The same measure by the same name as `lumorph rig info` prints.
TEST(RigFacts, AmplitudeIsThatOfTheReport) {
    const Rig rig = test::cutTablet();
    const ShapeReport report = shapeReport(rig, 1, 1);
    for (std::size_t actuator = 0; actuator < rig.actuatorCount(); ++actuator) {
        const auto facts = studio::factsOf(rig, actuator, amplitudeOf(rig, actuator));
        const auto fact = std::ranges::find(facts, QString("Amplitude"), &studio::RigFact::name);
        ASSERT_NE(fact, facts.end());
        EXPECT_EQ(fact->value, QString("%1 mm").arg(1000.0 * report.actuators[actuator].amplitude, 0, 'f', 1));
    }
}

} // namespace
} // namespace lumorph::test

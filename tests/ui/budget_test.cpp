#include <cmath>
#include <set>

#include <QAbstractButton>
#include <QAction>
#include <QRegularExpression>

#include "app/studio/calibration/chain.h"
#include "app/studio/document/scene_edit.h"
#include "calibration/budget/error_budget.h"
#include "core/scene/measured_sigma.h"
#include "tests/ui/studio_window.h"

// Where the millimetres come from, as the window shows it, beside what is added up without it.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

struct ShownPart {
    double millimetres = 0.0;
    QString words;
};

class Budget : public ::testing::Test {
protected:
    Budget() {
        window.window().showWorkspace("calibrate");
        EXPECT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    }
    /// In the order of BudgetPart.
    [[nodiscard]] std::vector<ShownPart> parts() {
        std::vector<ShownPart> all;
        const auto* bar = window.find<QWidget>("budget.bar");
        static const QRegularExpression form("^.*: ([0-9.]+) mm, (.*)$");
        for (const QString& part : bar->accessibleDescription().split("; ", Qt::SkipEmptyParts)) {
            const auto match = form.match(part.trimmed());
            if (match.hasMatch())
                all.push_back({match.captured(1).toDouble(), match.captured(2)});
            else if (!all.empty())
                all.back().words += "; " + part; // words with a semicolon
        }
        return all;
    }
    [[nodiscard]] double shown(BudgetPart part) { return parts().at(static_cast<std::size_t>(part)).millimetres; }
    [[nodiscard]] double total() { return window.text("budget.total").section(' ', 0, 0).toDouble(); }
    void settle() {
        pass(20ms);
        ASSERT_TRUE(eventually([&] { return window.studio().jobs.running().empty(); }, 20s));
        pass(20ms);
    }
    [[nodiscard]] ErrorBudget expected(double speed = 0.3) {
        const Rig& rig = *window.state().rig.rig;
        const Installation& room = *window.state().installation;
        const SlipView view;
        CarryingHand hand;
        hand.speed = speed;
        return budgetOf(rig, slipModelOf(rig, room, view), errorsOf(room, rig, commandedOf(view, rig)), hand);
    }
    void expectShown(const ErrorBudget& budget) {
        EXPECT_NEAR(total(), 1e3 * budget.total, 0.051);
        double squares = 0.0;
        for (const BudgetItem& item : budget.items) {
            EXPECT_NEAR(shown(item.part), 1e3 * item.metres, 0.051) << keyOf(item.part);
            squares += std::pow(shown(item.part), 2);
        }
        EXPECT_NEAR(total(), std::sqrt(squares), 0.1) << "squares are added";
    }
    /// Colours of the square before the part's row: one is solid, more are a hatching.
    [[nodiscard]] std::size_t coloursBefore(BudgetPart part) {
        QWidget* bar = window.find<QWidget>("budget.bar");
        const QImage picture = bar->grab().toImage();
        const double scale = picture.devicePixelRatio();
        const auto rows = static_cast<double>(kBudgetParts);
        // The rows fill what is below the bar and its gap.
        const double top = 56.0, high = (bar->height() - top) / rows;
        const double middle = top + high * static_cast<double>(part) + 14.0; // words may be under the name
        std::set<QRgb> colours;
        for (int x = 3; x < 13; ++x)
            for (int y = -5; y < 5; ++y)
                colours.insert(picture.pixel(static_cast<int>(x * scale), static_cast<int>((middle + y) * scale)));
        return colours.size();
    }

    TemporaryFolder folder;
    StudioWindow window{folder.path(), "scene"};
};

TEST_F(Budget, TellsWhereTheMillimetresComeFromAndWhatHelps) {
    window.studio().commands.find("calibrate.budget")->trigger();
    ASSERT_TRUE(window.find<QWidget>("budget.bar"));
    settle();
    window.screenshot("budget");
    expectShown(expected());
    EXPECT_TRUE(window.text("budget.card.text").contains("nobody has said where the tracker's world lies"));

    // Twice as fast: twice as much of the delay, and nothing of what does not move.
    const std::vector<ShownPart> slow = parts();
    window.enter("budget.speed", "60 cm");
    const std::vector<ShownPart> fast = parts();
    for (const BudgetPart part : kAllBudgetParts) {
        const auto k = static_cast<std::size_t>(part);
        if (part == BudgetPart::prediction) continue;
        const double times = part == BudgetPart::delay ? 2.0 : 1.0;
        EXPECT_NEAR(fast[k].millimetres, times * slow[k].millimetres, part == BudgetPart::delay ? 0.15 : 0.0)
            << keyOf(part);
    }
    expectShown(expected(0.6));
    window.enter("budget.speed", "30 cm");

    // What lies on the surface itself needs no eye.
    EXPECT_GT(shown(BudgetPart::eye), 0.5);
    window.enter("budget.floats", "0 cm");
    settle();
    EXPECT_EQ(shown(BudgetPart::eye), 0.0);
    window.enter("budget.floats", "2 cm");
    settle();

    // A measurement that tells how sure it is.
    EXPECT_TRUE(parts()[static_cast<std::size_t>(BudgetPart::device)].words.startsWith("not measured"));
    EXPECT_GT(coloursBefore(BudgetPart::device), 3U);
    const double before = shown(BudgetPart::device), allBefore = total();
    studio::editInstallation(window.studio().document, "Measured", [](Installation& room) {
        room.origins.deviceBody = {Origin::Way::measured, withSigma("touched corners, 12", {0.0003, 0.0008, 0.0}),
                                   "2026-11-20T10:00:00Z"};
    });
    settle();
    expectShown(expected());
    EXPECT_LT(shown(BudgetPart::device), 0.05 * before);
    EXPECT_LT(total(), 0.7 * allBefore);
    EXPECT_EQ(parts()[static_cast<std::size_t>(BudgetPart::device)].words, "measured");
    EXPECT_EQ(coloursBefore(BudgetPart::device), 1U);
    EXPECT_GT(coloursBefore(BudgetPart::eye), 3U);

    // What the lab made is hatched, and said to be simulated.
    studio::editInstallation(window.studio().document, "Simulated",
                             [](Installation& room) { room.origins.deviceBody.way = Origin::Way::simulated; });
    settle();
    expectShown(expected());
    EXPECT_EQ(parts()[static_cast<std::size_t>(BudgetPart::device)].words, "simulated in the virtual lab");
    EXPECT_GT(coloursBefore(BudgetPart::device), 3U);
    window.screenshot("budget-simulated");
    window.studio().document.undoStack().undo();
    settle();

    // What is advised is the link that the button leads to.
    studio::editInstallation(window.studio().document, "Placed", [](Installation& room) {
        room.origins.tracker = {Origin::Way::measured, withSigma("touched dots, 12", {0.0003, 0.0008, 0.0}),
                                "2026-11-20T10:00:00Z"};
    });
    settle();
    ASSERT_EQ(expected().advice.front().part, BudgetPart::delay);
    EXPECT_EQ(window.text("budget.card.title"), "Measure delays");
    EXPECT_TRUE(window.text("budget.card.text")
                    .contains(QString("%1 mm").arg(1e3 * expected().advice.front().after, 0, 'f', 1)));
    window.screenshot("budget-advice");
    EXPECT_FALSE(window.find<QAbstractButton>("chain.link.delays")->isChecked());
    window.click("budget.card.next");
    EXPECT_FALSE(window.findNow<QWidget>("budget.view"));
    EXPECT_EQ(window.text("chain.card.title"), "Delays");
    EXPECT_TRUE(window.find<QAbstractButton>("chain.link.delays")->isChecked());

    // Out of the light, and without a device, it says what is missing in place of numbers of before.
    window.click("chain.budget");
    studio::editInstallation(window.studio().document, "Elsewhere", [](Installation& room) {
        for (InstalledProjector& projector : room.projectors) projector.camera.cameraFromWorld[3].x += 30.0F;
    });
    settle();
    EXPECT_EQ(window.text("budget.card.title"), "The millimetres cannot be added up");
    EXPECT_TRUE(window.text("budget.card.text").contains("Lay it into the light"));
    EXPECT_FALSE(window.findNow<QWidget>("budget.total"));
    window.studio().document.undoStack().undo();
    settle();
    expectShown(expected());
    window.studio().document.change("Nothing", [](studio::StudioState& state) { state.rig = {}; });
    settle();
    EXPECT_EQ(window.text("budget.card.title"), "No device is open");
    EXPECT_FALSE(window.findNow<QWidget>("budget.total"));
    window.screenshot("budget-nothing");
}

} // namespace
} // namespace lumorph::test

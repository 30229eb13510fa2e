#include <QAbstractButton>
#include <QLabel>

#include "app/studio/calibration/chain.h"
#include "app/studio/document/scene_edit.h"
#include "tests/ui/studio_window.h"

// From boxes to a calibrated show in the window, by the mouse: each link is measured in the lab, shown, and used.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using studio::LinkStand;

class Chain : public ::testing::Test {
protected:
    Chain() {
        window.window().showWorkspace("calibrate");
        window.click("calibrate.whole");
    }
    [[nodiscard]] QString badge(const QString& link) { return window.text("chain.link." + link + ".how"); }
    [[nodiscard]] QString button() {
        const auto* next = window.findNow<QAbstractButton>("chain.card.next");
        return next ? next->text() : QString();
    }
    [[nodiscard]] bool offers(const QString& words) {
        return eventually([&] { return button() == words; }, 120s);
    }
    void next() {
        pass(std::chrono::milliseconds(QApplication::doubleClickInterval() + 50));
        window.click("chain.card.next");
    }
    [[nodiscard]] const Installation& room() { return *window.state().installation; }
    [[nodiscard]] std::string story() {
        return (window.text("chain.card.title") + ": " + window.text("chain.card.text")).toStdString();
    }

    TemporaryFolder folder;
    StudioWindow window{folder.path(), "scene"};
};

TEST_F(Chain, EachLinkIsMeasuredShownAndUsed) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    window.screenshot("chain");
    window.click("chain.link.tracker");
    EXPECT_EQ(badge("tracker"), "Later") << "the pointer comes first";
    window.click("chain.link.pointer");
    ASSERT_TRUE(offers("Measure in the lab")) << story();
    next();
    ASSERT_TRUE(offers("Use it")) << story();
    window.screenshot("chain-pointer");
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::assumed) << "nothing is used before one says so";
    next();
    ASSERT_TRUE(eventually([&] { return badge("pointer") == "Measured"; })) << story();
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::measured);
    EXPECT_GT(glm::length(room().pointerTip), 0.1F) << "the lab's pointer is long";
    window.studio().document.undoStack().undo();
    EXPECT_EQ(room().origins.pointer.way, Origin::Way::assumed);
    EXPECT_EQ(badge("pointer"), "To be used") << "undo gives it back to be used";
    window.studio().document.undoStack().redo();
    EXPECT_EQ(badge("pointer"), "Measured");
}

TEST_F(Chain, AllThatIsMissingIsMeasuredOneAfterTheOther) {
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    studio::editInstallation(window.studio().document, "Measured before", [](Installation& room) {
        room.projectors.front().lens = {Origin::Way::measured, "structured light", "2026-11-20T10:00:00Z"};
    });
    window.click("chain.rest");
    ASSERT_TRUE(eventually([&] { return badge("servos") == "Running"; }, 120s)) << story();
    EXPECT_EQ(window.text("chain.warning"), "Hands off: the servos move");
    window.screenshot("chain-servos");
    // STOP ends it, and nothing of it is kept.
    window.studio().loop.stop();
    EXPECT_TRUE(eventually([&] { return badge("servos") == "Next"; }));
    EXPECT_TRUE(room().servos.empty());
    window.studio().loop.resume();
    window.click("chain.rest");
    ASSERT_TRUE(eventually([&] { return badge("check") == "Measured"; }, 300s)) << story();
    for (const studio::ChainLink& link : studio::chainLinks())
        EXPECT_EQ(badge(link.key), "Measured") << link.key << ": " << story();
    EXPECT_EQ(room().servos.size(), window.state().rig.rig->actuatorCount());
    window.screenshot("chain-checked");
    window.click("chain.link.servos");
    pass(300ms);
    window.screenshot("chain-servos-measured");
    window.click("chain.link.eye");
    pass(300ms);
    window.screenshot("chain-eye");
}

// The lab's camera sees the room as it was when the watch began.
TEST_F(Chain, TheWatchTellsAHostThatTheProjectorHasMoved) {
    window.window().showWorkspace("scene");
    ASSERT_TRUE(eventually([&] { return window.state().rig.rig && window.studio().jobs.running().empty(); }, 60s));
    window.studio().commands.find("calibrate.watch")->setChecked(true);
    pass(3s);
    EXPECT_TRUE(window.studio().notices.at("calibrate").empty());
    studio::editInstallation(window.studio().document, "Believed elsewhere", [](Installation& room) {
        room.projectors.front().camera.cameraFromWorld[3].x += 0.006;
    });
    ASSERT_TRUE(eventually([&] { return !window.studio().notices.at("calibrate").empty(); }, 120s));
    pass(500ms);
    window.screenshot("watch-moved");
    const studio::Notice notice = window.studio().notices.at("calibrate").front();
    ASSERT_EQ(notice.actions.size(), 1U);
    notice.actions.front().run();
    EXPECT_EQ(window.window().workspace(), "calibrate");
    EXPECT_EQ(window.text("chain.card.title"), "Check");
    window.studio().commands.find("calibrate.watch")->setChecked(false);
    EXPECT_TRUE(window.studio().notices.at("calibrate").empty()) << "nobody watches any more";
}

} // namespace
} // namespace lumorph::test
